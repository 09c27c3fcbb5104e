"""A complete submission of a study: parameter set, README, proof of calibration, predictions."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from pyrofit import __version__
from pyrofit.config import Study
from pyrofit.errors import StudyError, suggest
from pyrofit.experiments import kind_of
from pyrofit_exchange.macfp.asked import Submission
from pyrofit_exchange.macfp.forms_of_submission import (
    VALIDATION_CASES,
    form_3,
    form_4,
    like_experiment,
)
from pyrofit_exchange.macfp.material import strict_of
from pyrofit_exchange.macfp.numeric import numeric_material
from pyrofit_exchange.macfp.predict import IdealSlab, SlabCurves, simulate_case
from pyrofit_exchange.macfp.proof import calibration_signals, write_proofs
from pyrofit_exchange.macfp.readme import readme
from pyrofit_exchange.sets import ParameterSet

_TRANSLUCENT = (
    "absorption in depth: once little is left, the back face absorbs the radiation "
    "that passes the remnant. The back temperature of the ideal slabs then rises "
    "above the equilibrium; it is valid until 95 % of the mass is lost"
)


def submit(study: Study, chosen: ParameterSet, asked: Submission, folder: Path) -> Iterator[str]:
    """Write all files of a submission into a folder; yield their list and the warnings.

    Raises
    ------
    DataError
        The data base has no words for a part of the material.
    StudyError
        There is no such experiment.
    """
    if asked.like and asked.like not in study.experiments:
        known = [n for n, e in study.experiments.items() if kind_of(e).stage == "imp"]
        raise StudyError(f"there is no experiment '{asked.like}'. {suggest(asked.like, known)}")
    of, notes = numeric_material(chosen.material, chosen.values)
    about = {
        "Material": asked.material,
        "Lab": asked.institute,
        "Calibration": calibration(study, chosen),
    }
    strict = strict_of(of, about)
    if any(part.absorption_1_m is not None for part in of.components.values()):
        notes.append(_TRANSLUCENT)
    folder.mkdir(parents=True, exist_ok=True)
    name = f"MaCFP_{asked.material}_{asked.institute}.json"
    (folder / name).write_text(strict.text(), encoding="utf-8")
    yield f"{name}: {len(strict.composition.names)} components, {len(strict.kinetics.A)} reactions"
    proofs = write_proofs(study, chosen, folder / "proof_of_calibration", asked.institute)
    yield f"proof_of_calibration: {len(proofs)} files"
    written: list[str] = []
    if 4 in asked.forms:
        written += form_4(of, folder / "MaCFP-4", asked.institute, asked.material)
    if 3 in asked.forms:
        simulate: Callable[[IdealSlab], SlabCurves] = partial(simulate_case, of)
        if asked.like:
            test = study.experiments[asked.like]
            simulate = like_experiment(chosen.material, test, chosen.values)
        written += form_3(simulate, folder / "MaCFP-3", asked.institute)
    yield f"predictions: {len(written)} files"
    warnings = list(_against_rules(study, asked))
    text = readme(study, chosen, strict, proofs, written, [*notes, *warnings], asked)
    (folder / "README.md").write_text(text, encoding="utf-8")
    yield "README.md: complete the places marked CHANGE"
    yield from warnings


def calibration(study: Study, chosen: ParameterSet) -> list[dict[str, Any]]:
    """Return how the parameters were found, an entry for each stage."""
    used = calibration_signals(study)
    entries = []
    for stage, scope in (
        ("kinetics", ["Kinetics"]),
        ("imp", ["Heat Capacity", "Heat of Pyrolysis", "Density", "Conductivity", "Emissivity"]),
    ):
        names = [n for n in used if kind_of(study.experiments[n]).stage == stage]
        if names:
            entries.append(
                {
                    "Model": f"pyrofit {__version__}",
                    "Method": f"set '{chosen.label}' of study '{study.name}'",
                    "Scope": scope,
                    "Data": _data(study, names),
                }
            )
    return entries


def _data(study: Study, names: Sequence[str]) -> dict[str, Any]:
    tests = [study.experiments[name] for name in names]
    data: dict[str, Any] = {
        "Type": sorted({kind_of(test).words for test in tests}),
        "Source": sorted({test.laboratory for test in tests if test.laboratory}),
        "Experiments": list(names),
    }
    rates = [r for t in tests if (r := getattr(t, "heating_rate_K_min", None)) is not None]
    fronts = [t.front for t in tests if hasattr(t, "front")]
    fluxes = [f.flux_W_m2 / 1e3 for f in fronts if isinstance(f.flux_W_m2, float)]
    if rates:
        data["Heating Rate"] = rates
    if fluxes:
        data["Heat Flux"] = fluxes
    return data


def _against_rules(study: Study, asked: Submission) -> Iterator[str]:
    """Yield the requirements of the guidelines that the study does not meet."""
    stages = [kind_of(study.experiments[name]).stage for name in calibration_signals(study)]
    if stages.count("imp") < (1 if "kinetics" in stages else 2):
        yield (
            "the guidelines ask for data of one milligram-scale and one gram-scale test, or of two "
            "gram-scale ones; this study calibrates fewer"
        )
    if 3 in asked.forms and not asked.like:
        fluxes = " and ".join(f"{c.flux_W_m2 / 1e3:g}" for c in VALIDATION_CASES)
        yield (
            f"MaCFP-3: the slabs at {fluxes} kW/m2 are ideal; give the apparatus with --like "
            "EXPERIMENT"
        )
