"""The study description: the only reader of YAML, and all checks that need no measured data."""

import hashlib
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, Self

import yaml
from pydantic import Field, ValidationError, model_validator

from pyrofit.cost import KINDS, NORMALISATIONS
from pyrofit.errors import StudyError, suggest
from pyrofit.model.base import Part, numbers
from pyrofit.model.experiment import AnyExperiment, Gasification, Tga
from pyrofit.model.material import Material, check_composition
from pyrofit.model.parameters import Parameter
from pyrofit.simulate import Accuracy

Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$")]


class TermSpec(Part):
    """One cost of one signal, a term of Eq. 5."""

    experiment: str = Field(description="name of the experiment")
    signal: str = Field(description="measured quantity: mlr, back_temperature or mass_fraction")
    kind: str = Field(description="cost: " + ", ".join(KINDS))
    weight: float = Field(1.0, ge=0.0, description="weight w of Eq. 5")
    normalisation: str | None = Field(
        None, description="y_N of Table 1: " + ", ".join(NORMALISATIONS) + "; default: the cost's"
    )
    points: int | None = Field(
        None, ge=2, description="points the target is interpolated to; none = measured points"
    )
    window_s: tuple[float, float] | None = Field(None, description="compared time window [s]")
    options: dict[str, float] = Field(default_factory=dict, description="options of the cost")

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.kind not in KINDS:
            raise ValueError(f"unknown cost '{self.kind}'. {suggest(self.kind, KINDS)}")
        if self.normalisation is not None and self.normalisation not in NORMALISATIONS:
            raise ValueError(
                f"unknown normalisation '{self.normalisation}'. "
                + suggest(self.normalisation, NORMALISATIONS)
            )
        if self.window_s is not None and self.window_s[0] >= self.window_s[1]:
            raise ValueError("window_s must be [start, end] with start below end")
        return self


Terms = Annotated[tuple[TermSpec, ...], Field(min_length=1)]


class Sceua(Part):
    """Budget of SPOTPY's SCE-UA."""

    complexes: int | None = Field(
        None, ge=1, description="number of complexes; none = number of parameters, as PROPTI"
    )
    generations: int = Field(
        20, ge=3, description="generations, the burn-in counted as the first, as PROPTI counts"
    )


class LeastSquares(Part):
    """Multistart bounded least squares beside it."""

    starts: int = Field(8, ge=1, description="random starts within the limits")


class KineticValues(Part):
    """Published kinetics of one reaction."""

    A_1_s: float = Field(gt=0.0, description="pre-exponential factor A [1/s]")
    E_J_mol: float = Field(ge=0.0, description="activation energy E [J/mol]")
    order: float = Field(1.0, ge=0.0, description="reaction order n [-]")


class KineticSet(Part):
    """Kinetics to compare with, or to use instead of fitted ones."""

    reactions: dict[str, KineticValues] = Field(description="by reaction of the material")
    composition: dict[str, float | str] = Field(description="mass fractions of the virgin material")


class Kinetics(Part):
    """Stage 1: fit of the kinetics to TGA."""

    estimate: tuple[str, ...] = Field(min_length=1, description="parameters to estimate")
    cost: Terms = Field(description="terms of the fitness, Eq. 5")
    sceua: Sceua = Field(default_factory=Sceua, description="budget of SCE-UA")
    least_squares: LeastSquares = Field(default_factory=LeastSquares, description="beside it")
    compare: tuple[str, ...] = Field((), description="further experiments to draw and score")
    sets: dict[str, KineticSet] = Field(
        default_factory=dict, description="published kinetics, drawn and scored beside the fit"
    )


class Imp(Part):
    """Stage 2: inverse modelling, repeated for every cost."""

    estimate: tuple[str, ...] = Field(min_length=1, description="parameters to estimate")
    kinetics: str = Field("described", description="'described', 'fitted', or one of kinetics.sets")
    costs: dict[Name, Terms] = Field(min_length=1, description="cost functions by name")
    repetitions: int = Field(25, ge=1, description="repetitions per cost")
    sceua: Sceua = Field(default_factory=Sceua, description="budget of SCE-UA")
    least_squares: LeastSquares = Field(default_factory=LeastSquares, description="beside it")


