"""The decks in FDS: a program of these tests' own stands for it; with PYROFIT_FDS a real one."""

import json
import os
import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from decks import base, deck_of, predicted
from fake_fds import install

from pyrofit.cli import main
from pyrofit.config import Study, read_study
from pyrofit.external.fds import find_fds
from pyrofit.results.files import Results
from pyrofit.show.parts import Passage
from pyrofit_exchange import fds_page
from pyrofit_exchange.fds.agreement import levels, slab_agreement
from pyrofit_exchange.fds.check import check_decks
from pyrofit_exchange.fds.export import WrittenDeck, decks, slab_curve
from pyrofit_exchange.fds.read import read_devc, read_tga
from pyrofit_exchange.fds.run import version_text
from pyrofit_exchange.fds.versions import OLD, FdsError
from pyrofit_exchange.sets import ParameterSet, parameter_set

ROOT = Path(__file__).parents[2]
SMOKE = ROOT / "config" / "smoke.yaml"
FAILED = {"error": "ERROR: Problem with SURF", "stopped": "improperly set-up"}
FAILED |= {"truncated": "ends at", "silent": "has not written"}


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(SMOKE)


@pytest.fixture(scope="module")
def chosen(study: Study) -> ParameterSet:
    return parameter_set(study, Results(Path("none")), "truth", SMOKE.parent)


@pytest.fixture(scope="module")
def written(study: Study, chosen: ParameterSet) -> list[WrittenDeck]:
    return decks(study, chosen, OLD)


def run(
    study: Study, chosen: ParameterSet, fds: Path | None, folder: Path, limit_s: float = 20.0
) -> tuple[list[dict[str, object]], str]:
    """Check a study; return the entries and what was told."""
    told: list[str] = []
    check_decks(study, chosen, fds, folder, told.append, limit_s)
    return json.loads((folder / "check.json").read_text()), "\n".join(told)


@pytest.mark.parametrize("version", ["6.7.4", "6.11.1"])
def test_a_complete_run_is_compared(
    version: str, study: Study, chosen: ParameterSet, written: list[WrittenDeck], tmp_path: Path
) -> None:
    fds = install(tmp_path / "a folder with spaces", written, "success", version)
    entries, _ = run(study, chosen, fds, tmp_path)
    assert {e["experiment"] for e in entries} == {one.experiment for one in written}
    for entry in entries:
        assert {"experiment", "signal", "rms_over_mean", "burnout_s"} <= set(entry)
        assert entry["fds"] == version
        assert entry["verdict"] == "agrees"
        assert float(str(entry["rms_over_mean"])) < 1e-4
    text = (tmp_path / "checked" / "material.fds").read_text()
    assert f"proof, FDS {version}" in text
    assert ("ADJUST_H" in text) == (version == "6.11.1")


def test_a_rate_that_is_off_by_one_percent_differs_by_that(
    study: Study, chosen: ParameterSet, written: list[WrittenDeck], tmp_path: Path
) -> None:
    fds = install(tmp_path, written, "success", factor=1.01)
    entries, _ = run(study, chosen, fds, tmp_path)
    rates = [e for e in entries if e["signal"] == "mlr"]
    assert rates
    for entry in rates:
        share = float(str(entry["rms_over_mean"]))
        assert 0.01 < share < 0.02  # the rms of a rate is above its mean
        assert entry["verdict"] == "differs"


@pytest.mark.parametrize("mode", FAILED)
def test_a_run_that_failed_is_recorded_in_spite_of_its_exit_status(
    mode: str, study: Study, chosen: ParameterSet, written: list[WrittenDeck], tmp_path: Path
) -> None:
    entries, told = run(study, chosen, install(tmp_path, written, mode), tmp_path)
    assert len(entries) == len(written)
    for entry in entries:
        assert entry["verdict"] == "failed"
        assert entry["rms_over_mean"] is None
        assert FAILED[mode] in str(entry["error"]) or "it holds no numbers" in str(entry["error"])
    assert "FDS failed" in told


def test_a_run_that_hangs_is_killed_with_what_it_started(
    study: Study, chosen: ParameterSet, written: list[WrittenDeck], tmp_path: Path
) -> None:
    few = study.model_copy(update={"experiments": dict(list(study.experiments.items())[:1])})
    begin = time.monotonic()
    entries, _ = run(few, chosen, install(tmp_path, written, "hang"), tmp_path, limit_s=1.0)
    assert time.monotonic() - begin < 20.0
    assert [e["error"] for e in entries] == ["it did not end within 1 s"]


def test_without_fds_there_is_a_sentence_and_no_entry(
    study: Study, chosen: ParameterSet, tmp_path: Path
) -> None:
    entries, told = run(study, chosen, None, tmp_path)
    assert entries == []
    assert "no FDS found; set PYROFIT_FDS" in told
    assert "no FDS found" in (tmp_path / "check.md").read_text()


def test_a_missing_binary_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PYROFIT_FDS", str(tmp_path / "no fds"))
    given = ["fds-check", "--study", str(SMOKE), "--set", "truth", "--results", str(tmp_path)]
    assert main(given) == 2
    assert "there is no such executable file" in capsys.readouterr().err


