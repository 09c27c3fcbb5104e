"""Sensitivity of the signals to the parameters."""

from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv
from pyrofit.results.identification import noise
from pyrofit.show import style
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.identification.sentences import correlation
from pyrofit.show.units import difference, difference_unit


def sensitivities(study: Study, results: Results) -> Canvas:
    """Draw d curve / d parameter times the distance of its limits against time, by signal."""
    words = dict.fromkeys(("experiment", "signal", "parameter"), object)
    columns = {**words, **dict.fromkeys(("time_s", "si"), float)}
    frame = read_csv(results.identification("sensitivities.csv"), columns)
    signals = noise(results).channels
    canvas, axes = style.panels(len(signals), 2, style.TWO_COLUMNS, 72.0)
    style.letter(axes, [title_of(study, c.experiment) for c in signals])
    looks = {
        name: {"color": style.colour(i), "linestyle": style.dashes(i + i // len(style.COLOURS))}
        for i, name in enumerate(study.imp.estimate)
    }
    for ax, signal in zip(axes, signals, strict=True):
        experiment = study.experiments[signal.experiment]
        quantity = experiment.quantity(signal.signal)
        here = frame[
            (frame["experiment"] == signal.experiment) & (frame["signal"] == signal.signal)
        ]
        sd = float(difference(quantity, signal.sd_median))
        ax.axhspan(-sd, sd, color=style.BAND, linewidth=0.0)
        for name, look in looks.items():
            curve = here[here["parameter"] == name]
            ax.plot(curve["time_s"], difference(quantity, curve["si"]), **look)
        style.zero_line(ax)
        ax.set_xlabel("time [s]")
        title = experiment.words(signal.signal).replace(" (", "\n(")
        unit = difference_unit(quantity)
        ax.set_ylabel(f"change of {title}\nper search range [{unit}]")
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
    verdict=lambda study, facts: correlation(facts.estimates),
    title="Sensitivity of the signals",
    caption="Change of each signal per distance of a parameter's limits, at the optimum. A "
    "curve within the noise (grey area) at all times tells little about its "
    "parameter. Parameters with curves of the same shape cannot be distinguished.",
)
