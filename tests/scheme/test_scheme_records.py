"""Which records a scheme is chosen from, and what is refused."""

from functools import cache

import numpy as np
import pytest

from pyrofit.config import Study
from pyrofit.errors import StudyError
from pyrofit.scheme.fit import Setting
from pyrofit.scheme.posed import template_of
from pyrofit.scheme.records import rates_of, records_of
from pyrofit.scheme.schemes import Scheme
from pyrofit.scheme.settings import Settings
from pyrofit.scheme.twins import FITTED_RATES, HELD_OUT_RATES, make_twin


@cache
def setting() -> Setting:
    return make_twin(Scheme(), 1, Settings()).setting


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
    with pytest.raises(StudyError, match="no kinetics stage; add `kinetics:`"):
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
