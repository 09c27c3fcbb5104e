"""Compiled code on disk is right, whoever writes it at the same time, and whatever fails."""

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

RUN = Path(__file__).with_name("compiled_run.py")
TOGETHER = 8


class Process:
    """A process that calls compiled functions; it starts at once."""

    def __init__(self, folder: Path, *arguments: str, **environment: str) -> None:
        self._process = subprocess.Popen(
            [sys.executable, str(RUN), *arguments],
            env={**os.environ, "NUMBA_CACHE_DIR": str(folder), **environment},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def end(self) -> tuple[dict[str, Any], str]:
        """Return its result and its messages."""
        out, said = self._process.communicate(timeout=600)
        assert self._process.returncode == 0, said
        return json.loads(out.splitlines()[-1]), said

    def kill(self) -> None:
        """End it as a power cut would."""
        self._process.kill()
        self._process.communicate()

    @property
    def runs(self) -> bool:
        return self._process.poll() is None


def run(folder: Path, *arguments: str, **environment: str) -> tuple[dict[str, Any], str]:
    return Process(folder, *arguments, **environment).end()


@cache
def right(name: str) -> str:
    """Return the bits of a call as this process makes it."""
    from compiled_run import bits

    return bits(name)


def misses(found: dict[str, Any]) -> int:
    return sum(found["compiled"].values())


def codes(folder: Path) -> list[Path]:
    return sorted(folder.rglob("*.code"))


# --- several processes ----------------------------------------------------------------------


def test_two_signatures_saved_in_each_others_way_are_both_right(tmp_path: Path) -> None:
    marks = tmp_path / "marks"
    marks.mkdir()
    cold = tmp_path / "cache"
    processes = [
        Process(cold, "one_tga", "--turn", str(marks), "first"),
        Process(cold, "eight_tga", "--turn", str(marks), "second"),
    ]
    for process in processes:
        found, said = process.end()
        assert misses(found) == 1, said
    for name in ("one_tga", "eight_tga"):
        found, _ = run(cold, name)
        assert found["bits"] == {name: right(name)}
        assert misses(found) == 0


def test_eight_cold_starts_compile_each_signature_once(
    tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    from compiled_run import CALLS

    thorough = request.config.getoption("--thorough")
    names = list(CALLS) if thorough else ["cells", "one_tga"]
    orders = [names[n % len(names) :] + names[: n % len(names)] for n in range(TOGETHER)]
    processes = [Process(tmp_path, *order) for order in orders]
    ends = [process.end()[0] for process in processes]
    for found in ends:
        assert found["bits"] == {name: right(name) for name in names}
    signatures = len(names)  # those of slabs share that of `cells`
    assert sum(misses(found) for found in ends) == signatures
    assert len(codes(tmp_path)) == signatures
    found, _ = run(tmp_path, *names)
    assert misses(found) == 0


def test_process_killed_while_it_compiles_stops_nobody(tmp_path: Path) -> None:
    first = Process(tmp_path, "cells")
    while first.runs and not list(tmp_path.rglob("*.lock")):
        time.sleep(0.01)
    assert first.runs
    first.kill()
    assert not codes(tmp_path)
    found, said = run(tmp_path, "cells")
    assert found["bits"]["cells"] == right("cells")
    assert "waiting" not in said


# --- users and processors -------------------------------------------------------------------


def test_two_kinds_of_processor_on_one_file_system_have_a_file_each(tmp_path: Path) -> None:
    for processor, new in (({}, 1), ({"NUMBA_CPU_NAME": "generic"}, 1), ({}, 0)):
        found, _ = run(tmp_path, "cells", **processor)
        assert misses(found) == new
        assert found["bits"]["cells"] == right("cells")
    assert len(codes(tmp_path)) == 2


@pytest.fixture
def of_another_user(tmp_path: Path) -> Iterator[Path]:
    """Return a folder that the tests' user can write, and `--nobody` cannot."""
    folder = tmp_path / "cache"
    folder.mkdir()
    # Three with several processes: of the user, of the run, of the process.
    several = "PYTEST_XDIST_WORKER" in os.environ
    for above in (tmp_path, *tmp_path.parents[: 3 if several else 2]):
        above.chmod(0o755)
    yield folder
    for path in (folder, *folder.rglob("*")):
        path.chmod(0o755)


def make_read_only(folder: Path) -> None:
    for path in (*folder.rglob("*"), folder):
        path.chmod(0o555 if path.is_dir() else 0o444)


def test_two_users_share_what_the_first_has_compiled(of_another_user: Path) -> None:
    run(of_another_user, "cells")
    make_read_only(of_another_user)
    found, said = run(of_another_user, "cells", "--nobody")
    assert misses(found) == 0
    assert found["bits"]["cells"] == right("cells")
    assert said == ""


def test_folder_that_cannot_be_written_costs_time_and_is_told(of_another_user: Path) -> None:
    make_read_only(of_another_user)
    found, said = run(of_another_user, "cells", "--nobody")
    assert misses(found) == 1
    assert found["bits"]["cells"] == right("cells")
    assert "cannot be kept" in said
    assert "set NUMBA_CACHE_DIR to a folder that can be written" in said


def test_second_folder_serves_where_the_first_cannot_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from pyrofit.compiled import cache as compiled

    (tmp_path / "first").touch()
    folders = [tmp_path / "first" / "a", tmp_path / "second"]
    compiled._save(folders, "tga-0", "processor", b"code")
    assert [path.parent for path in codes(tmp_path)] == [folders[1] / "processor"]


# --- faults of the disk ---------------------------------------------------------------------


def test_full_disk_costs_time_and_leaves_nothing_half_written(tmp_path: Path) -> None:
    found, said = run(tmp_path, "cells", "--room", "50000")
    assert found["bits"]["cells"] == right("cells")
    assert "cannot be kept" in said
    assert [path.suffix for path in tmp_path.rglob("*") if path.is_file()] == [".lock"]
    found, _ = run(tmp_path, "cells")
    assert misses(found) == 1
    assert len(codes(tmp_path)) == 1


def test_damaged_file_is_compiled_anew(tmp_path: Path) -> None:
    run(tmp_path, "cells")
    (code,) = codes(tmp_path)
    whole = code.read_bytes()
    half = len(whole) // 2
    for damaged in (whole[:half], whole[:half] + b"\x00\x01" + whole[half + 2 :]):
        code.write_bytes(damaged)
        found, _ = run(tmp_path, "cells")
        assert misses(found) == 1
        assert found["bits"]["cells"] == right("cells")


def test_code_without_a_lock_is_right(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from pyrofit.compiled import cache as compiled

    monkeypatch.setattr(compiled, "fcntl", None)
    monkeypatch.setattr(compiled, "folders", lambda package: [tmp_path])
    kept = compiled.CompiledFiles(test_damaged_file_is_compiled_anew)
    assert not kept._wait_for_lock("tga-0", "processor")
    compiled._save([tmp_path], "tga-0", "processor", b"one")
    compiled._save([tmp_path], "tga-0", "processor", b"other")
    assert codes(tmp_path)[0].read_bytes()[32:] == b"other"
    kept._unlock()
