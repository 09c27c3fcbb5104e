"""The result of the preview: written by the step, read by its tables, figures and sentences."""

from pydantic import Field

from pyrofit.results.files import Results, write_json
from pyrofit.results.record import Record, read_record

FOUND, BANDS = "preview.json", "bands.csv"
"""Files of the findings, and of the band of every record."""


class Window(Record):
    """Points of a record that lie beside all that the sets reach."""

    experiment: str = Field(description="name of the experiment")
    signal: str = Field(description="name of the signal")
    begins: float = Field(description="first point outside [s], or [K] of a heated sample")
    ends: float = Field(description="last point outside [s] or [K]")
    above: bool = Field(description="above all sets, else below")
    largest: float = Field(description="largest distance from the band, SI unit of the signal")
    share: float = Field(description="the same over the range of the record [-]")


class NearestSet(Record):
    """A record and the set that comes nearest to all records at once."""

    experiment: str = Field(description="name of the experiment")
    signal: str = Field(description="name of the signal")
    left: float = Field(description="root mean square of their difference over the range [-]")


class Likely(Record):
    """A likely cause."""

    cause: str = Field(description="kind of cause")
    places: list[str] = Field(description="experiments, or the parameter, that it concerns")
    words: str = Field(description="the cause in words")
    explained: float = Field(description="part of the squared difference that it explains [-]")
    left: float = Field(description="root mean square difference that is left, over the range [-]")


class HeldUp(Record):
    """A temperature that water holds up, in a slab whose model holds none."""

    experiment: str = Field(description="name of the test")
    signal: str = Field(description="name of the signal")
    temperature_K: float = Field(description="where its rise is slowest [K]")


class Preview(Record):
    """What the data are beside all that the limits allow."""

    sets: int = Field(description="number of sets")
    unfinished: dict[str, int] = Field(description="runs that did not finish, by experiment")
    windows: list[Window] = Field(description="where records lie outside")
    nearest: list[NearestSet] = Field(description="the set nearest to all records, of each record")
    far: bool = Field(description="no set comes near all records at once")
    causes: list[Likely] = Field(description="likely causes, the likeliest first")
    unmoved: list[str] = Field(description="parameters that move no signal beyond its noise")
    held_up: list[HeldUp] = Field([], description="temperatures that show water without a model")


def write(results: Results, found: Preview) -> None:
    """Write the findings; temperatures that are held up only where there are any."""
    left_out = set() if found.held_up else {"held_up"}
    write_json(results.of_step("preview", FOUND), found.model_dump(exclude=left_out))


def read(results: Results) -> Preview:
    """Return the findings.

    Raises
    ------
    DataError
        They are missing or broken.
    """
    return read_record(results.of_step("preview", FOUND), Preview)
