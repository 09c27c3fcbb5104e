"""Mass loss rate, before and after."""

from pyrofit.show.diagnosis.curves import CAPTION, has, of_signal
from pyrofit.show.figure import Figure

FIGURE = Figure(
    place=20,
    applies=lambda found: has(found, "mlr"),
    make=of_signal("mlr"),
    title="Mass loss rate, before and after",
    caption=CAPTION,
)
