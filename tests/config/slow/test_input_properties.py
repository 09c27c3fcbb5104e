"""What holds for whatever is read: files of any valid shape, and mistakes of any kind."""

import copy
import itertools
import json
import string
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from bad_input import FILES, STUDY
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pyrofit.config import as_study, read_study
from pyrofit.data.series import read_series
from pyrofit.data.spec import SeriesSpec
from pyrofit.errors import DataError, StudyError
from pyrofit.quantities import known_quantities
from pyrofit.quantities.units import SCALES, ZEROS_K

fixed = settings(
    derandomize=True,
    deadline=None,
    max_examples=200,
    database=None,
    # The folder is the same for all examples: each writes its own file over the last.
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)

# --- measured series ------------------------------------------------------------------------

RANGES = {
    "mlr": ("mass flux", -1e-3, 0.1),
    "back_temperature": ("temperature", 250.0, 1500.0),
    "mass_fraction": ("fraction", 0.0, 1.2),
}
SPELLINGS = (str.lower, str.upper, str.title, str.swapcase, lambda h: h.replace(" ", "_"))
FORMATS = ("{:.17g}", "{:.16e}", "{!r}", "+{:.17g}")


def units(kind: str) -> st.SearchStrategy[str]:
    return st.sampled_from(sorted(SCALES[kind]))


def written(value: float, unit: str, kind: str, style: str) -> str:
    """Write an SI value in a unit, as a laboratory would."""
    shift = ZEROS_K.get(unit, 0.0) / SCALES[kind][unit]
    text = style.format(value / SCALES[kind][unit] - shift)
    return text.replace("+-", "-")


@st.composite
def series(draw: st.DrawFn) -> tuple[str, dict[str, list[float]], str]:
    """Draw a quantity, its columns in SI units, and a file that holds them."""
    quantity = draw(st.sampled_from(sorted(RANGES)))
    kind, low, high = RANGES[quantity]
    n = draw(st.integers(3, 8))
    steps = draw(st.lists(st.floats(0.01, 500.0), min_size=n, max_size=n))
    columns = {"time": (list(itertools.accumulate(steps)), "time")}
    if quantity == "mass_fraction":
        hot = draw(st.lists(st.floats(300.0, 1200.0), min_size=n, max_size=n))
        columns["temperature"] = (hot, "temperature")
    values = draw(st.lists(st.floats(low, high), min_size=n - 1, max_size=n - 1))
    # One point that no rule on signs and sizes refuses.
    columns["value"] = ([0.9 * high, *values], kind)
    unit = {role: draw(units(kind)) for role, (_, kind) in columns.items()}
    header = {
        role: draw(st.sampled_from(SPELLINGS))(
            draw(st.sampled_from(known_quantities()[quantity].roles[role]))
        )
        for role in columns
    }
    order = draw(st.permutations(sorted(columns)))
    comma = draw(st.sampled_from([",", ";", "\t", " ; "]))
    style = draw(st.sampled_from(FORMATS))
    quote = draw(st.sampled_from(["{}", "{}", '"{}"'])) if comma != " ; " else "{}"
    names = [header[role] for role in order]
    measures = [unit[role] for role in order]
    heading = draw(st.sampled_from(["units below", "units in brackets", "units above"]))
    if heading == "units in brackets":
        top = [[f"{name} [{one}]" for name, one in zip(names, measures, strict=True)]]
    else:
        top = [names, [f"[{one}]" for one in measures]]
        top = top[::-1] if heading == "units above" else top
    rows = [
        [quote.format(written(columns[r][0][i], unit[r], columns[r][1], style)) for r in order]
        for i in range(n)
    ]
    end = draw(st.sampled_from(["\n", "\r\n", "\r"]))
    text = end.join(comma.join(row) for row in [*top, *rows]) + draw(st.sampled_from(["", end]))
    return quantity, {role: column for role, (column, _) in columns.items()}, text


@fixed
@given(given_series=series(), mark=st.booleans())
def test_series_reads_back_however_it_is_written(
    given_series: tuple[str, dict[str, list[float]], str], mark: bool, tmp_path: Path
) -> None:
    quantity, columns, text = given_series
    path = tmp_path / "run.csv"
    path.write_bytes(text.encode("utf-8-sig" if mark else "utf-8"))
    frame = read_series(SeriesSpec(quantity, path)).frame
    names = {
        "time": "time_s",
        "temperature": "temperature_K",
        "value": known_quantities()[quantity].column,
    }
    assert sorted(frame) == sorted(names[role] for role in columns)
    for role, column in columns.items():
        # 2e-13 K is the rounding of degrees Celsius.
        assert frame[names[role]].to_numpy() == pytest.approx(column, rel=1e-14, abs=5e-13)


def refused_or_read(path: Path, quantity: str) -> None:
    """Read a series; let nothing but a refusal that names the file pass."""
    try:
        frame = read_series(SeriesSpec(quantity, path)).frame
    except DataError as error:
        said = str(error)
    else:
        said = path.name
        assert np.isfinite(frame.to_numpy()).all()
    assert path.name in said


