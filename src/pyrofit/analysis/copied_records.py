"""Records that hold the numbers of another file, in words."""

from collections.abc import Iterator, Mapping

import pandas as pd

from pyrofit.config import Study
from pyrofit.data.copies import Copy, columns_alike, copies, is_copy
from pyrofit.data.suspect import LOOK
from pyrofit.quantities.base import Quantity

Key = tuple[str, str]


def notes_on_copies(
    study: Study, frames: Mapping[Key, pd.DataFrame], sources: Mapping[Key, str]
) -> Iterator[tuple[Key, str]]:
    """Yield (experiment, signal) and a note for each series whose numbers stand in another file."""
    keys = list(frames)
    quantities = [study.experiments[name].quantity(signal) for name, signal in keys]
    series = [
        (of.name, frames[key][of.column].to_numpy(float))
        for key, of in zip(keys, quantities, strict=True)
    ]
    for found in copies(series):
        key, other = keys[found.position], keys[found.of]
        if sources[key] != sources[other] and is_copy(found, frames[key], frames[other]):
            said = numbers_of(found, quantities[found.position], frames[key], frames[other])
            yield key, f"{LOOK}{said} {sources[other]}. Leave one of both out"


def numbers_of(found: Copy, quantity: Quantity, frame: pd.DataFrame, other: pd.DataFrame) -> str:
    """Say which columns of a record are those of another one, whose name is to follow."""
    columns = columns_alike(found, frame, other)
    besides = f", with {' and '.join(columns)}," if columns else ""
    return f"{found.words} of the {quantity.title}{besides} are those of"
