"""Rates of right and wrong claims with their intervals, over the table of all twins."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pandas as pd
from scipy.stats import beta

DETECTABLE = 10.0
"""Detectability from which an effect should be named [standard deviations]."""
EDGES = (0.0, 3.0, 10.0, 30.0, 100.0, np.inf)
"""Limits of the classes of detectability [standard deviations]."""
LEVEL = 0.95
Mask = Callable[[pd.DataFrame], "pd.Series[bool]"]


@dataclass(frozen=True)
class Rate:
    """The share of twins for which a column of the table is true, among some of them."""

    words: str
    among: Mask
    hit: str


def rate_interval(hits: int, of: int) -> tuple[float, float]:
    """Return the 95 % interval of a rate (Clopper and Pearson 1934, doi 10.1093/biomet/26.4.404).

    Its coverage is at least 95 %, also for few twins.

    Examples
    --------
    No false alarm in 100: the rate is below 1 - 0.025^(1/100).

    >>> [round(float(bound), 4) for bound in rate_interval(0, 100)]
    [0.0, 0.0362]
    """
    tail = 0.5 * (1.0 - LEVEL)
    low = beta.ppf(tail, hits, of - hits + 1) if hits > 0 else 0.0
    high = beta.ppf(1.0 - tail, hits + 1, of - hits) if hits < of else 1.0
    return float(low), float(high)


def _of(kind: str) -> Mask:
    return lambda t: t["kind"] == kind


def _plain(t: pd.DataFrame) -> "pd.Series[bool]":
    return (t["kind"] == "effect") & (t["detectability"] >= DETECTABLE)


def _weak(t: pd.DataFrame) -> "pd.Series[bool]":
    back = t["signals"].str.contains("back")
    return (t["kind"] == "effect") & (t["strength"] < 1.0) & back


def _everything(t: pd.DataFrame) -> "pd.Series[bool]":
    return t["kind"].notna()


def _claimed(among: Mask) -> Mask:
    return lambda t: among(t) & t["claim"]


def _verdict(among: Mask, kind: str) -> Mask:
    return lambda t: among(t) & (t["verdict"] == kind)


def _candidate(among: Mask) -> Mask:
    return lambda t: among(t) & t["is_candidate"]


def _again(kind: str) -> Mask:
    return lambda t: (t["kind"] == kind) & (t["left_out"] != "")


def _confirmed(t: pd.DataFrame) -> "pd.Series[bool]":
    return t["confirmed"].astype(bool)


def _predicted(t: pd.DataFrame) -> "pd.Series[bool]":
    return (t["kind"] == "effect") & t["claim"] & t["held_out_gain"].notna()


RATES = (
    Rate("effect of 10 sd or more: claimed", _plain, "claim"),
    Rate("effect of 10 sd or more, claimed: name right", _claimed(_plain), "right"),
    Rate("effect of 10 sd or more, named: name right", _verdict(_plain, "named"), "right"),
    Rate(
        "effect of 10 sd or more, ambiguous: best fit right", _verdict(_plain, "ambiguous"), "right"
    ),
    Rate("effect of 10 sd or more, claimed: group right", _claimed(_plain), "group_right"),
    Rate("effect of 10 sd or more: largest score right", _plain, "score_only_right"),
    Rate(
        "effect of 10 sd or more, claimed: largest score right",
        _claimed(_plain),
        "score_only_right",
    ),
    Rate("effect of part strength, back temperature: name right", _weak, "right"),
    Rate(
        "effect of part strength, back temperature, claimed: name right", _claimed(_weak), "right"
    ),
    Rate("effect, claimed: hidden effect in set", _claimed(_of("effect")), "in_set"),
    Rate("effect, claimed: held-out prediction better", _predicted, "held_out_better"),
    Rate("any claim: a wrong name (false discovery)", _claimed(_everything), "wrong"),
    Rate("confirmed claim: a wrong name (false discovery)", _confirmed, "wrong"),
    Rate("no hidden effect: claimed", _of("null"), "claim"),
    Rate("no hidden effect: verdict unknown", _of("null"), "unknown"),
    Rate(
        "effect removed from candidates: another group named",
        _again("effect"),
        "left_out_wrong",
    ),
    Rate(
        "pair, the second removed from candidates: another group named",
        _again("pair"),
        "left_out_wrong",
    ),
    Rate("pair, the second removed from candidates: the first named", _again("pair"), "kept_named"),
    Rate("pair: both in the sets", _of("pair"), "in_set"),
    Rate("pair: both lead", _of("pair"), "all_lead"),
    Rate("pair, claimed: no other effect leads", _claimed(_of("pair")), "right"),
    Rate("wrong description: misfit noticed", _of("error"), "noticed"),
    Rate("wrong description: an effect claimed", _of("error"), "claim"),
    Rate("wrong description: a wrong name with certainty", _of("error"), "surely_wrong"),
    Rate("other form: claimed", _of("form"), "claim"),
    Rate("other form, claimed: group right", _claimed(_of("form")), "group_right"),
    Rate(
        "other form, hidden effect a candidate, claimed: name right",
        _claimed(_candidate(_of("form"))),
        "right",
    ),
)


def rates(twins: pd.DataFrame) -> pd.DataFrame:
    """Return the rates over all twins, by signals and by noise, without those of no twin."""
    return pd.DataFrame(
        [
            {"quantity": rate.words, "by": by, "of": of, **_rate(part[rate.among(part)], rate.hit)}
            for rate in RATES
            for by, of, part in _parts(twins)
            if bool(rate.among(part).any())
        ]
    )


def _parts(twins: pd.DataFrame) -> Iterator[tuple[str, str, pd.DataFrame]]:
    yield "all", "", twins
    for by in ("signals", "noise"):
        for value in sorted(twins[by].unique()):
            yield by, str(value), twins[twins[by] == value]


def _rate(part: pd.DataFrame, hit: str) -> dict[str, float]:
    count, hits = len(part), int(part[hit].sum())
    low, high = rate_interval(hits, count) if count else (0.0, 1.0)
    share = hits / count if count else np.nan
    return {"hits": hits, "twins": count, "rate": share, "low": low, "high": high}


def by_detectability(twins: pd.DataFrame) -> pd.DataFrame:
    """Return the shares of effects claimed and rightly named, by class of detectability."""
    effects = twins[twins["kind"] == "effect"]
    rows = []
    for low, high in pairwise(EDGES):
        here = effects[(effects["detectability"] >= low) & (effects["detectability"] < high)]
        for what, hit in SHARES.items():
            rows.append({"from_sd": low, "to_sd": high, "share": what, **_rate(here, hit)})
    return pd.DataFrame(rows)


SHARES = {
    "claimed": "claim",
    "rightly named": "right",
    "largest score right": "score_only_right",
}
"""Columns of the shares that are drawn against detectability."""


def middles(twins: pd.DataFrame) -> pd.DataFrame:
    """Return means and medians over claimed effects, by signals.

    Gaps are root mean squares of whitened residuals; 1 is expected of a right model.
    """
    claimed = twins[(twins["kind"] == "effect") & twins["claim"]]
    gaps = [f"{r}_{w}" for r in ("calibration", "held_out") for w in ("before", "after")]
    rows = []
    for _, of, part in _parts(claimed):
        row: dict[str, object] = {"of": of or "all", "twins": len(part)}
        row["set_size_mean"] = part["set_size"].mean()
        row |= {f"{name}_median": part[name].median() for name in (*gaps, "held_out_gain")}
        rows.append(row)
    return pd.DataFrame(rows)


def cpu_times(twins: pd.DataFrame) -> pd.DataFrame:
    """Return the CPU time of a diagnosis by its verdict [s]."""
    parts = [("all", twins), *twins.groupby("verdict")]
    return pd.DataFrame(
        [
            {
                "verdict": verdict,
                "twins": len(part),
                "median_s": part["seconds"].median(),
                "longest_s": part["seconds"].max(),
            }
            for verdict, part in parts
        ]
    )


def window_rates(twins: pd.DataFrame) -> pd.DataFrame:
    """Return means of precision, recall and F1 of the windows, over effects of 10 sd or more."""
    seen = twins[_plain(twins)]
    names = ("window_precision", "window_recall", "window_f1")
    return pd.DataFrame(
        [
            {"of": of or "all", "twins": len(part), **{name: part[name].mean() for name in names}}
            for _, of, part in _parts(seen)
        ]
    )


def coverage(strengths: pd.DataFrame) -> pd.DataFrame:
    """Return how often the 95 % intervals of the strengths hold the truth.

    ``fitted model`` is the interval in the model that was fitted, ``wide`` the one over other forms
    and models.
    """
    rows = []
    for what, hit in (("fitted model", "covered"), ("wide", "covered_wide")):
        for by in ("all", "signals", "noise", "effect"):
            for of, part in [("", strengths)] if by == "all" else strengths.groupby(by):
                if len(part):
                    rows.append({"interval": what, "by": by, "of": str(of), **_rate(part, hit)})
    return pd.DataFrame(rows)


def bias(parameters: pd.DataFrame) -> pd.DataFrame:
    """Return errors of the base parameters without and with the effects of right claims.

    Mean and root mean square of (fitted - truth) / truth in per cent, and how often the 95 %
    interval holds the truth.
    """
    repaired = parameters[parameters["right"].astype(bool) & parameters["after"].notna()]
    rows = []
    for name, part in repaired.groupby("parameter", sort=False):
        row: dict[str, object] = {"parameter": name, "twins": len(part)}
        for when in ("before", "after"):
            off = 100.0 * part[f"{when}_off"].to_numpy(float)
            covered = _rate(part, f"{when}_covered")
            row |= {f"{when}_mean_%": off.mean(), f"{when}_rms_%": np.sqrt(np.mean(off**2))}
            row |= {f"{when}_covered": covered["rate"]}
            row |= {f"{when}_covered_{end}": covered[end] for end in ("low", "high")}
        rows.append(row)
    return pd.DataFrame(rows)
