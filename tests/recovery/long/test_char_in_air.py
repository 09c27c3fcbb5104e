"""The twin of char that burns in air: its truth is found, from small samples and a cone test."""

from pathlib import Path

import pyrofit as pf

STUDY = Path(__file__).parents[3] / "config" / "char_air.yaml"
SDS = 4.0


def test_kinetics_of_oxidation_and_conductivity_of_char_are_found() -> None:
    study = pf.read_study(STUDY)
    assert study.synthetic is not None
    fit = pf.fit(study, profiles=False)
    for name, truth in study.synthetic.truth.items():
        row = fit.table.loc[name]
        assert abs(row["value"] - truth) < SDS * row["sd"], name