@fixed
@given(content=st.binary(max_size=300), quantity=st.sampled_from(sorted(RANGES)))
def test_random_bytes_are_refused_as_data(content: bytes, quantity: str, tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_bytes(content)
    with pytest.raises(DataError, match=r"run\.csv"):
        read_series(SeriesSpec(quantity, path))


CELLS = st.one_of(
    st.floats().map(repr),
    st.integers(-(10**400), 10**400).map(str),
    st.text(alphabet=string.printable, max_size=6),
    st.sampled_from(["", "NaN", "1,5", "1e308", "0", "[s]", "Time", "Mass", '"', "١٢", "1_0"]),
)


@fixed
@given(
    names=st.lists(st.sampled_from(["Time [s]", "Temperature [K]", "Mass [kg]", "MLR [kg/s/m2]"])),
    rows=st.lists(st.lists(CELLS, min_size=1, max_size=5), max_size=6),
    quantity=st.sampled_from(sorted(RANGES)),
)
def test_table_of_anything_is_read_or_refused_as_data(
    names: list[str], rows: list[list[str]], quantity: str, tmp_path: Path
) -> None:
    path = tmp_path / "run.csv"
    path.write_text("\n".join(",".join(row) for row in [names, *rows]), encoding="utf-8")
    refused_or_read(path, quantity)


@fixed
@given(data=st.data(), name=st.sampled_from(["tga", "mlr", "back"]))
def test_valid_file_with_a_few_bytes_changed_is_read_or_refused_as_data(
    data: st.DataObject, name: str, tmp_path: Path
) -> None:
    content = bytearray(FILES[f"data/{name}.csv"].encode())
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(content) - 1))
        content[at : at + data.draw(st.integers(0, 3))] = data.draw(st.binary(max_size=3))
    path = tmp_path / "run.csv"
    path.write_bytes(bytes(content))
    quantity = {"tga": "mass_fraction", "mlr": "mlr", "back": "back_temperature"}[name]
    refused_or_read(path, quantity)


# --- studies --------------------------------------------------------------------------------

VALID = json.dumps(yaml.safe_load(STUDY))
WORDS = ["rho", "k", "dh", "wood", "rest", "slab_25", "RMSE", "synthetic", "macfp:x", "0,5", "1e3"]
SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(10**20), 10**20),
    st.floats(),
    st.dates(),
    st.text(max_size=8),
    st.sampled_from([*WORDS, 0, -1, 1e-3, 1e308, ""]),
)
VALUES = st.one_of(
    SCALARS,
    st.lists(SCALARS, max_size=3),
    st.dictionaries(st.one_of(st.text(max_size=4), SCALARS), SCALARS, max_size=3),
)


def places(part: Any, above: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the keys that lead to every part of a description."""
    below: list[tuple[Any, ...]] = []
    keys = part if isinstance(part, dict) else range(len(part)) if isinstance(part, list) else ()
    for key in keys:
        below += [(*above, key), *places(part[key], (*above, key))]
    return below


@st.composite
def mutants(draw: st.DrawFn) -> dict[Any, Any]:
    """Draw the small study with up to three mistakes: a key gone, renamed, or of another value."""
    study = json.loads(VALID)
    for _ in range(draw(st.integers(1, 3))):
        known = places(study)
        if not known:
            break
        *above, last = draw(st.sampled_from(known))
        part = study
        for key in above:
            part = part[key]
        how = draw(st.sampled_from(["delete", "rename", "replace", "replace", "move"]))
        if how == "replace":
            part[last] = draw(VALUES)
        elif how == "move":
            where = draw(st.sampled_from(known))
            found: Any = study
            for key in where:
                found = found[key]
            part[last] = copy.deepcopy(found)
        else:
            taken = part.pop(last)
            if how == "rename" and isinstance(part, dict):
                part[draw(st.one_of(st.text(max_size=5), SCALARS))] = taken
    return study


@settings(fixed, max_examples=400)
@given(study=mutants())
def test_study_with_mistakes_is_valid_or_refused_with_a_place(study: dict[Any, Any]) -> None:
    try:
        valid = as_study(study, "mine.yaml")
    except StudyError as error:
        first, *lines = str(error).splitlines()
        assert first.startswith("mine.yaml: the study description breaks ")
        assert lines
        for line in lines:
            assert line.strip()
    else:
        text = valid.model_dump_json()
        assert as_study(json.loads(text), "study.json") == valid


@settings(fixed, max_examples=100)
@given(study=mutants())
def test_study_means_the_same_as_yaml_and_as_a_mapping(
    study: dict[Any, Any], tmp_path: Path
) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump(study, allow_unicode=True), encoding="utf-8")

    def outcome(read: Any) -> object:
        try:
            return read()
        except StudyError as error:
            return str(error).partition(":")[2][:60]

    assert isinstance(outcome(lambda: read_study(path)), str) == isinstance(
        outcome(lambda: as_study(study, str(path))), str
    )


@settings(fixed, max_examples=100)
@given(data=st.data())
def test_study_file_with_a_few_bytes_changed_is_valid_or_refused(
    data: st.DataObject, tmp_path: Path
) -> None:
    content = bytearray(STUDY.encode())
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(content) - 1))
        content[at : at + data.draw(st.integers(0, 4))] = data.draw(st.binary(max_size=4))
    path = tmp_path / "mine.yaml"
    path.write_bytes(bytes(content))
    try:
        said = f"{path}: {read_study(path).name}"
    except StudyError as error:
        said = str(error)
    assert said.startswith(f"{path}: ")


@fixed
@given(content=st.binary(max_size=200))
def test_random_bytes_are_refused_as_a_study(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_bytes(content)
    with pytest.raises(StudyError, match=r"mine\.yaml: "):
        read_study(path)


@settings(fixed, max_examples=100)
@given(
    value=st.floats(1e-6, 1e6),
    digits=st.integers(1, 17),
    style=st.sampled_from(["{:.{}g}", "{:.{}e}", "{:.{}E}", "+{:.{}e}"]),
)
def test_number_means_the_same_however_it_is_written(
    value: float, digits: int, style: str, tmp_path: Path
) -> None:
    path = tmp_path / "mine.yaml"
    text = style.format(value, digits)
    path.write_text(STUDY.replace("kJ/kg, value: 800", f"kJ/kg, value: {text}"))
    assert read_study(path).parameters["dh"].value == float(text)
