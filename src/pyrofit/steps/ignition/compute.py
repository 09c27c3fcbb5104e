"""Times to ignition of all slabs, and the lines through them."""

from dataclasses import asdict

from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.logs import Tell
from pyrofit.model.slab import SlabExperiment
from pyrofit.results import recorded
from pyrofit.results.files import Results
from pyrofit.steps.ignition import record
from pyrofit.steps.ignition.options import IgnitionOptions
from pyrofit.steps.ignition.series import EXPONENTS, Law, ignition_temperature, line_of
from pyrofit.steps.ignition.times import DEFINITIONS, times_of


def run(study: Study, results: Results, tell: Tell, processes: int) -> None:
    """Find the time to ignition of each slab; write ``ignition``.

    Raises
    ------
    DataError
        No slab has a radiant flux and a rate.
    """
    options = study.options(IgnitionOptions)
    series = recorded.measured(study, results).series
    tests, left_out = [], []
    for name, experiment in study.experiments.items():
        if not isinstance(experiment, SlabExperiment):
            continue
        rates = [
            (experiment.quantity(signal), frame)
            for (of, signal), frame in series.items()
            if of == name
        ]
        flux, times = experiment.front.flux_W_m2, times_of(experiment, rates, options)
        if not times or not isinstance(flux, float) or flux <= 0.0:
            left_out.append(name)
            continue
        tests.append(record.OfIgnition(experiment=name, flux_W_m2=flux, time_s=times))
    if not tests:
        raise DataError(
            f"study '{study.name}': no slab has a radiant flux as a number and a time of ignition. "
            "A mass loss rate or a heat release rate tells it too; add such a test"
        )
    found = [
        _line(tests, definition, law, options)
        for definition in DEFINITIONS
        for law in EXPONENTS
        if any(definition in test.time_s for test in tests)
    ]
    record.write(
        results,
        record.Ignition(study=study.name, tests=tests, series=found, left_out=left_out),
    )


def _line(
    tests: list[record.OfIgnition], definition: str, law: Law, options: IgnitionOptions
) -> record.OfLine:
    """Return the line through the times of a definition."""
    of = [(test.flux_W_m2, test.time_s[definition]) for test in tests if definition in test.time_s]
    ignited = [(flux, time) for flux, time in of if time is not None and time > 0.0]
    line = line_of(
        law,
        [flux for flux, _ in ignited],
        [time for _, time in ignited],
        [flux for flux, time in of if time is None],
    )
    critical = line.critical_W_m2
    kelvin = (
        None
        if critical is None
        else ignition_temperature(critical, options.emissivity, options.convection_W_m2K)
    )
    return record.OfLine(
        definition=definition, law=law, tests=len(ignited), ignition_K=kelvin, **asdict(line)
    )
