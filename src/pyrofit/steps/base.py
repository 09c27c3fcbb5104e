"""Definition of a step, apart from its code: that is loaded when it is needed."""

import importlib
import pkgutil
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Step:
    """A step that a study may go without.

    Parameters
    ----------
    place
        Its place in the report and in the help, in ascending order.
    words
        What it does, for the help of its command.
    message
        What the workflow says when it begins.
    threads
        Processes that share its work.
    part, part_message
        Option that names one of its parts, which are jobs of their own; none = it has no parts.
    page
        The page that shows it: 'report', or 'diagnosis' and the report; none = no page.
    write
        A file that its command also writes where `--write` says, in words; none = no such option.
        Its function ``write`` does that, from the value that ``run`` returns.
    early
        Whether every run makes it, before the fits.
    name, package
        Name of its folder, and full name of its package; `known_steps` fills them in.
    """

    place: int
    words: str
    message: str
    threads: int = 1
    part: str = ""
    part_message: str = ""
    page: str = "report"
    write: str = ""
    early: bool = False
    name: str = ""
    package: str = ""

    def load(self, module: str) -> Any:
        """Return one of its modules: ``options``, ``inputs``, ``compute`` or ``page``."""
        return importlib.import_module(f"{self.package}.{module}")

    @property
    def modules(self) -> list[str]:
        """Full names of all its modules."""
        folders = importlib.import_module(self.package).__path__
        return sorted(f"{self.package}.{found.name}" for found in pkgutil.iter_modules(folders))

    @property
    def options(self) -> Any:
        """Class of its options, a part of a study; none if it has no options."""
        return self.load("options").OPTIONS if f"{self.package}.options" in self.modules else None
