from pathlib import Path

import pytest

from pyrofit.data.csvfile import FileTable, read_table
from pyrofit.errors import DataError


def write(folder: Path, content: str | bytes) -> Path:
    path = folder / "run.csv"
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


SHAPES = {
    "units below the names": "Time,Mass loss\n[s],[kg/s/m^2]\n0,1.5\n2,-2e-1\n",
    "units above the names": "[s],[kg/s/m^2]\nTime,Mass loss\n0,1.5\n2,-2e-1\n",
    "units in parentheses": "(s),(kg/s/m^2)\nTime,Mass loss\n0,1.5\n2,-2e-1\n",
    "units without brackets": "Time,Mass loss\ns,kg/s/m^2\n0,1.5\n2,-2e-1\n",
    "units in the names": "\nTime (s),Mass loss [kg/s/m^2]\n0,1.5\n2,-2e-1\n",
    "no space before the unit": "\nTime(s),Mass loss[kg/s/m^2]\n0,1.5\n2,-2e-1\n",
    "byte-order mark": "\ufeffTime,Mass loss\n[s],[kg/s/m^2]\n0,1.5\n2,-2e-1\n",
    "trailing commas": "Time,Mass loss,,\n[s],[kg/s/m^2],,\n0,1.5,,\n2,-2e-1,,\n",
    "Windows line ends": "Time,Mass loss\r\n[s],[kg/s/m^2]\r\n0,1.5\r\n2,-2e-1\r\n",
    "old Macintosh line ends": "Time,Mass loss\r[s],[kg/s/m^2]\r0,1.5\r2,-2e-1\r",
    "blank lines at the end": "Time,Mass loss\n[s],[kg/s/m^2]\n0,1.5\n2,-2e-1\n\n , \n,,\n\n",
    "no line end at the end": "Time,Mass loss\n[s],[kg/s/m^2]\n0,1.5\n2,-2e-1",
    "semicolons": "Time;Mass loss\n[s];[kg/s/m^2]\n0;1.5\n2;-2e-1\n",
    "tabs": "Time\tMass loss\n[s]\t[kg/s/m^2]\n0\t1.5\n2\t-2e-1\n",
    "spaces around cells": " Time , Mass loss\n [s] , [kg/s/m^2]\n 0 , 1.5\n 2 , -2e-1\n",
    "quotes": '"Time","Mass loss"\n"[s]","[kg/s/m^2]"\n"0","1.5"\n"2","-2e-1"\n',
}


@pytest.mark.parametrize("content", SHAPES.values(), ids=SHAPES.keys())
def test_every_shape_gives_the_same_table(tmp_path: Path, content: str) -> None:
    table = read_table(write(tmp_path, content))
    assert list(table.columns) == ["Time", "Mass loss"]
    assert table.columns["Time"].tolist() == [0.0, 2.0]
    assert table.columns["Mass loss"].tolist() == [1.5, -0.2]
    assert table.units == {"Time": "s", "Mass loss": "kg/s/m^2"}
    assert table.first_row == 3


def test_units_are_none_where_the_file_has_none(tmp_path: Path) -> None:
    table = read_table(write(tmp_path, "Time,Mass,Rate [1/s]\n0,1,2\n"))
    assert table.units == {"Time": None, "Mass": None, "Rate": "1/s"}
    assert table.first_row == 2


def test_units_row_may_leave_columns_out(tmp_path: Path) -> None:
    table = read_table(write(tmp_path, "Time,n,Mass,m\n[s],,[]\n0,1,2,3\n"))
    assert table.units == {"Time": "s", "n": None, "Mass": None, "m": None}


def test_names_keep_their_parentheses_above_a_units_row(tmp_path: Path) -> None:
    table = read_table(write(tmp_path, "Time,T (back)\n[s],[K]\n0,300\n"))
    assert table.units == {"Time": "s", "T (back)": "K"}


def test_nested_parentheses_stay_in_the_unit(tmp_path: Path) -> None:
    table = read_table(write(tmp_path, "Time (s),MLR (kg/(m2 s))\n0,1\n"))
    assert table.units["MLR"] == "kg/(m2 s)"


LAST = {
    "Heat Flow (Normalized) (W/g)": ("Heat Flow (Normalized)", "W/g"),
    "Gas Flow (purge)/(ml/min)": ("Gas Flow (purge)", "ml/min"),
    "MLR [dry] [kg/(m2 s)]": ("MLR [dry]", "kg/(m2 s)"),
    "MLR (g/(m² s)": ("MLR", "g/(m² s"),
}


