import os

import numpy as np
import pandas as pd
import pytest

from pyrofit.data.closure import Closure, mass_closure
from pyrofit.errors import DataError


def frame(time: list[float], mlr: list[float]) -> pd.DataFrame:
    return pd.DataFrame({"time_s": time, "mlr_kg_m2_s": mlr})


def test_three_bins_by_hand() -> None:
    # Edges 0, 3, 6.5, 9: 3 s x 0.1 + 3.5 s x 0.2 - 2.5 s x 0.04.
    closure = mass_closure(frame([2.0, 4.0, 9.0], [0.1, 0.2, -0.04]), 1.8)
    assert closure.released_kg_m2 == pytest.approx(0.9, rel=1e-14)
    assert closure.ratio == pytest.approx(0.5, rel=1e-14)


def test_constant_rate_is_integrated_from_zero_to_the_last_time() -> None:
    closure = mass_closure(frame([7.0, 9.0, 30.0, 31.0], [0.02] * 4), 1.0)
    assert closure.released_kg_m2 == pytest.approx(0.62, rel=1e-14)


def test_series_from_zero_is_the_trapezoidal_rule() -> None:
    time = np.array([0.0, 1.0, 4.0, 6.0])
    rate = np.array([0.0, 2.0, 1.0, 0.5])
    released = mass_closure(frame(time.tolist(), rate.tolist()), 1.0).released_kg_m2
    assert released == pytest.approx(np.trapezoid(rate, time), rel=1e-14)


def test_description_is_one_line_with_both_masses() -> None:
    assert Closure(6.3, 7.0, 0.9).describe() == "released 6.300 of 7.000 kg/m² (90.0 %)"


@pytest.mark.parametrize("mass", [0.0, -1.0, float("nan"), float("inf")])
def test_impossible_initial_mass_is_refused(mass: float) -> None:
    with pytest.raises(DataError, match="must be a number above 0"):
        mass_closure(frame([1.0, 2.0], [0.1, 0.1]), mass)


@pytest.mark.measured
@pytest.mark.skipif(not os.environ.get("PYROFIT_DATA_DIR"), reason="PYROFIT_DATA_DIR is not set")
@pytest.mark.parametrize(("flux", "released", "negative"), [(25, 6.95, 8), (60, 6.82, 4)])
def test_measured_runs_release_the_known_mass(flux: int, released: float, negative: int) -> None:
    from pyrofit.data.fetch import locate
    from pyrofit.data.series import SeriesSpec, read_series

    path = locate(f"PMMA/Calibration_Data/UMD/UMD_CAPA_{flux}kW_Mass.csv")
    series = read_series(SeriesSpec("mlr", path))
    assert mass_closure(series.frame, 7.0).released_kg_m2 == pytest.approx(released, abs=0.005)
    assert int((series.frame["mlr_kg_m2_s"] < 0.0).sum()) == negative
    assert "left out, zero throughout: Temp_avg_all4, Temperature_Error" in series.notes
