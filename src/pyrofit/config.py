"""The study description: the only reader of YAML, and all checks that need no measured data."""

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, Self

import yaml
from pydantic import Field, ValidationError, model_validator

from pyrofit.cost import KINDS, NORMALISATIONS
from pyrofit.errors import StudyError, suggest
from pyrofit.model.base import FRACTION, Part, Rule, numbers
from pyrofit.model.experiment import AnyExperiment, Gasification, Tga
from pyrofit.model.material import REST, Material, check_composition
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

    experiments: tuple[str, ...] = Field(min_length=1, description="gasification experiments")


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

    @property
    def own_files(self) -> tuple[str, ...]:
        """Measured files of the user that the study reads."""
        files = [s.file for e in self.experiments.values() for s in e.signals.values()]
        return tuple(dict.fromkeys(f for f in files if _is_own(f)))

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


def parameters_of_tga(material: Material) -> set[str]:
    """Return the names of the parameters that the kinetics and the composition use."""
    cold = {"heat_of_reaction_J_kg": 0.0}
    kinetics = [reaction.model_copy(update=cold) for reaction in material.reactions.values()]
    return parameters_in(*kinetics) | _names(material.composition)


def _names(composition: Mapping[str, float | str]) -> set[str]:
    return {f for f in composition.values() if isinstance(f, str) and f != REST}


def _is_own(file: str) -> bool:
    return file != "synthetic" and not file.startswith("macfp:")


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
                else:
                    _check_parameter(study, value, rule, place)


def _check_parameter(study: Study, name: str, rule: Rule, place: str) -> None:
    """Refuse an unknown parameter, or one whose value or limits break the rule of its place."""
    _require(
        name in study.parameters,
        place,
        f"unknown parameter '{name}'. {suggest(name, study.parameters)}",
    )
    p = study.parameters[name]
    for what in ("value", "lower", "upper"):
        given = getattr(p, what)
        _require(
            given is None or rule.holds(given * p.factor),
            f"parameters.{name}.{what}",
            f"{given} {rule.text} (it is used as {place})",
        )


def _check_compositions(study: Study) -> None:
    compositions = {"material.composition": study.material.composition}
    for name, experiment in study.kinds(Gasification).items():
        for i, layer in enumerate(experiment.sample.layers):
            if layer.composition is not None:
                place = f"experiments.{name}.sample.layers.{i}.composition"
                compositions[place] = layer.composition
    for label, chosen in (study.kinetics.sets if study.kinetics else {}).items():
        place = f"kinetics.sets.{label}"
        _require(label not in ("described", "fitted"), place, f"'{label}' is a reserved name")
        missing = set(study.material.reactions) ^ set(chosen.reactions)
        _require(not missing, place, f"reactions differ from the material's: {sorted(missing)}")
        compositions[f"{place}.composition"] = chosen.composition
    for place, composition in compositions.items():
        try:
            check_composition(composition, study.material.components)
        except ValueError as error:
            raise ValueError(f"{place}: {error}") from None
        for name in sorted(_names(composition)):
            _check_parameter(study, name, FRACTION, place)


def _check_stages(study: Study) -> None:
    stages: dict[str, tuple[tuple[str, ...], Iterable[TermSpec]]] = {
        "imp": (study.imp.estimate, [t for terms in study.imp.costs.values() for t in terms])
    }
    if study.kinetics is not None:
        stages["kinetics"] = (study.kinetics.estimate, study.kinetics.cost)
        _known(study, study.kinetics.compare, "kinetics.compare", Tga)
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
        wanted = Tga if stage == "kinetics" else Gasification
        for term in terms:
            _known(study, (term.experiment,), f"{stage} cost", wanted)
            signals = study.experiments[term.experiment].signals
            _require(
                term.signal in signals,
                f"{stage} cost",
                f"experiment '{term.experiment}' has no signal '{term.signal}'. "
                + suggest(term.signal, signals),
            )
    _known(study, study.validation.experiments, "validation.experiments", Gasification)
    choices = {"described", *(("fitted", *study.kinetics.sets) if study.kinetics else ())}
    _require(
        study.imp.kinetics in choices,
        "imp.kinetics",
        f"unknown kinetics '{study.imp.kinetics}'. {suggest(study.imp.kinetics, choices)}",
    )
    _check_values(study)
    for cost, shown in (study.published.costs if study.published else {}).items():
        for name in shown:
            _require(
                name == "fit" or name in study.parameters,
                f"published.costs.{cost}",
                f"unknown parameter '{name}'. {suggest(name, ('fit', *study.parameters))}",
            )


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
    if study.kinetics is None:
        return
    given = set(study.fixed_values()) | set(study.kinetics.estimate)
    for label in ("fitted", *study.kinetics.sets):
        for name in sorted(parameters_of_tga(study.material_with(label)) - given):
            raise ValueError(
                f"parameters.{name}: TGA needs it; add it to kinetics.estimate or give a value"
            )
    for name in sorted(set(study.kinetics.estimate) - parameters_of_tga(study.material)):
        raise ValueError(f"kinetics.estimate: '{name}' has no effect on TGA")


