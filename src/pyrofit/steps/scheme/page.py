"""The choice of a reaction scheme: tables and figure, and a section of the report."""

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Axes, Canvas, DrawStyle
from pyrofit.show.figure import Figure
from pyrofit.show.page import page_of_step
from pyrofit.show.parts import Passage, study_to_run
from pyrofit.show.subjects.kinetics.drawing import rate_of, slope
from pyrofit.show.table import Row, Table
from pyrofit.show.units import celsius
from pyrofit.solver.arrays import FloatArray
from pyrofit.steps.scheme import record
from pyrofit.steps.scheme.record import OfScheme


def schemes(study: Study, results: Results) -> pd.DataFrame:
    """List the schemes, best prediction first, those without predictions by BIC behind them."""
    found = record.read(study, results)
    least = min(s.bic for s in found.schemes)
    ordered = sorted(
        [*found.schemes, found.own],
        key=lambda s: (s.log_score is None, -(s.log_score or 0.0), s.bic),
    )
    return pd.DataFrame([_row(s, s.name == found.chosen, least) for s in ordered])


def _row(s: OfScheme, chosen: bool, least: float) -> Row:
    return {
        "scheme": s.words,
        "chosen": "chosen" if chosen else "",
        "parameters": s.parameters,
        "bic": s.bic - least,
        "log_score": s.log_score,
        "rms": s.rms,
        "predicted_rms": s.predicted_rms,
        "held_out_rms": s.held_out_rms,
        "discrepancy": s.discrepancy,
    }


def scheme_parameters_table(study: Study, results: Results) -> pd.DataFrame:
    """List the parameters of the chosen scheme."""
    found = record.read(study, results)
    return pd.DataFrame(
        [
            {
                "parameter": name,
                "meaning": p.label,
                "value": p.value,
                "low": p.low,
                "high": p.high,
                "unit": p.unit,
                "remark": "at a limit" if p.at_limit else "",
            }
            for name, p in found.parameters.items()
        ]
    )


SCHEMES = Table(
    place=60,
    make=schemes,
    title="Reaction schemes and their predictions",
    note="BIC: above the least one. Log score: log density of all heating rates, each "
    "predicted by a fit to the others; the higher, the better. Deviations are root "
    "mean squares of the mass over the initial mass. They are given for the fit, for "
    "heating rates left out of it, and for records that were not fitted. Left over: "
    "standard deviation of the misfit beyond the noise.",
    headings={
        "bic": "BIC",
        "log_score": "log score",
        "rms": "fit",
        "predicted_rms": "rates left out",
        "held_out_rms": "records not fitted",
        "discrepancy": "left over",
    },
)
PARAMETERS = Table(
    place=70,
    make=scheme_parameters_table,
    title="Parameters of the chosen scheme",
    note="Linear 95 % intervals within the limits. A reference temperature is that at which the "
    "rate constant is 0.001 1/s.",
)


LOOKS: dict[str, DrawStyle] = {
    "before": {"color": style.COLOURS[1], "linestyle": style.DASHES[1], "linewidth": 1.0},
    "after": {"color": style.COLOURS[0], "linestyle": "-", "linewidth": 1.0},
    "predicted": {"color": style.COLOURS[2], "linestyle": style.DASHES[3], "linewidth": 1.1},
}
_LABELS = {
    "before": "scheme of the study",
    "after": "chosen scheme",
    "predicted": "chosen scheme, rate left out",
}
_MEASURED: DrawStyle = {"color": style.MEASURED, "linewidth": 0.8}


def draw_schemes(study: Study, results: Results) -> Canvas:
    """Draw one row of panels for each record."""
    curves = record.read_scheme_curves(results)
    names = sorted(
        curves["experiment"].unique(),
        key=lambda n: study.experiments[n].heating_rate_K_min,  # type: ignore[union-attr]
    )
    canvas, axes = style.panels(3 * len(names), 3, style.TWO_COLUMNS, 38.0)
    titles = []
    for i, name in enumerate(names):
        here = curves[curves["experiment"] == name]
        _draw(axes[3 * i : 3 * i + 3], here)
        held = "" if bool(here["calibrated"].iloc[0]) else ", not fitted"
        titles += [f"{rate_of(study, name)}{held}", "slope", "residual"]
    style.letter(axes, titles)
    for ax in axes[-3:]:
        ax.set_xlabel("temperature [°C]")
    entries = [style.line("measured", **_MEASURED)]
    entries += [style.line(_LABELS[name], **look) for name, look in LOOKS.items()]
    style.legend_below(canvas, entries)
    return canvas


def _draw(axes: list[Axes], curve: pd.DataFrame) -> None:
    mass, rate, left = axes
    temperature = curve["temperature_K"].to_numpy(float)
    at = celsius(temperature)
    measured = curve["measured"].to_numpy(float)
    mass.plot(at, measured, **_MEASURED)
    _draw_slope(rate, temperature, measured, _MEASURED)
    style.zero_line(left)
    for name, look in LOOKS.items():
        simulated = curve[name].to_numpy(float)
        mass.plot(at, simulated, **look)
        _draw_slope(rate, temperature, simulated, look)
        left.plot(at, simulated - measured, **look)
    busy = np.flatnonzero((measured < 0.995) & (measured > 0.005))
    ends = (busy[0], busy[-1]) if busy.size else (0, -1)
    for ax in axes:
        ax.set_xlim(at[ends[0]] - 20.0, at[ends[1]] + 20.0)
    mass.set_ylabel("$m/m_0$ [–]")
    rate.set_ylabel("−d$(m/m_0)$/d$T$ [1/K]")
    left.set_ylabel("sim. − meas. [–]")


def _draw_slope(ax: Axes, temperature: FloatArray, mass: FloatArray, look: DrawStyle) -> None:
    grid, rate = slope(temperature, mass)
    ax.plot(celsius(grid), rate, **look)


FIGURE = Figure(
    place=10,
    make=draw_schemes,
    title="Reaction scheme of the study and the chosen one",
    caption="At every heating rate, the slowest at the top: mass over initial mass (left), "
    "its slope over temperature (middle), simulated minus measured mass (right). "
    "Black: measured; red, dashed: the scheme of the study, fitted alike. Blue: the "
    "chosen scheme; ochre, dotted: prediction of the chosen scheme, fitted without "
    "this heating rate. Rates marked 'not fitted' are predicted by every curve.",
)


def _sentences(study: Study, results: Results) -> list[str]:
    found = record.read(study, results)
    return [found.words, found.rule]


def _extended(study: Study, results: Results) -> list[Passage]:
    path = results.of_step("scheme", record.read(study, results).extended_study)
    return [study_to_run("chosen scheme", "chosen scheme at its fitted values", path)]


PAGE = page_of_step(
    "scheme",
    heading="Reaction scheme",
    text="The scheme that predicts heating rates left out of its fit.",
    tables={"schemes": SCHEMES, "parameters": PARAMETERS},
    figures={"scheme": FIGURE},
    sentences=_sentences,
    prefix="",
    more=_extended,
)
