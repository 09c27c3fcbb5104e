"""Definition of a figure, apart from the results in it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Canvas
from pyrofit.show.table import always


@dataclass(frozen=True)
class Figure:
    """A figure: when a study has it, how it is drawn, and its title and caption."""

    place: int
    """Place in its section, in ascending order."""
    make: Callable[[Study, Results], Canvas]
    title: str
    caption: str
    applies: Callable[[Any], bool] = always
    """Whether a study has it; in the diagnosis, whether its result has something to draw."""
    verdict: Callable[[Study, Any], str] | None = None
    """Function of the study and the facts of its report that returns what the figure shows."""
    paper: str = ""
    """Figure of the paper that it reproduces, such as 'Figure 3'."""
    shown: bool = True
    """Whether the report shows it; else it is drawn alone."""


def draw_figure(
    figure: Figure, name: str, study: Study, results: Results, folder: str = "figures"
) -> None:
    """Write a figure to ``<folder>/<name>.svg`` and ``.png``."""
    with style.style():
        canvas = figure.make(study, results)
        if study.is_synthetic:
            canvas.suptitle(f"{figure.title} (synthetic data)")
        style.save(canvas, results, name, folder)
