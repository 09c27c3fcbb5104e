"""Back temperature, before and after."""

from pyrofit.show.diagnosis.curves import CAPTION, has, of_signal
from pyrofit.show.figure import Figure

FIGURE = Figure(
    place=21,
    applies=lambda found: has(found, "back_temperature"),
    make=of_signal("back_temperature"),
    title="Back temperature, before and after",
    caption=CAPTION,
)
