"""Schema of ``diagnosis.json``: written, read and documented from these records."""

from typing import Literal

from pydantic import Field

from pyrofit.results.diagnosis_candidates import OfCandidate
from pyrofit.results.record import Record

Kind = Literal["none", "named", "ambiguous", "multiple", "partly", "unknown"]


class OfSuspect(Record):
    """A candidate for the misfit that the verdict does not explain."""

    effect: str = Field(description="its name")
    gain: float = Field(description="fall of chi-square that the score test promises")


class OfOtherTerm(Record):
    """A free correction of another term of the model, in the place of an effect."""

    words: str = Field(description="the correction in words")
    above: float = Field(description="-2 ln of its marginal likelihood less that of the effect")


class OfEvidence(Record):
    """Tests of an effect besides its gain."""

    agreement: float | None = Field(
        description="probability that equal strengths differ as much between experiments; None = "
        "fewer than two show the effect"
    )
    predictions: dict[str, float] = Field(
        description="rise of the log score by the effect, by prediction"
    )
    expected: dict[str, float | None] = Field(
        description="rise that each prediction promises if the effect is real; below "
        "`informative_gain`, the prediction cannot tell. None = a run does not finish"
    )
    known: dict[str, list[float]] = Field(
        description="known parameters less their known values, in standard deviations, without the "
        "effect and with it"
    )
    implausible: float = Field(
        description="standard deviations by which the strength is not plausible, 0 where it is"
    )
    weight: float = Field(
        description="share of the weight of all fitted models that has an effect of the group"
    )


class OfTakenAway(Record):
    """An effect that the search ended with, and that is not claimed."""

    effect: str = Field(description="its name")
    reason: str = Field(description="the test that it fails, in words")


class OfVerdict(Record):
    """The verdict."""

    kind: Kind = Field(description="kind of verdict")
    effects: list[str] = Field(description="the leading effect of each set")
    groups: list[str] = Field(description="missing items, by effect")
    forms: list[str] = Field(description="in which form each is found, in words")
    sets: list[list[str]] = Field(description="per effect, those that cannot be told from it")
    evidence: list[OfEvidence] = Field(description="per effect, tests besides its gain")
    other_terms: list[list[OfOtherTerm]] = Field(
        description="per effect, free corrections in its place, where they were fitted"
    )
    confirmed: bool = Field(
        description="effects are named, and predictions improve with each, held-out ones included. "
        "No other term of the model, and no exchange of one effect and two, fits nearly as well"
    )
    words: str = Field(description="the verdict in sentences")
    reasons: list[str] = Field(description="reasons against a firmer verdict, or evidence for it")
    suspects: list[OfSuspect] = Field(
        description="leading candidates for the rest, where the verdict explains a part"
    )
    weights: dict[str, float] = Field(
        description="share of the weight of all fitted models, by group of effects"
    )
    taken_away: list[OfTakenAway] = Field(
        description="effects that the search ended with and that are not claimed, in this order"
    )


class OfNoise(Record):
    """The noise of a signal."""

    experiment: str = Field(description="experiment")
    signal: str = Field(description="signal")
    role: str = Field(description="`calibration` or `held out`")
    points: int = Field(description="number of points")
    unit: str = Field(description="SI unit of the signal")
    sd_median: float = Field(description="median standard deviation [`unit`]")
    words: str = Field(description="the noise in words")
    stated: bool = Field(description="an uncertainty is given")
    white: bool = Field(description="the whitened scatter may be white")
    chi2_base: float = Field(description="chi-square of the base")


class OfParameter(Record):
    """A parameter of a model with its 95 % interval."""

    value: float = Field(description="estimate")
    low: float = Field(description="lower end of the 95 % interval")
    high: float = Field(description="upper end of the 95 % interval")
    unit: str = Field(description="unit")
    at_limit: bool = Field(description="the estimate is at a limit")


class OfBase(Record):
    """The base model, and tests for lack of fit; critical values hold for 1 % of studies."""

    chi2: float = Field(description="chi-square")
    points: int = Field(description="number of points")
    chi2_critical: float = Field(description="critical chi-square")
    scan: float = Field(description="largest bias of an interval of a curve")
    scan_critical: float = Field(description="its critical value")
    score: float = Field(description="largest score of an effect")
    score_critical: float = Field(description="its critical value")
    adequate: bool = Field(description="scan and chi-square are below their critical values")
    parameters: dict[str, OfParameter] = Field(description="parameters by name")


class OfExtended(Record):
    """The model with the effects that the search ended with."""

    parameters: dict[str, OfParameter] = Field(
        description="parameters of the base beside the effects; empty without effects"
    )


class OfSolver(Record):
    """How accurate the solver's runs are."""

    coarsened: bool = Field(description="runs of the search are coarser than the study asks for")
    error_chi2: float = Field(description="change of chi-square by finer runs")


class OfWindow(Record):
    """An interval of a curve in which the residuals are biased."""

    model: str = Field(description="`base` or `extended`")
    experiment: str = Field(description="experiment")
    signal: str = Field(description="signal")
    start_s: float = Field(description="start [s]")
    end_s: float = Field(description="end [s]")
    start_K: float | None = Field(description="temperature at the start [K], TGA")
    end_K: float | None = Field(description="temperature at the end [K], TGA")
    conversion: list[float] | None = Field(description="conversion at both ends [-]")
    surface_temperature_K: list[float] | None = Field(description="at both ends [K]")
    phase: str = Field(description="phase of the test")
    sign: int = Field(description="1: the simulation is above the measurement, else -1")
    mean: float = Field(description="mean of simulated minus measured [`unit`]")
    relative: float | None = Field(description="the same over the measured mean [-]")
    unit: str = Field(description="SI unit of the signal")
    statistic: float = Field(description="test statistic")
    critical: float = Field(description="its critical value")


