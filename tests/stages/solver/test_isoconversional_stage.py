"""The analysis in the workflow and in Python, on the computed masses of the smallest study."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from stage_studies import estimated_by_hand

import pyrofit as pf
from pyrofit.analysis.isoconversional.analyse import no_table
from pyrofit.analysis.isoconversional.records import masses
from pyrofit.errors import DataError, StudyError
from pyrofit.results import isoconversional
from pyrofit.results.files import Results, write_csv
from pyrofit.solver.outputs import MASS_FRACTION
from pyrofit.stages.isoconversional import analyse_masses
from pyrofit.stages.measurements import computed

SMOKE = Path(__file__).parents[3] / "config" / "smoke.yaml"
Data = dict[tuple[str, str], pd.DataFrame]


@pytest.fixture(scope="module")
def study() -> pf.Study:
    return pf.read_study(SMOKE)


@pytest.fixture(scope="module")
def data(study: pf.Study) -> Data:
    return computed(study, fast=True)


def prepared(study: pf.Study, data: Data, root: Path) -> Results:
    results = Results(root)
    for (name, signal), frame in data.items():
        write_csv(results.measurement(name, signal), frame)
    return results


def energy(study: pf.Study) -> float:
    (reaction,) = study.material.reactions.values()
    value = reaction.E_J_mol
    return study.true_values()[value] if isinstance(value, str) else value


def test_masses_of_one_reaction_have_its_energy_and_that_of_the_model(
    study: pf.Study, data: Data
) -> None:
    found = pf.isoconversional(study, study.synthetic.truth, data=data)
    core = found.table[(found.table["conversion"] > 0.15) & (found.table["conversion"] < 0.85)]
    exact = energy(study) / 1e3
    for method in ("friedman", "vyazovkin"):
        apart = np.abs(core[f"{method}_kJ_mol"] - exact)
        assert (apart < core[f"{method}_error_kJ_mol"]).mean() > 0.9, method
        assert core[f"model_{method}_kJ_mol"].to_numpy() == pytest.approx(exact, rel=0.01), method
    assert not any("varies" in text or "outside" in text for text in found.warnings)


def test_step_analyses_the_fitted_model_too(study: pf.Study, data: Data, tmp_path: Path) -> None:
    results = prepared(study, data, tmp_path)
    said: list[str] = []
    analyse_masses(study, results, said.append)
    assert "without the model's" in said[0]
    assert "model_vyazovkin_kJ_mol" not in isoconversional.energies(results)
    assert study.kinetics is not None
    wrong = {n: study.true_values()[n] for n in study.kinetics.estimate}
    wrong = {n: 0.5 * v if n.startswith("E") else v for n, v in wrong.items()}
    estimated_by_hand(results, wrong, "kinetics")
    analyse_masses(study, results, said.append)
    table = isoconversional.energies(results)
    half = 0.5 * energy(study) / 1e3
    # Later conversions depend on the last mass, which this slow model has not reached.
    early = table.loc[table["conversion"] < 0.5, "model_vyazovkin_kJ_mol"]
    assert early.to_numpy() == pytest.approx(half, rel=0.02)
    assert any(
        "E of the fitted model lies outside" in t for t in isoconversional.read_findings(results)
    )


def test_masses_that_do_not_fall_are_left_out_and_named(
    study: pf.Study, data: Data, tmp_path: Path
) -> None:
    name, signal = next(iter(masses(study).items()))
    still = {**data, (name, signal): data[name, signal].assign(**{MASS_FRACTION: 1.0})}
    results = prepared(study, still, tmp_path)
    analyse_masses(study, results, lambda text: None)
    first, second = isoconversional.read_findings(results)
    assert first.startswith(f"The mass of {name} falls by less than 0.02")
    assert second.startswith("Fewer than two heating programmes are left")
    assert isoconversional.energies(results)["vyazovkin_kJ_mol"].isna().all()
    with pytest.raises(DataError, match=f"{name}: the mass falls by less than 0.02"):
        pf.isoconversional(study, data=still)


def test_one_heating_rate_is_refused(study: pf.Study) -> None:
    name = next(iter(masses(study)))
    others = {n: e for n, e in study.experiments.items() if n == name or n not in masses(study)}
    alone = study.model_copy(update={"experiments": others})
    with pytest.raises(StudyError, match="no mass of 2 heating programmes"):
        pf.isoconversional(alone)


def test_tables_without_a_column_are_refused() -> None:
    table = pd.DataFrame({"time_s": [0.0, 1.0], "temperature_K": [300.0, 301.0]})
    with pytest.raises(DataError, match="'a' has no column mass_fraction"):
        pf.isoconversional({"a": table, "b": table})
    with pytest.raises(DataError, match=r"'a' has the shape \(4, 2\)"):
        pf.isoconversional({"a": np.ones((4, 2)), "b": np.ones((4, 2))})


def test_reactions_that_are_offered_are_kept_beside_the_findings(tmp_path: Path) -> None:
    results = Results(tmp_path)
    assert isoconversional.offers(results) == []
    isoconversional.write(results, no_table(), ["E varies."], None, ["Two reactions."])
    assert isoconversional.read_findings(results) == ["E varies."]
    assert isoconversional.offers(results) == ["Two reactions."]