def test_fds_is_found_by_its_variable_and_on_the_path(
    written: list[WrittenDeck], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = install(tmp_path / "with a space", written, "success", "6.8.0")
    monkeypatch.setenv("PYROFIT_FDS", str(path))
    found = find_fds()
    assert found == path
    assert version_text(path, tmp_path) == "6.8.0"
    monkeypatch.delenv("PYROFIT_FDS")
    monkeypatch.setenv("PATH", str(path.parent), prepend=os.pathsep)
    assert find_fds() == path
    monkeypatch.setenv("PATH", "")
    assert find_fds() is None


def test_another_program_is_not_taken_for_fds(tmp_path: Path) -> None:
    with pytest.raises(FdsError, match="check that this is FDS's executable"):
        version_text(Path("/bin/true"), tmp_path)


def test_spots_of_a_surface_are_averaged_with_their_weights(tmp_path: Path) -> None:
    path = tmp_path / "x_devc.csv"
    names = [f"{name}_{n}" for name in ("MLR", "T_front", "T_back", "mass") for n in (1, 2)]
    rows = [[t, *[float(n)] * 8] for n, t in enumerate((0.0, 1.0, 2.0))]
    for row in rows:
        row[1], row[2] = 1.0, 3.0
    lines = ["s," * 8, ",".join(f'"{n}"' for n in ("Time", *names))]
    path.write_text("\n".join([*lines, *(",".join(map(str, row)) for row in rows)]))
    found = read_devc(path, (0.25, 0.75))
    assert found["rate_kg_m2s"].tolist() == [2.5, 2.5]
    assert found["time_s"].tolist() == [0.5, 1.5]


def test_the_temperature_of_a_tga_is_that_of_the_sample(tmp_path: Path) -> None:
    path = tmp_path / "x_tga.csv"
    path.write_text("s,C,C,g/g\nTime,Temp,T_surf,Total mass\n0,20,19,1\n1,21,20,0.9\n2,22,0,0\n")
    found = read_tga(path)
    assert found["temperature_K"].tolist() == pytest.approx([292.15, 293.15])
    assert found["mass_fraction"].tolist() == [1.0, 0.9]


def test_what_is_approximate_gets_no_verdict() -> None:
    from decks import with_effect

    of = with_effect(base(), "in_depth")
    deck = deck_of(of, "capa_25", like=predicted(base(), "capa_25"))
    curve = slab_curve(predicted(base(), "capa_25"))
    fds = pd.DataFrame(
        {
            "time_s": curve["time_s"],
            "rate_kg_m2s": curve["mlr_kg_m2s"] * 1.1,
            "back_K": curve["back_temperature_K"],
            "mass_kg_m2": curve["mass_kg_m2"],
        }
    )
    verdicts = {a.verdict for a in slab_agreement(fds, curve, levels(deck))}
    assert verdicts == {"approximate terms"}


def test_burn_out_that_is_late_differs() -> None:
    of = predicted(base(), "capa_25")
    curve, deck = slab_curve(of), deck_of(base(), "capa_25", like=of)
    late = pd.DataFrame({"time_s": curve["time_s"]})
    for name, own in (
        ("rate_kg_m2s", "mlr_kg_m2s"),
        ("back_K", "back_temperature_K"),
        ("mass_kg_m2", "mass_kg_m2"),
    ):
        late[name] = np.interp(curve["time_s"] - 0.8, curve["time_s"], curve[own])
    rate = slab_agreement(late, curve, levels(deck))[0]
    assert rate.burnout_s == pytest.approx(0.8, abs=0.05)
    assert rate.verdict == "differs"


def test_the_command_draws_what_the_report_shows(
    written: list[WrittenDeck], study: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fds = install(tmp_path / "a bin", written, "success", "6.8.0", factor=1.01)
    monkeypatch.setenv("PYROFIT_FDS", str(fds))
    results = Results(tmp_path / "results")
    given = ["fds-check", "--study", str(SMOKE), "--set", "truth", "--results", str(results.root)]
    assert main(given) == 0
    assert fds_page.PAGE.exists(study, results)
    part = fds_page.PAGE.section(study, results)
    shown = part.parts[0]
    assert isinstance(shown, Passage)
    assert "FDS 6.8.0, set 'truth'" in shown.text
    rows = [row for body in shown.bodies for row in body["rows"]]
    assert len(rows) == len(json.loads(results.fds("check.json").read_text()))
    assert any("differs" in row for row in rows)
    # Without FDS, or where all runs fail, an old figure would be taken for a proof.
    (tmp_path / "a bin" / "mode").write_text("error")
    assert main(given) == 0
    assert not fds_page.PAGE.exists(study, results)


@pytest.mark.skipif(not os.environ.get("PYROFIT_FDS"), reason="PYROFIT_FDS is not set")
def test_a_real_fds_agrees(study: Study, chosen: ParameterSet, tmp_path: Path) -> None:
    entries, _ = run(study, chosen, find_fds(), tmp_path, limit_s=600.0)
    assert {e["verdict"] for e in entries} == {"agrees"}