class OfScreen(Record):
    """Score test of an effect."""

    effect: str = Field(description="effect")
    group: str = Field(description="group of effects")
    family: str = Field(description="family of effects")
    detectability: float = Field(description="size at typical strength [sd]")
    typical: float = Field(description="typical strength [`unit`]")
    unit: str = Field(description="unit of the strength")
    z: float = Field(description="score of the residuals [sd]")
    ahead: float = Field(description="fall of chi-square predicted by a linear refit")


class OfConfusability(Record):
    """How alike effects are after a refit."""

    effects: list[str] = Field(description="effects")
    cosine: list[list[float]] = Field(description="matrix of cosines, in the order of `effects`")


class OfNotTried(Record):
    """An effect that is no candidate."""

    effect: str = Field(description="effect")
    reason: str = Field(description="why it is no candidate")


class OfGap(Record):
    """Misfit of a signal before and after the effects were added."""

    experiment: str = Field(description="experiment")
    signal: str = Field(description="signal")
    role: str = Field(description="`calibration` or `held out`")
    tells: bool | None = Field(
        description="a held-out test can tell whether an effect of the verdict is real; null if "
        "fitted, or without effects"
    )
    points: int = Field(description="number of points")
    unit: str = Field(description="SI unit of the signal")
    noise_sd: float = Field(description="median standard deviation of the noise [`unit`]")
    rms_before: float = Field(description="root mean square before [`unit`]")
    rms_after: float = Field(description="root mean square after [`unit`]")
    chi2_before: float = Field(description="chi-square before")
    chi2_after: float = Field(description="chi-square after")


class OfProfile(Record):
    """Profile of chi-square over a strength of the search's end."""

    effect: str = Field(description="effect")
    parameter: str = Field(description="strength")
    unit: str = Field(description="unit of the strength")
    value: list[float] = Field(description="values of the strength [`unit`]")
    rise: list[float] = Field(description="rise of chi-square, all else fitted anew")
    level: float = Field(description="rise at the ends of the 95 % interval")
    low: float = Field(description="lower end of the 95 % interval")
    high: float = Field(description="upper end of the 95 % interval")
    low_open: bool = Field(description="a limit cuts the interval off below")
    high_open: bool = Field(description="a limit cuts the interval off above")


class OfProbe(Record):
    """A free correction that was put into the model, for verdict `unknown`."""

    probe: str = Field(description="where it acts")
    what: str = Field(description="the same in words")
    unit: str = Field(description="unit; `-`: a factor, else a change")
    chi2: float = Field(description="chi-square with it")
    absorbed: float = Field(description="share of the excess of chi-square that it absorbs [-]")
    shape: list[list[float]] = Field(
        description="pairs of time [s] (`flux`) or temperature [K] and correction [`unit`]"
    )


class OfExperiment(Record):
    """A new experiment that would separate competing models."""

    design: str = Field(description="its name")
    words: str = Field(description="the same in words")
    separation_sd: float = Field(description="separation of the two models separated least [sd]")
    pairs: dict[str, float] = Field(description="separation of each two models [sd]")


class OfKinetics(Record):
    """A parameter that small samples tell without the slab."""

    parameter: str = Field(description="its name")
    alone: float = Field(description="fitted to the small samples alone [SI]")
    sd: float = Field(description="standard deviation of that [SI]")
    all: float = Field(description="fitted to all signals [SI]")
    difference: float = Field(description="(`all` - `alone`) / `sd`")


class Diagnosis(Record):
    """Result of a diagnosis."""

    schema_: int = Field(alias="schema", description="1")
    settings: dict[str, int | float | list[float]] = Field(
        description="numbers that steered the diagnosis, by name"
    )
    study: str = Field(description="name of the study")
    verdict: OfVerdict = Field(description="the verdict")
    noise: list[OfNoise] = Field(description="the noise, by signal")
    base: OfBase = Field(description="the base model")
    windows: list[OfWindow] = Field(description="intervals in which residuals are biased")
    screen: list[OfScreen] = Field(description="score tests, by effect")
    confusability: OfConfusability = Field(description="how alike effects are")
    needed: float = Field(description="gain of chi-square that a claim needs")
    ambiguity: float = Field(description="difference of penalised chi-square that decides nothing")
    not_tried: list[OfNotTried] = Field(description="effects that are no candidates")
    candidates: list[OfCandidate] = Field(description="models with effects, the best first")
    extended: OfExtended = Field(description="the model that the search ended with")
    gap: list[OfGap] = Field(description="misfit before and after, by signal")
    solver: OfSolver = Field(description="accuracy of the solver")
    kinetics_alone: list[OfKinetics] = Field(
        description="the final model fitted to small samples alone; empty without a slab beside"
    )
    profiles: list[OfProfile] = Field(description="profiles, by strength")
    probes: list[OfProbe] = Field(description="free corrections")
    next_experiment: list[OfExperiment] = Field(description="new experiments")
    extended_study: str = Field(
        description="file of the study with the effects, in the same folder; empty without effects"
    )
