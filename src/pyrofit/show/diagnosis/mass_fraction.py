"""Mass of the TGA, before and after."""

from pyrofit.show.diagnosis.curves import CAPTION, has, of_signal
from pyrofit.show.figure import Figure

FIGURE = Figure(
    place=22,
    applies=lambda found: has(found, "mass_fraction"),
    make=of_signal("mass_fraction"),
    title="Mass of the TGA, before and after",
    caption=CAPTION,
)
