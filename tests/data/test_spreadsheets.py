"""Spreadsheets are read where their reader is installed; else the message says what to do."""

import datetime
import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
import pytest

from pyrofit.data import spreadsheet
from pyrofit.data.csvfile import read_table
from pyrofit.errors import DataError
from pyrofit.new_study.draft import read_experiment
from pyrofit.new_study.write import init

KELVIN = np.arange(300.0, 900.0, 10.0)
TIME = 6.0 * (KELVIN - 300.0)
MASS = 100.0 - 85.0 / (1.0 + np.exp(-(KELVIN - 640.0) / 12.0))
NAMES = ["Time (min)", "Temperature (°C)", "Mass (%)"]
ROWS = np.c_[TIME / 60.0, KELVIN - 273.15, MASS].tolist()
_MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
_LINK = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_PARTS = "http://schemas.openxmlformats.org/package/2006"
_TYPE = "application/vnd.openxmlformats-officedocument.spreadsheetml"


def _sheet(rows: Sequence[Sequence[object]]) -> str:
    def cell(value: object) -> str:
        if isinstance(value, str):
            return f'<c t="inlineStr"><is><t>{escape(value)}</t></is></c>'
        return f"<c><v>{value!r}</v></c>"

    lines = "".join(f"<row>{''.join(map(cell, row))}</row>" for row in rows)
    return f'<worksheet xmlns="{_MAIN}"><sheetData>{lines}</sheetData></worksheet>'


def write_xlsx(path: Path, **sheets: Sequence[Sequence[object]]) -> Path:
    """Write a spreadsheet of sheets by name."""
    numbers = range(1, len(sheets) + 1)
    names = "".join(
        f'<sheet name="{name}" sheetId="{i}" r:id="r{i}"/>'
        for i, name in zip(numbers, sheets, strict=True)
    )
    links = "".join(
        f'<Relationship Id="r{i}" Type="{_LINK}/worksheet" Target="worksheets/s{i}.xml"/>'
        for i in numbers
    )
    parts = "".join(
        f'<Override PartName="/xl/worksheets/s{i}.xml" ContentType="{_TYPE}.worksheet+xml"/>'
        for i in numbers
    )
    with zipfile.ZipFile(path, "w") as file:
        file.writestr(
            "[Content_Types].xml",
            f'<Types xmlns="{_PARTS}/content-types">'
            f'<Override PartName="/xl/workbook.xml" ContentType="{_TYPE}.sheet.main+xml"/>'
            f"{parts}</Types>",
        )
        root = f'<Relationship Id="r1" Type="{_LINK}/officeDocument" Target="xl/workbook.xml"/>'
        wrapped = f'<Relationships xmlns="{_PARTS}/relationships">{{}}</Relationships>'
        file.writestr("_rels/.rels", wrapped.format(root))
        file.writestr("xl/_rels/workbook.xml.rels", wrapped.format(links))
        book = f'<workbook xmlns="{_MAIN}" xmlns:r="{_LINK}"><sheets>{names}</sheets></workbook>'
        file.writestr("xl/workbook.xml", book)
        for i, rows in zip(numbers, sheets.values(), strict=True):
            file.writestr(f"xl/worksheets/s{i}.xml", _sheet(rows))
    return path


def test_first_sheet_with_a_table_is_read(tmp_path: Path) -> None:
    pytest.importorskip("python_calamine")
    facts = [["Sample mass (mg)", 5.0], ["Purge gas", "N2"]]
    path = write_xlsx(
        tmp_path / "a.xlsx", Cover=facts, Data=[*facts, [], NAMES, *ROWS], More=[NAMES, *ROWS]
    )
    run = read_experiment("tga", path)
    frame = run.frames["mass_fraction"]
    np.testing.assert_allclose(frame, np.c_[TIME, KELVIN, MASS / 100.0])
    assert not run.signals[0].guessed
    assert run.gas == "N2"
    assert run.mended[:2] == (
        "read from the sheet 'Data' of a spreadsheet",
        "further sheets with tables are not read: More",
    )


def test_new_study_holds_the_table_as_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("python_calamine")
    path = write_xlsx(tmp_path / "board_10K.xlsx", Data=[NAMES, *ROWS])
    init("wood", {"tga": [path]}, tmp_path)
    monkeypatch.setitem(sys.modules, "python_calamine", None)
    table = read_table(tmp_path / "wood" / "data" / "board_10K.csv")
    np.testing.assert_array_equal(np.transpose([*table.columns.values()]), ROWS)


def test_spreadsheet_without_a_table_or_damaged_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("python_calamine")
    path = write_xlsx(tmp_path / "a.xlsx", Cover=[["Sample", "wood"]], Note=[["Time", 1.0]])
    with pytest.raises(DataError, match=r"no sheet of this spreadsheet \(Cover, Note\) holds rows"):
        read_table(path)
    for ending, content in ((".xlsx", b"PK\x03\x04rest"), (".xls", b"\xd0\xcf\x11\xe0rest")):
        path = tmp_path / f"b{ending}"
        path.write_bytes(content)
        with pytest.raises(DataError, match=r"spreadsheet .*save the sheet with the table as CSV"):
            read_table(path)


def test_bomb_is_refused_before_it_is_unpacked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("python_calamine")
    path = write_xlsx(tmp_path / "a.xlsx", Data=[NAMES, *ROWS])
    monkeypatch.setattr(spreadsheet, "LARGEST_BYTES", 1000)
    with pytest.raises(DataError, match="MB when unpacked"):
        read_table(path)


def test_message_says_what_to_install_or_to_export(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "python_calamine", None)
    path = write_xlsx(tmp_path / "a.xlsx", Data=[NAMES, *ROWS])
    with pytest.raises(DataError, match=r"pip install python-calamine.*Or save the sheet") as told:
        read_table(path)
    assert str(path) in str(told.value)
    other = tmp_path / "a.ngb-ss3"
    other.write_bytes(b"PK\x03\x04rest")
    with pytest.raises(DataError, match=r"export its data from NETZSCH Proteus.*pyngb"):
        read_table(other)


def test_times_of_a_clock_and_dates_are_text() -> None:
    row = [datetime.timedelta(hours=1, seconds=90.5), datetime.time(0, 2), 1.0, "a\tb\n"]
    assert spreadsheet.lines_of([row]) == "01:01:30.500\t00:02:00.000\t1.0\ta b"
    assert spreadsheet.lines_of([[datetime.datetime(2024, 5, 7, 1)]]) == "2024-05-07 01:00:00.000"
