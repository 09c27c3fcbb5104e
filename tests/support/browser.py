"""Chromium without a window, driven over the protocol WebDriver (W3C) by its own chromedriver."""

import json
import shutil
import socket
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import psutil
import requests

NEEDED = ("chromium", "chromedriver")
"""Programs of Debian's packages chromium and chromium-driver."""
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"
"""Key of an element in the protocol."""


def lacking() -> str:
    """Name the programs that are not here."""
    return ", ".join(name for name in NEEDED if shutil.which(name) is None)


class Browser:
    """A browser with one page."""

    def __init__(self, wide: int = 1280, high: int = 900) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self._driver = subprocess.Popen(
            ["chromedriver", f"--port={port}"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self._at = f"http://127.0.0.1:{port}"
        until(lambda: self._is_there(), "chromedriver")
        arguments = [
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            f"--window-size={wide},{high}",
        ]
        wanted = {"goog:chromeOptions": {"args": arguments}, "timeouts": {"script": 300_000}}
        made = self._call("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})
        self._at += f"/session/{made['sessionId']}"

    def _is_there(self) -> bool:
        try:
            return requests.get(f"{self._at}/status", timeout=5).ok
        except requests.ConnectionError:
            return False

    def _call(self, method: str, path: str, body: object = None) -> Any:
        sent = None if method != "POST" else json.dumps(body or {})
        answer = requests.request(method, self._at + path, data=sent, timeout=400)
        assert answer.ok, answer.text[:600]
        return answer.json()["value"]

    def open(self, address: str) -> None:
        """Open a page in place of the present one."""
        self._call("POST", "/url", {"url": address})

    def run(self, script: str, *given: object) -> Any:
        """Run a script in the page; return what it returns, once a promise is kept."""
        return self._call("POST", "/execute/sync", {"script": script, "args": list(given)})

    def click(self, selector: str) -> None:
        """Click at an element as a user does."""
        found = self._call("POST", "/element", {"using": "css selector", "value": selector})
        self._call("POST", f"/element/{found[ELEMENT]}/click")

    def picture(self, path: Path) -> None:
        """Write a picture of the window."""
        import base64

        path.write_bytes(base64.b64decode(self._call("GET", "/screenshot")))

    def processor_s(self) -> float:
        """Return the time that the processes of the browser have computed [s]."""
        every = psutil.Process(self._driver.pid).children(recursive=True)
        return float(sum(sum(one.cpu_times()[:2]) for one in every))

    def close(self) -> None:
        """End the browser."""
        try:
            self._call("DELETE", "")
        finally:
            self._driver.terminate()
            self._driver.wait()


def until(holds: Callable[[], object], what: str, seconds: float = 60.0) -> None:
    """Wait until a condition holds."""
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, f"waited {seconds:g} s for {what}"
        time.sleep(0.05)
