"""The setting of the blind test: every key of its YAML file."""

from hashlib import sha256
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, ValidationError, model_validator

from pyrofit.config import digest, read_mapping
from pyrofit.config.words import in_plain_words
from pyrofit.effects import known_effects
from pyrofit.errors import StudyError, suggest
from pyrofit.model.accuracy import Resolution
from pyrofit.model.base import Part
from pyrofit.model.signal import Noise

Kind = Literal["effect", "null", "form", "pair", "error"]
Hidden = dict[str, dict[str, float]]
"""Values of the parameters of hidden effects in SI units, by effect and parameter."""
Draft = dict[str, Any]
"""Fields of a case, the number of its repetition instead of its seed."""
Count = Annotated[int, Field(ge=0)]
Size = Annotated[float, Field(gt=0.0)]


class HeldOut(Part):
    """The held-out experiment: predicted, not fitted."""

    name: str = Field(description="its name")
    like: str = Field(description="experiment of the base that it copies")
    changes: dict[str, Any] = Field(default_factory=dict, description="keys that differ")


class Form(Part):
    """A hidden effect of another form than any candidate."""

    hidden: Hidden = Field(description="effect and its form; without a strength, the nominal one")
    without: tuple[str, ...] = Field((), description="effects removed from the candidates")


class WrongValue(Part):
    """A known value of a study that is wrong."""

    sd: Size = Field(description="its stated standard deviation, in the parameter's unit")
    off_sd: float = Field(description="its error, in stated standard deviations")


class DescriptionError(Part):
    """An error of the study of a twin: its description is wrong, not the model."""

    known: dict[str, WrongValue] = Field(
        default_factory=dict, description="wrong known values, by parameter"
    )
    truth: dict[str, Any] = Field(
        default_factory=dict,
        description="keys in which experiments of the truth differ from those of the study, by "
        "kind of experiment",
    )
    same: tuple[str, ...] = Field(
        (), description="effects of the catalogue that describe this error; others are wrong names"
    )

    @model_validator(mode="after")
    def _check(self) -> Self:
        if not self.known and not self.truth:
            raise ValueError("changes nothing; give `known` or `truth`")
        return self


class Plan(Part):
    """A plan: how many twins of each kind."""

    seeds: str = Field(description="range of the seeds, by name")
    strengths: tuple[Size, ...] = Field(
        (1.0, 1.0 / 3.0), min_length=1, description="fractions of the nominal strength"
    )
    effects: Count = Field(description="twins per effect, strength and signals")
    nulls: Count = Field(description="twins without an effect per noise and signals")
    forms: Count = Field(description="twins per form and signals")
    pairs: Count = Field(description="twins per pair and signals")
    errors: Count = Field(0, description="twins per error of the description and signals")
    left_out: Count = Field(
        0,
        description="every n-th effect of full strength is diagnosed again, without the effect "
        "among the candidates. 0 = none; 1 = pairs without their second effect as well",
    )
    most: dict[Kind, Count] = Field(
        default_factory=dict, description="largest number of twins, by kind"
    )
    chunks: int = Field(ge=1, description="number of jobs over which the twins are distributed")


