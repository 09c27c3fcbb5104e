"""Files as instruments export them: read with the right numbers, and said how."""

import os
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

from pyrofit import cli
from pyrofit.data import csvfile, series, text_file
from pyrofit.data.csvfile import read_table
from pyrofit.data.series import read_series
from pyrofit.data.spec import SeriesSpec
from pyrofit.errors import DataError
from pyrofit.new_study import draft

TIME_S = np.linspace(0.0, 594.0, 100)
KELVIN = 300.0 + TIME_S
FRACTION = 1.0 - 0.98 / (1.0 + np.exp((640.0 - KELVIN) / 12.0))
MLR = 0.012 / (1.0 + np.exp((120.0 - TIME_S) / 15.0)) + 1e-4


def rows(sep: str, *columns: Sequence[object], comma: bool = False) -> str:
    """Return rows of cells; numbers with six decimals."""
    cells = [
        [c if isinstance(c, str) else f"{c:.6f}" for c in row] for row in zip(*columns, strict=True)
    ]
    text = "\n".join(sep.join(row) for row in cells) + "\n"
    return text.replace(".", ",") if comma else text


CELSIUS, MINUTES, PERCENT, MG = KELVIN - 273.15, TIME_S / 60.0, 100.0 * FRACTION, 5.0 * FRACTION
COUNT = [str(i) for i in range(TIME_S.size)]
HALVES = slice(0, 50), slice(50, None)
NETZSCH = "#EXPORTTYPE:;DATA ALL\n#DECIMAL:;{}\n#SAMPLE MASS /mg:;5\n#RANGE:;30/10(K/min)/600\n\n"
TA = ["Instrument\tTGA Q500", "Size\t5.0\tmg", "Nsig\t3", "Sig1\tTime (min)"]
TA += ["Sig2\tTemperature (°C)", "Sig3\tWeight (mg)", "StartOfData", ""]
TRIOS = (
    "Filename,x.tri\nSample Mass,5.0 mg\n[step]\nRamp 60 °C/min\nTime,Temperature,Weight,Weight\n"
)
PYRIS = "Sample Weight:\t5.0 mg\n1)\tHeat to 600 °C\n\n\tTime\tUnsubtracted Weight\tSample "
PYRIS += "Temperature\tProgram Temperature\n\tmin\tmg\t°C\t°C\n"
STARE = "Curve Name:\n  TGA\nCurve Values:\n  Index    t     Ts    Value\n    [s]  [°C]   [mg]\n"

# Pyris writes names in two rows, and a title above each step of the run.
RUN = "Sample Weight:\t5.0 mg \n1)\tHold for 1.0 min at 27.00°C \n \n1) TGA Isothermal \n"
RUN += "\tTime     \tUnsubtracted\tBaseline     \tProgram     \tSample     \tSample     \n"
RUN += "\t          \tWeight     \tWeight     \tTemperature\tTemperature\tPurge Flow \n"
SCAN = "2) TGA Temperature Scan \n"
CALIBRATION = "\n\tWEIGHT CALIBRATION INPUTS: \nNickel    \t\t 355.3\t\t 354.1\t\t 2.3\n"
CALIBRATION += " 62.5\t\t 68.4\t\t-6.1e-005 \n\nSoftware Version\t13.4\n"


def pyris(part: slice) -> str:
    """Return rows of Pyris, which begin with a tabulator."""
    zero = 0.0 * TIME_S[part]
    return rows(
        "\t", [""] * zero.size, MINUTES[part], MG[part], zero, zero + 27.0, CELSIUS[part], zero
    )


# STARe writes the evaluation and further curves below the first one.
AGAIN = "\n\nResults:\n  ? Step\t-98.0 %\n  \t-4.9 mg\n\nCurve Name:\n  Heat Flow\nCurve Values:\n"
AGAIN += "  Index    t     Ts    Value\n    [s]  [°C]   [mW]\n"
POWER = rows("  ", COUNT, TIME_S, CELSIUS, 3.0 + 0.0 * TIME_S)
SIGNED = "\n\nUser:\n  me\n________\nNot signed     STARe SW 16.00"

