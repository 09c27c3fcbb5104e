import numpy as np
import pytest

from pyrofit.quantities.integral import integral as released


def integral(time: list[float], mlr: list[float]) -> float:
    return released(np.array(time), np.array(mlr))


def test_three_bins_by_hand() -> None:
    # Edges 0, 3, 6.5, 9: 3 s x 0.1 + 3.5 s x 0.2 - 2.5 s x 0.04.
    assert integral([2.0, 4.0, 9.0], [0.1, 0.2, -0.04]) == pytest.approx(0.9, rel=1e-14)


def test_constant_rate_is_integrated_from_zero_to_the_last_time() -> None:
    assert integral([7.0, 9.0, 30.0, 31.0], [0.02] * 4) == pytest.approx(0.62, rel=1e-14)


def test_series_from_zero_is_the_trapezoidal_rule() -> None:
    time, rate = [0.0, 1.0, 4.0, 6.0], [0.0, 2.0, 1.0, 0.5]
    assert integral(time, rate) == pytest.approx(np.trapezoid(rate, time), rel=1e-14)


@pytest.mark.measured
@pytest.mark.parametrize(("flux", "mass", "negative"), [(25, 6.95, 8), (60, 6.82, 4)])
def test_measured_runs_release_the_known_mass(flux: int, mass: float, negative: int) -> None:
    from pyrofit.data.fetch import locate
    from pyrofit.data.series import read_series
    from pyrofit.data.spec import SeriesSpec

    path = locate(f"PMMA/Calibration_Data/UMD/UMD_CAPA_{flux}kW_Mass.csv")
    series = read_series(SeriesSpec("mlr", path))
    rate = series.frame["mlr_kg_m2_s"]
    assert released(series.frame["time_s"].to_numpy(), rate.to_numpy()) == pytest.approx(
        mass, abs=0.005
    )
    assert int((rate < 0.0).sum()) == negative
    assert "left out, zero throughout: Temp_avg_all4, Temperature_Error" in series.notes