@pytest.mark.parametrize(("header", "both"), LAST.items(), ids=LAST)
def test_last_of_several_brackets_is_the_unit(
    tmp_path: Path, header: str, both: tuple[str, str]
) -> None:
    table = read_table(write(tmp_path, f"Time (s),{header}\n0,1\n"))
    assert list(table.units.items())[1] == both


BROKEN = {
    "empty": ("", "the file is empty"),
    "blank": ("\n , ,\n", "the file is empty"),
    "header only": ("Time,Mass\n", "header and no numbers"),
    "header and units only": ("Time,Mass\n[s],[mg]\n\n", "header and no numbers"),
    "no header": ("0,1\n1,2\n", "line 1: the first row holds numbers"),
    "three text rows": ("run 7,\nTime,Mass\n[s],[mg]\n0,1\n", r"line 3: given text .*'\[s\]'"),
    "blank row": ("Time,Mass\n0,1\n\n1,2\n", "line 3: this row is blank"),
    "short row": ("Time,Mass\n0,1\n1\n", "line 3: given 1 cells; the header names 2"),
    "long row": ("Time,Mass\n0,1\n1,2,3\n", "line 3: given 3 cells; the header names 2"),
    "decimal commas": ("Time,Mass\n0,5,1,5\n", "decimal commas, write points"),
    "long units row": ("Time,Mass\n[s],[mg],[K]\n0,1\n", "line 2: given 3 cells"),
    "spaces for delimiters": ("Time Mass\n0 1\n", "no numbers"),
    "spreadsheet": (b"PK\x03\x04\x14\x00\xfc", "a spreadsheet or an archive"),
    "byte 0": (b"Time,Mass\n0,1\n\x00\n", "line 3: a byte 0 stands here"),
    "no names": ("Test 7\n" + "0,1\n" * 6, "line 2: the numbers begin here, in 2 columns"),
}


@pytest.mark.parametrize(("content", "message"), BROKEN.values(), ids=BROKEN.keys())
def test_broken_file_is_refused_with_its_place(
    tmp_path: Path, content: str | bytes, message: str
) -> None:
    path = write(tmp_path, content)
    with pytest.raises(DataError, match=message) as error:
        read_table(path)
    assert str(path) in str(error.value)


NO_NUMBERS = {
    "abc": "each cell must be a finite number",
    "inf": "each cell must be a finite number",
    "1e999": "each cell must be a finite number",
    "1_0": "each cell must be a finite number",
    "12:30": "each cell must be a finite number",
    "4,999": "it may be 4.999, with a decimal comma, or 4999, with a separator of thousands",
    "4,99": "other numbers of the file have a decimal point",
}


@pytest.mark.parametrize(("cell", "why"), NO_NUMBERS.items(), ids=NO_NUMBERS)
def test_cell_that_is_no_number_matters_where_its_column_is_used(
    tmp_path: Path, cell: str, why: str
) -> None:
    table = read_table(write(tmp_path, f"Time;Mass\n0;1\n1;{cell}\n2;1.5\n"))
    assert table.columns["Time"].tolist() == [0.0, 1.0, 2.0]
    table.require(["Time"])
    with pytest.raises(DataError, match=f"line 3, column 'Mass': given '{cell}'; {why}"):
        table.require(["Mass"])


def test_missing_file_names_the_nearest_one(tmp_path: Path) -> None:
    write(tmp_path, "")
    with pytest.raises(DataError, match=r"no such file. Did you mean 'run.csv'\?"):
        read_table(tmp_path / "runs.csv")


def test_missing_file_lists_few_names_of_a_crowded_folder(tmp_path: Path) -> None:
    for i in range(100):
        (tmp_path / f"other_{i}.txt").touch()
    write(tmp_path, "")
    with pytest.raises(DataError, match=r"Did you mean 'run.csv'\?") as error:
        read_table(tmp_path / "runs.csv")
    assert str(error.value).count("other_") < 15


def test_missing_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"folder .*nowhere does not exist"):
        read_table(tmp_path / "nowhere" / "run.csv")


def test_empty_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="holds no files"):
        read_table(tmp_path / "run.csv")


def test_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="this is a folder"):
        read_table(tmp_path)


def test_unreadable_file_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def deny(self: Path) -> bytes:
        raise PermissionError(13, "Permission denied")

    path = write(tmp_path, "Time,Mass\n0,1\n")
    monkeypatch.setattr(Path, "read_bytes", deny)
    with pytest.raises(DataError, match=r"cannot be read \(Permission denied\)"):
        read_table(path)


def test_line_number_of_a_row_counts_all_lines(tmp_path: Path) -> None:
    table: FileTable = read_table(write(tmp_path, "\n\nTime\n\n[s]\n7\n8\n"))
    assert table.first_row == 6