TGA: dict[str, tuple[str, str]] = {
    "NETZSCH, German": (
        NETZSCH.format("COMMA")
        + "##Temp./°C;Time/min;Mass/%;Sensit./(uV/mW)\n"
        + rows(";", CELSIUS, MINUTES, PERCENT, TIME_S, comma=True),
        "cp1252",
    ),
    "NETZSCH, English, text in a column": (
        NETZSCH.format("POINT").replace(";", ",")
        + "##Temp./°C,Time/min,Mass/%,Segment\n"
        + rows(",", CELSIUS, MINUTES, PERCENT, ["S1"] * TIME_S.size),
        "utf-8",
    ),
    "TA Universal Analysis": (
        "\r\n".join(TA) + rows("\t", MINUTES, CELSIUS, MG) + "-4.0\t0.0\t0.0\n",
        "utf-16",
    ),
    "savetxt of numpy": ("# time_s T_K mass_mg\n" + rows(" ", TIME_S, KELVIN, MG), "utf-8"),
    "blanks around units": (
        "Time (min) Sample Temperature (°C) Weight (%)\n" + rows(" ", MINUTES, CELSIUS, PERCENT),
        "utf-8",
    ),
    "TRIOS": (TRIOS + "min,°C,mg,%\n" + rows(",", MINUTES, CELSIUS, MG, PERCENT), "utf-8-sig"),
    "Pyris": (PYRIS + rows("\t", COUNT, MINUTES, MG, CELSIUS, CELSIUS + 2.0), "latin-1"),
    "STARe": (STARE + rows("  ", COUNT, TIME_S, CELSIUS, MG) + "Results:\n  5 mg\n", "latin-1"),
    "Pyris, one step": (RUN + pyris(slice(None)), "latin-1"),
    "Pyris, two steps": (RUN + pyris(HALVES[0]) + SCAN + pyris(HALVES[1]) + CALIBRATION, "latin-1"),
    "STARe, two curves": (
        STARE + rows("  ", COUNT, TIME_S, CELSIUS, MG) + AGAIN + POWER + SIGNED,
        "latin-1",
    ),
    "STARe, the same curve again": (
        2 * (STARE + rows("  ", COUNT, TIME_S, CELSIUS, MG) + "\n"),
        "latin-1",
    ),
    "micrograms, fahrenheit": (
        "Time [s];T [°F];Mass [µg]\n" + rows(";", TIME_S, KELVIN * 1.8 - 459.67, 1e3 * MG),
        "latin-1",
    ),
}


@pytest.mark.parametrize(("text", "encoding"), TGA.values(), ids=TGA)
def test_tga_export_is_read_in_si_units(text: str, encoding: str, tmp_path: Path) -> None:
    path = tmp_path / "run.txt"
    path.write_bytes(text.encode(encoding))
    run = draft.read_experiment("tga", path)
    frame = run.frames["mass_fraction"]
    np.testing.assert_allclose(frame["time_s"], TIME_S, atol=1e-4)
    np.testing.assert_allclose(frame["temperature_K"], KELVIN, atol=1e-5)
    np.testing.assert_allclose(frame["mass_fraction"], FRACTION, atol=1e-6)
    assert run.number == pytest.approx(60.0)


@pytest.mark.parametrize("sep", ["\t", " "])
def test_units_of_signals_of_a_preamble_hold_for_any_separator(sep: str, tmp_path: Path) -> None:
    # A sample that has lost a tenth of its mass before the record: the numbers look like mg.
    path = tmp_path / "run.txt"
    head = "\n".join(TA).replace("(mg)", "(%)")
    path.write_text(head + rows(sep, MINUTES, CELSIUS, 90.0 * FRACTION), encoding="utf-8")
    table = read_table(path)
    assert table.units == {"Time": "min", "Temperature": "°C", "Weight": "%"}
    lost = read_series(SeriesSpec("mass_fraction", path, {"value": "Weight"})).frame[
        "mass_fraction"
    ]
    np.testing.assert_allclose(lost, 0.9 * FRACTION, atol=1e-7)


CLOCK = [f"{int(t) // 3600}:{int(t) // 60 % 60:02d}:{t % 60:04.1f}" for t in TIME_S]
GROUPED = [f'"{10 * t:,.2f}"' for t in TIME_S]
GERMAN = [f"{10 * t:,.2f}".translate(str.maketrans(",.", ".,")) for t in TIME_S]
SLABS: dict[str, tuple[str, str, float]] = {
    "mg/cm2/s": ("Time [s],MLR [mg/cm2/s]\n" + rows(",", TIME_S, 100.0 * MLR), "utf-8", 1),
    "per minute": ("Time (min),MLR (g/m2/min)\n" + rows(",", MINUTES, 6e4 * MLR), "utf-8", 1),
    "power signs": ("Time/s;MLR/(g m⁻² s⁻¹)\n" + rows(";", TIME_S, 1e3 * MLR), "utf-8", 1),
    "UTF-16 without a mark": (
        "Time [s];MLR [g/(m² s)]\n" + rows(";", TIME_S, 1e3 * MLR, comma=True),
        "utf-16-be",
        1,
    ),
    "preamble and footer": (
        "Test 7\nMass,5.1\n"
        + "key,value\n" * 58
        + "Time (s),MLR (g/m2s),,\n"
        + rows(",", TIME_S, 1e3 * MLR, [""] * TIME_S.size, [""] * TIME_S.size)
        + "\nEnd of data\nAverage,5.2\n",
        "utf-8",
        1,
    ),
    "clock": ("Time (hh:mm:ss),MLR (kg/m2/s)\n" + rows(",", CLOCK, MLR), "utf-8", 1),
    "thousands": ("Time (s),MLR (kg/m2/s)\n" + rows(",", GROUPED, MLR), "utf-8", 10),
    "German thousands": (
        "Zeit [s];Massenverlustrate [g/m²s]\n"
        + rows(";", GERMAN, [f"{1e3 * m:.5f}".replace(".", ",") for m in MLR]),
        "cp1252",
        10,
    ),
    "NaN in a column nobody uses": (
        "Time (s),MLR (kg/m2/s),O2 (%)\n" + rows(",", TIME_S, MLR, ["NaN"] * TIME_S.size),
        "utf-8",
        1,
    ),
    "blanks": ("Time(s) MLR(kg/m2s)\n" + rows(" ", TIME_S, MLR), "utf-8", 1),
}


