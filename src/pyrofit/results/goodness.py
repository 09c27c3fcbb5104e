"""The stored test of a fit, one file for each stage."""

from pydantic import TypeAdapter, ValidationError

from pyrofit.errors import DataError
from pyrofit.estimate.goodness import Goodness
from pyrofit.results.files import Results

FILE = "goodness.json"
_GOODNESS = TypeAdapter(Goodness)


def write(results: Results, stage: str, found: Goodness) -> None:
    """Write the test of a stage's fit, 'kinetics' or 'imp'."""
    path = results.identification(FILE, stage)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(_GOODNESS.dump_json(found, indent=1) + b"\n")


def read(results: Results, stage: str) -> Goodness:
    """Return it.

    Raises
    ------
    DataError
        It is missing or broken.
    """
    path = results.identification(FILE, stage)
    try:
        return _GOODNESS.validate_json(path.read_bytes())
    except FileNotFoundError:
        raise DataError(f"{path}: there is no such result; run the step identify") from None
    except ValidationError as error:
        raise DataError(f"{path}: {error.errors()[0]['msg']}; run the step identify anew") from None
