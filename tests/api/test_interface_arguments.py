"""Every argument of the Python interface that is of a wrong kind ends in an error of pyrofit."""

import re
from inspect import signature
from pathlib import Path

import matplotlib
import numpy as np
import pandas as pd
import pytest

import pyrofit as pf
from pyrofit.api.curves import MEASURED

matplotlib.use("agg")
SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"
STUDY = pf.read_study(SMOKE)
KEY = ("tga_5K", "mass_fraction")
T = np.arange(450.0, 750.0, 3.0)
RECORD = pd.DataFrame(
    {"time_s": 12.0 * (T - T[0]), "temperature_K": T, "mass_fraction": np.linspace(1.0, 0.1, 100)}
)
DATA = {KEY: RECORD}
SMALL = {"signals": [KEY], "data": DATA}
FUNCTIONS = {
    pf.read_study: {},
    pf.new_study: {"name": "wood", "tga": {"a": RECORD}},
    pf.write_study: {"path": "study.yaml"},
    pf.read_data: SMALL,
    pf.simulate: {"values": {"T_p": 605.0, "E_p": 190.0}, "experiments": "tga_5K"},
    pf.compare: {"values": {"T_p": 605.0, "E_p": 190.0}, **SMALL},
    pf.compare_with: {"tests": "tests.yaml"},
    pf.fit: SMALL,
    pf.residuals: SMALL,
    pf.log_likelihood: SMALL,
    pf.isoconversional: {"data": DATA},
    pf.diagnose: {},
    pf.effects: {},
    pf.read_results: {"folder": "."},
    pf.compare_models: {"fits": []},
}
SWITCHES = {"profiles", "advise", "left_out"}
"""Arguments of which only the truth counts."""
CASES = [
    (function, name)
    for function in FUNCTIONS
    for name, parameter in signature(function).parameters.items()
    if name not in SWITCHES and parameter.kind is not parameter.VAR_KEYWORD
]


@pytest.mark.parametrize("given", [object(), np.array([1.0, 2.0])], ids=["object", "array"])
@pytest.mark.parametrize(
    ("function", "argument"), CASES, ids=[f"{f.__name__}-{name}" for f, name in CASES]
)
def test_argument_of_a_wrong_kind_is_refused(
    function, argument: str, given: object, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    first = {"study": STUDY} if "study" in signature(function).parameters else {}
    with pytest.raises(pf.PyrofitError) as caught:
        function(**{**first, **FUNCTIONS[function], argument: given})
    assert str(caught.value)


@pytest.mark.parametrize("key", [object(), 3, ("tga_5K",), ("a", "b"), [1]])
def test_key_of_a_wrong_kind_is_refused(key: object) -> None:
    curves = pf.Curves(STUDY, DATA, MEASURED)
    with pytest.raises(pf.PyrofitError, match="no measured series"):
        curves[key]


@pytest.mark.parametrize("given", [object(), 3, "x"])
def test_axes_of_a_wrong_kind_are_refused(given: object) -> None:
    curves = pf.Curves(STUDY, DATA, MEASURED)
    with pytest.raises(pf.PyrofitError, match="ax: Axes of Matplotlib"):
        curves.plot("tga_5K", ax=given)


@pytest.mark.parametrize(
    ("column", "value", "said"),
    [
        ("temperature_K", np.nan, "given an empty cell or NaN"),
        ("mass_fraction", np.inf, "given 'inf'"),
        ("time_s", 0.0, "given 0; time must exceed"),
    ],
)
def test_wrong_element_of_an_array_is_named_by_its_index(
    column: str, value: float, said: str
) -> None:
    wrong = RECORD.copy()
    wrong.loc[10, column] = value
    message = f"data of tga_5K, mass_fraction, index 10, column '{column}': {said}"
    for given in (wrong, wrong.to_numpy(), tuple(wrong.to_numpy().T)):
        with pytest.raises(pf.PyrofitError, match=re.escape(message)):
            pf.read_data(STUDY, [KEY], {KEY: given})


def test_every_class_of_the_interface_has_a_short_form_of_its_own() -> None:
    classes = [one for name in pf.__all__ if isinstance(one := getattr(pf, name), type)]
    classes = [one for one in classes if not issubclass(one, Exception)]
    assert len(classes) >= 9
    # That of a dataclass, which wraps a function, lists all fields with their tables and arrays.
    assert [one.__name__ for one in classes if hasattr(one.__repr__, "__wrapped__")] == []
    curves = pf.Curves(STUDY, DATA, MEASURED)
    assert len(repr(curves)) < 200