def _known(
    study: Study, names: Iterable[str], place: str, wanted: type[Tga] | type[Gasification]
) -> None:
    for name in names:
        _require(
            name in study.experiments,
            place,
            f"unknown experiment '{name}'. {suggest(name, study.experiments)}",
        )
        _require(
            isinstance(study.experiments[name], wanted),
            place,
            f"'{name}' is no {wanted.__name__.lower()} experiment",
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

    Files of the user are found relative to the folder of a YAML ``source``. JSON is what the
    workflow wrote of a study once checked: there they are found already.

    Raises
    ------
    StudyError
        With source, key, rule and way out for everything that is wrong.
    """
    try:
        meant = _as_meant(given)
        study = Study.model_validate(meant)
    except ValidationError as error:
        lines = _in_plain_words(error, meant)
    except ValueError as error:
        lines = [str(error)]
    else:
        path = Path(source)
        return study if path.suffix == ".json" else _located(study, path.parent)
    rules = "a rule" if len(lines) == 1 else f"{len(lines)} rules"
    text = "".join(f"\n  {line}" for line in lines)
    raise StudyError(f"{source}: the study description breaks {rules}:{text}")


def _as_meant(given: Any, place: str = "") -> Any:
    """Undo what YAML 1.1 makes of words and numbers: 1e-3 is text to it, ``no`` is not."""
    if isinstance(given, bool):
        raise ValueError(
            f"{place}: no key takes true or false (YAML reads yes, no, on, off as such); "
            "give a number, or put text in quotes"
        )
    if isinstance(given, str) and EXPONENT.fullmatch(given):
        return float(given)
    if isinstance(given, Mapping):
        return {k: _as_meant(v, f"{place}.{k}" if place else str(k)) for k, v in given.items()}
    if isinstance(given, list):
        return [_as_meant(v, f"{place}.{i}") for i, v in enumerate(given)]
    return given


def _in_plain_words(error: ValidationError, given: object) -> list[str]:
    """Return one line for each place where something is wrong."""
    found: dict[str, list[Any]] = {}
    for problem in error.errors():
        found.setdefault(_place(problem, given), []).append(problem)
    lines = []
    for place, problems in found.items():
        # What a place takes may have several forms, and each complains; errors inside it, and
        # the form with keys where keys were given, say more.
        if any(other.startswith(f"{place}.") for other in found):
            continue
        said = problems[-1 if isinstance(problems[0]["input"], dict) else 0]
        lines.append(f"{place}: {_rule(said)}".removeprefix(": "))
    return lines


def _place(problem: Any, given: Any) -> str:
    """Return the dotted path of a problem, without the names of forms that pydantic adds."""
    keys = []
    for part in problem["loc"]:
        inside = part in given if isinstance(given, dict) else isinstance(given, list)
        if inside and not (isinstance(given, list) and not isinstance(part, int)):
            keys.append(str(part))
            given = given[part] if isinstance(given, dict) or part < len(given) else None
    if problem["type"] == "missing" and keys[-1:] != [str(problem["loc"][-1])]:
        keys.append(str(problem["loc"][-1]))
    return ".".join(keys)


def _rule(problem: Any) -> str:
    """Return what is wrong as a rule."""
    words = WORDS.get(problem["type"])
    if words is None:
        return str(problem["msg"]).removeprefix("Value error, ")
    given = problem["input"]
    shown = f"'{given}'" if isinstance(given, str) else f"{given}"
    return words.format(given=shown, **problem.get("ctx", {}))


EXPONENT = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)[eE][-+]?\d+")
WORDS = {
    "missing": "this key is missing, and is required",
    "extra_forbidden": "this key is unknown",
    "float_type": "{given} is not a number",
    "float_parsing": "{given} is not a number",
    "finite_number": "{given} must be finite",
    "int_type": "{given} is not a whole number",
    "int_parsing": "{given} is not a whole number",
    "int_from_float": "{given} is not a whole number",
    "string_type": "{given} is not text; put text in quotes",
    "string_pattern_mismatch": "{given} is no name; letters, digits and _ make one, a letter first",
    "greater_than": "{given} must be above {gt:g}",
    "greater_than_equal": "{given} must be at least {ge:g}",
    "less_than_equal": "{given} must be at most {le:g}",
    "model_type": "{given} is not a mapping of keys",
    "model_attributes_type": "{given} is not a mapping of keys",
    "dict_type": "{given} is not a mapping of keys",
    "tuple_type": "{given} is not a list",
    "too_short": "a list of {actual_length} is too short; give at least {min_length}",
    "too_long": "a list of {actual_length} is too long; give at most {max_length}",
    "literal_error": "{given} must be {expected}",
    "union_tag_invalid": "unknown {discriminator} '{tag}'; known: {expected_tags}",
    "union_tag_not_found": "{discriminator} is missing, and is required",
}
"""What pydantic finds, as rules."""


def _located(study: Study, folder: Path) -> Study:
    """Return the study with the paths of the user's files as seen from the working folder."""
    experiments = {
        name: experiment.model_copy(
            update={
                "signals": {
                    quantity: signal.model_copy(update={"file": (folder / signal.file).as_posix()})
                    if _is_own(signal.file)
                    else signal
                    for quantity, signal in experiment.signals.items()
                }
            }
        )
        for name, experiment in study.experiments.items()
    }
    return study.model_copy(update={"experiments": experiments})


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
        what = (
            "this file is empty" if given is None else f"this is {_KIND.get(type(given), 'text')}"
        )
        raise StudyError(f"{path}: a study is a mapping of keys; {what}")
    return as_study(given, str(path))


_KIND = {list: "a list", int: "a number", float: "a number", bool: "true or false"}


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
