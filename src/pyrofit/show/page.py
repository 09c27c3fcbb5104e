"""A page: a subject with its tables, figures and sentences, shown as a section of a report."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from pyrofit.config import Study
from pyrofit.discovery import contents
from pyrofit.errors import StudyError
from pyrofit.results.files import Results
from pyrofit.results.step import check_options, exists
from pyrofit.show.figure import Figure, draw_figure
from pyrofit.show.names import titled
from pyrofit.show.parts import Passage, Picture, Section, picture, table_part
from pyrofit.show.table import Frames, Table, read_written_table, write_table
from pyrofit.steps import known_steps

_OF_CAMPAIGN = ("tables", "figures")


def _always(study: Study, results: Results) -> bool:
    return True


def _no_sentences(study: Study, facts: Any) -> list[str]:
    return []


def _nothing(study: Study, results: Results) -> None:
    pass


def _no_parts(study: Study, results: Results) -> Sequence[Passage]:
    return ()


@dataclass(frozen=True)
class Page:
    """A subject of a report: its topic, its tables and figures in the order of their places.

    Parameters
    ----------
    name
        Identifier of its section.
    heading, text
        Heading, and the topic of the section in a sentence.
    tables, figures
        By name; each has its place among both.
    sentences
        Function of study and facts that returns the sentences beside them. Facts are those of the
        report, the results of a step, or the diagnosis.
    place
        Place in the report, in ascending order.
    folded
        Whether it is about methods, which a reader of the answer may skip.
    folders
        Folders of the results with its tables, and with its figures.
    prefix
        What the names of files of tables begin with.
    written
        Whether tables are read as they were written; else they are made, and shown if they have
        rows.
    about
        Sentences before the first table with one hundred of places, by that hundred.
    exists
        Whether results have what it shows.
    finish
        Function that is called when all is written.
    more
        Function that returns parts of the section behind figures and tables.
    """

    name: str
    heading: str
    text: str
    tables: Mapping[str, Table]
    figures: Mapping[str, Figure]
    sentences: Callable[[Study, Any], list[str]] = _no_sentences
    place: int = 0
    folded: bool = False
    folders: tuple[str, str] = _OF_CAMPAIGN
    prefix: str = ""
    written: bool = True
    about: Mapping[int, Callable[[Study, Any], str]] = field(default_factory=dict)
    exists: Callable[[Study, Results], bool] = _always
    finish: Callable[[Study, Results], None] = _nothing
    more: Callable[[Study, Results], Sequence[Passage]] = _no_parts

    @property
    def modules(self) -> list[str]:
        """Full names of the modules that make the tables and figures of a subject."""
        return sorted(
            f"pyrofit.show.subjects.{self.name}.{n}" for n in (*self.tables, *self.figures)
        )

    def tables_of(self, study: Study) -> list[str]:
        """Return the names of the tables that a study has."""
        return [name for name, table in self.tables.items() if table.applies(study)]

    def figures_of(self, study: Study) -> list[str]:
        """Return the names of the figures that a study has."""
        return [name for name, figure in self.figures.items() if figure.applies(study)]

    def write(self, study: Study, results: Results) -> None:
        """Write the tables, then the figures, that a study has.

        Raises
        ------
        DataError
            A result is missing or broken.
        """
        for name in self.tables_of(study):
            self.write_table(name, study, results)
        for name in self.figures_of(study):
            self.draw(name, study, results)
        self.finish(study, results)

    def write_table(self, name: str, study: Study, results: Results) -> None:
        """Write a table as CSV and Markdown.

        Raises
        ------
        StudyError
            The study does not have it.
        """
        table = self.tables[name]
        _check(name, "table", table, study)
        folder, frame = results.folder(self.folders[0]), table.make(study, results)
        write_table(folder, f"{self.prefix}{name}", table, frame, study)

    def draw(self, name: str, study: Study, results: Results) -> None:
        """Write a figure as SVG and PNG.

        Raises
        ------
        StudyError
            The study does not have it.
        """
        _check(name, "figure", self.figures[name], study)
        draw_figure(self.figures[name], name, study, results, self.folders[1])

    def frames(self, study: Study, results: Results) -> Frames:
        """Return the tables that the report shows, by name.

        Raises
        ------
        DataError
            A result is missing or broken.
        """
        names = [name for name in self.tables_of(study) if self.tables[name].shown]
        if self.written:
            return {
                n: read_written_table(results, f"{self.prefix}{n}", self.folders[0]) for n in names
            }
        made = {name: self.tables[name].make(study, results) for name in names}
        return {name: frame for name, frame in made.items() if len(frame)}

    def section(
        self, study: Study, results: Results, facts: Any = None, frames: Frames | None = None
    ) -> Section | None:
        """Return its section, none where the study has no part of it.

        Parameters
        ----------
        study, results
            The study and its results.
        facts
            What the sentences rest on; default: the results.
        frames
            Its tables, where they are at hand.

        Raises
        ------
        DataError
            A result or a figure is missing, or a step was made with other options.
        """
        check_options(study, results, self.name)
        facts = results if facts is None else facts
        frames = self.frames(study, results) if frames is None else frames
        told = self._told(study, facts, frames)
        parts: list[Passage | Picture] = []
        for name, item in self._items():
            if isinstance(item, Figure):
                if item.shown and item.applies(study):
                    parts.append(self._picture(name, item, study, results, facts))
            elif name in frames:
                parts.append(table_part(study, item, frames[name], told.get(name, "")))
            elif name in told:
                parts.append(Passage(item.title, text=told[name]))
        parts += self.more(study, results)
        if not parts:
            return None
        said = tuple(self.sentences(study, facts))
        return Section(self.name, self.heading, self.text, tuple(parts), said, self.folded)

    def _items(self) -> list[tuple[str, Table | Figure]]:
        items: list[tuple[str, Table | Figure]] = [*self.tables.items(), *self.figures.items()]
        return sorted(items, key=lambda item: item[1].place)

    def _told(self, study: Study, facts: Any, frames: Frames) -> dict[str, str]:
        """Return the sentences before tables, by table: the first one shown, or the first."""
        told = {}
        for hundred, tell in self.about.items():
            if text := tell(study, facts):
                names = [n for n, item in self._items() if item.place // 100 == hundred // 100]
                told[next((name for name in names if name in frames), names[0])] = text
        return told

    def _picture(
        self, name: str, figure: Figure, study: Study, results: Results, facts: Any
    ) -> Picture:
        folder = self.folders[1]
        verdict = "" if figure.verdict is None else figure.verdict(study, facts)
        return picture(
            results.folder(folder) / f"{name}.svg",
            name if folder == _OF_CAMPAIGN[1] else f"{self.name}_{name}",
            titled(study, figure.title, figure.paper),
            figure.caption,
            verdict,
        )


def page_of_folder(package: str, folders: Sequence[str], **given: Any) -> Page:
    """Return the page of a subject, with all that the files of its folder define.

    A file ``name.py`` may define ``TABLE`` or ``FIGURE``; ``name`` is that of its results.

    Parameters
    ----------
    package, folders
        Full name of its package, and ``__path__``.
    given
        Other fields of the page.
    """
    tables = contents(package, folders, "TABLE")
    figures = contents(package, folders, "FIGURE")
    return Page(package.rpartition(".")[2], tables=tables, figures=figures, **given)


def page_of_step(name: str, prefix: str = "table_", **given: Any) -> Page:
    """Return the page of a step, whose tables and figures stand in its folder.

    Parameters
    ----------
    name
        Name of the step.
    prefix, given
        Fields of the page.
    """
    return Page(name, folders=(name, name), prefix=prefix, **given)


def pages_of_steps(page: str, study: Study, results: Results) -> list[Page]:
    """Return the pages of the steps that a page shows and that a study has run, in order."""
    return [
        step.load("page").PAGE
        for step in known_steps().values()
        if step.page == page and exists(study, results, step.name)
    ]


def _check(name: str, kind: str, item: Table | Figure, study: Study) -> None:
    if not item.applies(study):
        raise StudyError(f"study '{study.name}' has no {name}: it lacks the contents of the {kind}")
