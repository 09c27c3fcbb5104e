"""Twins: synthetic measurements of a drawn truth, and the study that the diagnosis reads."""

import copy
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study, as_study, candidate_effects, read_mapping, read_study
from pyrofit.errors import StudyError, suggest
from pyrofit.estimate.targets import Measurements
from pyrofit.quantities import known_quantities
from pyrofit.results.files import write_csv, write_json, write_text
from pyrofit.stages.measurements import computed
from pyrofit.stages.reading import read_all
from pyrofit_blind_test import foreign
from pyrofit_blind_test.places import Places
from pyrofit_blind_test.plan import TwinPlan
from pyrofit_blind_test.setting import Setting

Given = dict[str, Any]
"""Keys of a study."""


@dataclass(frozen=True, eq=False)
class Twin:
    """A twin.

    Parameters
    ----------
    case
        Its hidden effects, signals, noise and seed.
    study
        Keys of the study that the diagnosis reads; they do not contain the truth.
    truth
        The study that computed it, with the values and effects of the truth.
    series
        Measurements by (experiment, signal).
    """

    case: TwinPlan
    study: Given
    truth: Study
    series: Mapping[tuple[str, str], pd.DataFrame]


def make_twin(setting: Setting, case: TwinPlan) -> Twin:
    """Compute the measurements of a case, bit for bit the same for the same case.

    Raises
    ------
    StudyError
        The truth breaks a rule, such as a limit.
    DataError
        The reference solver does not finish, or a curve of another code is missing.
    """
    study, truth = describe_twin(setting, case)
    if case.curves:
        return Twin(
            case, study, truth, foreign.series_of_case(Path(setting.curves), case.curves, truth)
        )
    return Twin(case, study, truth, computed(truth))


def describe_twin(setting: Setting, case: TwinPlan) -> tuple[Given, Study]:
    """Return the keys of the study that the diagnosis reads, and the study of the truth.

    Raises
    ------
    StudyError
        The truth breaks a rule, such as a limit.
    """
    base = _with_signals(setting, case)
    truth = _stored(setting, case) if case.curves else _draw(setting, base, case)
    known = {} if _has_tga(base) else _known(setting, base, truth, case)
    known |= _wrong(setting, truth, case)
    for name, prior in known.items():
        base["parameters"][name]["value"] = prior["value"]
    study = _without_truth(case, base, known)
    synthetic = {
        "truth": truth,
        "effects": case.hidden,
        "accuracy": setting.accuracy.model_dump(),
    }
    true = _as_it_is(setting, base, case)
    return study, as_study({**true, "seed": case.seed, "synthetic": synthetic}, setting.base)


def write_twin(places: Places, twin: Twin) -> None:
    """Write a twin: study and measurements to one folder, the truth to another."""
    folder, study = places.twin(twin.case.id), copy.deepcopy(twin.study)
    for (name, quantity), frame in twin.series.items():
        write_csv(folder / _file(name, quantity), frame)
    path = folder / "study.yaml"
    _leave_out(study, twin.case.without, path)
    # JSON is YAML as well; files named in a YAML file are found beside it.
    write_text(path, json.dumps(study, indent=1) + "\n")
    assert twin.truth.synthetic is not None
    write_json(
        places.truth(twin.case.id),
        {"case": twin.case.model_dump(mode="json"), "values": twin.truth.synthetic.truth},
    )


def read_twin(places: Places, case: str) -> tuple[Study, Measurements]:
    """Read the input of the diagnosis: study and measurements of a twin.

    Raises
    ------
    StudyError, DataError
        A file is missing or breaks a rule.
    """
    study = read_study(places.twin(case) / "study.yaml")
    return study, {key: frame for key, (frame, _) in read_all(study).items()}


def without_effects(study: Study, names: set[str]) -> Study:
    """Return a study with some effects removed from its candidates."""
    left = tuple(name for name in candidate_effects(study) if name not in names)
    diagnosis = study.diagnosis.model_copy(update={"effects": left})
    return study.model_copy(update={"diagnosis": diagnosis})


def _leave_out(study: Given, without: tuple[str, ...], path: Path) -> None:
    if without:
        left = without_effects(as_study(study, str(path)), set(without))
        study["diagnosis"]["effects"] = list(candidate_effects(left))


def _with_signals(setting: Setting, case: TwinPlan) -> Given:
    """Return the keys of the base with the experiments, signals and noise of a case."""
    base: Given = json.loads(json.dumps(read_mapping(Path(setting.base))))
    held_out = setting.held_out
    if held_out.like not in base["experiments"]:
        raise StudyError(f"{setting.base}: held_out.like: no experiment '{held_out.like}'")
    like = base["experiments"][held_out.like]
    everything = base["experiments"] | {held_out.name: _merged(like, held_out.changes)}
    base["experiments"] = {}
    for name, experiment in everything.items():
        signals = {
            quantity: {**signal, "noise": _noise(setting, case, quantity, signal["noise"])}
            for quantity, signal in experiment["signals"].items()
            if quantity in setting.signals[case.signals]
        }
        used = experiment["kind"] == "tga" or name in (*setting.calibrate, held_out.name)
        if signals and used:
            base["experiments"][name] = {**experiment, "signals": signals}
    return base | _stages(setting, base)


