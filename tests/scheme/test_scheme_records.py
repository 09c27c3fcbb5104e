"""Which records a scheme is chosen from, and what is refused."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scheme_truths import FITTED_RATES, HELD_OUT_RATES, make_scheme_twin

from pyrofit.config import Study
from pyrofit.errors import StudyError
from pyrofit.scheme.fit import SchemeSetting, problem_of
from pyrofit.scheme.posed import pose_scheme, template_of
from pyrofit.scheme.records import rates_of, records_of
from pyrofit.scheme.schemes import Scheme
from pyrofit.scheme.settings import SchemeSettings


@cache
def setting() -> SchemeSetting:
    return make_scheme_twin(Scheme(), 1, SchemeSettings()).setting


def changed(**update: object) -> Study:
    study = setting().study
    assert study.kinetics is not None
    return study.model_copy(update={"kinetics": study.kinetics.model_copy(update=update)})


def records(study: Study) -> object:
    return records_of(study, setting().measurements, 120)


def test_fitted_records_are_those_of_the_cost() -> None:
    assert rates_of(setting().calibrated) == list(FITTED_RATES)
    others = [r for r in setting().records if not r.calibrated]
    assert rates_of(others) == list(HELD_OUT_RATES)


def test_one_heating_rate_is_refused() -> None:
    cost = setting().study.kinetics.cost[:1]  # type: ignore[union-attr]
    with pytest.raises(StudyError, match=r"at 1 K/min only.*at least 2"):
        records(changed(cost=cost))


def test_a_study_without_kinetics_is_refused() -> None:
    study = setting().study.model_copy(update={"kinetics": None})
    with pytest.raises(StudyError, match=r"imp\.costs compares no mass of a TGA"):
        records(study)


def test_a_study_that_fits_no_mass_is_refused() -> None:
    with pytest.raises(StudyError, match=r"kinetics\.cost compares no mass of a TGA"):
        records(changed(cost=()))


def test_a_material_without_reaction_is_refused() -> None:
    study = setting().study
    inert = study.material.model_copy(update={"reactions": {}})
    with pytest.raises(StudyError, match="reacts; give the material a reaction"):
        template_of(study.model_copy(update={"material": inert}))


def test_temperature_at_a_share_is_where_that_share_is_still_to_come() -> None:
    for record in setting().records:
        halfway = record.temperature_at(0.5)
        assert np.interp(halfway, record.temperature_K, record.mass) == pytest.approx(0.5, abs=0.02)


def test_each_of_two_laboratories_has_an_offset_of_5_K_about_zero() -> None:
    given = setting()
    experiments = dict(given.study.experiments)
    for name in experiments:
        laboratory = "one" if name in ("tga_1", "tga_10") else "two"
        experiments[name] = experiments[name].model_copy(update={"laboratory": laboratory})
    study = given.study.model_copy(update={"experiments": experiments})
    found = records_of(study, given.measurements, 120)
    posed = pose_scheme(study, Scheme(), found, given.settings)
    assert posed.offsets == ("scheme_offset_1", "scheme_offset_2")
    assert posed.count == 2
    _, prior = problem_of(replace(given, study=study, records=tuple(found)), posed, found)
    assert prior.mean.tolist() == [0.0, 0.0]
    assert prior.sd.tolist() == [5.0, 5.0]


def test_one_laboratory_has_no_offset() -> None:
    given = setting()
    assert pose_scheme(given.study, Scheme(), given.records, given.settings).offsets == ()
