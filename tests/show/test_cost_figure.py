from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from shown_studies import fake, synthetic

from pyrofit.show import style
from pyrofit.show.subjects.costs import fig1 as fig


@pytest.fixture(scope="module")
def axes(tmp_path_factory: pytest.TempPathFactory) -> list[Axes]:
    study, results = fake(tmp_path_factory.mktemp("fig1"))
    with style.style():
        return fig.fig1(study, results).axes


def curves() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Time [s], target, model, uncertainty [g/(m² s)]."""
    target, model = fig.example()
    assert target.uncertainty is not None
    return target.time_s, 1e3 * target.value, 1e3 * model, 1e3 * target.uncertainty


def said(ax: Axes) -> dict[str, float]:
    """The costs written in a panel."""
    lines = [line.split(" = ") for line in ax.texts[0].get_text().splitlines()]
    return {name: float(value) for name, value in lines}


def edges(ax: Axes, colour: str) -> np.ndarray:
    """Lower and upper edge at each time of what is filled with a colour, shape (2, times)."""
    (area,) = [c for c in ax.collections if tuple(c.get_facecolor()[0]) == to_rgba(colour)]
    vertices = np.concatenate([path.vertices for path in area.get_paths()])
    columns = [vertices[vertices[:, 0] == t, 1] for t in np.unique(vertices[:, 0])]
    return np.array([[y.min() for y in columns], [y.max() for y in columns]])


def bars(ax: Axes) -> list[np.ndarray]:
    """Ends of the bars, shape (2 ends, 2 coordinates) each."""
    return [line.get_xydata() for line in ax.lines if line.get_color() == fig._BAR["color"]]


def outside(lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """Distance of the example's model to limits, by cases as Table 2 prints them."""
    _, _, model, _ = curves()
    return np.where(model < lower, model - lower, np.where(model > upper, model - upper, 0.0))


def root_mean_square(differences: np.ndarray) -> float:
    return float(np.sqrt(np.mean(differences**2)))


def test_written_costs_are_those_of_the_printed_equations(axes: list[Axes]) -> None:
    _, y, model, width = curves()
    assert said(axes[2])["RMSE"] == pytest.approx(
        root_mean_square(model - y) / y.mean(), abs=5.1e-4
    )
    bands = root_mean_square(outside(y - width, y + width)) / y.mean()
    assert said(axes[3])["BANDS"] == pytest.approx(bands, abs=5.1e-4)
    within = root_mean_square(outside((1 - fig.R) * y, (1 + fig.R) * y)) / y.mean()
    assert said(axes[4])["RANGE"] == pytest.approx(within, abs=5.1e-4)


def test_shading_reaches_from_the_model_to_where_its_distance_counts_from(
    axes: list[Axes],
) -> None:
    _, y, model, width = curves()
    limits = {2: (y, y), 3: (y - width, y + width), 4: ((1 - fig.R) * y, (1 + fig.R) * y)}
    for panel, (lower, upper) in limits.items():
        nearest = model - outside(lower, upper)
        expected = [np.minimum(model, nearest), np.maximum(model, nearest)]
        assert np.allclose(edges(axes[panel], fig._COUNTED["facecolor"]), expected)
        if panel > 2:
            assert np.allclose(edges(axes[panel], fig._AREA["color"]), [lower, upper])


def test_bar_of_the_point_joins_the_two_curves_and_its_length_is_the_cost(axes: list[Axes]) -> None:
    time, y, model, _ = curves()
    ((low, high),) = bars(axes[0])
    assert low.tolist() == pytest.approx([fig.POINT_S, np.interp(fig.POINT_S, time, y)])
    assert high.tolist() == pytest.approx([fig.POINT_S, np.interp(fig.POINT_S, time, model)])
    assert said(axes[0])["NRSE"] == pytest.approx((high[1] - low[1]) / low[1], abs=5.1e-4)


def test_bars_of_the_threshold_join_the_passages_of_one_level(axes: list[Axes]) -> None:
    time, y, model, _ = curves()
    rise, fall = bars(axes[1])
    for (t0, level), (t, _) in (rise, fall):
        assert np.interp(t0, time, y) == pytest.approx(level)
        assert np.interp(t, time, model) == pytest.approx(level)
    assert rise[0, 1] == pytest.approx(fall[0, 1], rel=0.01)
    costs = [abs(t - t0) / t0 for (t0, _), (t, _) in (rise, fall)]
    assert list(said(axes[1]).values()) == pytest.approx(costs, abs=5.1e-4)


def test_weighted_sum_adds_up_to_what_it_says(axes: list[Axes]) -> None:
    *parts, total = said(axes[5]).values()
    assert total == pytest.approx(sum(parts), abs=2.1e-3)
    assert said(axes[5])["0.25 × NRSE"] == pytest.approx(said(axes[0])["NRSE"] / 4, abs=1e-3)
    assert said(axes[5])["0.25 × THR"] == pytest.approx(said(axes[1])["THR, rise"] / 4, abs=1e-3)


def test_a_model_that_meets_the_target_has_no_cost_in_the_weighted_sum() -> None:
    target, _ = fig.example()
    plateau = target.window(*fig.PLATEAU_S)
    assert fig.combined(target).value([plateau.value, target.value, target.value]) < 1e-12


def test_the_figure_is_the_same_for_every_study(tmp_path: Path) -> None:
    texts = []
    for given in (None, synthetic()):
        with style.style():
            canvas = fig.fig1(*fake(tmp_path, given))
        texts.append([ax.texts[0].get_text() for ax in canvas.axes])
    assert texts[0] == texts[1]