def _noise(setting: Setting, case: TwinPlan, quantity: str, given: Any) -> Given:
    size = given["sd"] if isinstance(given, dict) else given
    return {"sd": size, **setting.noise[case.noise].get(quantity, {})}


def _stages(setting: Setting, base: Given) -> Given:
    """Return the stages of a study of these experiments."""
    fitted, held_out = list(setting.calibrate), setting.held_out.name
    costs = [{"experiment": name, "signal": setting.cost_signal, "kind": "RMSE"} for name in fitted]
    imp = {
        "estimate": base["imp"]["estimate"],
        "kinetics": base["imp"]["kinetics"] if _has_tga(base) else "described",
        "costs": {"RMSE": costs},
        "identification": {name: list(base["experiments"][name]["signals"]) for name in fitted},
    }
    given = base["kinetics"]
    kinetics = {key: given[key] for key in ("estimate", "cost")} if _has_tga(base) else None
    unknown = given["estimate"] if given else list(setting.known)
    return {
        "kinetics": kinetics,
        "imp": imp,
        "validation": {"experiments": [*fitted, held_out]},
        "diagnosis": {
            "calibrate": {
                name: list(experiment["signals"])
                for name, experiment in base["experiments"].items()
                if name != held_out
            },
            "hold_out": {held_out: list(base["experiments"][held_out]["signals"])},
            "estimate": [*unknown, *base["imp"]["estimate"]],
        },
    }


def _has_tga(base: Given) -> bool:
    return any(experiment["kind"] == "tga" for experiment in base["experiments"].values())


def _merged(part: Any, changes: Mapping[str, Any]) -> Given:
    merged = dict(part)
    for key, value in changes.items():
        merged[key] = _merged(part[key], value) if isinstance(value, dict) else value
    return merged


def _draw(setting: Setting, base: Given, case: TwinPlan) -> dict[str, float]:
    """Draw the truth of a case uniformly around that of the base, in the parameters' units."""
    rng = np.random.default_rng([case.seed, 0])
    truth: dict[str, float] = base["synthetic"]["truth"]
    return {n: at + float(rng.uniform(-1, 1)) * setting.vary.get(n, 0.0) for n, at in truth.items()}


def _stored(setting: Setting, case: TwinPlan) -> dict[str, float]:
    """Return the truth of curves of another code, in the parameters' units."""
    values = foreign.read_manifest(Path(setting.curves)).truth(case.curves).values
    parameters = read_study(Path(setting.base)).parameters
    if unknown := [name for name in values if name not in parameters]:
        known = suggest(unknown[0], parameters)
        raise StudyError(f"{setting.curves}: unknown parameter '{unknown[0]}'. {known}")
    return {name: value / parameters[name].factor for name, value in values.items()}


def _known(setting: Setting, base: Given, truth: Mapping[str, float], case: TwinPlan) -> Given:
    """Draw known values of the kinetics around the truth, within the limits."""
    rng = np.random.default_rng([case.seed, 1])
    known = {}
    for name, sd in setting.known.items():
        drawn = truth[name] + sd * float(rng.standard_normal())
        parameter = base["parameters"][name]
        # Half a standard deviation inside the limits, so that the fit can start there.
        lower, upper = parameter["lower"] + 0.5 * sd, parameter["upper"] - 0.5 * sd
        known[name] = {"value": min(max(drawn, lower), upper), "sd": sd}
    return known


def _wrong(setting: Setting, truth: Mapping[str, float], case: TwinPlan) -> Given:
    """Return the known values that are wrong in a case."""
    if not case.error:
        return {}
    wrong = setting.errors[case.error].known
    return {
        name: {"value": truth[name] + one.off_sd * one.sd, "sd": one.sd}
        for name, one in wrong.items()
    }


def _as_it_is(setting: Setting, base: Given, case: TwinPlan) -> Given:
    """Return the keys of the truth, whose experiments differ where the description is wrong."""
    changes = setting.errors[case.error].truth if case.error else {}
    experiments = {
        name: _merged(experiment, changes.get(experiment["kind"], {}))
        for name, experiment in base["experiments"].items()
    }
    return {**base, "experiments": experiments}


def _without_truth(case: TwinPlan, base: Given, known: Given) -> Given:
    """Return the keys of the study of a twin, with files instead of the truth."""
    study = {key: value for key, value in base.items() if key not in ("synthetic", "seed")}
    study["name"] = case.id
    study["title"] = study["description"] = "Twin of a blind test."
    study["known"] = known
    study["experiments"] = {
        name: {
            **experiment,
            "signals": {q: _from_file(name, q, s) for q, s in experiment["signals"].items()},
        }
        for name, experiment in base["experiments"].items()
    }
    return study


def _from_file(experiment: str, quantity: str, signal: Given) -> Given:
    """Return a signal that is read from the file of a twin."""
    kept = {key: signal[key] for key in ("average_s",) if key in signal}
    return {"file": _file(experiment, quantity), **known_quantities()[quantity].tidy_keys(), **kept}


def _file(experiment: str, quantity: str) -> str:
    return f"{experiment}_{quantity}.csv"
