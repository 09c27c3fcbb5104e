"""The first picture: measured files as they were understood."""

from pathlib import Path

import numpy as np
import pytest

import pyrofit as pf
from pyrofit.cli import main
from pyrofit_files.looked import derivative, look_at


def tga(path: Path, centre_K: float, unit: str = "[K]") -> Path:
    """Write a record of a small sample that loses its mass about a temperature."""
    T = np.linspace(400.0, 800.0, 201)
    mass = 5.0 / (1.0 + np.exp((T - centre_K) / 8.0))
    rows = "".join(f"{6.0 * (t - 400.0)},{t:.2f},{m:.5f}\n" for t, m in zip(T, mass, strict=True))
    path.write_text(f"Time,Temperature,Mass\n[s],{unit},[mg]\n{rows}", encoding="utf-8")
    return path


def slab(path: Path) -> Path:
    t = np.linspace(0.0, 600.0, 121)
    mass = 60.0 * np.clip(1.0 - t / 500.0, 0.05, 1.0)
    rows = "".join(f"{a:.1f},{m:.4f},{300 + a / 3:.2f}\n" for a, m in zip(t, mass, strict=True))
    text = f"Time,Mass,Back temperature\n[s],[g],[K]\n{rows}"
    path.write_text(text, encoding="utf-8")
    return path


def test_files_with_numbers_at_the_end_are_repeats_of_one_test(tmp_path: Path) -> None:
    paths = [tga(tmp_path / f"Lab_TGA_N2_10K_{i}.csv", 620.0 + i) for i in (1, 2)]
    (test,) = look_at(paths).tests
    assert (test.name, test.kind, len(test.records)) == ("Lab_TGA_N2_10K", "tga", 2)
    assert test.loses
    assert test.disagreements == []


def test_masses_of_heated_samples_are_shown_over_the_first_one(tmp_path: Path) -> None:
    (test,) = look_at([tga(tmp_path / "Lab_TGA_N2_10K_1.csv", 620.0)]).tests
    assert test.values(test.records[0][1])[0] == pytest.approx(1.0)


def test_repeats_that_disagree_are_told(tmp_path: Path) -> None:
    paths = [tga(tmp_path / f"Lab_TGA_N2_10K_{i}.csv", 620.0 + 0.5 * i) for i in (1, 2)]
    paths.append(tga(tmp_path / "Lab_TGA_N2_10K_3.csv", 660.0))
    said = "\n".join(look_at(paths).lines())
    assert "Lab_TGA_N2_10K_3 differs from its repeats: the mass fraction changes" in said
    assert "Lab_TGA_N2_10K_1 differs" not in said


def test_each_column_is_told_with_its_unit(tmp_path: Path) -> None:
    (line, *_) = look_at([slab(tmp_path / "Lab_Gasification_N2_50kW_1.csv")]).lines()
    assert "gasification; mass per area from 'Mass' [g], 121 points" in line
    assert "back temperature from 'Back temperature' [K], 121 points" in line


def test_derivative_is_that_of_a_known_curve() -> None:
    x = np.linspace(0.0, 100.0, 2001)
    middle, rate = derivative(x, np.exp(-x / 20.0))
    assert rate == pytest.approx(np.exp(-middle / 20.0) / 20.0, rel=1e-3)


def test_derivative_leaves_out_where_the_abscissa_falls() -> None:
    x = np.array([0.0, 1.0, 2.0, 1.5, 3.0, 4.0])
    _, rate = derivative(x, np.array([4.0, 3.0, 2.0, 9.0, 1.0, 0.0]))
    assert rate == pytest.approx(np.ones(rate.size))


@pytest.mark.parametrize("ending", ["png", "svg", "html"])
def test_picture_is_written_in_each_form(
    ending: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = slab(tmp_path / "Lab_Gasification_N2_50kW_1.csv")
    made = tmp_path / f"look.{ending}"
    assert main(["look", str(path), "--output", str(made)]) == 0
    assert f"drawn in {made}" in capsys.readouterr().out
    start = {"png": b"\x89PNG", "svg": b"<?xml", "html": b"<!DOCTYPE html>"}[ending]
    assert made.read_bytes().startswith(start)
    if ending == "html":
        text = made.read_text(encoding="utf-8")
        assert "data:image/png;base64," in text
        assert "mass per area from &#x27;Mass&#x27; [g]" in text


def test_other_ending_is_refused_with_those_that_are_known(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = slab(tmp_path / "Lab_Gasification_N2_50kW_1.csv")
    assert main(["look", str(path), "--output", str(tmp_path / "look.jpg")]) == 2
    assert "give a name that ends with .png, .svg, .html" in capsys.readouterr().err


def test_missing_file_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["look", str(tmp_path / "absent.csv")]) == 2
    assert "absent.csv: there is no such file" in capsys.readouterr().err


def test_file_without_a_known_column_is_told_and_not_drawn(tmp_path: Path) -> None:
    path = tmp_path / "odd.csv"
    path.write_text("a,b\n1,2\n2,3\n3,4\n", encoding="utf-8")
    found = pf.look(path)
    assert "nothing recognised" in str(found)
    with pytest.raises(pf.PyrofitError, match="nothing is recognised"):
        found.plot()


def test_interface_looks_at_a_folder(tmp_path: Path) -> None:
    slab(tmp_path / "Lab_Gasification_N2_50kW_1.csv")
    tga(tmp_path / "Lab_TGA_N2_10K_1.csv", 620.0)
    found = pf.look(tmp_path)
    assert isinstance(found, pf.Look)
    drawn = [ax for ax in found.plot().axes if ax.lines]
    assert len(drawn) == 5  # two masses with derivatives, one temperature
    found.write(tmp_path / "look.png")
    assert (tmp_path / "look.png").is_file()


def test_texts_of_many_panels_neither_overlap_nor_leave_the_picture(tmp_path: Path) -> None:
    for flux in (20, 30, 40, 50, 60):
        for n in range(1, 9):
            slab(tmp_path / f"LongNameOfALab_Gasification_N2_{flux}kW_perpendicular_{n}.csv")
    canvas = pf.look(tmp_path).plot()
    drawn = [ax for ax in canvas.axes if ax.lines]
    assert len(drawn) == 15
    # A mass and its derivative stand in one row.
    rows = [ax.get_position(original=True).y0 for ax in drawn]
    assert rows[0] == pytest.approx(rows[1])
    canvas.draw_without_rendering()
    boxes = [
        text.get_window_extent()
        for ax in drawn
        for text in (ax._left_title, ax.yaxis.label, ax.get_legend())
    ]
    for i, box in enumerate(boxes):
        assert canvas.bbox.x0 <= box.x0
        assert box.x1 <= canvas.bbox.x1
        assert box.y1 <= canvas.bbox.y1
        assert not any(box.overlaps(other) for other in boxes[:i])
    looks = {(line.get_color(), str(line._dash_pattern)) for line in drawn[0].lines}
    assert len(looks) == 8


def test_something_else_than_names_of_files_is_refused() -> None:
    for given in (3, [3], {"a": 1}):
        with pytest.raises(pf.PyrofitError, match="name of a file"):
            pf.look(given)  # type: ignore[arg-type]
