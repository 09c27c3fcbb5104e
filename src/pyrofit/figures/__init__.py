"""The figures of a study, as SVG and PNG."""

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure as Canvas

from pyrofit.config import Study
from pyrofit.errors import StudyError, suggest
from pyrofit.figures import compared, curves, determined, style
from pyrofit.figures.convergence import fig5
from pyrofit.figures.cost_functions import R, fig1
from pyrofit.figures.kinetics import fig2, kinetics_all_rates
from pyrofit.results.files import Results
from pyrofit.tables.describe import predicted, rates_in_fit


@dataclass(frozen=True)
class Figure:
    """A figure: when a study has it, how it is drawn, and what it shows."""

    applies: Callable[[Study], bool]
    make: Callable[[Study, Results], Canvas]
    title: str
    caption: str
    paper: str = ""
    """Figure of the paper that it reproduces, such as 'Figure 3'."""


FIGURES: dict[str, Figure] = {
    "fig1": Figure(
        applies=lambda study: True,
        make=fig1,
        title="What the cost functions count",
        paper="Figure 1",
        caption="An example, the same for every study: target (solid), model (dashed), the "
        "distance that counts (green, hatched; green bars for a single point and a threshold), and "
        "the area in which a model costs nothing (light blue). The numbers are the costs of this "
        "example. a) Relative difference at one time. b) Time at which the model passes a level "
        "that the target passes at the dot. c) to e) Root mean square of the shaded differences "
        "divided by the mean of the target: to the target, to its band of uncertainty, to "
        f"{100 * R:g} % about it (usually 5 %). f) Three of them added with weights, BANDS over "
        "part of the time.",
    ),
    "fig2": Figure(
        applies=lambda study: bool(rates_in_fit(study)),
        make=fig2,
        title="Kinetics at the fitted heating rates",
        paper="Figure 2",
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
        title="Mass loss rate, fitted",
        paper="Figure 3",
        caption="Mass loss rate of the fitted experiment: the data with their uncertainty (grey "
        "area), and the best set that SCE-UA found for each cost function; thin grey "
        "curves with markers, if any, are our solver's for sets of the literature. Curves on "
        "top of each other mean that the choice of the cost function makes no difference here; "
        "long stretches outside the grey area are what no set explains.",
    ),
    "fig4": Figure(
        applies=lambda study: bool(curves.held_out_rates(study)),
        make=curves.fig4,
        title="Mass loss rate, predicted",
        paper="Figure 4",
        caption="The same sets at an experiment that was not fitted. Agreement among the simulated "
        "curves is not agreement with the data: compare them with the grey area.",
    ),
    "fig5": Figure(
        applies=lambda study: True,
        make=fig5,
        title="Convergence of SCE-UA",
        paper="Figure 5",
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
        title="Mass loss rate of the optimisers",
        caption="The best sets of least squares (dots) and CMA-ES (squares) beside those of "
        "SCE-UA. Where a lower cost at the fitted experiment comes with a worse prediction "
        "elsewhere, the fitted data do not determine the parameters, or these make up for "
        "something that the model lacks.",
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
    "spread": Figure(
        applies=lambda study: True,
        make=compared.spread,
        title="Where the sets of all repetitions lie",
        caption="Each dot is the best set of one repetition of SCE-UA, in their order from left to "
        "right; beside them the best sets of the other optimisers; to the left those of the "
        "literature, if any. The axis ends at the limits. Dots all over the height: the search "
        "finds no one value. Dots at one height but off the grey area, or off the truth: the "
        "searches agree on a value that the data, with the noise of each point, do not support.",
    ),
    "correlation_of_sets": Figure(
        applies=lambda study: study.imp.repetitions > 2,
        make=compared.correlation_of_sets,
        title="Correlation of the sets of all repetitions",
        caption="Spearman's correlation over the repetitions of SCE-UA, ranked within each cost "
        "function. It tells along which combinations of parameters the searches come to rest, and "
        "need not be that of the likelihood.",
    ),
    "good_sets": Figure(
        applies=lambda study: bool(study.validation.experiments),
        make=compared.good_sets,
        title="What the good sets predict",
        caption="Lowest and highest prediction of all sets whose cost is near the lowest known one "
        "(blue), and the set of the lowest cost for each cost function. Data outside the "
        "blue area are missed by all sets that fit well: what is wrong there is the model or its "
        "given values, not the choice of a set.",
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
