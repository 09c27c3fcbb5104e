"""Activation energies over conversion of a study's masses, beside those of its fitted model."""

from collections.abc import Iterator

from pyrofit.analysis.isoconversional.analyse import analyse, no_table
from pyrofit.analysis.isoconversional.curve import Curve
from pyrofit.analysis.isoconversional.findings import findings
from pyrofit.analysis.isoconversional.records import (
    FEWEST,
    LEAST_LOST,
    applies,
    measured_curves,
    simulated_curves,
)
from pyrofit.config import Study
from pyrofit.config.uses import parameters_of_heated
from pyrofit.errors import StudyError
from pyrofit.estimate.targets import Measurements
from pyrofit.logs import Tell
from pyrofit.results import goodness, identification, isoconversional, kinetics
from pyrofit.results.files import Results
from pyrofit.results.recorded import load
from pyrofit.scheme.choice import choose_scheme
from pyrofit.scheme.fit import SchemeSetting
from pyrofit.scheme.records import records_of
from pyrofit.scheme.settings import SchemeSettings

SETTINGS = SchemeSettings()


def more_reactions(
    study: Study,
    results: Results,
    measurements: Measurements,
    tell: Tell,
    settings: SchemeSettings = SETTINGS,
) -> Iterator[str]:
    """Choose a reaction scheme where a fit misses its masses; yield a sentence on its gain.

    Nothing where the fit describes them, where there is none, and where masses of fewer than two
    rates are fitted.
    """
    stage = "imp" if study.kinetics is None else "kinetics"
    if not results.identification(goodness.FILE, stage).exists():
        return
    if goodness.read(results, stage).describes:
        return
    try:
        records = tuple(records_of(study, measurements, settings.points))
    except StudyError:
        return
    found = choose_scheme(SchemeSetting(study, measurements, records, settings), tell)
    ours, theirs = found.own.left_out_rms, found.chosen.left_out_rms
    words = found.chosen.fitted.posed.words
    if found.gain <= settings.largest_margin:
        yield (
            "No scheme of up to four reactions is chosen that predicts heating rates left out of "
            f"its fit clearly better than that of the study. The rms is {theirs:.2g} of the "
            f"initial mass with {words}, and {ours:.2g} with the reactions of the study. Look at "
            "the records themselves: mass, temperature, baseline."
        )
        return
    yield (
        f"{words[0].upper()}{words[1:]} predict heating rates left out of the fit with an rms of "
        f"{theirs:.2g} of the initial mass, the reactions of the study with {ours:.2g}. Their log "
        f"score is {found.gain:.1f} above that of the study. `pyrofit scheme STUDY --write FILE` "
        "writes the study with them."
    )


def analyse_masses(study: Study, results: Results, tell: Tell) -> None:
    """Write ``isoconversional``: energies by three methods, and what they show.

    Where the fit misses the masses, a scheme of more reactions is chosen, and its gain told.

    The model is that of the fitted kinetics, or in a study without that stage the optimum of the
    inverse modelling. Without these results, the masses are analysed alone.

    Raises
    ------
    StudyError
        The study has no mass of two heating programmes.
    DataError
        A measurement is missing, or a result is broken.
    """
    if not applies(study):
        raise StudyError(
            f"study '{study.name}' has no mass of {FEWEST} heating programmes: activation "
            "energies come from the differences between programmes. Add TGA at other rates"
        )
    measurements = load(study, results)
    every = measured_curves(study, measurements)
    curves = [curve for curve in every if curve.lost > LEAST_LOST]
    still = [curve.name for curve in every if curve not in curves]
    said = [
        f"The mass of {name} falls by less than {LEAST_LOST:g} of the initial mass. It is left out."
        for name in still
    ]
    if len({curve.condition for curve in curves}) < FEWEST:
        said.append("Fewer than two heating programmes are left, which tell no activation energy.")
        isoconversional.write(results, no_table(), said, None)
        return
    found = analyse(curves, _model(study, results, measurements, still, tell))
    said += findings(found)
    offers = list(more_reactions(study, results, measurements, tell))
    isoconversional.write(results, found.table, said, found.temperature_sd_K, offers)
    for text in [*said, *offers]:
        tell(text)


def _model(
    study: Study, results: Results, measurements: Measurements, still: list[str], tell: Tell
) -> list[Curve]:
    values = _values(study, results)
    if values is None:
        tell("The fit has not been made yet: the masses are analysed without the model's")
        return []
    material = study.material_with(study.imp.kinetics if study.kinetics is None else "fitted")
    if not parameters_of_heated(material) <= set(values):
        return []
    curves = simulated_curves(study, material, values, measurements)
    return [curve for curve in curves if curve.name not in still]


def _values(study: Study, results: Results) -> dict[str, float] | None:
    """Return the values of the model, SI units; none where it has not been fitted."""
    if study.kinetics is not None:
        if not results.identification("estimate.csv", "kinetics").exists():
            return None
        return study.fixed_values() | kinetics.parameters(study, results)
    if not results.identification("estimate.csv").exists():
        return None
    found = identification.estimates(study, results)["estimate"]
    return study.fixed_values() | {str(n): float(v) for n, v in found.items()}
