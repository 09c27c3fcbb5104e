"""A matrix of correlations."""

import pandas as pd

from pyrofit.show import style
from pyrofit.show.drawn import Canvas


def draw_matrix(matrix: pd.DataFrame, label: str) -> Canvas:
    """Draw a matrix of correlations, with its numbers."""
    names = [str(name) for name in matrix]
    size = min(style.TWO_COLUMNS, 34.0 + 11.5 * max(len(names), 4))  # the title needs the width
    canvas, (ax,) = style.panels(1, 1, size + 12.0, size - 8.0)
    canvas.set_layout_engine("compressed")  # the usual one cuts off labels of square panels
    # Blue and red are told apart by every kind of colour vision.
    image = ax.imshow(matrix.to_numpy(), cmap="RdBu_r", vmin=-1.0, vmax=1.0)
    for i, row in enumerate(matrix.to_numpy()):
        for k, value in enumerate(row):
            text = f"{round(value, 2) + 0.0:.2f}".replace("-", "−")
            colour = "white" if abs(value) > 0.65 else "black"
            ax.text(k, i, text, ha="center", va="center", color=colour, fontsize=7)
    ax.set_xticks(range(len(names)), names, rotation=45, ha="right", rotation_mode="anchor")
    ax.set_yticks(range(len(names)), names)
    ax.tick_params(length=0)
    canvas.colorbar(image, ax=ax, label=label, shrink=0.85)
    return canvas
