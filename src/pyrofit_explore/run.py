"""Explore a study in the browser: the server, and the answers to its page."""

import os
import threading
import webbrowser
from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property, partial
from pathlib import Path
from types import MappingProxyType
from typing import Any

from pyrofit.api.arguments import path_of
from pyrofit.api.choices import si_values
from pyrofit.api.studies import Source, read_study
from pyrofit.config import Study
from pyrofit.config.resolve import diagnosed_parameters
from pyrofit.errors import DataError, StudyError, suggest
from pyrofit.model.slab import SlabExperiment
from pyrofit_compare.published import PublishedSet, material_in, published, shown_by
from pyrofit_explore.fit import Send, descend_and_tell
from pyrofit_explore.model import ExploredModel, Simulated
from pyrofit_explore.save import save_state
from pyrofit_explore.server import Server, in_background
from pyrofit_explore.session import Session, packed, session_of, stacked, state_of
from pyrofit_explore.taken import what_can_be_taken


class PublishedSets:
    """The parameter sets of the MaCFP data base, read when they are first asked for."""

    @cached_property
    def sets(self) -> Mapping[str, PublishedSet]:
        """The sets by name; none where the data base is not on this machine."""
        try:
            return published()[0]
        except DataError:
            return {}

    def simulate(self, model: ExploredModel, name: str, values: Mapping[str, float]) -> Simulated:
        """Return the curves of a published material in the apparatus of a study.

        Parameters
        ----------
        model
            The study. Tests that the set does not describe have no curve: slabs, where it has
            kinetics alone, and layers of a composition of their own.
        name
            Name of the set.
        values
            Values of the parameters of the apparatus, SI units.

        Raises
        ------
        StudyError
            There is no such set.
        """
        if name not in self.sets:
            raise StudyError(f"no published set '{name}'. {suggest(name, self.sets)}")
        one = self.sets[name]
        shown = {n for n, e in shown_by(model.study, one).items() if not _has_other_layers(e)}
        problem = replace(
            model.problem,
            material=material_in(model.study, one),
            runs={n: run for n, run in model.problem.runs.items() if n in shown},
        )
        return replace(model, problem=problem).simulate(values)


def _has_other_layers(experiment: object) -> bool:
    layers = experiment.sample.layers if isinstance(experiment, SlabExperiment) else ()
    return any(layer.composition or layer.beside for layer in layers)


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
    values
        Further sets, in the units of the study, by name.
    """

    def __init__(
        self,
        study: Study | Path,
        results: Path | None = None,
        given: str = "",
        port: int = 0,
        values: Mapping[str, Mapping[str, float]] = MappingProxyType({}),
    ) -> None:
        self._values = values
        self._read = partial(session_of, study, results, given)
        self._source = study
        self._lock = threading.Lock()
        self._session: Session | None = None
        self._stamp: float | None = None
        self._published = PublishedSets()
        actions = {
            "describe": self._describe,
            "curves": self._curves,
            "published": self._of_published,
            "save": self._save,
        }
        self.server = Server(actions, {"fit": self._fit}, port)

    @property
    def address(self) -> str:
        """Address of the page."""
        return self.server.address

    def __repr__(self) -> str:
        """Return the address of the page."""
        return f"page of a study at {self.address}"

    def _repr_html_(self) -> str:
        return f'<iframe src="{self.address}" width="100%" height="800"></iframe>'

    def close(self) -> None:
        """End the server and the jobs it has started."""
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
        published = {} if session.study.is_synthetic else self._published.sets
        starts = {n: what_can_be_taken(session.base, one)._asdict() for n, one in published.items()}
        told = session.description()
        sets = {**self._values, **told["sets"]}
        found = {"sets": sets, "estimate": estimate, "published": list(published)}
        return {**told, **found, "starts": starts}

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

    def _of_published(self, given: Given) -> Given:
        session, state = self.session, state_of(given)
        model, values = session.base, session.values(session.model(state.effects), state)
        simulated = self._published.simulate(model, str(given.get("name")), values)
        return {"curves": packed(stacked(model, simulated))}

    def _fit(self, given: Given, send: Send) -> None:
        descend_and_tell(self.session, state_of(given), _names(given), send)

    def _save(self, given: Given) -> Given:
        name = str(given.get("name", ""))
        study, values = save_state(self.session, state_of(given), _names(given), name, Path())
        lines = [
            f"{study}: study, {values}: set of values.",
            f"Run it: pyrofit run {study}",
            f"See it again: pyrofit explore {study} --set {values}",
        ]
        return {"said": "\n".join(lines)}


def explore(
    study: Source,
    values: Mapping[str, float] | None = None,
    *,
    results: str | os.PathLike[str] | None = None,
    browser: bool = False,
) -> Explorer:
    """Show a study in a page, on this machine alone.

    In a notebook the result shows itself as the page. It is served until ``close()``, or until
    Python ends.

    Parameters
    ----------
    study
        A study, its file, or its keys.
    values
        Values of parameters that the page offers to start from, in the units of the study.
    results
        Folder of the results of the study, by default ``results/<name>``.
    browser
        Whether a browser opens the page.

    Returns
    -------
    Explorer
        ``address`` is that of the page.

    Raises
    ------
    StudyError
        The study breaks a rule, or a value is that of no parameter.
    """
    read = read_study(study)
    if values is not None:
        si_values(read, values)
    folder = None if results is None else path_of("results", results)
    made = Explorer(read, folder, values={"values": dict(values)} if values is not None else {})
    in_background(made.server)
    if browser:
        webbrowser.open(made.address)
    return made


def _names(given: Given) -> list[str]:
    names = given.get("estimate", [])
    return [str(name) for name in names] if isinstance(names, list) else []