class Validation(Part):
    """Stage 3: prediction of experiments that were not fitted."""

    experiments: tuple[str, ...] = Field(description="held-out experiments")


class Synthetic(Part):
    """How synthetic measurements are made."""

    truth: dict[str, float] = Field(description="parameter values, in the units of `parameters`")
    accuracy: Accuracy = Field(
        default_factory=lambda: Accuracy(cells=200, tolerance=1e-4, longest_step_s=2.0),
        description="numerical settings, finer than those of the fit",
    )


class Published(Part):
    """Published results shown beside ours."""

    source: str = Field(description="reference")
    costs: dict[str, dict[str, tuple[float, float, float]]] = Field(
        default_factory=dict,
        description="by cost: best, mean and sigma of 'fit' and of each parameter, in its unit",
    )


class Study(Part):
    """Everything that defines a study."""

    name: Name = Field(description="name of the results folder")
    title: str = Field("", description="title of the report")
    description: str = Field("", description="what the study is, in a sentence or two")
    seed: int = Field(1, ge=0, description="seed of everything random")
    parameters: dict[Name, Parameter] = Field(description="named numbers")
    material: Material = Field(description="components, reactions, composition")
    experiments: dict[Name, AnyExperiment] = Field(min_length=1, description="experiments by name")
    accuracy: Accuracy = Field(default_factory=Accuracy, description="numerical settings")
    synthetic: Synthetic | None = Field(None, description="for signals with file: synthetic")
    kinetics: Kinetics | None = Field(None, description="stage 1, TGA")
    imp: Imp = Field(description="stage 2, inverse modelling")
    validation: Validation = Field(description="stage 3, prediction")
    published: Published | None = Field(None, description="published results")

    @model_validator(mode="after")
    def _check(self) -> Self:
        _check_numbers(self)
        _check_compositions(self)
        _check_stages(self)
        _check_synthetic(self)
        return self

    @property
    def is_synthetic(self) -> bool:
        """Whether any measurement is computed."""
        return any(
            signal.file == "synthetic"
            for experiment in self.experiments.values()
            for signal in experiment.signals.values()
        )

    @property
    def needs_macfp(self) -> tuple[str, ...]:
        """Files of the MaCFP data base that the study reads, relative to its root."""
        files = [s.file for e in self.experiments.values() for s in e.signals.values()]
        return tuple(f.removeprefix("macfp:") for f in files if f.startswith("macfp:"))

    def kinds(self, kind: type[Tga] | type[Gasification]) -> dict[str, Any]:
        """Return the experiments of one kind by name."""
        return {n: e for n, e in self.experiments.items() if isinstance(e, kind)}

    def fixed_values(self) -> dict[str, float]:
        """Return the given parameter values in SI units."""
        return {
            name: p.value * p.factor for name, p in self.parameters.items() if p.value is not None
        }

    def material_with(self, kinetics: str) -> Material:
        """Return the material with the kinetics 'described', 'fitted' or of a published set."""
        if kinetics in ("described", "fitted"):
            return self.material
        assert self.kinetics is not None
        chosen = self.kinetics.sets[kinetics]
        reactions = {
            name: reaction.model_copy(
                update={
                    "A_1_s": chosen.reactions[name].A_1_s,
                    "E_J_mol": chosen.reactions[name].E_J_mol,
                    "order": chosen.reactions[name].order,
                    "reference_temperature_K": None,
                    "reference_rate_1_s": None,
                }
            )
            for name, reaction in self.material.reactions.items()
        }
        return self.material.model_copy(
            update={"reactions": reactions, "composition": chosen.composition}
        )


