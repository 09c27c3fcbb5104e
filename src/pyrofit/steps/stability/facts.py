"""How often diagnoses of disturbed data find each effect, and with which strengths."""

from collections.abc import Sequence
from dataclasses import dataclass

from pyrofit.config import Study
from pyrofit.effects import known_effects
from pyrofit.results import diagnosis
from pyrofit.results.diagnosis_schema import Diagnosis
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import CLAIMS, leading
from pyrofit.steps.stability import record
from pyrofit.steps.stability.record import OfDraw


@dataclass(frozen=True)
class Stability:
    """The diagnosis of the measured data, and those of disturbed data."""

    measured: Diagnosis
    draws: Sequence[OfDraw]

    @property
    def claimed(self) -> list[str]:
        """Effects that the verdict on the measured data names, all of each set."""
        verdict = self.measured.verdict
        return _claimed(verdict.kind, verdict.sets)

    @property
    def effects(self) -> list[str]:
        """All effects that are found: those of the measured data first, then the most frequent."""
        found = {effect for draw in self.draws for effect in (*claimed_by(draw), *draw.final)}
        others = [effect for effect in found if effect not in self.claimed]
        order = sorted(others, key=lambda e: (-self.times_claimed(e), -self.times_final(e), e))
        return [*self.claimed, *order]

    def times_claimed(self, effect: str) -> int:
        """Return how many draws have a verdict that names an effect."""
        return sum(effect in claimed_by(draw) for draw in self.draws)

    def times_final(self, effect: str) -> int:
        """Return how many draws have a final model with an effect."""
        return sum(effect in draw.final for draw in self.draws)

    def strengths(self, effect: str) -> list[float]:
        """Return the strengths of an effect in the final models that have it."""
        return [draw.strengths[effect] for draw in self.draws if effect in draw.final]

    def measured_strength(self, effect: str) -> float | None:
        """Return the strength that the measured data give to an effect that leads its set."""
        chosen = leading(self.measured)
        if effect not in self.claimed or chosen is None or effect not in chosen.effects:
            return None
        (strength,) = known_effects()[effect].strength
        return chosen.parameters[f"{effect}_{strength}"].value


def claimed_by(draw: OfDraw) -> list[str]:
    """Return the effects that the verdict on a draw names; `unknown` and `none` name none."""
    return _claimed(draw.kind, draw.sets)


def _claimed(kind: str, sets: Sequence[Sequence[str]]) -> list[str]:
    return [effect for one in sets for effect in one] if kind in CLAIMS else []


def unit_of(effect: str) -> str:
    """Return the unit of an effect's strength."""
    (quantity,) = known_effects()[effect].strength.values()
    return quantity.unit


def read(study: Study, results: Results) -> Stability:
    """Return the diagnosis of the measured data, and those of all draws.

    Raises
    ------
    DataError
        A result is missing, broken, or that of another study.
    """
    return Stability(diagnosis.read(study, results), record.read(study, results))
