"""The study of pine: fitted and held-out tests, and the agreement of its files with its keys."""

from pathlib import Path

import numpy as np
import pytest

from pyrofit.analysis.closure import described_mass
from pyrofit.config import Study, read_study
from pyrofit.data.fetch import registry
from pyrofit.model.base import value_of
from pyrofit.model.slab import SlabExperiment
from pyrofit.stages.reading import read_all

WATER = {"w_w": 0.08}
"""Share of water at FSRI, by which the densities of its discs were told."""


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(Path(__file__).parents[2] / "config" / "pine.yaml")


def laboratories(study: Study, names: set[str]) -> set[str]:
    return {study.experiments[name].laboratory for name in names}


def test_three_laboratories_are_fitted_in_each_kind_and_one_is_held_out(study: Study) -> None:
    assert study.kinetics is not None
    slabs = {term.experiment for term in study.imp.costs["RMSE"]}
    powders = {term.experiment for term in study.kinetics.cost}
    assert laboratories(study, slabs) == {"UMD", "FSRI", "TIFP+UCT"}
    assert laboratories(study, powders) == {"FSRI", "UMD", "Aalto"}
    held_out = set(study.validation.experiments) - slabs
    assert laboratories(study, held_out) - laboratories(study, slabs) == {"Aalto"}
    assert not powders & set(study.kinetics.compare)


def test_water_is_in_no_sample_that_was_dried(study: Study) -> None:
    wet = {
        experiment.laboratory
        for experiment in study.experiments.values()
        if isinstance(experiment, SlabExperiment)
        and any("water" in (layer.composition or {}) for layer in experiment.sample.layers)
    }
    assert wet == {"FSRI", "TIFP+UCT", "Aalto"}
    assert "water" not in study.material.composition


def test_no_file_is_one_of_the_validation_laboratory(study: Study) -> None:
    files = [s.file for e in study.experiments.values() for s in e.signals.values()]
    assert {f.removeprefix("macfp:") for f in files} <= registry().keys()
    assert not [f for f in files if "NIST" in f]


@pytest.mark.measured
def test_discs_and_boards_weigh_what_the_study_says(study: Study) -> None:
    # Described by thickness and density factor, to 2 %; Aalto's load cell by its offset.
    masses = {key: frame for key, (frame, _) in read_all(study).items() if key[1] == "mass"}
    assert len(masses) == 28
    values = {**study.fixed_values(), **WATER, "w_v": 0.02, "w_e": 0.15, "w_m": 0.35, "w_l": 0.1}
    for (name, signal), frame in masses.items():
        experiment = study.experiments[name]
        assert isinstance(experiment, SlabExperiment)
        described = described_mass(study, experiment, values)
        offset = value_of(experiment.signals[signal].offset, values)
        start = float(np.median(frame["mass_kg_m2"][:5])) - offset
        assert start == pytest.approx(described, rel=0.02), name


@pytest.mark.measured
def test_back_temperatures_start_at_the_described_temperature(study: Study) -> None:
    read = read_all(study)
    assert len(read) == 55
    for (name, signal), (frame, _) in read.items():
        experiment = study.experiments[name]
        if isinstance(experiment, SlabExperiment) and signal != "mass":
            start = float(frame.iloc[0][experiment.quantity(signal).column])
            assert start == pytest.approx(
                value_of(experiment.sample.initial_temperature_K, {}), abs=6.0
            )
