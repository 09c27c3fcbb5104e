"""Fits that are kept as JSON."""

import json
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import pyrofit as pf
from pyrofit.config import digest
from pyrofit.errors import DataError, StudyError

SMOKE = Path(__file__).parents[3] / "config" / "smoke.yaml"
KEY = ("tga_5K", "mass_fraction")


@pytest.fixture(scope="module")
def fit() -> pf.Fit:
    keys = {"parameters.E_h": {"unit": "kJ/mol", "expression": "0.5 * E_p"}}
    study = pf.read_study(SMOKE, **keys)
    curve = pf.simulate(study, {"T_p": 605.0, "E_p": 190.0}, experiments="tga_5K")[KEY]
    noise = np.random.default_rng(1).normal(0.0, 0.003, len(curve))
    data = {KEY: curve.assign(mass_fraction=curve["mass_fraction"] + noise)}
    return pf.fit(
        study, data, signals=[KEY], weights={"tga_5K": 2.0}, starts=2, fixed={"E_p": 190.0}
    )


@pytest.fixture(scope="module")
def cost(fit: pf.Fit) -> pf.Fit:
    data = dict(fit.comparison.measured)
    few = pf.read_study(fit.study, **{"imp.sceua": {"generations": 3, "complexes": 2}})
    return pf.fit(few, data, signals=[KEY], cost=np.subtract, optimiser="sceua")


@pytest.mark.parametrize("kind", ["fit", "cost"])
def test_fit_is_read_bit_for_bit(kind: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    fit: pf.Fit = request.getfixturevalue(kind)
    text = fit.to_json(tmp_path / "fit.json")
    for again in (pf.Fit.from_json(text), pf.Fit.from_json(tmp_path / "fit.json")):
        for field in fields(pf.Fit):
            old, new = getattr(fit, field.name), getattr(again, field.name)
            if isinstance(old, pd.DataFrame):
                pd.testing.assert_frame_equal(old, new, check_exact=True)
            elif isinstance(old, pf.Comparison):
                for key in old.measured:
                    pd.testing.assert_frame_equal(old.measured[key], new.measured[key])
                    assert old.measured[key].attrs == new.measured[key].attrs
                    pd.testing.assert_frame_equal(old.simulated[key], new.simulated[key])
            elif isinstance(old, pf.Study):
                assert digest(old.model_dump(mode="json")) == digest(new.model_dump(mode="json"))
            else:
                assert old == new or (np.isnan(old) and np.isnan(new)), field.name
        assert str(again) == str(fit)
        assert again.to_json() == text
    assert again.predict("tga_5K", dict(again.comparison.measured)).scores["rmse"][0] > 0.0


def test_fit_of_another_version_is_refused(fit: pf.Fit) -> None:
    content = json.loads(fit.to_json())
    with pytest.raises(DataError, match="has the version 2, and this pyrofit reads version 1"):
        pf.Fit.from_json(json.dumps({**content, "version": 2}))
    for lost in set(content) - {"format", "version"}:
        part = {key: value for key, value in content.items() if key != lost}
        with pytest.raises(DataError, match=f"missing or broken .KeyError: '{lost}'"):
            pf.Fit.from_json(json.dumps(part))


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda fit: fit.to_json(3), "path: the path of a file or folder is needed"),
        (lambda fit: fit.intervals("wide"), "level: a finite number is needed.* str: 'wide'"),
        (lambda fit: fit.intervals(1.5), "level: 1.5 is not between 0 and 1"),
        (lambda fit: fit.report(None), "correlations_above: a finite number is needed"),
        (lambda fit: fit.plot(ax=3), "ax: Axes of Matplotlib is needed"),
        (lambda fit: fit.predict(3), "signals: a list of names is needed"),
    ],
)
def test_wrong_argument_of_a_fit_is_explained(
    wrong: Callable[[pf.Fit], object], message: str, fit: pf.Fit
) -> None:
    with pytest.raises(StudyError, match=message):
        wrong(fit)


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("nowhere.json", r"nowhere\.json: cannot be read"),
        ("{}", "JSON of a fit: this is no fit"),
        ("{", "JSON of a fit: this is no fit"),
        (3, "from_json: this is a int; give the text"),
        (None, "from_json: this is a NoneType"),
    ],
)
def test_what_is_no_fit_is_refused(source: object, message: str) -> None:
    with pytest.raises(DataError, match=message):
        pf.Fit.from_json(source)
