"""A page without a server holds the curves of the library, small and alone."""

import base64
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pyrofit.cli import main
from pyrofit.errors import StudyError
from pyrofit_explore.session import Session, State, stacked
from pyrofit_explore.static import MOST_BYTES, strongest_pair, write_static


@pytest.fixture(scope="module")
def written(session: Session, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("page") / "page.html"
    write_static(session, ["dh", "k"], "truth", path)
    return path


def content(path: Path) -> dict[str, Any]:
    (text,) = re.findall(r'type="application/json" id="data">(.*?)</script>', path.read_text())
    found: dict[str, Any] = json.loads(text)
    return found


def decoded(grid: dict[str, Any], sizes: list[int]) -> np.ndarray:
    codes = np.frombuffer(base64.b64decode(grid["curves"]), "<u2").reshape(-1, sum(sizes))
    low = np.concatenate([np.full(n, s[0]) for n, s in zip(sizes, grid["scales"], strict=True)])
    step = np.concatenate([np.full(n, s[1]) for n, s in zip(sizes, grid["scales"], strict=True)])
    return low + step * codes


def test_page_is_small_and_names_no_other_host(written: Path) -> None:
    text = written.read_text(encoding="utf-8")
    assert len(text.encode()) <= MOST_BYTES
    assert "://" not in text
    assert not re.search(r"(src|href)=\"(?!data:,)", text)


def test_curves_of_the_grid_are_those_of_the_study(session: Session, written: Path) -> None:
    found = content(written)
    grid = found["grid"]
    assert grid["names"] == ["dh", "k"]
    sizes = [len(s["x"]) for s in found["study"]["signals"]]
    curves = decoded(grid, sizes)
    dh, k = grid["at"]
    assert (dh[0], dh[-1]) == (250.0, 1500.0)
    assert len(curves) == len(dh) * len(k)
    state = State({**session.sets["truth"], "dh": dh[3], "k": k[5]})
    own = stacked(*session.simulate(state))
    scale = np.concatenate([np.full(n, s[1]) for n, s in zip(sizes, grid["scales"], strict=True)])
    assert np.all(np.abs(curves[3 * len(k) + 5] - own) <= 0.51 * scale + 1e-9)


def test_the_page_begins_at_the_start_itself(session: Session, written: Path) -> None:
    found = content(written)
    for name, at in zip(found["grid"]["names"], found["grid"]["at"], strict=True):
        assert found["study"]["middle"][name] in [pytest.approx(value, rel=1e-12) for value in at]
        assert session.sets["truth"][name] in [pytest.approx(value, rel=1e-12) for value in at]
        assert np.all(np.diff(at) > 0.0)


def test_the_strongest_parameters_are_sliders_by_default(session: Session) -> None:
    found = strongest_pair(session.base, session.study.true_values())
    assert "T_p" in found
    assert len(found) == 2


@pytest.mark.parametrize(
    ("sliders", "label", "words"),
    [
        (["dhh"], "", "'dhh' is no parameter.*Did you mean 'dh'"),
        (["dh", "k", "cp"], "", "one or two"),
        (["dh", "dh"], "", "one or two"),
        (["dh"], "truht", "no set 'truht'"),
    ],
)
def test_wrong_sliders_are_told(
    session: Session, tmp_path: Path, sliders: list[str], label: str, words: str
) -> None:
    with pytest.raises(StudyError, match=words):
        write_static(session, sliders, label, tmp_path / "page.html")


def test_the_command_writes_a_page(tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    smoke = Path(__file__).parents[2] / "config" / "smoke.yaml"
    assert main(["explore", str(smoke), "--static", str(path), "--sliders", "dh"]) == 0
    assert content(path)["grid"]["names"] == ["dh"]
