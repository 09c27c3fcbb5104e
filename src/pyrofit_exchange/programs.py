"""A study written for Gpyro, for ThermaKin, and as reference curves of FDS's scaling pyrolysis."""

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from pyrofit.config import Study
from pyrofit.errors import StudyError
from pyrofit.model.base import value_of
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.slab import SlabExperiment
from pyrofit.model.time_table import OverTime, TimeTable
from pyrofit.results.files import Results, write_text
from pyrofit.results.recorded import load
from pyrofit.solver.outputs import RATE
from pyrofit_exchange.fds.exposure import surroundings
from pyrofit_exchange.fds.include import GAS, USUAL_HEAT_KJ_KG, gas_line
from pyrofit_exchange.fds.layers import own_layers
from pyrofit_exchange.fds.materials import Values
from pyrofit_exchange.fds.namelists import comment_line, write_all
from pyrofit_exchange.fds.predicted import PredictedByPyrofit, predict_slab
from pyrofit_exchange.fds.remarks import Remark
from pyrofit_exchange.gpyro.data import heated_data, slab_data
from pyrofit_exchange.sets import ParameterSet
from pyrofit_exchange.spyro import ReferenceTest, ignition, scaling_lines
from pyrofit_exchange.thermakin.components import component_file
from pyrofit_exchange.thermakin.conditions import heated_conditions, slab_conditions

Said = dict[Remark, list[str]]
COPPER = (8940.0, 380.0)


def slabs_of_study(study: Study) -> dict[str, SlabExperiment]:
    """Return the slabs of a study by name."""
    return {n: e for n, e in study.experiments.items() if isinstance(e, SlabExperiment)}


def _heated(study: Study) -> dict[str, HeatedExperiment]:
    """Return the heated samples, each rate once."""
    rates = {
        e.heating_rate_K_min: (n, e)
        for n, e in reversed(study.experiments.items())
        if isinstance(e, HeatedExperiment) and not e.is_isothermal
    }
    return dict(reversed(rates.values()))


def _lines(said: Said) -> list[str]:
    return [f"{remark.line} [{', '.join(of)}]" for remark, of in said.items()]


def _add(said: Said, remarks: Iterable[Remark], name: str) -> None:
    for remark in remarks:
        said.setdefault(remark, []).append(name)


def export_gpyro(study: Study, chosen: ParameterSet, folder: Path) -> list[str]:
    """Write ``.data`` files; return the inexact terms, one line each."""
    said: Said = {}
    for name, slab in slabs_of_study(study).items():
        predicted = predict_slab(slab, chosen.material, chosen.values, study.accuracy)
        data = slab_data(name, slab, chosen.material, chosen.values, predicted)
        write_text(folder / f"{name}.data", write_all(data.namelists))
        _add(said, data.remarks, name)
    if heated := _heated(study):
        data = heated_data("tga", list(heated.values()), chosen.material, chosen.values)
        write_text(folder / "tga.data", write_all(data.namelists))
        _add(said, data.remarks, "tga")
    _write_readme(folder, study, chosen, "Gpyro", _lines(said))
    return _lines(said)


def export_thermakin(study: Study, chosen: ParameterSet, folder: Path) -> list[str]:
    """Write a ``.cmp`` file and ``.cnd`` files; return the inexact terms, one line each."""
    said: Said = {}
    material, values = chosen.material, chosen.values
    slabs = slabs_of_study(study)
    predicted = {n: predict_slab(e, material, values, study.accuracy) for n, e in slabs.items()}
    length, gas_heat, foil, back = 0.0, 0.0, COPPER, 0.0
    for name, slab in list(slabs.items())[:1]:
        sample = slab.sample
        length = value_of(sample.absorption_length_m, values)
        gas_heat = value_of(sample.gas_specific_heat_J_kgK, values)
        back = surroundings(slab, values, predicted[name], 0.9, False).emissivity_back
        if sample.foil is not None:
            density, heat = sample.foil.density_kg_m3, sample.foil.specific_heat_J_kgK
            foil = (value_of(density, values), value_of(heat, values))
    components = component_file(material, values, length, gas_heat, foil, back)
    write_text(folder / "material.cmp", components.text)
    _add(said, components.remarks, "material")
    for name, slab in slabs.items():
        text, remarks = slab_conditions(slab, material, values, components, predicted[name])
        write_text(folder / f"{name}.cnd", text)
        _add(said, remarks, name)
    for name, heated in _heated(study).items():
        write_text(folder / f"{name}.cnd", heated_conditions(heated, material, values, components))
    _write_readme(folder, study, chosen, "ThermaKin2Ds", _lines(said))
    return _lines(said)


