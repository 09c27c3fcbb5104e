"""The figures of a study, as SVG and PNG."""

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure as Canvas

from pyrofit.config import Study
from pyrofit.errors import StudyError, suggest
from pyrofit.figures import curves, determined, style
from pyrofit.figures.convergence import fig5
from pyrofit.figures.kinetics import fig2, kinetics_all_rates
from pyrofit.files import Results
from pyrofit.tables.describe import predicted, rates_in_fit


@dataclass(frozen=True)
class Figure:
    """A figure: when a study has it, how it is drawn, and what it shows."""

    applies: Callable[[Study], bool]
    make: Callable[[Study, Results], Canvas]
    title: str
    caption: str


FIGURES: dict[str, Figure] = {
    "fig2": Figure(
        applies=lambda study: bool(rates_in_fit(study)),
        make=fig2,
        title="Figure 2. Kinetics at the fitted heating rates",
        caption="Normalised mass (left) and mass loss rate (right) against temperature at the "
        "heating rates used in the fit, the slowest to the left: data (wide, light), fitted "
        "(dashed), sets of the literature, if any (dotted). The rate is divided by the heating "
        "rate, so that all are of similar height; it is the slope of a parabola fitted to each "
        "10 K of the mass, of data and simulations alike. Good kinetics shift with the heating "
        "rate as the data do.",
    ),
    "kinetics_all_rates": Figure(
        applies=lambda study: study.kinetics is not None,
        make=kinetics_all_rates,
        title="Kinetics at all heating rates",
        caption="Mass against temperature at the fitted and compared heating rates. Panels without "
        "'in fit' are predictions: a set that only fits where it was fitted fails there.",
    ),
    "fig3": Figure(
        applies=lambda study: bool(curves.fitted_rates(study)),
        make=curves.fig3,
        title="Figure 3. Mass loss rate, fitted",
        caption="Mass loss rate of the fitted experiment: the data with their uncertainty (grey "
        "area), and the best set that SCE-UA found for each cost function; thin grey "
        "curves, if any, are our solver's for sets of the literature. Curves on top of each "
        "other mean that the choice of the cost function makes no difference here; long "
        "stretches outside the grey area are what no set explains.",
    ),
    "fig4": Figure(
        applies=lambda study: bool(curves.held_out_rates(study)),
        make=curves.fig4,
        title="Figure 4. Mass loss rate, predicted",
        caption="The same sets at an experiment that was not fitted. Agreement among the simulated "
        "curves is not agreement with the data: compare them with the grey area.",
    ),
    "fig5": Figure(
        applies=lambda study: True,
        make=fig5,
        title="Figure 5. Convergence of SCE-UA",
        caption="Lowest cost found so far, from the lowest to the highest of the repetitions "
        "(area) and their median (line), by generation and by model calls. The scale is "
        "logarithmic and each cost function has its own: heights of different cost functions are "
        "not comparable. Where the dashed line, the best of least squares on the same cost, lies "
        "below the area, SCE-UA did not reach the lowest known cost; a narrow area alone does not "
        "show that it did.",
    ),
    "optimisers": Figure(
        applies=lambda study: bool(predicted(study, "mlr")),
        make=curves.optimisers,
        title="Mass loss rate of the two optimisers",
        caption="The best sets of least squares (dots) beside those of SCE-UA. Where a lower cost "
        "at the fitted experiment comes with a worse prediction elsewhere, the fitted data do not "
        "determine the parameters, or these make up for something that the model lacks.",
    ),
    "sensitivities": Figure(
        applies=lambda study: True,
        make=determined.sensitivities,
        title="Sensitivity of the signals",
        caption="Change of each signal per distance of a parameter's limits, at the optimum. A "
        "curve within the noise (grey area) at all times tells little of its parameter; parameters "
        "whose curves have the same shape cannot be told apart.",
    ),
    "correlation": Figure(
        applies=lambda study: True,
        make=determined.correlation,
        title="Correlation of the estimates",
        caption="Near ±1 the data determine a combination of two parameters and not each of them.",
    ),
    "profiles": Figure(
        applies=lambda study: True,
        make=determined.profiles,
        title="Profiles of the likelihood",
        caption="Rise of χ² over its least value against each parameter. Where it follows its "
        "parabola to the 95 % level, the linear interval is quoted; else the profile, all other "
        "parameters fitted anew at each point. Where a profile meets a limit (vertical line) below "
        "the level, the limit cuts the interval off.",
    ),
    "residuals": Figure(
        applies=lambda study: bool(predicted(study, "mlr")),
        make=curves.residuals,
        title="Residuals of the mass loss rate",
        caption="Mass loss rate of the best sets minus that of the data: every point (thin) and "
        "the running mean over 3 % of the points (bold), and the uncertainty of the data "
        "about zero (grey area). Noise scatters about zero; long stretches on one side are "
        "systematic.",
    ),
    "back_temperature": Figure(
        applies=lambda study: bool(predicted(study, "back_temperature")),
        make=curves.back_temperature,
        title="Back temperature",
        caption="Temperature of the back of the sample, the data with their uncertainty and "
        "predicted by the same sets. Where it was not fitted, it tests whether the parameters have "
        "a physical meaning.",
    ),
}


def make_figure(name: str, study: Study, results: Results) -> None:
    """Write one figure to ``figures/<name>.svg`` and ``.png``.

    Raises
    ------
    StudyError
        There is no such figure, or the study does not have it.
    """
    if name not in FIGURES:
        raise StudyError(f"unknown figure '{name}'. {suggest(name, FIGURES)}")
    figure = FIGURES[name]
    if not figure.applies(study):
        raise StudyError(f"study '{study.name}' has no {name}: it lacks what the figure shows")
    with style.style():
        canvas = figure.make(study, results)
        if study.is_synthetic:
            canvas.suptitle(f"{figure.title} (synthetic data)")
        style.save(canvas, results, name)
