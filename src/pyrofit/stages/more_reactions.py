"""Which reactions describe masses better that the study's own reactions miss."""

from collections.abc import Iterator

from pyrofit.config import Study
from pyrofit.errors import StudyError
from pyrofit.estimate.targets import Measurements
from pyrofit.logs import Tell
from pyrofit.results import goodness
from pyrofit.results.files import Results
from pyrofit.scheme.choice import choose_scheme
from pyrofit.scheme.fit import SchemeSetting
from pyrofit.scheme.records import records_of
from pyrofit.scheme.settings import SchemeSettings

SETTINGS = SchemeSettings()
BETTER = 0.8
"""Error of predictions over that of the study's reactions, below which others are offered."""


def more_reactions(
    study: Study,
    results: Results,
    measurements: Measurements,
    tell: Tell,
    settings: SchemeSettings = SETTINGS,
) -> Iterator[str]:
    """Choose a reaction scheme where a fit misses its masses; yield a sentence on its gain.

    Nothing where the fit describes them, where there is none, and where masses of fewer than two
    rates are fitted.
    """
    stage = "imp" if study.kinetics is None else "kinetics"
    if not results.identification(goodness.FILE, stage).exists():
        return
    if goodness.read(results, stage).describes:
        return
    try:
        records = tuple(records_of(study, measurements, settings.points))
    except StudyError:
        return
    found = choose_scheme(SchemeSetting(study, measurements, records, settings), tell)
    ours, theirs = found.own.left_out_rms, found.chosen.left_out_rms
    words = found.chosen.fitted.posed.words
    if theirs > BETTER * ours:
        yield (
            "No scheme of up to four reactions predicts heating rates left out of its fit clearly "
            f"better than that of the study. The rms is {theirs:.2g} and {ours:.2g} of the initial "
            "mass. Look at the records themselves: mass, temperature, baseline."
        )
        return
    yield (
        f"{words[0].upper()}{words[1:]} predict heating rates left out of the fit with an rms of "
        f"{theirs:.2g} of the initial mass, the reactions of the study with {ours:.2g}. `pyrofit "
        "scheme STUDY --write FILE` writes the study with them."
    )
