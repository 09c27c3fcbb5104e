"""Predictions of tests that were not made."""

from pyrofit.analysis.uses import ESTIMATES, SCEUA, STARTED, predicted_sets
from pyrofit.config import Study
from pyrofit.config.check.unmeasured import unmeasured
from pyrofit.quantities import known_quantities
from pyrofit.results import prediction
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.curves import curve_of_set, label_axes, look_of, panels_of, set_entries
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.units import shown


def draw_predictions(study: Study, results: Results) -> Canvas:
    """Draw the predicted curves of every set, one panel per experiment and quantity."""
    pairs = [(name, q) for name, quantities in unmeasured(study).items() for q in quantities]
    canvas, axes = panels_of(study, pairs)
    sets = predicted_sets(study)
    drawn = [chosen for chosen in sets if chosen.origin in (ESTIMATES, SCEUA, *STARTED)]
    curves = prediction.unmeasured_curves(study, results, [chosen.label for chosen in sets])
    for ax, (name, quantity) in zip(axes, pairs, strict=True):
        for chosen in drawn:
            curve = curve_of_set(curves, name, quantity, chosen.label)
            values = shown(known_quantities()[quantity], curve["simulated"])
            ax.plot(curve["time_s"], values, **look_of(study, chosen))
    label_axes(axes, [known_quantities()[quantity].label for _, quantity in pairs])
    style.legend_below(canvas, set_entries(study, drawn))
    return canvas


FIGURE = Figure(
    place=60,
    applies=lambda study: bool(unmeasured(study)),
    make=draw_predictions,
    title="Predictions without a measurement",
    caption="The estimates, and the best sets of all cost functions and optimisers at experiments "
    "that nobody measured. The distance between the curves shows how much the choice of a set "
    "matters. It is no prediction interval.",
)