@pytest.mark.parametrize(("text", "encoding", "slower"), SLABS.values(), ids=SLABS)
def test_slab_file_is_read_in_si_units(
    text: str, encoding: str, slower: float, tmp_path: Path
) -> None:
    path = tmp_path / "slab_25kW.csv"
    path.write_bytes(text.encode(encoding))
    frame = draft.read_experiment("gasification", path).frames["mlr"]
    np.testing.assert_allclose(frame["time_s"], slower * TIME_S, atol=1e-3)
    np.testing.assert_allclose(frame["mlr_kg_m2_s"], MLR, atol=1e-6)


def test_new_study_says_how_a_file_was_read_and_what_it_leaves_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    head = "Test 7\n\nTime (s);Abbrandrate (g/m2/s);HRR (kW/m2);DTG;HRR (kW/m2)\n"
    for flux in (25, 50):
        body = rows(";", TIME_S, 20.0 * flux * MLR, TIME_S, TIME_S, TIME_S, comma=True)
        Path(f"slab_{flux}kW.csv").write_bytes((head + body).encode("utf-16"))
    assert cli.main(["init", "x", "--gasification", "slab_25kW.csv", "slab_50kW.csv"]) == 0
    said = capsys.readouterr().out
    for words in (
        "; read as UTF-16",
        "; 1 rows before the header",
        "; read with decimal commas",
        "told apart as HRR (1), HRR (2)",
        "'HRR (1)' is not used: it is a heat release rate, which the model does not predict",
        "give the file after --cone",
        "'DTG' is not used: it is the derivative of another column",
        "Held out: slab_50kW.",
        "study 'x' is valid; 2 measured series read",
    ):
        assert words in said


def test_steps_of_one_record_are_read_as_one(tmp_path: Path) -> None:
    step = "[step]\nTime,Temperature,Weight,Weight\nmin,°C,mg,%\n"
    first, last = (rows(",", MINUTES[s], CELSIUS[s], MG[s], PERCENT[s]) for s in HALVES)
    path = tmp_path / "run.csv"
    path.write_text(f"Filename,x.tri\n{step}{first}\n{step}{last}", encoding="utf-8")
    table = read_table(path)
    np.testing.assert_allclose(table.columns["Weight (%)"], PERCENT, atol=1e-6)
    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines[table.line(60) - 1].startswith(f"{MINUTES[60]:.6f},")


def test_further_curves_and_text_below_the_first_are_noted(tmp_path: Path) -> None:
    path = tmp_path / "run.txt"
    path.write_bytes(TGA["STARe, two curves"][0].encode("latin-1"))
    table = read_table(path)
    line = table.line(99) + 10
    assert f"another table begins in line {line}, in s, °C, mW; it is not read: save" in "".join(
        table.mended
    )
    assert any(note.endswith("rows below the table are not read") for note in table.mended)


def test_lines_are_counted_across_the_steps_of_a_run(tmp_path: Path) -> None:
    path = tmp_path / "run.txt"
    path.write_bytes(TGA["Pyris, two steps"][0].encode("latin-1"))
    table = read_table(path)
    assert list(table.columns)[1:4] == [
        "Unsubtracted Weight",
        "Baseline Weight",
        "Program Temperature",
    ]
    lines = path.read_text(encoding="latin-1").splitlines()
    assert lines[table.line(60) - 1].startswith(f"\t{MINUTES[60]:.6f}\t")
    assert "1 rows that begin a step of the run" in table.mended


def test_rows_below_a_blank_one_of_an_export_are_not_dropped(tmp_path: Path) -> None:
    path = tmp_path / "run.txt"
    first, last = (rows(";", MINUTES[s], CELSIUS[s], MG[s]) for s in HALVES)
    head = "Test 7\n\nTime (min);Temperature (°C);Mass (mg)\n"
    path.write_text(f"{head}{first}\n{last}", encoding="utf-8")
    with pytest.raises(DataError, match="line 54: this row is blank but numbers follow"):
        read_table(path)


