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
