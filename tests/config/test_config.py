"""Study descriptions: what is accepted, and what is said about what is not."""

import json
import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from changed_study import CONFIG, GONE, changed

from pyrofit.cli import main
from pyrofit.config import Study, as_study, digest, read_study
from pyrofit.config.uses import parameters_of_heated
from pyrofit.errors import StudyError

BLIND_TESTS = ("blind_test", "foreign_truth", "gpyro_truth")
SHIPPED = [p for p in sorted(CONFIG.glob("*.yaml")) if p.stem not in BLIND_TESTS]
JARGON = re.compile(
    r"pydantic|Input should|Value error|Field required|Extra inputs|function-|union\[|\[type=|"
    r"dict instance|Tuple|valid string|validation error|Traceback"
)


def message(given: dict[str, Any]) -> str:
    with pytest.raises(StudyError) as caught:
        as_study(given, "mine.yaml")
    return str(caught.value)


# --- what is accepted -----------------------------------------------------------------------


@pytest.mark.parametrize("path", SHIPPED, ids=lambda p: p.stem)
def test_shipped_study_is_valid_and_named_like_its_file(path: Path) -> None:
    assert read_study(path).name == path.stem


@pytest.mark.parametrize("path", SHIPPED, ids=lambda p: p.stem)
def test_dumped_study_reads_back_as_the_same_study(path: Path, tmp_path: Path) -> None:
    study = read_study(path)
    kept = tmp_path / "study.json"
    kept.write_text(json.dumps(study.model_dump(mode="json")))
    assert read_study(kept) == study


@pytest.mark.parametrize("written", ["2e-3", "2.e-3", "0.2e-2", "2.0e-03", "+2E-3", ".2e-2"])
def test_number_with_an_exponent_is_a_number_however_written(written: str, tmp_path: Path) -> None:
    # YAML 1.1 reads some of these as text.
    path = tmp_path / "mine.yaml"
    text = (CONFIG / "smoke.yaml").read_text(encoding="utf-8")
    path.write_text(text.replace("thickness_m: 0.004", f"thickness_m: {written}"), encoding="utf-8")
    assert read_study(path).experiments["slab_25"].sample.layers[0].thickness_m == 0.002


