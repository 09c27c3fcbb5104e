"""Templates, expressions and the output of external programs."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from decay import READS, TEMPLATE, study, write

from pyrofit.config import as_study
from pyrofit.config.expand.programs import externals
from pyrofit.errors import StudyError
from pyrofit.experiments.external.simulate import mean
from pyrofit.external.filled import filled_input, placeholder_values
from pyrofit.external.output import OutputError, WrittenCurve, read_output, to_number
from pyrofit.external.template import bytes_of, fill_template, text_of
from pyrofit.model.expressions import names_of, value_of_expression
from pyrofit.model.program import Program, Reading
from pyrofit.quantities import known_quantities

MLR = known_quantities()["mlr"]


def test_a_number_that_is_read_back_has_every_bit() -> None:
    for x in np.random.default_rng(1).lognormal(sigma=20.0, size=200):
        assert float(fill_template("#x#", {"x": float(x)})) == x


def test_bytes_that_are_no_text_stay() -> None:
    content = b"! \xe9\xff #k#\r\n"
    assert bytes_of(fill_template(text_of(content), {"k": 0.5})) == b"! \xe9\xff 0.5\r\n"


def test_the_value_of_an_expression() -> None:
    expression = "0.001 * exp(1e3*E / (8.314 * T)) ** 2 - -3"
    found = value_of_expression(expression, {"E": 100.0, "T": 500.0})
    assert found == 0.001 * math.exp(1e5 / (8.314 * 500.0)) ** 2 + 3.0
    assert names_of(expression) == {"E", "T"}
    assert math.isnan(value_of_expression("log(x)", {"x": -1.0}))
    for root in ("(-x) ** 0.5", "exp((-x) ** 0.5)", "abs((-x) ** 0.5)", "max(1, (-x) ** 0.5)"):
        assert math.isnan(value_of_expression(root, {"x": 2.0}))


@pytest.mark.parametrize(
    "expression",
    ["__import__('os')", "x.y", "[x]", "x if x else 1", "open(x)", "x +", "exp()", "True", "'a'"],
)
def test_only_arithmetic_is_accepted(expression: str) -> None:
    with pytest.raises(ValueError, match=r"expression|only numbers|unknown function"):
        names_of(expression)


@pytest.mark.parametrize(
    ("expression", "says"),
    [("log(x, 2)", "one number"), ("sqrt(x, x)", "one number"), ("min(x)", "two numbers or more")],
)
def test_a_function_takes_no_other_number_of_numbers(expression: str, says: str) -> None:
    with pytest.raises(ValueError, match=f"takes {says}"):
        names_of(expression)


def posed(folder: Path, given: dict[str, Any]) -> Program:
    return externals(as_study(given, str(folder / "study.yaml")))["plate"].program


def test_a_parameter_is_filled_in_its_unit_or_in_the_one_asked_for(tmp_path: Path) -> None:
    write(tmp_path, template=TEMPLATE + "c = #c#\nd = #d#\nkelvin = #kelvin#\n")
    given = study(units={"d": "J/(kg K)"}, placeholders={"kelvin": "1e3 * c / d", "unused": 1})
    for name in "cd":
        given["parameters"][name] = {"unit": "kJ/(kg K)", "value": 1.7}
    with pytest.raises(
        StudyError, match=r"placeholders.unused: .*decay.inp has no '#unused#'; delete it"
    ):
        posed(tmp_path, given)
    del given["experiments"]["plate"]["program"]["placeholders"]["unused"]
    found = placeholder_values(
        posed(tmp_path, given), {"c": 1700.0, "d": 1700.0, "height": 9.0, "fall": 0.02}
    )
    assert found == {"c": 1.7, "d": 1700.0, "kelvin": 1.0, "height": 9.0, "fall": 0.02}


WRONG: dict[str, tuple[str, dict[str, Any], str]] = {
    "unknown placeholder": (
        "a = #height#\nb = #fal#\n",
        {},
        r"decay.inp, line 2: unknown placeholder '#fal#'. Did you mean 'fall'",
    ),
    "no placeholder": ("a = 1\n", {}, "there is no placeholder, so that all runs"),
    "parameter without effect": ("a = #height#\n", {}, "'fall' has no effect"),
    "unknown name": (
        TEMPLATE + "x = #x#\n",
        {"placeholders": {"x": "2 * falls"}},
        r"placeholders.x: unknown parameter 'falls'. Did you mean 'fall'",
    ),
    "hidden parameter": (
        TEMPLATE,
        {"placeholders": {"fall": 3}},
        "this is a parameter, too",
    ),
    "unit": (TEMPLATE, {"units": {"fall": "K"}}, "'K' is no unit of a parameter in 1/s"),
    "unit of nothing": (TEMPLATE, {"units": {"falls": "K"}}, "units.falls.*does not use it"),
    "unit of the output": (
        TEMPLATE,
        {"reads": {"mlr": {**READS, "units": {"value": "K"}}}},
        "unknown unit 'K' of the value",
    ),
    "no column": (
        TEMPLATE,
        {"reads": {"mlr": {**READS, "columns": {"time": "t"}}}},
        "columns: name that of the value",
    ),
    "column before the first": (
        TEMPLATE,
        {"reads": {"mlr": {**READS, "columns": {"time": 1, "value": 0}}}},
        "columns: the number of the value is 0; the first column is 1",
    ),
    "signal that is not read": (TEMPLATE, {"reads": {}}, "name the file and the columns"),
    "no template": (TEMPLATE, {"template": "decai.inp"}, "no such file. Did you mean 'decay.inp'"),
    "path of the output": (
        TEMPLATE,
        {"reads": {"mlr": {**READS, "file": "../rate.csv"}}},
        "must be a name in the folder of the run",
    ),
    "output that is there": (
        TEMPLATE,
        {"reads": {"mlr": {**READS, "file": "decay.inp"}}},
        "exists before the run",
    ),
    "quotes": (TEMPLATE, {"command": "decay 'a"}, "No closing quotation"),
    "pattern": (TEMPLATE, {"fails": "("}, "is no regular expression"),
}


@pytest.mark.parametrize(("template", "program", "says"), WRONG.values(), ids=WRONG)
def test_broken_input_is_refused_before_anything_runs(
    template: str, program: dict[str, Any], says: str, tmp_path: Path
) -> None:
    write(tmp_path, template=template)
    with pytest.raises(StudyError, match=says):
        posed(tmp_path, study(**program))


def test_expression_in_a_template_is_refused(tmp_path: Path) -> None:
    write(tmp_path)
    given = study()
    given["parameters"]["fall"] = {"unit": "1/s", "expression": "0.5 * height"}
    with pytest.raises(StudyError, match="'fall' is an expression; a program has its own"):
        posed(tmp_path, given)


AGAINST_TEMPERATURE: dict[str, tuple[str, dict[str, Any], str]] = {
    "rate over time": ("mlr", {}, "mlr is measured over time; name the column of the time"),
    "bins in seconds": ("mass_fraction", {"average_s": 5}, "average_s: .* without a time"),
    "delay": ("mass_fraction", {"delay_s": 2}, "delay_s: .* without a time"),
    "no measured file": ("mass_fraction", {"file": "synthetic"}, "cannot be synthetic"),
}


@pytest.mark.parametrize(
    ("signal", "keys", "says"), AGAINST_TEMPERATURE.values(), ids=AGAINST_TEMPERATURE
)
def test_a_record_against_temperature_takes_no_key_of_time(
    signal: str, keys: dict[str, Any], says: str, tmp_path: Path
) -> None:
    write(tmp_path)
    reading = {
        "file": "rate.csv",
        "columns": {"temperature": "T", "value": "Rate"},
        "units": {"temperature": "K", "value": "g/m2/s" if signal == "mlr" else "-"},
    }
    given = study(reads={signal: reading})
    given["experiments"]["plate"]["signals"] = {signal: {"file": "tga.csv", **keys}}
    with pytest.raises(StudyError, match=says):
        posed(tmp_path, given)


def test_another_template_file_program_or_number_is_another_run(tmp_path: Path) -> None:
    write(tmp_path)
    values = {"height": 9.0, "fall": 0.02}
    first = filled_input(posed(tmp_path, study()), values).key
    assert filled_input(posed(tmp_path, study(time_limit_s=5, keep_failed=0)), values).key == first
    others = [
        filled_input(posed(tmp_path, study()), {**values, "fall": 0.02 + 1e-15}).key,
        filled_input(posed(tmp_path, study(environment={"A": "1"})), values).key,
        filled_input(posed(tmp_path, study(command="python3 decay.py decay.inp")), values).key,
    ]
    (tmp_path / "decay.py").write_text("# edited\n")
    others.append(filled_input(posed(tmp_path, study()), values).key)
    write(tmp_path, "hangs")
    others.append(filled_input(posed(tmp_path, study()), values).key)
    assert len({first, *others}) == 6


# --- output ---------------------------------------------------------------------------------


def read(folder: Path, text: str, **reading: Any) -> WrittenCurve:
    (folder / "rate.csv").write_text(text)
    return read_output(folder, Reading.model_validate({**READS, **reading}), MLR)


FORMS = {
    "names above units": "Time,Rate\n[s],[g/m2/s]\n0,1\n2,3\n",
    "units above names, as FDS": 's,g/m2/s\n"Time","Rate"\n 0.0E+00, 1.0E+00\n 2.0E+00, 3.0E+00\n',
    "preamble": "# a program\n\nTime;Other;Rate\n0;7;1\n2;8;3\n",
    "blanks": "   Time      Rate\n   0.0   1.0D+00\n   2.0   3.0D+00\n",
    "unit in the name, comma at the end": "Time (s),Rate (x),\n0,1,\n2,3,\n",
}


@pytest.mark.parametrize("text", FORMS.values(), ids=FORMS)
def test_columns_are_found_in_every_form(text: str, tmp_path: Path) -> None:
    found = read(tmp_path, text)
    assert found.at.tolist() == [0.0, 2.0]
    assert found.value.tolist() == [0.001, 0.003]


def test_columns_by_number_need_no_header(tmp_path: Path) -> None:
    found = read(tmp_path, "1 5 0\n3 5 2\n", columns={"time": 3, "value": 1})
    assert found.value.tolist() == [0.001, 0.003]


def test_a_mean_over_an_interval_is_the_value_in_its_middle(tmp_path: Path) -> None:
    found = read(tmp_path, "Time,Rate\n0,9\n2,1\n6,3\n", holds="before")
    assert found.at.tolist() == [1.0, 4.0]
    assert found.value.tolist() == [0.001, 0.003]


def test_a_row_without_its_end_is_left_out(tmp_path: Path) -> None:
    assert read(tmp_path, "Time,Rate\n0,1\n1,25\n2,3").value.tolist() == [0.001, 0.025]


BROKEN = {
    "no file": (None, "the program has not written it"),
    "no column": ("Time,Rat\n0,1\n1,2\n", "there is no column 'Rate'. Did you mean 'Rat'"),
    "cut row": ("Time,Rate\n0,1\n1,2\n2\n", "'nothing': the last row is cut"),
    "stars": ("Time,Rate\n0,1\n1,*****\n2,3\n", r"row 2 of numbers, column 'Rate': '\*\*\*\*\*'"),
    "not a number": ("Time,Rate\n0,1\n1,NaN\n2,3\n", "no finite number"),
    "no rows": ("Time,Rate\n", "it holds 0 rows"),
    "time falls": ("Time,Rate\n0,1\n2,1\n1,1\n", "row 3 of numbers: time decreases"),
}


@pytest.mark.parametrize(("text", "says"), BROKEN.values(), ids=BROKEN)
def test_broken_output_is_a_failure_with_its_place(
    text: str | None, says: str, tmp_path: Path
) -> None:
    if text is not None:
        (tmp_path / "rate.csv").write_text(text)
    with pytest.raises(OutputError, match=says):
        read_output(tmp_path, Reading.model_validate(READS), MLR)


def test_exponents_of_fortran() -> None:
    assert [to_number(x) for x in ("1.5D-03", "-.5d2", "0.25-100")] == [0.0015, -50.0, 2.5e-101]
    assert math.isnan(to_number("12:30"))


def test_a_bin_is_the_exact_mean_of_the_broken_line() -> None:
    record = WrittenCurve(np.array([0.0, 1.0, 4.0]), np.array([0.0, 2.0, 2.0]))
    assert mean(record, np.array([1.0]), 2.0) == pytest.approx([(1.0 + 2.0) / 2.0])
    fine = np.linspace(0.3, 2.9, 20001)
    middle = 0.5 * (fine[1:] + fine[:-1])
    exact = np.interp(middle, record.at, record.value).mean()
    assert mean(record, np.array([1.6]), 2.6) == pytest.approx([exact], rel=1e-7)
