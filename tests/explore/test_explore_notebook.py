"""The page of a study in Python, and of the command."""

import http.client
import json
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import pyrofit as pf
from pyrofit.errors import StudyError
from pyrofit_explore.commands import INSTALLED_TWIN
from pyrofit_explore.run import Explorer
from pyrofit_explore.session import Session

SMOKE = Path(__file__).parents[2] / "config" / "smoke.yaml"


def asked(explorer: Explorer, name: str, given: object) -> dict[str, Any]:
    line = http.client.HTTPConnection("127.0.0.1", explorer.server.server_port, timeout=60)
    line.request("POST", f"/{name}", json.dumps(given), {"X-Token": explorer.server.token})
    found: dict[str, Any] = json.loads(line.getresponse().read())
    line.close()
    return found


def test_a_notebook_shows_the_page_until_it_is_closed(session: Session, tmp_path: Path) -> None:
    made = pf.explore(session.study, {"k": 0.3}, results=tmp_path)
    try:
        assert made.address in made._repr_html_()
        told = asked(made, "describe", {})
        assert told["sets"]["values"] == {"k": 0.3}
        assert told["estimate"] == ["T_p", "E_p", "rho", "k", "cp", "eps", "dh"]
        assert told["published"] == []
        assert "curves" in asked(made, "curves", {"values": {"k": 0.3}})
    finally:
        made.close()
    with pytest.raises(ConnectionError):
        asked(made, "describe", {})


def test_wrong_values_are_told_at_once(session: Session) -> None:
    with pytest.raises(StudyError, match="'kk'"):
        pf.explore(session.study, {"kk": 0.3})


def test_curves_before_the_page_is_described_are_refused(session: Session) -> None:
    made = pf.explore(session.study)
    try:
        assert asked(made, "curves", {"values": {}}) == {"error": "open the page anew"}
    finally:
        made.close()


def test_ctrl_c_ends_the_command(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "pyrofit", "explore", str(SMOKE), "--no-browser"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        address = process.stdout.readline().strip()
        line = http.client.HTTPConnection(address.split("/")[2], timeout=60)
        line.request("GET", f"/{address.rsplit('/', 1)[1]}")
        assert b"pyrofit explore" in line.getresponse().read()
        line.close()
        process.send_signal(signal.SIGINT)
        assert process.wait(20) == 0
    with pytest.raises(ConnectionError):
        http.client.HTTPConnection(address.split("/")[2], timeout=5).connect()


def test_the_study_of_the_package_is_the_shipped_twin() -> None:
    assert INSTALLED_TWIN.read_bytes() == SMOKE.with_name("twin.yaml").read_bytes()
