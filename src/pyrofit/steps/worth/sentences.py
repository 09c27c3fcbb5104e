"""Which test to make next, in sentences."""

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.text import listed, several
from pyrofit.steps.worth import record
from pyrofit.steps.worth.facts import LITTLE, label, share_left
from pyrofit.steps.worth.record import OfTest, Worth

UNLIKE = 15.0
"""Difference of the check from the linear number that is mentioned [% of the present sd]."""
MOST_NAMED = 3


def sentences(study: Study, results: Results) -> list[str]:
    """Return the sentences on the worth of planned tests."""
    found = record.read(study, results)
    return [_best(study, found), *_check(study, found), *_useless(found), *_left_out(found)]


def _best(study: Study, found: Worth) -> str:
    test = found.tests[0]
    left = share_left(found, test)
    parameters = sorted(study.imp.estimate, key=lambda name: left[name])[:MOST_NAMED]
    names = [*parameters, *found.predictions]
    shares = [f"{left[name]:.0f} % ({label(study, found, name)})" for name in names]
    exact = "described" if found.apparatus == "exact" else "uncertain"
    return (
        f"With the apparatus taken as {exact}, {test.words} narrows parameters and predictions "
        f"most, of {several(len(found.tests), 'planned test')}. Of the present standard "
        f"deviations it leaves {listed(shares)}."
    )


def _check(study: Study, found: Worth) -> list[str]:
    """Say how far refits of drawn data agree with the linear numbers."""
    checked = [test for test in found.tests if test.checked is not None]
    if not checked:
        return []
    apart = {
        (test.words, name): abs(value - share_left(found, test)[name])
        for test in checked
        for name, value in share_left(found, test, checked=True).items()
    }
    (words, name), most = max(apart.items(), key=lambda pair: pair[1])
    about = f"The best {len(checked)} were checked by refits of {found.draws} drawn data sets"
    if most <= UNLIKE:
        return [
            f"{about}, which agree: the numbers differ by at most {most:.0f} percentage points."
        ]
    return [
        f"{about}. Their numbers differ most for {label(study, found, name)} with {words}, by "
        f"{most:.0f} percentage points: the linear numbers are rough there."
    ]


def _useless(found: Worth) -> list[str]:
    none = [test.words for test in found.tests if _narrows(found, test) < LITTLE]
    return [f"Nothing is narrowed by {LITTLE:g} % or more by {listed(none)}."] if none else []


def _narrows(found: Worth, test: OfTest) -> float:
    return max(100.0 - left for left in share_left(found, test).values())


def _left_out(found: Worth) -> list[str]:
    return [f"Left out, as its simulation does not finish: {words}." for words in found.left_out]
