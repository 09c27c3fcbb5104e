"""A study of TGA alone: which of its masses schemes are fitted to, and the study with a scheme."""

from typing import Any

import numpy as np
import pytest
from scheme_truths import make_scheme_twin, name_at_rate

from pyrofit.config import Study, as_study
from pyrofit.errors import StudyError
from pyrofit.scheme.extended import scheme_keys
from pyrofit.scheme.fit import SchemeSetting, fit_posed
from pyrofit.scheme.masses import masses_of
from pyrofit.scheme.posed import own, pose_scheme
from pyrofit.scheme.records import rates_of, records_of
from pyrofit.scheme.schemes import Scheme
from pyrofit.scheme.settings import SchemeSettings
from pyrofit.solver.outputs import MASS_FRACTION

RATES = (1.0, 10.0, 50.0)


def of_tga_alone(fitted: tuple[float, ...]) -> Study:
    """Return the twin's study without slab and without a stage of kinetics."""
    twin = make_scheme_twin(Scheme(order=True), 3, SchemeSettings()).setting.study
    keys: dict[str, Any] = twin.model_dump(mode="json", exclude_defaults=True)
    kinetics = keys.pop("kinetics")
    names = [name_at_rate(rate) for rate in RATES]
    keys["experiments"] = {name: keys["experiments"][name] for name in names}
    cost = [t for t in kinetics["cost"] if t["experiment"] in map(name_at_rate, fitted)]
    keys["imp"] = {"estimate": kinetics["estimate"], "costs": {"RMSE": cost}}
    keys["parameters"]["k"]["value"] = 0.2
    keys["validation"] = {"experiments": names}
    return as_study(keys, "tga_alone.json")


def setting_of(study: Study) -> SchemeSetting:
    measurements = make_scheme_twin(Scheme(order=True), 3, SchemeSettings()).setting.measurements
    records = tuple(records_of(study, measurements, SchemeSettings().points))
    return SchemeSetting(study, measurements, records, SchemeSettings())


def test_fewer_than_three_fitted_rates_are_joined_by_those_held_out() -> None:
    found = setting_of(of_tga_alone((1.0, 50.0)))
    assert rates_of(found.calibrated) == list(RATES)
    assert masses_of(found.study).predicted == ()


def test_rates_held_out_stay_so_where_three_are_fitted() -> None:
    study = of_tga_alone(RATES)
    assert [name for name, _ in masses_of(study).fitted] == [name_at_rate(rate) for rate in RATES]


def test_the_scheme_of_the_study_has_the_parameters_of_the_inverse_modelling() -> None:
    found = setting_of(of_tga_alone(RATES))
    assert own(found.study, found.records).names == ("T", "E")


def test_a_study_that_compares_no_mass_is_refused_with_the_key_of_the_cost() -> None:
    study = of_tga_alone(RATES)
    bare = study.imp.model_copy(update={"costs": {}})
    with pytest.raises(StudyError, match=r"imp\.costs compares no mass of a TGA"):
        setting_of(study.model_copy(update={"imp": bare}))


def test_the_study_with_a_scheme_is_valid_and_estimates_its_parameters() -> None:
    found = setting_of(of_tga_alone(RATES))
    posed = pose_scheme(found.study, Scheme(order=True), found.records, found.settings)
    rng = np.random.default_rng(1)
    start = {"scheme_T_1": 600.0, "scheme_E_1": 2e5, "scheme_n_1": 1.0}
    fitted = fit_posed(found, posed, found.calibrated, [start], rng, random=0)
    files = {(name_at_rate(r), MASS_FRACTION): {"file": f"{name_at_rate(r)}.csv"} for r in RATES}
    study = as_study(scheme_keys(found.study, fitted, files), "extended.json")
    assert study.kinetics is None
    assert set(study.imp.estimate) == {"scheme_T_1", "scheme_E_1", "scheme_n_1"}
    assert not {"T", "E"} & set(study.parameters)
    assert study.diagnosis.estimate == study.imp.estimate
