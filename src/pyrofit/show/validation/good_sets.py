"""Predictions of the good sets, drawn."""

from typing import Any

from matplotlib.figure import Figure as Canvas

from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.quantities import known_quantities
from pyrofit.results import recorded
from pyrofit.results.comparison import ALL
from pyrofit.results.comparison import bands as band_curves
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.figure import Figure
from pyrofit.show.names import data_name

_BAND: dict[str, Any] = {"color": "#9ecae1", "linewidth": 0.0}


_AXES = {
    "mlr": ("mass loss rate [g/(m² s)]", 1e3, 0.0),
    "back_temperature": ("back temperature [°C]", 1.0, -273.15),
}


def good_sets(study: Study, results: Results) -> Canvas:
    """Draw what the good sets predict, over time, beside the data."""
    frame = band_curves(study, results)
    channels = list(frame[["experiment", "signal"]].drop_duplicates().itertuples(index=False))
    canvas, axes = style.panels(len(channels), 2, style.TWO_COLUMNS, 62.0)
    style.letter(axes, [title_of(study, name) for name, _ in channels])
    looks = style.cost_styles(study)
    stated = False
    for ax, (name, signal) in zip(axes, channels, strict=True):
        label, factor, shift = _AXES[signal]
        measured = recorded.series(study, results, name, signal)
        time, value = measured["time_s"], measured[known_quantities()[signal].column]
        if known_quantities()[signal].uncertainty_column in measured:
            stated = True
            sd = measured[known_quantities()[signal].uncertainty_column]
            low, high = (factor * (value + side * sd) + shift for side in (-1.0, 1.0))
            ax.fill_between(time, low, high, color=style.BAND, linewidth=0.0)
        here = frame[(frame["experiment"] == name) & (frame["signal"] == signal)]
        around = here[here["cost_function"] == (ALL if len(looks) > 1 else next(iter(looks)))]
        low, high = (factor * around[end] + shift for end in ("low", "high"))
        ax.fill_between(around["time_s"], low, high, **_BAND)
        ax.plot(time, factor * value + shift, color=style.MEASURED, linewidth=0.7)
        for cost, look in looks.items():
            best = here[here["cost_function"] == cost]
            ax.plot(best["time_s"], factor * best["best"] + shift, **{**look, "linewidth": 0.9})
        ax.set_xlim(left=0.0)
        ax.set_xlabel("time [s]")
        ax.set_ylabel(label)
    data = data_name(study, [(name, signal) for name, signal in channels])
    entries: list[Any] = [style.line(data, color=style.MEASURED, linewidth=0.7)]
    entries += [style.patch("uncertainty", color=style.BAND)] if stated else []
    entries.append(style.patch("reach of the good sets", color=_BAND["color"]))
    entries += [style.line(f"{c}, lowest cost known", **look) for c, look in looks.items()]
    style.legend_below(canvas, entries)
    return canvas


FIGURE = Figure(
    place=50,
    applies=lambda study: bool(study.validation.experiments),
    make=good_sets,
    title="What the good sets predict",
    caption="Lowest and highest prediction of all sets whose cost is near the lowest known one "
    "(blue), and the set of the lowest cost for each cost function. Data outside the "
    "blue area are missed by all sets that fit well: what is wrong there is the model or its "
    "given values, not the choice of a set.",
)
