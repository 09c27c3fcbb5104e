"""The page of a step of its own: its tables and figures, and its section of the report."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.figure import Figure, draw_figure
from pyrofit.show.parts import Shown, picture, table_part
from pyrofit.show.table import Table, read_table, write_table


@dataclass(frozen=True)
class StepPage:
    """Tables, figures and sentences of a step that a study may go without.

    Parameters
    ----------
    folder
        Folder of its results, and identifier of its section.
    heading, text
        Heading of the section, and a sentence on it.
    tables, figures
        All that are written to the folder, by name.
    sentences
        Function that returns the sentences beside them.
    tables_shown, figures_shown
        Names of those in the report.
    """

    folder: str
    heading: str
    text: str
    tables: Mapping[str, Table]
    figures: Mapping[str, Figure]
    sentences: Callable[[Study, Results], list[str]]
    tables_shown: tuple[str, ...]
    figures_shown: tuple[str, ...]

    def draw_and_write(self, study: Study, results: Results) -> None:
        """Write the tables, then the figures, to the folder.

        Raises
        ------
        DataError
            A result is missing or broken.
        """
        for name, table in self.tables.items():
            frame = table.make(study, results)
            write_table(results.root / self.folder, f"table_{name}", table, frame, study)
        for name, figure in self.figures.items():
            draw_figure(figure, name, study, results, self.folder)

    def section(self, study: Study, results: Results) -> Shown:
        """Return figures, tables and sentences as a section of the report.

        Raises
        ------
        DataError
            A result or a figure is missing.
        """
        drawn = [
            picture(
                results.root / self.folder / f"{name}.svg",
                f"{self.folder}_{name}",
                self.figures[name].title,
                self.figures[name].caption,
            )
            for name in self.figures_shown
        ]
        tables = [
            table_part(study, self.tables[name], read_table(results, f"table_{name}", self.folder))
            for name in self.tables_shown
        ]
        said = tuple(self.sentences(study, results))
        return Shown(self.folder, self.heading, self.text, (*drawn, *tables), said)
