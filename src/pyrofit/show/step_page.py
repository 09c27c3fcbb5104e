"""The page of a step of its own: its tables and figures, and its section of the report."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.results.step import check_options, exists
from pyrofit.show.figure import Figure, draw_figure
from pyrofit.show.parts import Part, Picture, Shown, picture, table_part
from pyrofit.show.table import Table, read_table, write_table
from pyrofit.steps import known_steps


def _nothing(study: Study, results: Results) -> None:
    pass


def _no_parts(study: Study, results: Results) -> list[Part]:
    return []


@dataclass(frozen=True)
class StepPage:
    """Tables, figures and sentences of a step that a study may go without.

    Parameters
    ----------
    folder
        Name of the step: the folder of its results, and the identifier of its section.
    heading, text
        Heading of the section, and a sentence on it.
    tables, figures
        All that are written to the folder, by name.
    sentences
        Function that returns the sentences beside them.
    tables_shown, figures_shown
        Names of those in the report.
    prefix
        What the names of files of tables begin with.
    finish
        Function that is called when all is written.
    more
        Function that returns parts of the section behind figures and tables.
    """

    folder: str
    heading: str
    text: str
    tables: Mapping[str, Table]
    figures: Mapping[str, Figure]
    sentences: Callable[[Study, Results], list[str]]
    tables_shown: tuple[str, ...]
    figures_shown: tuple[str, ...]
    prefix: str = "table_"
    finish: Callable[[Study, Results], None] = _nothing
    more: Callable[[Study, Results], list[Part]] = _no_parts

    def draw_and_write(self, study: Study, results: Results) -> None:
        """Write the tables, then the figures, to the folder.

        Raises
        ------
        DataError
            A result is missing or broken.
        """
        for name, table in self.tables.items():
            frame = table.make(study, results)
            write_table(results.folder(self.folder), f"{self.prefix}{name}", table, frame, study)
        for name, figure in self.figures.items():
            draw_figure(figure, name, study, results, self.folder)
        self.finish(study, results)

    def section(self, study: Study, results: Results) -> Shown:
        """Return figures, tables and sentences as a section of the report.

        Raises
        ------
        DataError
            A result or a figure is missing, or they were made with other options.
        """
        check_options(study, results, self.folder)
        drawn = [
            picture(
                results.of_step(self.folder, f"{name}.svg"),
                f"{self.folder}_{name}",
                self.figures[name].title,
                self.figures[name].caption,
            )
            for name in self.figures_shown
        ]
        tables = [
            table_part(
                study,
                self.tables[name],
                read_table(results, f"{self.prefix}{name}", self.folder),
            )
            for name in self.tables_shown
        ]
        parts: list[Part | Picture] = [*drawn, *tables, *self.more(study, results)]
        said = tuple(self.sentences(study, results))
        return Shown(self.folder, self.heading, self.text, tuple(parts), said)


def sections_of(page: str, study: Study, results: Results) -> list[Shown]:
    """Return the sections of all steps on a page that the study has run."""
    return [
        step.load("page").PAGE.section(study, results)
        for step in known_steps().values()
        if step.page == page and exists(study, results, step.name)
    ]
