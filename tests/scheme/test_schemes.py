"""What schemes there are, and the material each makes of a study's own."""

import numpy as np
import pytest
from scheme_truths import all_schemes, draw_truth, make_scheme_twin, scheme_named, simulated_masses

from pyrofit.errors import StudyError
from pyrofit.scheme.arrangements import ARRANGEMENTS
from pyrofit.scheme.arrangements.base import PREFIX
from pyrofit.scheme.posed import pose_scheme
from pyrofit.scheme.schemes import Scheme
from pyrofit.scheme.search import largest_first
from pyrofit.scheme.settings import SchemeSettings

SETTINGS = SchemeSettings()
SCHEMES = all_schemes(SETTINGS.most_reactions)


def test_each_scheme_has_a_name_of_its_own() -> None:
    # One reaction, catalysed or not, two to four in arrangements; order, volatile and lag or not.
    assert len(SCHEMES) == (2 + 3 * len(ARRANGEMENTS)) * 2**3
    assert all(scheme_named(name, 4) == scheme for name, scheme in SCHEMES.items())


def test_unknown_scheme_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(StudyError, match=r"unknown scheme 'paralel_2'.*parallel_2"):
        scheme_named("paralel_2", 4)


def test_an_extension_has_one_feature_more() -> None:
    for scheme in SCHEMES.values():
        for more in scheme.extensions(4, lag=True):
            features = [
                s.reactions + s.order + s.catalysis + s.volatile + s.lag for s in (scheme, more)
            ]
            assert features[1] == features[0] + 1
            assert not more.catalysis or more.reactions == 1


def test_no_extension_lags_where_records_have_a_lag_already() -> None:
    assert not any(s.lag for s in Scheme().extensions(4, lag=False))


def test_largest_first_keeps_the_mixture() -> None:
    given = {f"{PREFIX}{k}": v for k, v in {"w_2": 0.3, "w_3": 0.6, "T_1": 1.0}.items()}
    given |= {f"{PREFIX}T_{i}": float(i) for i in (2, 3)}
    found = largest_first(given)
    assert [found[f"{PREFIX}T_{i}"] for i in (1, 2, 3)] == [3.0, 2.0, 1.0]
    assert found[f"{PREFIX}w_2"] == 0.3
    assert found[f"{PREFIX}w_3"] == pytest.approx(0.1)


@pytest.fixture(scope="module")
def setting():
    return make_scheme_twin(Scheme(), 3, SETTINGS).setting


@pytest.mark.parametrize("name", SCHEMES)
def test_material_of_each_scheme_uses_its_parameters(name: str, setting) -> None:
    posed = pose_scheme(setting.study, SCHEMES[name], setting.records, SETTINGS)
    assert posed.count == len(set(posed.names))
    assert len(posed.study.material.reactions) == SCHEMES[name].reactions + SCHEMES[name].volatile


@pytest.mark.parametrize("name", ["parallel_3_order", "consecutive_3", "single_volatile"])
def test_residue_is_that_of_the_study_whatever_the_scheme(name: str, setting) -> None:
    truth = draw_truth(SCHEMES[name], np.random.default_rng(5))
    mass = simulated_masses(
        setting.study, SCHEMES[name], truth, setting.measurements, "tga_1", SETTINGS
    )
    share = 1.0 - truth[f"{PREFIX}volatile_share"] if SCHEMES[name].volatile else 1.0
    assert mass[0] == pytest.approx(1.0, abs=1e-6)
    assert mass[-1] == pytest.approx(0.002 * share, abs=2e-4)
    assert np.all(np.diff(mass) <= 1e-12)


def test_two_equal_parallel_reactions_are_one(setting) -> None:
    study, measured = setting.study, setting.measurements
    truth = draw_truth(SCHEMES["parallel_2"], np.random.default_rng(6))
    truth |= {f"{PREFIX}{k}_2": truth[f"{PREFIX}{k}_1"] for k in ("T", "E")}
    both = simulated_masses(study, SCHEMES["parallel_2"], truth, measured, "tga_10", SETTINGS)
    one = simulated_masses(study, SCHEMES["single"], truth, measured, "tga_10", SETTINGS)
    assert both == pytest.approx(one, abs=1e-12)


def test_two_equal_competing_reactions_are_one_of_twice_the_rate(setting) -> None:
    study, measured = setting.study, setting.measurements
    truth = draw_truth(SCHEMES["competing_2"], np.random.default_rng(6))
    T, E = (truth[f"{PREFIX}{k}_1"] for k in ("T", "E"))
    truth |= {f"{PREFIX}T_2": T, f"{PREFIX}E_2": E, f"{PREFIX}y_2": 0.002}
    both = simulated_masses(study, SCHEMES["competing_2"], truth, measured, "tga_10", SETTINGS)
    # k is 0.001 1/s at T; twice as large, it is so where 1/T is larger by R ln 2 / E.
    truth |= {f"{PREFIX}T_1": 1.0 / (1.0 / T + 8.314462618 * np.log(2.0) / E)}
    one = simulated_masses(study, SCHEMES["single"], truth, measured, "tga_10", SETTINGS)
    assert both == pytest.approx(one, abs=1e-6)


def test_residue_of_competing_reactions_depends_on_the_heating_rate(setting) -> None:
    study, measured = setting.study, setting.measurements
    values = {"T_1": 600.0, "E_1": 2.4e5, "T_2": 590.0, "E_2": 1.2e5, "y_2": 0.5}
    truth = {PREFIX + key: value for key, value in values.items()}
    slow, fast = (
        simulated_masses(study, SCHEMES["competing_2"], truth, measured, name, SETTINGS)[-1]
        for name in ("tga_1", "tga_20")
    )
    assert slow > fast + 0.05
    assert 0.002 < fast < slow < 0.5


def test_autocatalytic_reaction_is_slow_first_and_fast_then(setting) -> None:
    study, measured = setting.study, setting.measurements
    assert SCHEMES["single_order_catalysis"].words == "one autocatalytic reaction of order n"
    truth = {f"{PREFIX}T_1": 600.0, f"{PREFIX}E_1": 1.8e5, f"{PREFIX}K": 0.0}
    plain = simulated_masses(study, SCHEMES["single"], truth, measured, "tga_10", SETTINGS)
    none = simulated_masses(study, SCHEMES["single_catalysis"], truth, measured, "tga_10", SETTINGS)
    truth |= {f"{PREFIX}K": 20.0}
    fast = simulated_masses(study, SCHEMES["single_catalysis"], truth, measured, "tga_10", SETTINGS)
    assert none == pytest.approx(plain, abs=1e-9)
    assert np.all(fast <= plain + 1e-9)
    # The part from 90 to 10 % of the mass takes fewer kelvins.
    of = [np.count_nonzero((m > 0.1) & (m < 0.9)) for m in (fast, plain)]
    assert of[0] < 0.7 * of[1]
