"""Sensitivity of the signals to the parameters."""

from matplotlib.figure import Figure as Canvas

from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv
from pyrofit.results.identification import noise
from pyrofit.show import style
from pyrofit.show.figure import Figure

_UNITS: dict[str, tuple[str, str, float]] = {
    "mlr": ("mass loss rate", "g/(m² s)", 1e3),
    "back_temperature": ("back temperature", "K", 1.0),
}


def sensitivities(study: Study, results: Results) -> Canvas:
    """Draw d curve / d parameter times the distance of its limits against time, by channel."""
    words = dict.fromkeys(("experiment", "signal", "parameter"), object)
    columns = {**words, **dict.fromkeys(("time_s", "si"), float)}
    frame = read_csv(results.identification("sensitivities.csv"), columns)
    channels = noise(results)["channels"]
    canvas, axes = style.panels(len(channels), 2, style.TWO_COLUMNS, 72.0)
    style.letter(axes, [title_of(study, c["experiment"]) for c in channels])
    looks = {
        name: {"color": style.colour(i), "linestyle": style.dashes(i + i // len(style.COLOURS))}
        for i, name in enumerate(study.imp.estimate)
    }
    for ax, channel in zip(axes, channels, strict=True):
        label, unit, factor = _UNITS[channel["signal"]]
        here = frame[
            (frame["experiment"] == channel["experiment"]) & (frame["signal"] == channel["signal"])
        ]
        sd = factor * channel["sd_median"]
        ax.axhspan(-sd, sd, color=style.BAND, linewidth=0.0)
        for name, look in looks.items():
            curve = here[here["parameter"] == name]
            ax.plot(curve["time_s"], factor * curve["si"], **look)
        style.zero_line(ax)
        ax.set_xlabel("time [s]")
        ax.set_ylabel(f"change of {label}\nper limits' distance [{unit}]")
    style.legend_below(
        canvas,
        [
            *(style.line(name, **look) for name, look in looks.items()),
            style.patch("± sd of the noise", color=style.BAND),
        ],
    )
    return canvas


FIGURE = Figure(
    place=30,
    applies=lambda study: True,
    make=sensitivities,
    title="Sensitivity of the signals",
    caption="Change of each signal per distance of a parameter's limits, at the optimum. A "
    "curve within the noise (grey area) at all times tells little of its parameter; parameters "
    "whose curves have the same shape cannot be told apart.",
)
