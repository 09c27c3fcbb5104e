"""Explore a study in the browser: the server with what its page can ask for."""

import os
import threading
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

from pyrofit.config import Study
from pyrofit.config.resolve import diagnosed_parameters
from pyrofit.errors import StudyError
from pyrofit.explore.fit import Send, fit
from pyrofit.explore.save import save
from pyrofit.explore.server import Server
from pyrofit.explore.session import Session, session_of, state_of

Given = Mapping[str, Any]


class Explorer:
    """The page of a study, served on this machine until it is closed.

    The study is read as a page opens, so that a page opened anew shows a study that was corrected.

    Parameters
    ----------
    study
        A study or its file.
    results
        Folder of its results.
    given
        A further set, as ``--set`` names it.
    port
        Port; 0 takes a free one.
    """

    def __init__(
        self, study: Study | Path, results: Path | None = None, given: str = "", port: int = 0
    ) -> None:
        self._read = partial(session_of, study, results, given)
        self._source = study
        self._lock = threading.Lock()
        self._session: Session | None = None
        self._stamp: float | None = None
        actions = {"describe": self._describe, "curves": self._curves, "save": self._save}
        self.server = Server(actions, {"fit": self._fit}, port)

    @property
    def address(self) -> str:
        """Address of the page."""
        return self.server.address

    def close(self) -> None:
        """End the server and what it has started."""
        self.server.shutdown()
        self.server.server_close()
        if self._session:
            self._session.close()

    def _describe(self, given: Given) -> Given:
        with self._lock:
            stamp = os.stat(self._source).st_mtime if isinstance(self._source, Path) else 0.0
            if self._session is None or stamp != self._stamp:
                new = self._read()
                if self._session:
                    self._session.close()
                self._session, self._stamp = new, stamp
            session = self._session
        ticked = diagnosed_parameters(session.study)
        names = session.base.problem.names
        estimate = [name for name in names if name in ticked]
        return {**session.description(), "estimate": estimate, "published": []}

    @property
    def session(self) -> Session:
        """The study as it was read last.

        Raises
        ------
        StudyError
            No page has been opened.
        """
        if self._session is None:
            raise StudyError("open the page anew")
        return self._session

    def _curves(self, given: Given) -> Given:
        return self.session.curves(state_of(given))

    def _fit(self, given: Given, send: Send) -> None:
        fit(self.session, state_of(given), _names(given), send)

    def _save(self, given: Given) -> Given:
        name = str(given.get("name", ""))
        study, values = save(self.session, state_of(given), _names(given), name, Path())
        lines = [
            f"{study}: study, {values}: set of values.",
            f"Run it: pyrofit run {study}",
            f"See it again: pyrofit explore {study} --set {values}",
        ]
        return {"said": "\n".join(lines)}


def _names(given: Given) -> list[str]:
    names = given.get("estimate", [])
    return [str(name) for name in names] if isinstance(names, list) else []
