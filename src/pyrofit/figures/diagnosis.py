"""The diagnosis, drawn: candidates, what can be told from what, probes, the next experiment."""

import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas

from pyrofit.config import Study
from pyrofit.figures import style
from pyrofit.figures.diagnosed_curves import has, of_signal
from pyrofit.figures.diagnosed_shapes import probes, profiles
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.tables.diagnosis import CLAIMS, ranked, remark

Found = Mapping[str, Any]

FOLDER = "diagnosis"
MOST = 20
"""Candidates that a figure shows."""
WRAP = 42
"""Letters of a line beside the candidates."""
MOST_DESIGNS = 12
FAMILIES = {"apparatus": "xxxx", "environment": "////", "material": ""}
"""Hatching of each family, so that they stay apart in grey."""
_LIMIT: dict[str, Any] = {"color": "black", "linewidth": 0.8, "linestyle": (0, (4, 2))}
_BASE: dict[str, Any] = {"color": style.COLOURS[1], "linewidth": 1.2}
_KEPT: dict[str, Any] = {"marker": "o", "linestyle": "none", "color": style.COLOURS[0]}
_REJECTED: dict[str, Any] = {**_KEPT, "markerfacecolor": "white"}


def _ranking(study: Study, results: Results) -> Canvas:
    """Draw the penalised chi-square of the candidates above that of the best."""
    found = diagnosis.read(study, results)
    shown = ranked(found)[:MOST]
    lowest = float(shown[0]["penalised"])
    labels = [textwrap.fill(_label(candidate), WRAP) for candidate in shown]
    reasons = [_reason(found, candidate) for candidate in shown]
    lines = max(text.count("\n") + 1 for text in (*labels, *reasons))
    height = max(5.2, 0.8 + 2.6 * lines)
    canvas, (ax,) = style.panels(1, 1, style.TWO_COLUMNS, 26.0 + height * len(shown))
    limit = float(found["ambiguity"])
    base, points = float(found["base"]["chi2"]) - lowest, float(found["base"]["points"])
    needed = base - (float(found["needed"]) - np.log(points))
    ax.set_xscale("symlog", linthresh=1.0, linscale=0.5)
    right = 1.8 * max(base, *(float(c["penalised"]) - lowest for c in shown), limit)
    ax.axvspan(needed, right, color=style.BAND, linewidth=0.0)
    ax.axvline(limit, **_LIMIT)
    ax.axvline(base, **_BASE)
    for i, candidate in enumerate(shown):
        look = _REJECTED if candidate["rejected"] else _KEPT
        ax.plot([candidate["penalised"] - lowest], [i], **look, markersize=4.5)
        place: dict[str, Any] = {
            "va": "center",
            "ha": "left",
            "transform": ax.get_yaxis_transform(),
        }
        ax.text(1.015, i, reasons[i], fontsize=6.5, **place)
    ax.set_yticks(range(len(shown)), labels, fontsize=6.5)
    ax.set_ylim(len(shown) - 0.4, -0.6)
    ax.set_xlim(min(-0.3, 1.3 * needed), right)
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("penalised χ² above that of the best candidate [–]")
    kept = "in the verdict" if found["verdict"]["kind"] in CLAIMS else "not rejected"
    entries: list[Any] = [
        style.line(kept, **_KEPT, markersize=4.5),
        style.line("rejected", **_REJECTED, markersize=4.5),
        style.line(f"not told apart below {limit:g}", **_LIMIT),
        style.line("base model", **_BASE),
        style.patch("an effect gains too little", color=style.BAND),
    ]
    style.legend_below(canvas, entries)
    return canvas


def _reason(found: Found, candidate: Found) -> str:
    """Say what speaks against a candidate, in two lines at most."""
    said = textwrap.shorten(remark(found, candidate), 2 * WRAP - 6, placeholder=" …")
    return textwrap.fill(said, WRAP, break_on_hyphens=False)


def _label(candidate: Found) -> str:
    """Name a candidate: its effects, and the form parameters that were free."""
    parts = []
    for effect in candidate["effects"]:
        forms = candidate["free"].get(effect, ())[1:]
        parts.append(f"{effect} ({', '.join(forms)})" if forms else str(effect))
    return " + ".join(parts)