@pytest.mark.parametrize("between", ["", "pause", "Time,Temperature\n"])
def test_other_text_between_the_rows_is_refused(between: str, tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    body = [rows(",", MINUTES[s], CELSIUS[s], MG[s]) for s in HALVES]
    path.write_text(f"Time,Temperature,Mass\n{body[0]}{between}\n{body[1]}", encoding="utf-8")
    with pytest.raises(DataError, match=r"line 52: (this row is blank|given \d cells)"):
        read_table(path)


def test_measurement_that_can_be_read_in_two_ways_is_not_dropped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    cells = [f"1,{234 - i:03d}" for i in range(TIME_S.size)]
    Path("a_25kW.csv").write_text("Time (s);Mass (g)\n" + rows(";", COUNT, cells), encoding="utf-8")
    assert cli.main(["init", "x", "--gasification", "a_25kW.csv"]) == 0
    said = capsys.readouterr().out
    assert "a_25kW.csv: mass: time 'Time', value 'Mass'" in said
    assert "column 'Mass': given '1,234'; it may be 1.234, with a decimal comma, or 1234" in said


LARGE = {
    "commas": ("{}", ",", ""),
    "decimal commas": ("{}", ";", "read with decimal commas"),
    "blanks": ("{}", "  ", ""),
    "quotes": ('"{}"', ",", ""),
}


@pytest.mark.parametrize(("cell", "sep", "note"), LARGE.values(), ids=LARGE)
def test_large_file_is_read_in_one_piece_with_the_same_numbers(
    cell: str, sep: str, note: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "run.csv"
    numbers = np.random.default_rng(1).lognormal(0.0, 9.0, (500, 2))
    cells = [[cell.format(repr(float(x))) for x in column] for column in numbers.T]
    body = rows(sep, *cells, comma=sep == ";")
    path.write_text(sep.join(["time_s", "mlr_g_m2_s"]) + "\n" + body, encoding="utf-8")
    slow = read_table(path)
    monkeypatch.setattr(csvfile, "MANY_ROWS", 100)
    monkeypatch.setattr(csvfile, "_table", None)
    fast = read_table(path)
    for name, column in slow.columns.items():
        np.testing.assert_array_equal(fast.columns[name], column)
    assert (fast.line(7), fast.units, fast.mended) == (slow.line(7), slow.units, slow.mended)
    assert note in " ".join(fast.mended)


@pytest.mark.parametrize("late", ["1,5;2", "x;2", "1", '"1";2', '"1;2', '"1""2";3', "inf;2"])
def test_large_file_with_an_odd_row_is_read_as_a_small_one(
    late: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "run.csv"
    path.write_text("Time (s);m\n" + "0.5;1\n" * 150 + f"{late}\n" + "2;3\n", encoding="utf-8")
    monkeypatch.setattr(csvfile, "_LOOKED_AT", 100)
    said = []
    for many in (100_000, 100):
        monkeypatch.setattr(csvfile, "MANY_ROWS", many)
        try:
            table = read_table(path)
            said.append(f"{table.columns} {table.faults}")
        except DataError as error:
            said.append(str(error))
    assert said[0] == said[1]


def test_long_series_is_thinned_with_a_note(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(series, "MOST_POINTS", 50)
    path = tmp_path / "slab_25kW.csv"
    path.write_text("Time (s),MLR (kg/m2/s)\n" + rows(",", TIME_S, MLR), encoding="utf-8")
    run = draft.read_experiment("gasification", path)
    times = run.frames["mlr"]["time_s"].to_numpy()
    assert (len(times), times[0], times[-1]) == (50, TIME_S[0], TIME_S[-1])
    assert run.mended == ("thinned: 50 of 100 rows are used, evenly spread",)


def pipe(path: Path) -> None:
    os.mkfifo(path)


def too_large(path: Path) -> None:
    with path.open("wb") as file:
        file.truncate(text_file.LARGEST_BYTES + 1)


ODD_FILES: dict[str, tuple[Callable[[Path], object], str]] = {
    "pipe": (pipe, "this is a pipe, a socket or a device; give a file on a disk"),
    "device": (lambda path: path.symlink_to("/dev/zero"), "this is a pipe, a socket or a device"),
    "too large": (too_large, "500 MB; files of at most 500 MB are read"),
    "compressed": (lambda path: path.write_bytes(b"\x1f\x8b\x08"), "a compressed file, no text"),
}


@pytest.mark.parametrize(("make", "words"), ODD_FILES.values(), ids=ODD_FILES)
def test_what_is_no_text_file_is_refused_at_once(
    make: Callable[[Path], object], words: str, tmp_path: Path
) -> None:
    path = tmp_path / "run.csv"
    make(path)
    with pytest.raises(DataError, match=words):
        read_table(path)
