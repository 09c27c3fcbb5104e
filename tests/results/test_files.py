"""Results are written whole or not at all, and read back to the bit."""

import errno
import gzip
import json
import os
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from pyrofit.errors import DataError
from pyrofit.results.files import (
    Results,
    read_csv,
    read_json,
    write_bytes,
    write_csv,
    write_json,
    write_text,
)

ODD = [0.1 + 0.2, 1e-300, 5e-324, 3.0, *np.random.default_rng(1).standard_normal(1000)]
FRAME = pd.DataFrame({"a": ODD, "name": "x"})


def no_room(self: Path, content: bytes) -> int:
    """Write the first half, then find the disk full."""
    with self.open("wb") as file:
        file.write(content[: len(content) // 2])
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_full_disk_leaves_no_partial_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Path, "write_bytes", no_room)
    with pytest.raises(DataError, match=r"fit.json: cannot be written \(No space left on device\)"):
        write_bytes(tmp_path / "fit.json", b"0123456789")
    assert list(tmp_path.iterdir()) == []


def test_full_disk_keeps_the_result_that_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_text(tmp_path / "fit.json", "old")
    monkeypatch.setattr(Path, "write_bytes", no_room)
    with pytest.raises(DataError, match="make room or choose another folder"):
        write_text(tmp_path / "fit.json", "new")
    assert (tmp_path / "fit.json").read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["fit.json"]


def test_interruption_between_writing_and_renaming_keeps_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(self: Path, target: Path) -> Path:
        raise KeyboardInterrupt

    write_text(tmp_path / "fit.json", "old")
    monkeypatch.setattr(Path, "replace", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_text(tmp_path / "fit.json", "new")
    assert (tmp_path / "fit.json").read_text() == "old"


def test_folder_that_is_a_file_is_told(tmp_path: Path) -> None:
    (tmp_path / "imp").touch()
    with pytest.raises(DataError, match="cannot be written"):
        write_text(tmp_path / "imp" / "fit.json", "x")


def test_missing_folders_are_made(tmp_path: Path) -> None:
    write_text(tmp_path / "imp" / "RMSE" / "00.json", "x")
    assert (tmp_path / "imp" / "RMSE" / "00.json").read_text() == "x"


def test_compressed_table_has_the_same_bytes_each_time(tmp_path: Path) -> None:
    write_csv(tmp_path / "a.csv.gz", FRAME)
    write_csv(tmp_path / "b.csv.gz", FRAME)
    content = (tmp_path / "a.csv.gz").read_bytes()
    assert content == (tmp_path / "b.csv.gz").read_bytes()
    assert int.from_bytes(content[4:8], "little") == 0  # the time stamp of the gzip header
    assert gzip.decompress(content).decode().splitlines()[0] == "a,name"


@pytest.mark.parametrize("name", ["a.csv", "a.csv.gz"])
def test_table_keeps_every_bit(name: str, tmp_path: Path) -> None:
    write_csv(tmp_path / name, FRAME)
    pd.testing.assert_frame_equal(read_csv(tmp_path / name), FRAME, check_exact=True)


def test_json_keeps_every_bit(tmp_path: Path) -> None:
    write_json(tmp_path / "a.json", {"cost": 0.1 + 0.2, "names": ["rho"]})
    assert read_json(tmp_path / "a.json") == {"cost": 0.30000000000000004, "names": ["rho"]}


def test_json_refuses_what_is_no_json(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="not JSON compliant"):
        write_json(tmp_path / "a.json", {"cost": float("nan")})
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.json", b"{", "cannot be read .*delete it and run again"),
        ("a.json", b"\xff\xfe", "cannot be read .*delete it and run again"),
        ("a.json", json.dumps([1]).encode(), "this is no result; delete it"),
        ("a.csv", b"", "cannot be read .*delete it and run again"),
        ("a.csv", b'a,b\n1,"2\n', "cannot be read .*delete it and run again"),
        ("a.csv.gz", b"no gzip", "cannot be read .*delete it and run again"),
        (
            "a.csv.gz",
            gzip.compress(b"a,b\n1,2\n" * 99, mtime=0)[:-20],
            "cannot be read .*delete it",
        ),
    ],
)
def test_broken_result_is_told(name: str, content: bytes, words: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(DataError, match=words) as caught:
        read_json(path) if name == "a.json" else read_csv(path)
    assert str(caught.value).startswith(f"{path}: ")


def test_name_that_reads_like_a_missing_value_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    frame = pd.DataFrame({"parameter": ["NA", "nan", "k"], "value": [1.0, np.nan, 3.0]})
    write_csv(path, frame)
    found = read_csv(path, rows={("parameter",): [("NA",), ("nan",), ("k",)]})
    assert found["parameter"].tolist() == ["NA", "nan", "k"]
    assert np.array_equal(found["value"], frame["value"], equal_nan=True)


def test_missing_result_is_told(tmp_path: Path) -> None:
    for read in (read_json, read_csv):
        with pytest.raises(DataError, match="this result is missing; run the workflow to make it"):
            read(tmp_path / "none")


def test_results_of_a_study_have_one_place_each() -> None:
    results = Results(Path("results/x"))
    places = [
        results.measurement("slab", "mlr"),
        results.measurements_summary,
        results.kinetics("fit.json"),
        results.repetition("RMSE", 3, ".json"),
        results.repetition("RMSE", 103, "_convergence.csv"),
        results.starts("RMSE", "least_squares"),
        results.imp("summary.csv"),
        results.validation("scores.csv"),
    ]
    assert [p.relative_to("results/x").as_posix() for p in places] == [
        "measurements/slab_mlr.csv",
        "measurements/summary.json",
        "kinetics/fit.json",
        "imp/RMSE/03.json",
        "imp/RMSE/103_convergence.csv",
        "imp/RMSE/least_squares.json",
        "imp/summary.csv",
        "validation/scores.csv",
    ]