def _effects(study: Study, results: Results) -> Canvas:
    """Draw how well each effect would show, and which look alike."""
    found = diagnosis.read(study, results)
    names = [str(name) for name in found["confusability"]["effects"]]
    screen = {str(s["effect"]): s for s in found["screen"]}
    order = sorted(range(len(names)), key=lambda i: (_family(screen[names[i]]), names[i]))
    names = [names[i] for i in order]
    cosine = np.asarray(found["confusability"]["cosine"], dtype=float)[np.ix_(order, order)]
    canvas, (bars, image) = style.panels(
        2, 2, style.TWO_COLUMNS, max(75.0, 34.0 + 3.5 * len(names)), width_ratios=[1.0, 1.55]
    )
    style.letter([bars, image], ["how well each would show", "which look alike"])
    _bars(bars, [screen[name] for name in names], float(found["base"]["score_critical"]))
    # Both signs of a cosine mean alike: a strength of the other sign.
    drawn = image.imshow(np.abs(cosine), cmap="Greys", vmin=0.0, vmax=1.0, aspect="auto")
    for i, k in zip(*np.nonzero(np.abs(cosine) >= 0.9), strict=True):
        if i != k:
            image.text(k, i, "×", ha="center", va="center", color="white", fontsize=7)
    image.set_xticks(range(len(names)), names, rotation=90, fontsize=6)
    image.set_yticks(range(len(names)), [])
    image.tick_params(length=0)
    canvas.colorbar(drawn, ax=image, label="|cosine| [–]", shrink=0.7)
    entries = [
        style.patch(family, facecolor=style.colour(i), hatch=hatch, edgecolor="white")
        for i, (family, hatch) in enumerate(FAMILIES.items())
    ]
    score = style.line(
        "score z of the residuals", marker="D", markersize=3, color="black", linestyle="none"
    )
    level = style.line("its critical value", **_LIMIT)
    style.legend_below(canvas, [*entries, score, level])
    return canvas


def _family(row: Found) -> int:
    return list(FAMILIES).index(str(row["family"])) if row["family"] in FAMILIES else len(FAMILIES)


def _bars(ax: Axes, rows: Sequence[Found], critical: float) -> None:
    """Draw detectability, and the score that was found."""
    sizes = [float(row["detectability"]) for row in rows]
    scores = [float(row["z"]) for row in rows]
    for i, (row, size) in enumerate(zip(rows, sizes, strict=True)):
        family = _family(row)
        hatch = [*FAMILIES.values(), ""][family]
        look: dict[str, Any] = {"color": style.colour(family), "hatch": hatch, "edgecolor": "white"}
        ax.barh(i, size, height=0.75, **look, linewidth=0.0)
    ax.plot(scores, range(len(rows)), "D", color="white", markersize=4.6)
    ax.plot(scores, range(len(rows)), "D", color="black", markersize=3)
    ax.axvline(critical, **_LIMIT)
    ax.set_xscale("log")
    ax.set_xlim(0.3, 2.0 * max([*sizes, *scores, 10.0]))
    ax.set_yticks(range(len(rows)), [str(row["effect"]) for row in rows], fontsize=6)
    ax.set_ylim(len(rows) - 0.5, -0.5)
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("standard deviations [–]")


def _next(study: Study, results: Results) -> Canvas:
    """Draw how well each planned experiment would separate what is not told apart."""
    found = diagnosis.read(study, results)
    shown = sorted(found["next_experiment"], key=lambda d: -float(d["separation_sd"]))[
        :MOST_DESIGNS
    ]
    canvas, (ax,) = style.panels(1, 1, style.TWO_COLUMNS, 24.0 + 5.5 * len(shown))
    longest = 0.0
    for i, design in enumerate(shown):
        ax.barh(i, float(design["separation_sd"]), height=0.62, color=style.COLOURS[0])
        pairs = design.get("pairs")
        sizes = [float(v) for v in pairs.values()] if isinstance(pairs, dict) else []
        ax.plot(sizes, [i] * len(sizes), "o", color="black", markersize=3, clip_on=False)
        longest = max([longest, float(design["separation_sd"]), *sizes])
    ax.axvline(np.sqrt(found["ambiguity"]), **_LIMIT)
    ax.set_yticks(range(len(shown)), [d["words"] for d in shown], fontsize=6.5)
    ax.set_ylim(len(shown) - 0.5, -0.5)
    ax.set_xlim(0.0, 1.06 * max(4.0, longest))
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("separation [standard deviations]")
    entries: list[Any] = [
        style.patch("the two models separated least", color=style.COLOURS[0]),
        style.line("each two models", marker="o", color="black", markersize=3, linestyle="none"),
        style.line("told apart", **_LIMIT),
    ]
    style.legend_below(canvas, entries)
    return canvas