def parameters_in(*parts: object) -> set[str]:
    """Return the names of the parameters that parts of a description use."""
    found = set()
    for part in parts:
        found |= {value for _, value, _ in numbers(part) if isinstance(value, str)}
        if isinstance(part, Material):
            found |= _names(part.composition)
        if isinstance(part, Gasification):
            for layer in part.sample.layers:
                found |= _names(layer.composition or {})
    return found


def _names(composition: Mapping[str, float | str]) -> set[str]:
    return {f for f in composition.values() if isinstance(f, str) and f != "rest"}


def _require(ok: bool, place: str, message: str) -> None:
    if not ok:
        raise ValueError(f"{place}: {message}")


def _check_numbers(study: Study) -> None:
    described = {
        "material": study.material,
        **{f"experiments.{n}": e for n, e in study.experiments.items()},
    }
    for root, part in described.items():
        for place, value, rules in numbers(part, root):
            for rule in rules:
                if isinstance(value, float):
                    _require(rule.holds(value), place, f"{value:g} {rule.text}")
                    continue
                _require(
                    value in study.parameters,
                    place,
                    f"unknown parameter '{value}'. {suggest(value, study.parameters)}",
                )
                p = study.parameters[value]
                for what in ("value", "lower", "upper"):
                    given = getattr(p, what)
                    _require(
                        given is None or rule.holds(given * p.factor),
                        f"parameters.{value}.{what}",
                        f"{given} {rule.text} (it is used as {place})",
                    )


def _check_compositions(study: Study) -> None:
    for experiment in study.kinds(Gasification).values():
        for layer in experiment.sample.layers:
            if layer.composition is not None:
                check_composition(layer.composition, study.material.components)
    for name in parameters_in(study.material, *study.experiments.values()):
        _require(
            name in study.parameters,
            "composition",
            f"unknown parameter '{name}'. {suggest(name, study.parameters)}",
        )
    if study.kinetics is None:
        return
    for label, chosen in study.kinetics.sets.items():
        place = f"kinetics.sets.{label}"
        _require(label not in ("described", "fitted"), place, f"'{label}' is a reserved name")
        missing = set(study.material.reactions) ^ set(chosen.reactions)
        _require(not missing, place, f"reactions differ from the material's: {sorted(missing)}")
        check_composition(chosen.composition, study.material.components)


def _check_stages(study: Study) -> None:
    stages: dict[str, tuple[tuple[str, ...], Iterable[TermSpec]]] = {
        "imp": (study.imp.estimate, [t for terms in study.imp.costs.values() for t in terms])
    }
    if study.kinetics is not None:
        stages["kinetics"] = (study.kinetics.estimate, study.kinetics.cost)
        _known(study, study.kinetics.compare, "kinetics.compare")
    for stage, (estimate, terms) in stages.items():
        _require(len(set(estimate)) == len(estimate), f"{stage}.estimate", "a name stands twice")
        for name in estimate:
            _require(
                name in study.parameters,
                f"{stage}.estimate",
                f"unknown parameter '{name}'. {suggest(name, study.parameters)}",
            )
            _require(
                study.parameters[name].lower is not None,
                f"parameters.{name}",
                f"{stage} estimates it: give lower and upper limits",
            )
        for term in terms:
            _known(study, (term.experiment,), f"{stage} cost")
            signals = study.experiments[term.experiment].signals
            _require(
                term.signal in signals,
                f"{stage} cost",
                f"experiment '{term.experiment}' has no signal '{term.signal}'. "
                + suggest(term.signal, signals),
            )
        used = {term.experiment for term in terms}
        wanted = Tga if stage == "kinetics" else Gasification
        for name in used:
            _require(
                isinstance(study.experiments[name], wanted),
                f"{stage} cost",
                f"'{name}' is no {wanted.__name__.lower()} experiment",
            )
    _known(study, study.validation.experiments, "validation.experiments")
    choices = {"described", *(("fitted", *study.kinetics.sets) if study.kinetics else ())}
    _require(
        study.imp.kinetics in choices,
        "imp.kinetics",
        f"unknown kinetics '{study.imp.kinetics}'. {suggest(study.imp.kinetics, choices)}",
    )
    _check_values(study)