def test_quoted_number_stays_text(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    text = (CONFIG / "smoke.yaml").read_text(encoding="utf-8")
    path.write_text(f"{text}\npublished: {{source: '1e3'}}\n", encoding="utf-8")
    study = read_study(path)
    assert study.published.source == "1e3"
    kept = tmp_path / "study.json"
    kept.write_text(study.model_dump_json())
    assert read_study(kept) == study


def test_own_files_are_found_relative_to_the_study_file() -> None:
    given = changed("experiments.tga_5K.signals.mass_fraction", {"file": "data/run.csv"})
    assert as_study(given, "config/mine.yaml").own_files == ("config/data/run.csv",)
    assert as_study(given, "mine.yaml").own_files == ("data/run.csv",)


def test_own_files_with_absolute_path_stay_where_they_are() -> None:
    given = changed("experiments.tga_5K.signals.mass_fraction", {"file": "/data/run.csv"})
    assert as_study(given, "config/mine.yaml").own_files == ("/data/run.csv",)


def test_own_files_of_a_checked_study_are_not_moved_again(tmp_path: Path) -> None:
    given = changed("experiments.tga_5K.signals.mass_fraction", {"file": "data/run.csv"})
    study = as_study(given, "config/mine.yaml")
    kept = tmp_path / "study.json"
    kept.write_text(json.dumps(study.model_dump(mode="json")))
    assert read_study(kept).own_files == ("config/data/run.csv",)


def test_published_and_synthetic_files_are_not_own_files() -> None:
    assert read_study(CONFIG / "smoke.yaml").own_files == ()
    paper = read_study(CONFIG / "paper.yaml")
    assert paper.own_files == ()
    assert "PMMA/Calibration_Data/UMD/UMD_CAPA_25kW_Mass.csv" in paper.needs_macfp


def test_truth_of_the_twin_is_neither_at_a_limit_nor_in_the_middle() -> None:
    study = read_study(CONFIG / "twin.yaml")
    assert study.synthetic is not None
    assert study.kinetics is not None
    assert set(study.synthetic.truth) == {*study.kinetics.estimate, *study.imp.estimate}
    for name, truth in study.synthetic.truth.items():
        lower, upper = study.parameters[name].lower, study.parameters[name].upper
        share = (truth - lower) / (upper - lower)
        assert 0.05 < share < 0.95, name
        assert abs(share - 0.5) > 0.05, name


def test_noise_is_a_number_or_a_description() -> None:
    white = as_study(changed(NOISE, 2e-4), "mine.yaml")
    described = as_study(changed(NOISE, {"sd": 2e-4}), "mine.yaml")
    assert white == described
    differenced = {"sd": 2e-4, "autocorrelation": [-0.5]}
    noise = as_study(changed(NOISE, differenced), "mine.yaml").experiments["slab_25"].signals["mlr"]
    assert noise.noise.correlation(4).tolist() == [1.0, -0.5, 0.0, 0.0]


def test_values_are_taken_to_si_units() -> None:
    given = changed("parameters.dh", {"unit": "kJ/kg", "value": 800})
    given = changed("imp.estimate", ["rho", "k", "cp", "eps"], given)
    assert as_study(given, "mine.yaml").fixed_values() == {"dh": 800e3}
    assert as_study(given, "mine.yaml").parameters["E_p"].bounds_si == (100e3, 300e3)


def test_published_kinetics_replace_rate_order_and_composition_only() -> None:
    study = read_study(CONFIG / "paper.yaml")
    material = study.material_with("Table 3")
    assert material.reactions["A"].A_1_s == 9.98e4
    assert material.reactions["B"].E_J_mol == 1.6e5
    assert material.reactions["A"].reference_temperature_K is None
    assert material.reactions["A"].heat_of_reaction_J_kg == "dh"
    assert material.composition == {"A": 0.025, "B": "rest"}
    assert material.components == study.material.components
    assert study.material_with("described") == study.material


def test_heat_of_reaction_is_no_parameter_of_tga() -> None:
    study = read_study(CONFIG / "paper.yaml")
    assert parameters_of_heated(study.material) == {"T_A", "E_A", "T_B", "E_B", "w_A"}
    assert parameters_of_heated(study.material_with("Table 3")) == set()


def test_digest_ignores_order_of_keys_and_sees_every_value() -> None:
    assert digest({"a": 1, "b": {2, 3}}) == digest({"b": {3, 2}, "a": 1})
    assert digest({"a": 1.0}) != digest({"a": 1.0000000000000002})
    study = read_study(CONFIG / "smoke.yaml")
    assert digest(study) == digest(Study.model_validate(study.model_dump()))


def test_digest_refuses_what_it_cannot_describe() -> None:
    with pytest.raises(TypeError, match="cannot digest object"):
        digest({"a": object()})


# --- what is refused ------------------------------------------------------------------------

NOISE = "experiments.slab_25.signals.mlr.noise"
BROKEN: list[tuple[str, str, object, list[str]]] = [
    # case, dotted path, value, words of the message
    ("unknown key at the top", "repetitions", 3, ["unknown key 'repetitions'", "Known:"]),
    ("misspelt key at the top", "tilte", "x", ["Did you mean 'title'?"]),
    ("misspelt key of a parameter", "parameters.rho.uper", 3, ["parameters.rho:", "'upper'?"]),
    (
        "misspelt key of a component",
        "material.components.polymer.density",
        3,
        ["material.components.polymer:", "unknown key 'density'", "'density_kg_m3'?"],
    ),
    (
        "misspelt key of a sample",
        "experiments.slab_25.sample.layer",
        [],
        ["experiments.slab_25.sample:", "Did you mean 'layers'?"],
    ),
    (
        "misspelt key of a signal",
        "experiments.slab_25.signals.mlr.avarage_s",
        5,
        ["experiments.slab_25.signals.mlr:", "Did you mean 'average_s'?"],
    ),
    ("misspelt key of a budget", "imp.sceua.ngs", 3, ["imp.sceua:", "Known: complexes, gen"]),
    (
        "misspelt key of a cost term",
        "imp.costs.RMSE.0.normalization",
        "mean",
        ["imp.costs.RMSE.0:", "Did you mean 'normalisation'?"],
    ),
    (
        "misspelt key of a property",
        "material.components.polymer.conductivity_W_mK",
        {"valu": 0.2, "slope_1_K": 0.001},
        ["material.components.polymer.conductivity_W_mK:", "Did you mean 'value'?"],
    ),
    (
        "misspelt key of a flux table",
        "experiments.slab_25.front.flux_W_m2",
        {"time_s": [0, 10], "valu": [0, 1e4]},
        ["experiments.slab_25.front.flux_W_m2: unknown key 'valu'", "'value'?"],
    ),
    (
        "text inside a flux table",
        "experiments.slab_25.front.flux_W_m2",
        {"time_s": [0, "ten"], "value": [0, 1e4]},
        ["experiments.slab_25.front.flux_W_m2.time_s.1: 'ten' is not a number"],
    ),
    ("unknown unit", "parameters.rho.unit", "g/cm3", ["parameters.rho:", "'g/cm3'", "kg/m3"]),
    ("swapped limits", "parameters.rho.lower", 1600, ["lower (1600) must be below upper (1500)"]),
    ("equal limits", "parameters.rho.lower", 1500, ["lower (1500) must be below upper (1500)"]),
    ("only the lower limit", "parameters.rho.upper", GONE, ["parameters.rho: give both limits"]),
    ("only the upper limit", "parameters.rho.lower", GONE, ["parameters.rho: give both limits"]),
    ("neither value nor limits", "parameters.rho", {"unit": "K"}, ["give a value, or limits"]),
    (
        "density 0",
        "material.components.residue.density_kg_m3",
        0,
        ["material.components.residue.density_kg_m3: 0 must be above 0"],
    ),
    (
        "negative density",
        "material.components.residue.density_kg_m3",
        -1000,
        ["material.components.residue.density_kg_m3: -1000 must be above 0"],
    ),
    (
        "density 0 through the lower limit",
        "parameters.rho.lower",
        0,
        ["parameters.rho.lower: 0.0 must be above 0", "material.components.polymer.density_kg_m3"],
    ),
    (
        "negative density through a value",
        "parameters.rho.value",
        -5,
        ["parameters.rho.value: -5.0 must be above 0 (it is used as"],
    ),
    (
        "thickness 0",
        "experiments.slab_25.sample.layers.0.thickness_m",
        0.0,
        ["experiments.slab_25.sample.layers.0.thickness_m: 0 must be above 0"],
    ),
    (
        "negative thickness of the foil",
        "experiments.slab_60.sample.foil.thickness_m",
        -1e-5,
        ["experiments.slab_60.sample.foil.thickness_m: -1e-05 must be above 0"],
    ),
    (
        "temperature below absolute zero",
        "experiments.slab_25.sample.initial_temperature_K",
        -20,
        ["experiments.slab_25.sample.initial_temperature_K: -20 must be above 0"],
    ),
    (
        "reference temperature 0 through the lower limit",
        "parameters.T_p.lower",
        0,
        ["parameters.T_p.lower: 0.0 must be above 0", "reference_temperature_K"],
    ),
    (
        "negative flux",
        "experiments.slab_25.front.flux_W_m2",
        -25000,
        ["experiments.slab_25.front.flux_W_m2: -25000 must not be negative"],
    ),
    (
        "emissivity above 1",
        "material.components.residue.emissivity",
        1.2,
        ["material.components.residue.emissivity: 1.2 must lie within 0 and 1"],
    ),
    (
        "emissivity above 1 through the upper limit",
        "parameters.eps.upper",
        1.5,
        ["parameters.eps.upper: 1.5 must lie within 0 and 1"],
    ),
    (
        "solid yield above 1",
        "material.reactions.pyrolysis.products.residue",
        1.01,
        ["material.reactions.pyrolysis: the solid yields add up to 1.01, above 1"],
    ),
    ("heating rate 0", "experiments.tga_5K.heating_rate_K_min", 0, ["0 must be above 0"]),
    ("fractions below one", "material.composition", {"polymer": 0.9}, ["add up to 0.9, not to 1"]),
    (
        "fractions above one beside rest",
        "material.composition",
        {"polymer": "rest", "residue": 1.5},
        ["'residue' is 1.5, not within 0 and 1"],
    ),
    (
        "two rests",
        "material.composition",
        {"polymer": "rest", "residue": "rest"},
        ["material: only one component may be 'rest'"],
    ),
    (
        "fraction by a parameter without rest",
        "material.composition",
        {"polymer": "eps"},
        ["one component must be 'rest'"],
    ),
    (
        "fraction by a parameter beyond 1",
        "material.composition",
        {"polymer": "cp", "residue": "rest"},
        ["parameters.cp.lower: 1.0 must lie within 0 and 1", "material.composition"],
    ),
    (
        "fraction by an unknown parameter",
        "material.composition",
        {"polymer": "ep", "residue": "rest"},
        ["material.composition: unknown parameter 'ep'. Did you mean 'eps'?"],
    ),
    (
        "fractions of a layer",
        "experiments.slab_25.sample.layers.0.composition",
        {"polymer": 0.5},
        ["experiments.slab_25.sample.layers.0.composition: the mass fractions add up to 0.5"],
    ),
    (
        "unknown component in the composition",
        "material.composition",
        {"polymr": 1.0},
        ["unknown component 'polymr'. Did you mean 'polymer'?"],
    ),
    (
        "unknown component in a reaction",
        "material.reactions.pyrolysis.products",
        {"residu": 0.01},
        ["reaction 'pyrolysis' uses the unknown component 'residu'", "'residue'?"],
    ),
    (
        "unknown parameter in the material",
        "material.components.polymer.density_kg_m3",
        "roh",
        ["material.components.polymer.density_kg_m3: unknown parameter 'roh'", "'rho'?"],
    ),
    (
        "unknown parameter to estimate",
        "imp.estimate",
        ["rho", "k", "cp", "epss", "dh"],
        ["imp.estimate: unknown parameter 'epss'. Did you mean 'eps'?"],
    ),
    ("parameter twice", "imp.estimate", ["rho", "rho"], ["imp.estimate: a name stands twice"]),
    (
        "unknown experiment in a cost",
        "imp.costs.RMSE.0.experiment",
        "slab25",
        ["imp.costs.RMSE.0.experiment: unknown experiment 'slab25'. Did you mean 'slab_25'?"],
    ),
    (
        "unknown experiment to predict",
        "validation.experiments",
        ["slab60"],
        ["validation.experiments: unknown experiment 'slab60'. Did you mean 'slab_60'?"],
    ),
    (
        "unknown experiment to compare",
        "kinetics.compare",
        ["tga_50K"],
        ["kinetics.compare: unknown experiment 'tga_50K'. Did you mean 'tga_5K'?"],
    ),
    (
        "unknown signal in a cost",
        "imp.costs.RMSE.0.signal",
        "mrl",
        ["imp.costs.RMSE.0.signal: experiment 'slab_25' has no signal 'mrl'. Did you mean 'mlr'?"],
    ),
    (
        "unknown signal of an experiment",
        "experiments.slab_25.signals",
        {"bak_temperature": {"file": "synthetic"}},
        ["experiments.slab_25: unknown signal 'bak_temperature'", "'back_temperature'?"],
    ),
    ("unknown cost", "imp.costs.RMSE.0.kind", "RMS", ["unknown cost 'RMS'", "'RMSE'?"]),
    (
        "unknown normalisation",
        "imp.costs.RMSE.0.normalisation",
        "men",
        ["imp.costs.RMSE.0: unknown normalisation 'men'. Did you mean 'mean'?"],
    ),
    ("unknown kinetics", "imp.kinetics", "fited", ["unknown kinetics 'fited'", "'fitted'?"]),
    ("fitted kinetics without a fit", "kinetics", None, ["unknown kinetics 'fitted'. Known: desc"]),
    (
        "estimated without limits",
        "parameters.dh",
        {"unit": "kJ/kg", "value": 800},
        ["parameters.dh: imp estimates it: give lower and upper limits"],
    ),
    (
        "neither estimated nor given",
        "imp.estimate",
        ["rho", "k", "cp", "eps"],
        ["parameters.dh: neither estimated in imp nor given a value", "imp.estimate"],
    ),
    (
        "TGA parameter neither estimated nor given",
        "kinetics.estimate",
        ["T_p"],
        ["parameters.E_p:", "neither estimated in imp nor given a value"],
    ),
    (
        "estimated without effect on TGA",
        "kinetics.estimate",
        ["T_p", "E_p", "rho"],
        ["kinetics.estimate: 'rho' has no effect on TGA"],
    ),
    (
        "heat of reaction estimated from TGA",
        "kinetics.estimate",
        ["T_p", "E_p", "dh"],
        ["kinetics.estimate: 'dh' has no effect on TGA"],
    ),
    (
        "cycle of reactions",
        "material.reactions.back",
        {"reactant": "residue", "products": {"polymer": 0.5}, "E_J_mol": 1e5, "A_1_s": 1e5},
        ["material: the reactions of polymer, residue form a cycle"],
    ),
    (
        "reaction that forms its reactant",
        "material.reactions.pyrolysis.products",
        {"polymer": 0.5},
        ["reaction 'pyrolysis' forms its own reactant 'polymer'"],
    ),
    (
        "both A and a reference",
        "material.reactions.pyrolysis.A_1_s",
        1e13,
        ["material.reactions.pyrolysis: give either A_1_s or the reference pair, not both"],
    ),
    (
        "half a reference",
        "material.reactions.pyrolysis.reference_rate_1_s",
        GONE,
        ["give A_1_s, or reference_temperature_K with reference_rate_1_s"],
    ),
    (
        "absorption of one component only",
        "material.components.polymer.absorption_1_m",
        2000,
        ["material: give absorption_1_m for every component or for none"],
    ),
    (
        "TGA in the inverse modelling",
        "imp.costs.RMSE.0",
        {"experiment": "tga_5K", "signal": "mass_fraction", "kind": "RMSE"},
        [
            "imp.costs.RMSE.0.experiment: 'tga_5K' is no cone calorimeter, "
            "gasification or external experiment"
        ],
    ),
    (
        "gasification in the kinetics",
        "kinetics.cost.0",
        {"experiment": "slab_25", "signal": "mlr", "kind": "RMSE"},
        ["kinetics.cost.0.experiment: 'slab_25' is no TGA, DSC or MCC experiment"],
    ),
    (
        "gasification to compare kinetics with",
        "kinetics.compare",
        ["slab_25"],
        ["kinetics.compare: 'slab_25' is no TGA, DSC or MCC experiment"],
    ),
    (
        "TGA to predict",
        "validation.experiments",
        ["slab_25", "tga_5K"],
        [
            "validation.experiments: 'tga_5K' is no cone calorimeter, "
            "gasification or external experiment"
        ],
    ),
    ("nothing to predict", "validation.experiments", [], ["validation.experiments:", "at least 1"]),
    ("no cost", "imp.costs.RMSE", [], ["imp.costs.RMSE:", "too short; give at least 1"]),
    (
        "swapped window",
        "imp.costs.RMSE.0.window_s",
        [100, 10],
        ["imp.costs.RMSE.0: window_s must be [start, end] with start below end"],
    ),
    (
        "negative weight",
        "imp.costs.RMSE.0.weight",
        -1,
        ["imp.costs.RMSE.0.weight: -1 must be at least 0"],
    ),
    ("2 generations", "imp.sceua.generations", 2, ["imp.sceua.generations: 2 must be at least 3"]),
    ("0 repetitions", "imp.repetitions", 0, ["imp.repetitions: 0 must be at least 1"]),
    ("2.5 repetitions", "imp.repetitions", 2.5, ["imp.repetitions: 2.5 is not a whole number"]),
    ("1 cell", "accuracy", {"cells": 1}, ["accuracy.cells: 1 must be at least 2"]),
    ("6000 cells", "accuracy", {"cells": 6000}, ["accuracy.cells: 6000 must be at most 5000"]),
    ("bad name of the study", "name", "my study", ["name: 'my study' is no name; letters"]),
    ("bad name of a cost", "imp.costs", {"a/b": []}, ["imp.costs.a/b: 'a/b' is no name"]),
    ("negative seed", "seed", -1, ["seed: -1 must be at least 0"]),
    (
        "reserved name of a set",
        "kinetics.sets",
        {"fitted": {"reactions": {"pyrolysis": {"A_1_s": 1, "E_J_mol": 1}}, "composition": {}}},
        ["kinetics.sets.fitted: 'fitted' is a reserved name"],
    ),
    (
        "set without a reaction",
        "kinetics.sets",
        {"Table 3": {"reactions": {}, "composition": {"polymer": 1.0}}},
        ["kinetics.sets.Table 3: reactions differ from the material's: ['pyrolysis']"],
    ),
    (
        "set with wrong fractions",
        "kinetics.sets",
        {
            "Table 3": {
                "reactions": {"pyrolysis": {"A_1_s": 1, "E_J_mol": 1}},
                "composition": {"polymer": 0.7},
            }
        },
        ["kinetics.sets.Table 3.composition: the mass fractions add up to 0.7"],
    ),
    ("missing truth", "synthetic.truth.dh", GONE, ["synthetic.truth: the true value of 'dh'"]),
    ("no truth at all", "synthetic", GONE, ["synthetic: a signal has file: synthetic; give"]),
    (
        "truth of an unknown parameter",
        "synthetic.truth.dhh",
        1,
        ["synthetic.truth: unknown parameter 'dhh'. Did you mean 'dh'?"],
    ),
    (
        "published value of an unknown parameter",
        "published",
        {"source": "x", "costs": {"RMSE": {"rhoa": [1, 2, 3]}}},
        ["published.costs.RMSE: unknown parameter 'rhoa'. Did you mean 'rho'?"],
    ),
    (
        "published values without a spread",
        "published",
        {"source": "x", "costs": {"RMSE": {"rho": [1, 2]}}},
        ["published.costs.RMSE.rho.2: this item of the list is missing"],
    ),
    ("missing key", "name", GONE, ["name: this key is missing, and is required"]),
    (
        "missing key of a component",
        "material.components.polymer.density_kg_m3",
        GONE,
        ["material.components.polymer.density_kg_m3: this key is missing"],
    ),
    ("missing kind", "experiments.slab_25.kind", GONE, ["experiments.slab_25: 'kind' is missing"]),
    (
        "unknown kind",
        "experiments.slab_25.kind",
        "cones",
        ["experiments.slab_25: unknown 'kind' 'cones'; known: 'cone', "],
    ),
    (
        "unknown temperature program",
        "experiments.tga_5K.program",
        "ideal",
        ["experiments.tga_5K.program: 'ideal' must be 'nominal', 'measured', 'from_temperature'"],
    ),
    ("text in a limit", "parameters.rho.lower", "low", ["parameters.rho.lower: 'low' is not a"]),
    (
        "number with its unit",
        "experiments.slab_25.front.flux_W_m2",
        "25 kW/m2",
        ["experiments.slab_25.front.flux_W_m2: '25 kW/m2' is neither a number nor the name"],
    ),
    (
        "nan in a limit",
        "parameters.rho.lower",
        float("nan"),
        ["parameters.rho.lower: nan must be finite"],
    ),
    (
        "nan in a property",
        "material.components.residue.density_kg_m3",
        float("nan"),
        ["material.components.residue.density_kg_m3: nan must be finite"],
    ),
    (
        "infinity in a composition",
        "material.composition.polymer",
        float("inf"),
        ["material.composition.polymer: inf must be finite"],
    ),
    ("boolean limit", "parameters.rho.lower", True, ["parameters.rho.lower: no key takes true"]),
    (
        "boolean component",
        "material.composition",
        {"polymer": True},
        ["material.composition.polymer: no key takes true or false"],
    ),
    ("list for a mapping", "imp", [1], ["imp: [1] is not a mapping of keys"]),
    ("text for a mapping", "parameters.rho", "1200", ["parameters.rho: '1200' is not a mapping"]),
    ("text for a list", "imp.estimate", "rho", ["imp.estimate: 'rho' is not a list"]),
    ("number for text", "title", 5, ["title: 5 is not text; put text in quotes"]),
    ("nothing for a mapping", "material", None, ["material:", "is not a mapping of keys"]),
    ("no layers", "experiments.slab_25.sample.layers", [], ["experiments.slab_25.sample.layers:"]),
    (
        "table of unequal length",
        "material.components.polymer.conductivity_W_mK",
        {"temperature_K": [300, 400], "value": [0.2]},
        ["conductivity_W_mK: temperature_K and value need the same length, at least 2"],
    ),
    (
        "table of falling temperature",
        "material.components.polymer.conductivity_W_mK",
        {"temperature_K": [400, 300], "value": [0.2, 0.3]},
        ["conductivity_W_mK: temperature_K must increase"],
    ),
    ("negative noise", NOISE, -1e-4, [f"{NOISE}: ", "must be at least 0"]),
    ("noise in words", NOISE, "little", [f"{NOISE}: 'little' is neither a number nor a mapping"]),
    (
        "autocorrelation that no noise has",
        NOISE,
        {"sd": 1e-4, "autocorrelation": [-0.12, -0.4]},
        # f(0) = 1 - 2 (0.12 + 0.4) = -0.04; times 1/1.04 = 0.9615 it is 0.
        [f"{NOISE}: autocorrelation [-0.12, -0.4] is not positive definite", "by 0.961 or less"],
    ),
    (
        "two kinds of noise",
        NOISE,
        {"sd": 1e-4, "autocorrelation": [0.2], "ar": 0.5},
        [f"{NOISE}: autocorrelation and ar describe two kinds of noise; give one"],
    ),
    ("noise that grows", NOISE, {"sd": 1, "ar": 1}, [f"{NOISE}: ar 1 must lie between -1 and 1"]),
    ("noise without size", NOISE, {"ar": 0.5}, [f"{NOISE}.sd: this key is missing"]),
    (
        "flux table that starts late",
        "experiments.slab_25.front.flux_W_m2",
        {"time_s": [5, 10], "value": [0, 1]},
        ["experiments.slab_25.front.flux_W_m2: time_s must start at 0"],
    ),
]


@pytest.mark.parametrize(
    ("path", "value", "words"), [c[1:] for c in BROKEN], ids=[c[0] for c in BROKEN]
)
def test_broken_study_is_refused_with_file_place_and_rule(
    path: str, value: object, words: list[str]
) -> None:
    said = message(changed(path, value))
    assert said.startswith("mine.yaml: the study description breaks a rule:\n  ")
    for word in words:
        assert word in said
    assert not JARGON.search(said)


def test_estimated_parameter_without_effect_is_refused() -> None:
    given = changed("parameters.spare", {"unit": "K", "lower": 1, "upper": 2})
    given = changed("imp.estimate", ["rho", "k", "cp", "eps", "dh", "spare"], given)
    assert "imp.estimate: 'spare' has no effect on any gasification" in message(given)


def test_kinetics_parameter_estimated_only_from_slabs_is_refused_for_tga() -> None:
    given = changed("kinetics.estimate", ["T_p"])
    given = changed("imp.estimate", ["rho", "k", "cp", "eps", "dh", "E_p"], given)
    assert "parameters.E_p: TGA needs it; add it to kinetics.estimate" in message(given)


def test_every_broken_rule_is_told_at_once() -> None:
    given = changed("name", GONE, changed("parameters.rho.lower", "low"))
    said = message(changed("imp.sceua.generations", 1, given))
    assert "breaks 3 rules" in said
    assert [line.split(":")[0].strip() for line in said.splitlines()[1:]] == [
        "name",
        "parameters.rho.lower",
        "imp.sceua.generations",
    ]


# --- files that hold no study ---------------------------------------------------------------


def _text(text: str | bytes) -> Callable[[Path], None]:
    def write(path: Path) -> None:
        path.write_bytes(text.encode() if isinstance(text, str) else text)

    return write


NO_STUDY: dict[str, tuple[Callable[[Path], None], str]] = {
    "empty": (_text(""), "a study is a mapping of keys; this file is empty"),
    "comment only": (_text("# nothing\n"), "a study is a mapping of keys; this file is empty"),
    "list": (_text("- a\n- b\n"), "a study is a mapping of keys; this is a list"),
    "text": (_text("hello"), "a study is a mapping of keys; this is text"),
    "number": (_text("3"), "a study is a mapping of keys; this is a number"),
    "broken YAML": (_text("name: [a\nb: {"), "not valid yaml"),
    "tab": (_text("imp:\n\trepetitions: 2\n"), "not valid yaml"),
    "python object": (_text("name: !!python/object:os.system {}\n"), "not valid yaml"),
    "unknown alias": (_text("name: *nothing\n"), "not valid yaml"),
    "binary": (_text(bytes(range(128, 256))), "cannot be read"),
    "control characters": (_text("name: \x00\n"), "not valid yaml"),
    "directory": (Path.mkdir, "this is a directory; give the study's YAML file"),
}


@pytest.mark.parametrize(("write", "words"), NO_STUDY.values(), ids=NO_STUDY)
def test_file_without_a_study_is_refused(
    write: Callable[[Path], None], words: str, tmp_path: Path
) -> None:
    path = tmp_path / "mine.yaml"
    write(path)
    with pytest.raises(StudyError) as caught:
        read_study(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert words in str(caught.value)
    assert not JARGON.search(str(caught.value))


def test_missing_file_names_the_nearest(tmp_path: Path) -> None:
    (tmp_path / "pmma.yaml").touch()
    with pytest.raises(StudyError, match=r"no such study file\. Did you mean 'pmma.yaml'"):
        read_study(tmp_path / "pnma.yaml")


def test_missing_file_in_a_missing_folder_is_told(tmp_path: Path) -> None:
    with pytest.raises(StudyError, match=r"no such study file\. Nor is any other beside"):
        read_study(tmp_path / "nowhere" / "pmma.yaml")


def test_unreadable_file_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(self: Path, **options: Any) -> str:
        raise PermissionError(13, os.strerror(13), str(self))

    monkeypatch.setattr(Path, "read_text", refuse)
    with pytest.raises(StudyError, match=r"mine.yaml: cannot be read \(.*Permission denied"):
        read_study(tmp_path / "mine.yaml")


def test_broken_json_is_told(tmp_path: Path) -> None:
    path = tmp_path / "study.json"
    path.write_text("{")
    with pytest.raises(StudyError, match="not valid json"):
        read_study(path)


@pytest.mark.parametrize("case", ["swapped limits", "nan in a property", "missing key"])
def test_command_line_refuses_a_broken_study_with_code_2(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _, place, value, words = next(c for c in BROKEN if c[0] == case)
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump(changed(place, value)))
    assert main(["check", str(path)]) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.startswith(f"error: {path}: ")
    assert words[0] in shown.err
    assert "Traceback" not in shown.err
