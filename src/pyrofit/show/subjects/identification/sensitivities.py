"""Sensitivity of the signals to the parameters."""

import numpy as np

from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv
from pyrofit.results.identification import read_noise
from pyrofit.show import style
from pyrofit.show.curves import tests_of, title_of_test
from pyrofit.show.drawn import Axes, Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.subjects.identification.sentences import strongest_correlation
from pyrofit.show.units import difference, difference_unit
from pyrofit.solver.arrays import FloatArray

USUAL, SPIKE, ROOM = 0.98, 10.0, 2.0
"""Quantile of all values that is usual, times it that are a spike, and times it that are shown."""


def sensitivities(study: Study, results: Results) -> Canvas:
    """Draw d curve / d parameter times the distance of its limits against time, by signal."""
    words = dict.fromkeys(("experiment", "signal", "parameter"), object)
    columns = {**words, **dict.fromkeys(("time_s", "si"), float)}
    frame = read_csv(results.identification("sensitivities.csv"), columns)
    channels = {(c.experiment, c.signal): c for c in read_noise(results).channels}
    tests = tests_of(study, list(channels))
    signals = [channels[pairs[0]] for pairs in tests]
    canvas, axes = style.panels(len(signals), 2, style.TWO_COLUMNS, 72.0)
    style.letter(axes, [title_of_test(study, pairs) for pairs in tests])
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
        cut = _cut_spikes(ax, difference(quantity, here["si"].to_numpy(float)))
        ax.set_xlabel(f"time [s]{cut}")
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


def _cut_spikes(ax: Axes, values: FloatArray) -> str:
    """Cut spikes off, as at burn-out, beside which nothing else would be seen; say how high."""
    size = np.abs(values)
    usual, largest = float(np.quantile(size, USUAL)), float(size.max())
    if not largest > SPIKE * usual > 0.0:
        return ""
    ax.set_ylim(-ROOM * usual, ROOM * usual)
    return f"\na peak up to {largest:.2g} is cut off"


FIGURE = Figure(
    place=30,
    make=sensitivities,
    verdict=lambda study, facts: strongest_correlation(facts.estimates),
    title="Sensitivity of the signals",
    caption="Change of each signal per distance of a parameter's limits, at the optimum. A "
    "curve within the noise (grey area) at all times tells little about its "
    "parameter. Parameters with curves of the same shape cannot be distinguished.",
)