class Setting(Part):
    """The blind test."""

    base: str = Field(description="study of the model and its truth, relative to this file")
    curves: str = Field(
        "",
        description="folder of curves of another code, relative to this file; they then replace "
        "computed twins",
    )
    vary: dict[str, Size] = Field(
        default_factory=dict,
        description="half range of the truths around that of the base, in a parameter's unit",
    )
    known: dict[str, Size] = Field(
        description="standard deviations of the kinetics of twins without TGA, in their units"
    )
    calibrate: tuple[str, ...] = Field(min_length=1, description="fitted gasification experiments")
    held_out: HeldOut = Field(description="held-out experiment")
    signals: dict[str, tuple[str, ...]] = Field(
        min_length=1, description="measured quantities, by set of signals"
    )
    cost_signal: str = Field(description="signal of every set that the cost of a twin compares")
    noise: dict[str, dict[str, dict[str, Any]]] = Field(
        min_length=1, description="correlation of the noise by quantity, by kind of noise"
    )
    accuracy: Resolution = Field(
        default_factory=Resolution, description="numerical settings of the reference solver"
    )
    nominal: dict[str, float] = Field(
        default_factory=dict,
        description="nominal strength of effects, SI units; without one, the typical strength",
    )
    forms: tuple[Form, ...] = Field((), description="hidden effects of another form")
    pairs: tuple[tuple[str, str], ...] = Field((), description="pairs of hidden effects")
    pair_signals: tuple[str, ...] = Field((), description="sets of signals of twins with pairs")
    errors: dict[str, DescriptionError] = Field(
        default_factory=dict, description="errors of the description, by name"
    )
    error_signals: tuple[str, ...] = Field(
        (), description="sets of signals of twins with an error of the description"
    )
    seeds: dict[str, tuple[Count, Count]] = Field(description="first and last seed, by name")
    plans: dict[str, Plan] = Field(min_length=1, description="plans by name")

    @model_validator(mode="after")
    def _check(self) -> Self:
        effects = known_effects()
        for place, names in self._effects_named().items():
            for name in names:
                _require(name, effects, place, "effect")
        for place in ("pair_signals", "error_signals"):
            for name in getattr(self, place):
                _require(name, self.signals, place, "set of signals")
        for name, plan in self.plans.items():
            _require(plan.seeds, self.seeds, f"plans.{name}.seeds", "range of seeds")
        for name, quantities in self.signals.items():
            if self.cost_signal not in quantities:
                raise ValueError(
                    f"signals.{name}: lacks the cost_signal {self.cost_signal}; add it"
                )
        for by_quantity in self.noise.values():
            for correlation in by_quantity.values():
                Noise(sd=1.0, **correlation)
        _check_seeds(self.seeds)
        return self

    def _effects_named(self) -> dict[str, list[str]]:
        return {
            "nominal": list(self.nominal),
            "forms": [name for form in self.forms for name in (*form.hidden, *form.without)],
            "pairs": [name for pair in self.pairs for name in pair],
            "errors": [name for error in self.errors.values() for name in error.same],
        }

    def plan(self, name: str) -> Plan:
        """Return a plan by name.

        Raises
        ------
        StudyError
            There is none of that name.
        """
        if name not in self.plans:
            raise StudyError(f"unknown plan '{name}'. {suggest(name, self.plans)}")
        return self.plans[name]


def _require(name: str, known: Any, place: str, what: str) -> None:
    if name not in known:
        raise ValueError(f"{place}: unknown {what} '{name}'. {suggest(name, known)}")


def _check_seeds(seeds: dict[str, tuple[int, int]]) -> None:
    """Refuse ranges that overlap: seeds seen while developing must not be reported."""
    last, before = -1, ""
    for name, (start, end) in sorted(seeds.items(), key=lambda item: item[1]):
        if end < start:
            raise ValueError(f"seeds.{name}: [{start}, {end}] is empty; put the lower one first")
        if start <= last:
            raise ValueError(f"seeds: '{name}' overlaps '{before}'; keep them apart")
        last, before = end, name


def read_setting(path: Path) -> Setting:
    """Read the blind test's YAML file; its paths are returned as seen from the working folder.

    Raises
    ------
    StudyError
        The file is missing, not YAML, or breaks a rule.
    """
    given = read_mapping(path)
    try:
        setting = Setting.model_validate(given)
    except ValidationError as error:
        raise StudyError(f"{path}: " + "; ".join(in_plain_words(error, given))) from None
    places = {key: getattr(setting, key) for key in ("base", "curves")}
    found = {key: (path.parent / place).as_posix() for key, place in places.items() if place}
    return setting.model_copy(update=found)


def plan_digest(setting: Setting, name: str) -> str:
    """Return a digest of all that the twins of a plan depend on, the source excepted.

    Raises
    ------
    StudyError
        There is no such plan, or the base study is missing or no YAML.
    """
    twins = setting.model_dump(exclude={"plans"})
    return digest([twins, files_digest(setting), setting.plan(name).model_dump()])


def files_digest(setting: Setting) -> str:
    """Return a digest of the files that a setting refers to.

    Raises
    ------
    StudyError
        The base study is missing or no YAML.
    """
    curves = sorted(Path(setting.curves).glob("*.*")) if setting.curves else []
    hashes = {path.name: sha256(path.read_bytes()).hexdigest() for path in curves}
    return digest([read_mapping(Path(setting.base)), hashes])
