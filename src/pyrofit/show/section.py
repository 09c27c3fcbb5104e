"""A subject of the report: its tables and figures, found in its folder, and its sentences."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from pyrofit.config import Study
from pyrofit.discovery import contents
from pyrofit.show.facts import Facts
from pyrofit.show.figure import Figure
from pyrofit.show.table import Table

Sentences = Callable[[Study, Facts], list[str]]


@dataclass(frozen=True)
class Section:
    """A subject: its place on the page, its topic, its tables and figures.

    Parameters
    ----------
    package
        Full name of its package.
    anchor, heading, text
        Identifier on the page, heading, and the topic of the section in a sentence.
    tables, figures
        By name; see `section_of`.
    sentences
        Function that returns the sentences beside them.
    folded
        Whether it is about methods, which a reader of the answer may skip.
    """

    package: str
    anchor: str
    heading: str
    text: str
    tables: Mapping[str, Table]
    figures: Mapping[str, Figure]
    sentences: Sentences
    folded: bool = False

    @property
    def items(self) -> list[str]:
        """Names of tables and figures in the order of the page."""
        places = {name: table.place for name, table in self.tables.items()}
        places |= {name: figure.place for name, figure in self.figures.items()}
        return sorted(places, key=lambda name: places[name])

    def tables_of(self, study: Study) -> list[str]:
        """Return the names of the tables that a study has."""
        return [name for name, table in self.tables.items() if table.applies(study)]

    def figures_of(self, study: Study) -> list[str]:
        """Return the names of the figures that a study has."""
        return [name for name, figure in self.figures.items() if figure.applies(study)]

    @property
    def modules(self) -> list[str]:
        """Full names of the modules that make its tables and figures."""
        return sorted(f"{self.package}.{name}" for name in self.items)


def section_of(
    package: str,
    folders: Sequence[str],
    anchor: str,
    heading: str,
    text: str,
    sentences: Sentences,
    folded: bool = False,
) -> Section:
    """Return a section with all that the files of its folder define.

    A file ``name.py`` may define ``TABLE`` or ``FIGURE``; ``name`` is that of its results.
    """
    tables = contents(package, folders, "TABLE")
    figures = contents(package, folders, "FIGURE")
    return Section(package, anchor, heading, text, tables, figures, sentences, folded)