def _write_readme(
    folder: Path, study: Study, chosen: ParameterSet, program: str, said: list[str]
) -> None:
    """Write a description of the files, whose formats have no comments."""
    first = [f"Study '{study.name}', set '{chosen.label}', for {program}."]
    shown = ["", "Differences to pyrofit:", *said] if said else []
    write_text(folder / "README.txt", "\n".join([*first, *shown]) + "\n")


def export_spyro(
    study: Study, chosen: ParameterSet, results: Results, folder: Path, measured: bool
) -> list[str]:
    """Write reference curves, measured or simulated, as a surface of scaling pyrolysis.

    Raises
    ------
    StudyError
        The study has no slab.
    """
    slabs = slabs_of_study(study)
    if not slabs:
        raise StudyError(f"study '{study.name}' has no slab; scaling pyrolysis needs one")
    simulated = {
        n: predict_slab(e, chosen.material, chosen.values, study.accuracy) for n, e in slabs.items()
    }
    make = _measured(study, results) if measured else None
    curves = []
    for name, slab in slabs.items():
        time, rate = simulated[name].time_s, simulated[name].rate
        if make is not None:
            found = make(name)
            if found is None:
                continue
            time, rate = found
        size = own_layers(slab.sample, chosen.material, chosen.values)[0].thickness_m
        flux = strongest(slab.front.flux_W_m2, chosen.values)
        curves.append(ReferenceTest(name, flux, size, time, rate))
    if not curves:
        raise StudyError(
            f"study '{study.name}' measures no mass loss rate; take the simulated ones"
        )
    write_text(folder / "spyro.fds", _spyro_text(study, chosen, curves, simulated, measured))
    return []


def _spyro_text(
    study: Study,
    chosen: ParameterSet,
    curves: list[ReferenceTest],
    simulated: dict[str, PredictedByPyrofit],
    measured: bool,
) -> str:
    """Return the file of scaling pyrolysis; the front's temperature at ignition is simulated."""
    lit = []
    for curve in curves:
        of = simulated[curve.experiment]
        begin = ignition(curve._replace(time_s=of.time_s, rate=of.rate))
        lit.append(float(np.interp(begin, of.time_s, of.front_K)))
    material, values = chosen.material, chosen.values
    burnt = [value_of(r.heat_of_combustion_J_kg, values) for r in material.reactions.values()]
    heat = max(burnt, default=0.0) or 1e3 * USUAL_HEAT_KJ_KG
    slab = slabs_of_study(study)[curves[0].experiment]
    name, mean = study.name[:40].upper(), float(np.mean(lit))
    lines = scaling_lines(name, curves, slab, material, values, mean, heat)
    kind = "measured" if measured else f"simulated, set '{chosen.label}'"
    said = [
        f"study '{study.name}': scaling pyrolysis, FDS 6.8 and newer",
        f"reference curves: {kind}; {', '.join(c.experiment for c in curves)}",
        "ignition: 1 g/(m2 s); its temperature is the mean over the tests, "
        f"{min(lit):.0f} to {max(lit):.0f} K",
        f"heat release = mass loss rate x {1e-6 * heat:.3g} MJ/kg; the fuel of your fire is {GAS}",
    ]
    comment = "".join(f"{comment_line(line)}\n" for line in said)
    return comment + "\n" + write_all([gas_line(1e-3 * max(burnt, default=0.0)), *lines])


def strongest(flux: OverTime, values: Values) -> float:
    """Return the largest flux [W/m2]: before, a shield may be closed."""
    table = flux.value if isinstance(flux, TimeTable) else (flux,)
    return max(float(value_of(q, values)) for q in table)


def _measured(
    study: Study, results: Results
) -> Callable[[str], tuple[np.ndarray, np.ndarray] | None]:
    """Return a function that finds the measured mass loss rate of a test, or None."""
    series = load(study, results)

    def find(name: str) -> tuple[np.ndarray, np.ndarray] | None:
        experiment = study.experiments[name]
        for signal in experiment.signals:
            quantity = experiment.quantity(signal)
            if quantity.curve == RATE:
                frame = series[name, signal]
                return frame["time_s"].to_numpy(float), frame[quantity.column].to_numpy(float)
        return None

    return find
