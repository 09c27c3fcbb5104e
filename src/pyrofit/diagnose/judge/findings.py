"""Parts of a verdict: effects, those they cannot be told from, and the reasons."""

from dataclasses import dataclass

from pyrofit.diagnose.base.fitted import FittedModel, Key
from pyrofit.diagnose.judge.claim_tests import Trust
from pyrofit.diagnose.judge.other_terms import OtherTerm
from pyrofit.diagnose.search.stepwise import Search
from pyrofit.effects import known_effects
from pyrofit.results.diagnosis_schema import Kind, OfSuspect

ORDER = ("apparatus", "environment", "material")
"""The families that an experimenter can check come first."""


@dataclass(frozen=True, eq=False)
class Judged:
    """A model with an effect in the leading one's place, and the reason against it."""

    effect: str
    trial: FittedModel
    trust: Trust
    rejected: str


@dataclass(frozen=True, eq=False)
class Exchange:
    """A model with two effects in the place of one of the final model's, or one in that of two."""

    replaced: tuple[str, ...]
    by: tuple[str, ...]
    trial: FittedModel


@dataclass(frozen=True, eq=False)
class Finding:
    """One effect of the model that the search ended with, and those it cannot be told from."""

    effect: str
    judged: tuple[Judged, ...]
    """The best of each effect, the leading one first."""
    others: tuple[OtherTerm, ...] = ()
    """Free corrections of other terms in the effect's place, where they were fitted."""
    instead: tuple[Exchange, ...] = ()
    """Exchanges of one effect for two, or of two for one, that nothing speaks against."""
    weight: float = 1.0
    """Share of the weight of all fitted models that has an effect of the leading one's group."""

    @property
    def kept(self) -> list[Judged]:
        """Those that nothing speaks against, the best first."""
        return [judged for judged in self.judged if not judged.rejected]

    @property
    def leading(self) -> str:
        """Name of the best one that nothing speaks against, or of the best one."""
        return (self.kept or list(self.judged))[0].effect

    @property
    def effects(self) -> list[str]:
        """Names of those that nothing speaks against, apparatus before environment and material."""
        catalogue = known_effects()
        return sorted(
            (judged.effect for judged in self.kept),
            key=lambda name: ORDER.index(catalogue[name].family),
        )

    @property
    def group(self) -> str:
        """Group of the missing effect, where all agree on it, else empty."""
        groups = {known_effects()[name].group for name in self.effects}
        return groups.pop() if len(groups) == 1 else ""

    @property
    def open_words(self) -> str:
        """The reason that leaves open which of the effects is missing."""
        titles = (known_effects()[name].title for name in self.effects)
        return f"these data do not separate: {', '.join(titles)}"

    @property
    def predicted(self) -> bool:
        """Whether predictions improve with each one that is kept, also of held-out signals."""
        return bool(self.kept) and all(judged.trust.confirmed for judged in self.kept)

    @property
    def explains(self) -> bool:
        """Whether the leading one fits held-out signals, too."""
        return bool(self.kept) and self.kept[0].trust.explains is True

    @property
    def sure(self) -> bool:
        """Whether nothing else explains the data nearly as well, and all signals are predicted."""
        return self.agreed and not self.open_terms and not self.instead and self.weighs_alone

    @property
    def weighs_alone(self) -> bool:
        """Whether the group weighs, and no known value may be wrong instead."""
        return self.weighs and not self.wrong_instead

    @property
    def wrong_instead(self) -> tuple[str, ...]:
        """Parameters whose known values, if wrong, would explain as much as the leading effect."""
        return (self.kept or list(self.judged))[0].trust.wrong_instead

    @property
    def weighs(self) -> bool:
        """Whether nearly all models that fit have an effect of the group."""
        return self.weight >= self.judged[0].trial.settings.claimed_weight

    @property
    def implausible(self) -> float:
        """Standard deviations by which the leading strength is not plausible, 0 where it is."""
        return (self.kept or list(self.judged))[0].trust.implausible

    @property
    def agreed(self) -> bool:
        """Whether all agree on the group, and it explains and predicts all signals not fitted."""
        return bool(self.group) and self.predicted and self.explains and not self.outvoted

    @property
    def open_terms(self) -> list[str]:
        """Other terms of the model, in words, that explain the data nearly as well."""
        return [other.words for other in self.others if other.fits_as_well]

    @property
    def outvoted(self) -> bool:
        """Whether one held-out experiment is against one of them, and the others are for it."""
        return any(judged.trust.outvoted for judged in self.kept)


@dataclass(frozen=True, eq=False)
class Verdict:
    """The claim, with the findings it rests on and the reasons, in words."""

    kind: Kind
    search: Search
    """The search, ended with the model that the verdict is about."""
    findings: tuple[Finding, ...]
    reasons: tuple[str, ...]
    suspects: tuple[OfSuspect, ...] = ()
    """Where the findings explain a part only: the leading candidates for the rest."""
    taken_away: tuple[tuple[str, str], ...] = ()
    """Effects of the search's end that are not claimed, each with the reason, in order."""

    @property
    def judged(self) -> dict[Key, list[Judged]]:
        """The judgements on each model, one for each effect in whose place it was judged."""
        found: dict[Key, list[Judged]] = {}
        for finding in self.findings:
            for one in finding.judged:
                found.setdefault(one.trial.key, []).append(one)
        return found

    @property
    def confirmed(self) -> bool:
        """Whether the effects predict signals that were not fitted, and nothing else does so."""
        sure = self.kind in ("named", "multiple") and all(f.sure for f in self.findings)
        return sure or self.kind == "partly"