def _check_values(study: Study) -> None:
    material = study.material_with(study.imp.kinetics)
    given = set(study.fixed_values()) | set(study.imp.estimate)
    if study.imp.kinetics == "fitted" and study.kinetics is not None:
        given |= set(study.kinetics.estimate)
    used = parameters_in(material, *study.kinds(Gasification).values())
    for name in sorted(used - given):
        raise ValueError(
            f"parameters.{name}: neither estimated in imp nor given a value; "
            "add it to imp.estimate or give a value"
        )
    for name in sorted(set(study.imp.estimate) - used):
        raise ValueError(f"imp.estimate: '{name}' has no effect on any gasification experiment")
    if study.kinetics is not None:
        for name in sorted(set(study.kinetics.estimate) - parameters_in(study.material)):
            raise ValueError(f"kinetics.estimate: '{name}' has no effect on TGA")


def _known(study: Study, names: Iterable[str], place: str) -> None:
    for name in names:
        _require(
            name in study.experiments,
            place,
            f"unknown experiment '{name}'. {suggest(name, study.experiments)}",
        )


def _check_synthetic(study: Study) -> None:
    if not study.is_synthetic:
        return
    if study.synthetic is None:
        raise ValueError("synthetic: a signal has file: synthetic; give synthetic.truth")
    known = set(study.synthetic.truth) | set(study.fixed_values())
    for name in sorted(parameters_in(study.material, *study.experiments.values()) - known):
        raise ValueError(f"synthetic.truth: the true value of '{name}' is missing")
    for name in study.synthetic.truth:
        _require(
            name in study.parameters,
            "synthetic.truth",
            f"unknown parameter '{name}'. {suggest(name, study.parameters)}",
        )


def as_study(given: Mapping[str, Any], source: str) -> Study:
    """Check a study description.

    Raises
    ------
    StudyError
        With source, key, rule and way out for everything that is wrong.
    """
    try:
        return Study.model_validate(given)
    except ValidationError as error:
        lines = [f"{source}: the study description breaks {error.error_count()} rule(s):"]
        for problem in error.errors():
            place = ".".join(str(p) for p in problem["loc"])
            text = problem["msg"].removeprefix("Value error, ")
            lines.append(f"  {place + ': ' if place else ''}{text}")
        raise StudyError("\n".join(lines)) from None


def read_study(path: Path) -> Study:
    """Read a study from a YAML or JSON file.

    Raises
    ------
    StudyError
        The file is missing, a directory, not YAML, or breaks a rule.
    """
    if path.is_dir():
        raise StudyError(f"{path}: this is a directory; give the study's YAML file")
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        near = [p.name for p in path.parent.glob("*.y*ml")] if path.parent.is_dir() else []
        hint = f" {suggest(path.name, near)}" if near else ""
        raise StudyError(f"{path}: there is no such study file.{hint}") from None
    except (OSError, UnicodeDecodeError) as error:
        raise StudyError(f"{path}: cannot be read ({error}); check the file") from None
    try:
        given = json.loads(text) if path.suffix == ".json" else yaml.safe_load(text)
    except (yaml.YAMLError, json.JSONDecodeError) as error:
        raise StudyError(f"{path}: not valid {path.suffix[1:]}: {error}") from None
    if not isinstance(given, dict):
        raise StudyError(f"{path}: a study is a mapping of keys, this is {type(given).__name__}")
    return as_study(given, str(path))


def digest(part: object) -> str:
    """Return the SHA-256 of a slice of a description, order of keys excepted."""
    text = json.dumps(part, sort_keys=True, default=_plain)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _plain(part: object) -> object:
    if isinstance(part, Part):
        return part.model_dump(mode="json")
    if isinstance(part, set):
        return sorted(part)
    raise TypeError(f"cannot digest {type(part).__name__}")
