"""Inputs of each step of a study: the workflow reruns a step when its slice changes."""

from collections.abc import Iterable

from pyrofit.config import (
    Study,
    calibration_channels,
    candidate_effects,
    diagnosed_material,
    diagnosed_parameters,
    held_out_channels,
    kinetics_of,
    parameters_in,
)
from pyrofit.config.expand.programs import externals
from pyrofit.config.uses import names_in
from pyrofit.external.filled import file_digests
from pyrofit.model.external import ExternalExperiment
from pyrofit.plugins import code_digest
from pyrofit.quantities import known_quantities
from pyrofit.results.code_digests import all_terms, code, code_of

Slice = dict[str, object]
"""What a step depends on, as it is written as JSON to be compared."""


def _parameters(study: Study, names: set[str]) -> Slice:
    return {
        n: study.parameters[n].model_dump(exclude={"label", "fixed", "expression"})
        for n in sorted(names)
    }


def _values(study: Study) -> Slice:
    return {n: p.model_dump(include={"unit", "value"}) for n, p in study.parameters.items()}


def known_slice(study: Study, names: Iterable[str]) -> Slice:
    """Known values of some parameters; no key where there are none."""
    found = _known_values(study, names)
    return {"known": found} if found else {}


def _known_values(study: Study, names: Iterable[str]) -> Slice:
    return {n: study.known[n].model_dump(exclude={"source"}) for n in names if n in study.known}


def _experiment(study: Study, name: str) -> Slice:
    """As it is simulated and compared by costs, which know nothing of errors of clocks."""
    clocks = {"signals": {"__all__": {"timing_s"}}}
    described = study.experiments[name].model_dump(exclude={"title": True, "gas": True, **clocks})
    return described | _files(study, name)


def _measured(study: Study, name: str) -> Slice:
    """As it is simulated and compared with regard to its noise."""
    return study.experiments[name].model_dump(exclude={"title", "gas"}) | _files(study, name)


def measured_slice(study: Study) -> Slice:
    """Return all experiments, as they are simulated and compared with regard to their noise."""
    return {name: _measured(study, name) for name in study.experiments}


def _files(study: Study, name: str) -> Slice:
    """Checksums of template and other files of an external program; empty if there is none."""
    experiment = study.experiments[name]
    if not isinstance(experiment, ExternalExperiment):
        return {}
    return {"program_files": file_digests(experiment.program)}


def trial_slice(study: Study) -> Slice:
    """All inputs of the external programs, and the planned searches."""
    return {
        "experiments": {n: _experiment(study, n) for n in externals(study)},
        "parameters": _parameters(study, set(study.parameters)),
        "imp": study.imp.model_dump(),
        "seed": study.seed,
    }


def data_slice(study: Study) -> Slice:
    """Signals as they are read; with synthetic ones, all that makes them."""
    of_the_model = {"delay_s", "offset", "timing_s"}
    signals = {
        n: {k: s.model_dump(exclude=of_the_model) for k, s in e.signals.items()}
        for n, e in study.experiments.items()
    }
    if not study.is_synthetic:
        return {"signals": signals, "code": code_of(study)}
    return {
        "experiments": {n: _experiment(study, n) for n in study.experiments},
        "material": study.material.model_dump(),
        "parameters": _values(study),
        "synthetic": study.synthetic.model_dump() if study.synthetic else None,
        "code": code_of(study, more=study.synthetic.effects if study.synthetic else ()),
        "seed": study.seed,
    }


def kinetics(study: Study) -> Slice:
    """Everything of the TGA fit."""
    stage = kinetics_of(study)
    names = parameters_in(study.material, *study.of_stage("kinetics").values())
    composed = {n for chosen in stage.sets.values() for n in names_in(chosen.composition)}
    used = {term.experiment for term in stage.cost} | set(stage.compare)
    return {
        "terms": [t.model_dump() for t in stage.cost],
        "experiments": {n: _measured(study, n) for n in sorted(used)},
        "material": study.material.model_dump(),
        "parameters": _parameters(
            study, (names | composed) & (set(stage.estimate) | set(study.fixed_values()))
        ),
        "code": code_of(study, stage.cost),
        "stage": stage.model_dump(exclude={"cost"}),
        "accuracy": study.accuracy.tga_step_K,
        "seed": study.seed,
        **known_slice(study, stage.estimate),
    }


OF_SCHEMES = "volatile", "tga_lag"
"""Effects that reaction schemes may have."""