@dataclass(frozen=True)
class Figure:
    """A figure of the diagnosis: when there is one, how it is drawn, and what it shows."""

    applies: Callable[[Found], bool]
    make: Callable[[Study, Results], Canvas]
    title: str
    caption: str


_CURVES = (
    "Above: measured with twice the standard deviation of its noise, the base model, and the model "
    "with the effects found, if any. Below: simulated minus measured in standard deviations, every "
    "point (thin) and the running mean over 3 % of the points (bold). Shaded stretches are those "
    "where the base model is off to one side by more than noise would be, with their phase."
)
DIAGNOSIS_FIGURES: dict[str, Figure] = {
    "mass_loss_rate": Figure(
        applies=lambda found: has(found, "mlr"),
        make=of_signal("mlr"),
        title="Mass loss rate, before and after",
        caption=_CURVES,
    ),
    "back_temperature": Figure(
        applies=lambda found: has(found, "back_temperature"),
        make=of_signal("back_temperature"),
        title="Back temperature, before and after",
        caption=_CURVES,
    ),
    "mass_fraction": Figure(
        applies=lambda found: has(found, "mass_fraction"),
        make=of_signal("mass_fraction"),
        title="Mass of the TGA, before and after",
        caption=_CURVES,
    ),
    "ranking": Figure(
        applies=lambda found: bool(found["candidates"]),
        make=_ranking,
        title="Candidates, the best first",
        caption="Chi-square with log(points) for each parameter of an effect, above that of the "
        "best candidate; linear below 1, logarithmic beyond. What lies left of the dashed line is "
        "not told apart from the best by the fit alone; in the grey area one effect gains too "
        "little to be claimed. In brackets: parameters of the form that were fitted, too. "
        f"At most {MOST} are shown.",
    ),
    "profiles": Figure(
        applies=lambda found: bool(found["profiles"]),
        make=profiles,
        title="How sure the strengths are",
        caption="Rise of chi-square with the strength of each effect found, all else fitted anew "
        "at every point. The 95 % interval lies below the dashed line, at 3.84 times chi-square "
        "per degree of freedom.",
    ),
    "effects": Figure(
        applies=lambda found: bool(found["screen"]) and bool(found["confusability"]["effects"]),
        make=_effects,
        title="What these measurements can show",
        caption="a) Bars: by how many standard deviations each effect of typical strength would "
        "show after all parameters were fitted anew; short bars cannot be found with these "
        "measurements. Diamonds: how far the residuals of the base model point its way. b) Cosine "
        "between what two effects leave after such a refit; dark ones look alike, crosses mark "
        "0.9 and more.",
    ),
    "probes": Figure(
        applies=lambda found: any(p["shape"] for p in found["probes"]),
        make=probes,
        title="What would absorb the misfit",
        caption="Free curves, each put into the model in one place and fitted with all parameters, "
        "and the share of the excess of chi-square that they absorb; grey lines: no correction.",
    ),
    "next_experiments": Figure(
        applies=lambda found: bool(found["next_experiment"]),
        make=_next,
        title="What to measure next",
        caption="By how many standard deviations planned experiments would separate the models "
        "that the data cannot tell apart, or else the two best ones: those that are separated "
        "least (bars) and each two (points).",
    ),
}


def draw_all(results: Results, study: Study) -> list[str]:
    """Write ``diagnosis/<name>.svg`` and ``.png`` of all figures there are; return their names.

    Raises
    ------
    DataError
        A result is missing or broken.
    """
    names = figures_of(study, results)
    with style.style():
        for name in names:
            canvas = DIAGNOSIS_FIGURES[name].make(study, results)
            if study.is_synthetic:
                canvas.suptitle(f"{DIAGNOSIS_FIGURES[name].title} (synthetic data)")
            style.save(canvas, results, name, FOLDER)
    for name in set(DIAGNOSIS_FIGURES) - set(names):  # of an earlier diagnosis
        for kind in ("svg", "png"):
            results.diagnosis(f"{name}.{kind}").unlink(missing_ok=True)
    return names


def figures_of(study: Study, results: Results) -> list[str]:
    """Return the names of the figures that a diagnosis has."""
    found = diagnosis.read(study, results)
    return [name for name, figure in DIAGNOSIS_FIGURES.items() if figure.applies(found)]
