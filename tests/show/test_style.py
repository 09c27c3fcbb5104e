"""The layout of figures."""

from pathlib import Path

import matplotlib.image
import pytest

from pyrofit.results.files import Results
from pyrofit.show import style


@pytest.mark.parametrize("label", ["THR_above_literal", "a long label with more than 30 letters"])
def test_labels_beside_the_panels_are_not_cut_off(label: str, tmp_path: Path) -> None:
    with style.style():
        canvas, axes = style.panels(6, 3, style.TWO_COLUMNS, 60.0, sharey=True)
        axes[0].set_yticks([0.0, 1.0], [label, "short"])
        style.save(canvas, Results(tmp_path), "labels")
    picture = matplotlib.image.imread(tmp_path / "figures" / "labels.png")
    edges = picture[:, [0, 1, 2, -3, -2, -1], :3]
    assert float(edges.min()) > 0.9


@pytest.mark.parametrize("count", [4, 14])
def test_long_titles_and_labels_stay_within_their_panels(count: int) -> None:
    words = "cone calorimeter 25 kW/m², a_very_long_name_of_a_file_of_a_laboratory_without_a_space"
    with style.style():
        canvas, axes = style.panels(count, 2, style.TWO_COLUMNS, 62.0)
        style.letter(axes, [words] * count)
        for ax in axes:
            style.label_y(ax, "interface temperature (back_temperature_1) [°C]")
        canvas.draw_without_rendering()
    left, right = 0.0, canvas.bbox.width
    for ax in axes:
        title, label = ax._left_title.get_window_extent(), ax.yaxis.label.get_window_extent()
        assert left <= title.x0 < title.x1 <= right
        assert label.y1 <= title.y0 or label.x1 <= title.x0
    first, second = (ax._left_title.get_window_extent() for ax in axes[:2])
    assert first.x1 <= second.x0