def isoconversional_slice(study: Study) -> Slice:
    """All masses of heated samples, the model that is fitted to them, and schemes beside it."""
    heated = {n: _measured(study, n) for n in study.of_stage("kinetics")}
    fit = identify_slice(study) if study.kinetics is None else kinetics(study)
    of_schemes = code_of(study, more=OF_SCHEMES)["effects"]
    return {"heated": heated, "fit": fit, "schemes": of_schemes}


def imp(study: Study, cost: str, optimiser: str) -> Slice:
    """Everything of one cost's searches; ``optimiser`` is its key: 'sceua', 'cmaes' ..."""
    stage = study.imp
    terms = stage.costs[cost]
    used = sorted({t.experiment for t in terms})
    experiments = [study.experiments[n] for n in used]
    names = parameters_in(study.material_with(stage.kinetics), *experiments)
    return {
        "terms": [t.model_dump() for t in terms],
        "experiments": {n: _experiment(study, n) for n in used},
        "material": study.material_with(stage.kinetics).model_dump(),
        "parameters": _parameters(study, names | set(stage.estimate)),
        "estimate": stage.estimate,
        "kinetics": stage.kinetics,
        "code": code_of(study, terms),
        "budget": getattr(stage, optimiser).model_dump(),
        "accuracy": study.accuracy.model_dump(),
        "seed": study.seed,
        **known_slice(study, stage.estimate),
    }


def identify_slice(study: Study) -> Slice:
    """Channels, parameters and material of the analysis of identifiability."""
    stage = study.imp
    used = sorted({c.experiment for c in stage.channels})
    material = study.material_with(stage.kinetics)
    names = parameters_in(material, *(study.experiments[n] for n in used))
    return {
        "channels": [c.model_dump() for c in stage.channels],
        "experiments": {n: _measured(study, n) for n in used},
        "material": material.model_dump(),
        "parameters": _parameters(study, names | set(stage.estimate)),
        "estimate": stage.estimate,
        "kinetics": stage.kinetics,
        "code": code_of(study),
        "costs": list(stage.costs),
        "accuracy": study.accuracy.model_dump(),
        **known_slice(study, stage.estimate),
    }


def diagnose_slice(study: Study) -> Slice:
    """Channels, parameters, prior knowledge, material and candidates of the diagnosis."""
    stage = study.diagnosis
    fitted, held_out = calibration_channels(study), held_out_channels(study)
    used = sorted({c.experiment for c in fitted + held_out})
    material = diagnosed_material(study)
    estimate = diagnosed_parameters(study)
    names = parameters_in(material, *(study.experiments[n] for n in used))
    return {
        "calibrate": [c.model_dump() for c in fitted],
        "hold_out": [c.model_dump() for c in held_out],
        "experiments": {n: _measured(study, n) for n in used},
        "material": material.model_dump(),
        "parameters": _parameters(study, names | set(estimate)),
        "estimate": estimate,
        "known": _known_values(study, estimate),
        "candidates": candidate_effects(study),
        "code": code_of(study, more=candidate_effects(study)),
        # New tests may record any quantity.
        "quantities": {n: code_digest("quantities", n) for n in known_quantities()},
        "most_effects": stage.most_effects,
        "accuracy": study.accuracy.model_dump(),
        "seed": study.seed,
    }


def validation_slice(study: Study) -> Slice:
    """Predicted experiments, and the material they are predicted with."""
    return {
        "experiments": {n: _experiment(study, n) for n in study.of_stage("imp")},
        "material": study.material_with(study.imp.kinetics).model_dump(),
        "estimate": study.imp.estimate,
        "parameters": _values(study),
        "validation": study.validation.model_dump(),
        "code": code_of(study, all_terms(study)),
        "published": study.published.costs if study.published else {},
        "accuracy": study.accuracy.model_dump(),
    }


def compare_slice(study: Study) -> Slice:
    """Costs, predicted experiments and material, by which all sets are judged."""
    return {
        "terms": {n: [t.model_dump() for t in terms] for n, terms in study.imp.costs.items()},
        "measured": {n: _experiment(study, n) for n in study.experiments},
        "limits": {n: study.parameters[n].bounds_si for n in study.imp.estimate},
        "seed": study.seed,
        **known_slice(study, study.imp.estimate),
        **validation_slice(study),
        **collect_slice(study),
    }


def presentation(study: Study) -> Slice:
    """Whatever tables, figures and the report show: the whole study."""
    return {**study.model_dump(), "code": code(study)}


def collect_slice(study: Study) -> Slice:
    """Which repetitions there are."""
    return {"costs": list(study.imp.costs), "repetitions": study.imp.repetitions}
