"""The tables of the diagnosis: titles, notes, headings."""

from pyrofit.config import Study
from pyrofit.tables import diagnosis
from pyrofit.tables.table import Table


def _always(study: Study) -> bool:
    return True


DIAGNOSIS_TABLES: dict[str, Table] = {
    "windows": Table(
        applies=_always,
        make=diagnosis.windows,
        title="Where model and measurement disagree",
        note="Stretches of a curve that are to one side by more than noise would put any, in 99 of "
        "100 studies. Temperature: of the surface, in TGA of the programme. Conversion: share of "
        "all that is released in the record. Difference: mean of simulated minus measured, also in "
        "per cent of the measured mean; the simulation lies above where it is positive.",
        headings={
            "time_s": "time [s]",
            "temperature_K": "temperature [K]",
            "conversion": "conversion [-]",
            "relative_percent": "difference [%]",
        },
        group_by="model",
    ),
    "strengths": Table(
        applies=_always,
        make=diagnosis.strengths,
        title="What is missing, and how much of it",
        note="95 % intervals; with form: including that the effect may look otherwise than its "
        "equation says. Without: the value at which the effect is absent, or the usual value of a "
        "parameter that says how it looks.",
        headings={
            "low": "95 % low",
            "high": "95 % high",
            "low_form": "low, with form",
            "high_form": "high, with form",
        },
    ),
    "candidates": Table(
        applies=_always,
        make=diagnosis.candidates,
        title="Candidates, the best first",
        note="Each is the base model with one effect more, or several, all parameters fitted "
        "anew. Gain: fall of chi-square below that of the model with one effect less. Above best: "
        "penalised chi-square, log(points) for each parameter of an effect. Predictions: gain of "
        "the log score where an experiment is left out or held out; above 0 is better than "
        "without the effect, 2 counts.",
        headings={
            "chi2": "chi-square",
            "above_best": "above best",
            "fitted": "fitted (95 % interval)",
        },
    ),
    "gap": Table(
        applies=_always,
        make=diagnosis.gap,
        title="How much the gap shrank",
        note="Root mean square of simulated minus measured, before and after the effects of the "
        "verdict were added, and the same in standard deviations of the noise, allowing for its "
        "correlation: 1 is noise alone. Held-out signals were not fitted.",
        headings={
            "rms_before": "rms before",
            "rms_after": "rms after",
            "noise_sd": "sd of the noise",
            "closed_percent": "closed [%]",
            "before_sd": "before [sd]",
            "after_sd": "after [sd]",
        },
        group_by="role",
    ),
    "parameters": Table(
        applies=_always,
        make=diagnosis.parameters,
        title="Parameters of the model",
        note="95 % intervals, each model taken as right. A parameter at a limit is a symptom: it "
        "may stand in for what is missing.",
        headings={
            "base_low": "95 % low",
            "base_high": "95 % high",
            "at_limit": "at a limit",
            "extended": "with effects",
            "extended_low": "95 % low ",
            "extended_high": "95 % high ",
        },
    ),
    "noise": Table(
        applies=_always,
        make=diagnosis.noise,
        title="Noise of the signals, and how the base fits them",
        note="Estimated from the scatter of the series; sd is the median standard deviation. "
        "Chi-square per point is near 1 where the base model is off by noise only.",
        headings={"sd_median": "sd", "chi2_per_point": "chi-square per point"},
        group_by="role",
    ),
    "probes": Table(
        applies=_always,
        make=diagnosis.probes,
        title="What would absorb the misfit",
        note="A free curve in one place of the model; absorbed: share of the chi-square above that "
        "of noise which it removes. It tells where the missing effect acts, not its name.",
        headings={"absorbed_percent": "absorbed [%]"},
    ),
    "next_experiments": Table(
        applies=_always,
        make=diagnosis.next_experiments,
        title="What to measure next",
        note="Separation of the two models that the experiment separates least, in standard "
        "deviations, allowing for the uncertainty of their parameters; above 3 they are told "
        "apart.",
        headings={"separation_sd": "separation [sd]"},
    ),
}
"""Tables of the diagnosis, in its own folder; none has rows where there is nothing to list."""
