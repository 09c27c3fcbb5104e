"""The doctor of measured files: what a file is, and the faults that reviewers find by hand."""

import json
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from pyrofit.cli import main
from pyrofit.errors import DataError
from pyrofit_files.examined import Examined
from pyrofit_files.names import label_of
from pyrofit_files.report import counts, examine_folder

T = np.arange(300.0, 900.0, 2.0)
TIME = (T - 300.0) * 6.0
LOSS = 1.0 / (1.0 + np.exp((T - 640.0) / 12.0))
SECONDS = np.arange(0.0, 600.0, 2.0)
SLAB = 70.0 / (1.0 + np.exp((SECONDS - 300.0) / 30.0))
HRR = np.gradient(-SLAB, SECONDS) * 2400.0  # 24 MJ/kg on 0.01 m2


def write(path: Path, header: str, *columns: np.ndarray, encoding: str = "utf-8") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    rows = [",".join(f"{x:.7g}" for x in row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join([header, *rows]) + "\n", encoding=encoding)
    return path


def tga(path: Path, mass: np.ndarray = 5.0 * LOSS, T: np.ndarray = T, t: np.ndarray = TIME) -> Path:
    return write(path, "Time (s),Temperature (K),Mass (mg)", t, T, mass)


def cone(path: Path, mass: np.ndarray = SLAB, hrr: np.ndarray = HRR, unit: str = "kW/m2") -> Path:
    return write(path, f"Time,Mass,HRR\n[s],[g],[{unit}]", SECONDS, mass, hrr)


def found(folder: Path, name: str) -> Examined:
    return next(seen for seen in examine_folder(folder) if seen.path.stem == name)


def checks(seen: Examined, weight: str = "fault") -> set[str]:
    return {finding.check for finding in seen.findings if finding.weight == weight}


@pytest.mark.parametrize(
    ("stem", "kind", "conditions"),
    [
        ("UMD_TGA_N2_10K", "tga", "N2, 10 K/min"),
        ("IMT_Wood_TGA_O2-20_2K_R1", "tga", "O2-20, 2 K/min"),
        ("Lund_Wood-char_MCC_O2-20_60K_R1", "mcc", "O2-20, 60 K/min"),
        ("TUT_Wood_TGA_N2_10K_40Pa_R2", "tga", "N2, 10 K/min, 40pa"),
        ("UQ_Wood_Cone_60kW_hor_Parallel_R1", "cone", "60 kW/m2, horizontal, parallel"),
        ("UMET_WOOD_TM-DSC_N2_3K_R1", "dsc", "N2, 3 K/min"),
    ],
)
def test_name_tells_the_test(stem: str, kind: str, conditions: str) -> None:
    label = label_of(stem)
    assert (label.kind, label.conditions) == (kind, conditions)


def test_good_files_have_no_fault_and_no_doubt(tmp_path: Path) -> None:
    for i in range(5):
        tga(tmp_path / f"A_TGA_N2_10K_{i}.csv", (5.0 + 0.1 * i) * LOSS)
        cone(tmp_path / f"A_Cone_50kW_{i}.csv", SLAB * (1 + 0.01 * i), HRR * (1 + 0.01 * i))
    files = examine_folder(tmp_path)
    assert all(seen.classified for seen in files)
    assert [f for seen in files for f in seen.findings] == []


FAULTS: dict[str, tuple[Callable[[Path], Path], str]] = {
    "twice the rate": (lambda p: tga(p / "A_TGA_N2_10K_1.csv", t=0.5 * TIME), "heating rate"),
    "minutes": (
        lambda p: tga(p / "A_TGA_N2_10K_1.csv", t=TIME / 60.0),
        "heating rate",
    ),
    "Celsius": (lambda p: tga(p / "A_TGA_N2_10K_1.csv", T=T - 273.15), "temperature unit"),
    "percent": (lambda p: tga(p / "A_TGA_N2_10K_1.csv", 100.0 * LOSS), "mass unit"),
    "grams": (lambda p: tga(p / "A_TGA_N2_10K_1.csv", 5e-3 * LOSS), "mass unit"),
    "sign of the loss": (lambda p: cone(p / "A_Cone_50kW_1.csv", 140.0 - SLAB), "mass sign"),
    "jump": (
        lambda p: cone(p / "A_Cone_50kW_1.csv", np.where(SECONDS == 100.0, 140.0, SLAB)),
        "mass jump",
    ),
    "kW per m2": (lambda p: cone(p / "A_Cone_50kW_1.csv", hrr=5 * HRR, unit="kW"), "heat unit"),
    "time twice": (
        lambda p: tga(p / "A_TGA_N2_10K_1.csv", t=np.where(TIME == 120.0, 108.0, TIME)),
        "time",
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_fault_of_one_file_is_found(tmp_path: Path, name: str) -> None:
    make, check = FAULTS[name]
    path = make(tmp_path)
    assert check in checks(found(tmp_path, path.stem))


def test_density_of_the_readme_is_compared(tmp_path: Path) -> None:
    path = cone(tmp_path / "A_Cone_50kW_1.csv")
    (tmp_path / "README.md").write_text(
        "* Sample Surface Area: 0.01 m2\n\n"
        "|Test Name | Initial sample mass (g) | Thickness (cm) |\n|---|---|---|\n"
        "| A\\_Cone\\_50kW\\_1 | 75.0 | 60.0 |\n",
        encoding="utf-8",
    )
    seen = found(tmp_path, path.stem)
    assert seen.facts.thickness_m == pytest.approx(0.6)
    assert "density" in checks(seen)
    assert "mass against README" in checks(seen, "doubt")


def test_area_of_a_readme_holds_for_its_section(tmp_path: Path) -> None:
    head = "|Test Name | Initial sample mass (g) | Thickness (mm) |\n|---|---|---|\n"
    (tmp_path / "README.md").write_text(
        "### CAPA\n* Sample Surface Area: 0.00385 m2\n" + head + "| A_CAPA_50kW_1 | 12 | 8.5 |\n"
        "### LFA\n* Sample Surface Area: 5 cm2\n### Cone\n" + head + "| A_Cone_50kW_1 | 70 | 6 |\n",
        encoding="utf-8",
    )
    header = "Time (s),Mass (g)"
    write(tmp_path / "A_CAPA_50kW_1.csv", header, SECONDS, SLAB / 6.0)
    cone(tmp_path / "A_Cone_50kW_1.csv")
    facts = {seen.path.stem: seen.facts for seen in examine_folder(tmp_path)}
    assert facts["A_CAPA_50kW_1"].area_m2 == 0.00385
    assert facts["A_Cone_50kW_1"].area_m2 is None


def test_copied_end_is_found(tmp_path: Path) -> None:
    other = 71.0 / (1.0 + np.exp((SECONDS - 280.0) / 25.0))
    cone(tmp_path / "A_Cone_50kW_1.csv")
    cone(tmp_path / "A_Cone_75kW_1.csv", np.where(SECONDS < 250.0, other, SLAB), 1.01 * HRR)
    (copy,) = [f for f in found(tmp_path, "A_Cone_75kW_1").findings if f.weight == "fault"]
    assert copy.check == "copy"
    assert copy.text == "the last 175 of 300 values are those of A_Cone_50kW_1.csv"


@pytest.mark.parametrize(("factor", "check"), [(2.0, "heat per mass"), (0.5, "heat per mass")])
def test_factor_two_in_one_of_five_laboratories_is_found(
    tmp_path: Path, factor: float, check: str
) -> None:
    for i, lab in enumerate("ABCDE"):
        hrr = HRR * (factor if lab == "C" else 1 + 0.01 * i)
        cone(tmp_path / lab / f"{lab}_Cone_50kW_1.csv", SLAB * (1 + 0.01 * i), hrr)
    doubted = {s.label.laboratory for s in examine_folder(tmp_path) if check in checks(s, "doubt")}
    assert doubted == {"C"}


def test_sign_and_scale_of_a_heat_flow_are_compared(tmp_path: Path) -> None:
    peak = 2.5 * np.exp(-(((T - 640.0) / 15.0) ** 2)) + 1e-3 * (T - 300.0)
    for lab, factor in zip("ABCDEF", (1.0, 1.05, 0.95, 1.1, -1.0, 6.0), strict=True):
        header = "Time (s),Temperature (K),Heat Flow (W/g)"
        write(tmp_path / f"{lab}_DSC_N2_10K_1.csv", header, TIME, T, factor * peak)
    doubts = {s.label.laboratory: checks(s, "doubt") for s in examine_folder(tmp_path)}
    assert doubts["E"] == {"heat sign"}
    assert doubts["F"] == {"scale"}
    assert not any(doubts[lab] for lab in "ABCD")


def test_text_that_is_read_in_another_way_is_said(tmp_path: Path) -> None:
    path = tmp_path / "A_MCC_N2_60K_1.txt"
    rows = [f"{i}\t{380 + i}\t{50.0 * i}" for i in range(12)]
    head = ["Date:\t09 Dec", "Mass (mg):\t3.5", "Time (s)\tTemperature (°C)\tHRR (W/g)"]
    text = "\n".join([*head, *rows, "#N/A\t392\tNaN"])
    path.write_bytes(text.encode("cp1252"))
    seen = found(tmp_path, path.stem)
    assert seen.classified
    notes = [f.text for f in seen.findings if f.check == "mended"]
    assert notes[0].startswith("not UTF-8 (line 3): read as cp1252")
    assert notes[1:] == [
        "2 rows before the header",
        "1 rows at the end that begin with no number",
    ]


def test_file_that_is_no_table_is_reported_and_not_classified(tmp_path: Path) -> None:
    (tmp_path / "A_TGA_N2_10K_1.csv").write_text("no numbers\n", encoding="utf-8")
    seen = found(tmp_path, "A_TGA_N2_10K_1")
    assert not seen.classified
    assert checks(seen) == {"unreadable"}


def test_results_are_left_out_and_an_empty_folder_is_refused(tmp_path: Path) -> None:
    tga(tmp_path / "Computational_Results" / "A_TGA_10K.csv")
    with pytest.raises(DataError, match="no measured files"):
        examine_folder(tmp_path)
    with pytest.raises(DataError, match="no such folder"):
        examine_folder(tmp_path / "absent")


def test_command_prints_and_writes_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tga(tmp_path / "A_TGA_N2_10K_1.csv", 100.0 * LOSS)
    out = tmp_path / "out.json"
    assert main(["data", "doctor", str(tmp_path), "--json", str(out)]) == 0
    said = capsys.readouterr().out
    assert "A_TGA_N2_10K_1.csv: A; tga; N2, 10 K/min; mass fraction [mg]" in said
    assert "1 of 1 files classified (100.0 %)" in said
    (file,) = json.loads(out.read_text(encoding="utf-8"))["files"]
    assert file["findings"][0]["text"] == "begins at 100 mg: percent?"


@pytest.mark.measured
@pytest.mark.slow
def test_every_measured_file_of_the_data_base_is_classified() -> None:
    folder = Path(os.environ["PYROFIT_DATA_DIR"])
    if not (folder / "Wood").is_dir():
        pytest.skip("the data folder holds the files of the studies alone")
    files = examine_folder(folder)
    assert all(seen.classified for seen in files), counts(files)
    faults = {(s.path.stem, f.check) for s in files for f in s.findings if f.weight == "fault"}
    assert {
        ("LCPP_Cone_65kW_2", "copy"),
        ("LCPP_TGA_N2_10K_1", "heating rate"),
        ("IMT_Wood_Cone_75kW_hor_R1", "copy"),
        ("Edinburgh_Cone_65kW_4", "mass sign"),
        ("Edinburgh_Cone_65kW_6", "heat unit"),
        ("UClan_DSC_N2_10K", "heat unit"),
        ("UClan_Cone_65kW", "temperature"),
        ("FSRI_Wood_CAPA_N2_40kW_R1", "density"),
    } <= faults


def test_kinds_are_those_of_the_content_where_names_tell_none(tmp_path: Path) -> None:
    for rate in (5, 10, 20):
        write(tmp_path / f"BOARD_{rate}.csv", "t (s),T (K),m (mg)", TIME * 10 / rate, T, 9.0 * LOSS)
    write(tmp_path / "a1.txt", "t (min),T (C),TG (%)", TIME / 60.0, T - 273.15, 100.0 * LOSS)
    write(tmp_path / "a2.dat", "t (s),T (K),DSC (W/g)", TIME, T, LOSS - 0.5)
    write(tmp_path / "b1.csv", "t (s),m (g),T back (C)", SECONDS, SLAB, 20.0 + SECONDS**0.8)
    write(tmp_path / "b2.csv", "t (s),m (g),HRR (kW/m2)", SECONDS, SLAB, HRR)
    write(tmp_path / "b3.csv", "t (s),T (C),m (g)", SECONDS, 20.0 + SECONDS**0.8, SLAB)
    write(tmp_path / "c1.csv", "T,m,t", T - 273.15, LOSS, TIME)  # 1 may be a fraction as well as kg
    write(tmp_path / "c2.csv", "T,m", T - 273.15, 100.0 * LOSS)
    write(tmp_path / "c3.csv", "Temp (F),Weight (%)", 1.8 * T - 459.67, 100.0 * LOSS)
    (tmp_path / "readme.txt").write_text("Tests of May, by hand\n", encoding="utf-8")
    seen = {of.path.name: of for of in examine_folder(tmp_path)}
    kinds = {name: of.kind for name, of in seen.items()}
    heated = dict.fromkeys(
        ("BOARD_10.csv", "BOARD_20.csv", "BOARD_5.csv", "a1.txt", "c1.csv", "c2.csv", "c3.csv"),
        "tga",
    )
    slabs = {"b1.csv": "gasification", "b2.csv": "cone", "b3.csv": "gasification"}
    assert kinds == heated | {"a2.dat": "dsc"} | slabs
    assert seen["BOARD_5.csv"].label.heating_K_min == pytest.approx(5.0)
    faults = [f.check for of in seen.values() for f in of.findings if f.weight == "fault"]
    assert set(faults) == {"copy", "columns"}  # all slabs here have one mass, two files no times
    assert "9 of 11 files" in counts(list(seen.values()))[0]


def test_a_name_of_another_sort_of_test_is_a_fault(tmp_path: Path) -> None:
    tga(tmp_path / "A_Cone_50kW_1.csv")
    cone(tmp_path / "A_TGA_N2_10K_1.csv")
    for name, kind in (("A_Cone_50kW_1", "tga"), ("A_TGA_N2_10K_1", "cone")):
        seen = found(tmp_path, name)
        assert seen.kind == kind
        assert "kind" in checks(seen)


def test_files_of_instruments_are_named_with_a_way_out(tmp_path: Path) -> None:
    tga(tmp_path / "a.csv")
    (tmp_path / "b.xlsx").write_bytes(b"PK\x03\x04rest")
    (tmp_path / "c.ngb-ss3").write_bytes(b"PK\x03\x04rest")
    files = examine_folder(tmp_path)
    said = {seen.path.name: f.text for seen in files for f in seen.findings}
    assert "save the sheet with the table as CSV" in said["b.xlsx"]
    assert "NETZSCH Proteus" in said["c.ngb-ss3"]
    assert counts(files)[0].startswith("1 of 3 files classified")


def test_form_lists_all_and_its_status_tells_faults(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    good = tga(tmp_path / "data" / "A_TGA_N2_10K_R1.csv")
    form = tmp_path / "form.md"
    (good.parent / "README.md").write_text("| Test | Mass (mg) |\n|-|-|\n| A_TGA_N2_10K_R1 | 5 |\n")
    assert main(["data", "doctor", str(good.parent), "--form", str(form)]) == 0
    text = form.read_text()
    assert "- [x] Each file is a table of a known kind." in text
    assert "| `A_TGA_N2_10K_R1.csv` | tga | N2, 10 K/min | mass fraction [mg] |" in text
    assert "## Faults" not in text
    cone(good.parent / "A_TGA_N2_20K_R1.csv", unit="kW/m2")
    assert main(["data", "doctor", str(good.parent), "--form", str(form)]) == 2
    assert "none. Correct the files" in capsys.readouterr().err
    text = form.read_text()
    assert "- [ ] No file has a fault. Not so: 1, the first is A_TGA_N2_20K_R1.csv." in text
    assert "| `A_TGA_N2_20K_R1.csv` |  | kind |" in text
