"""The file to include in a fire: MATL, RAMP and SURF lines, with notes on their parameters."""

from collections.abc import Iterator, Mapping, Sequence

from pyrofit import __version__
from pyrofit.config import Study, parameters_in
from pyrofit.model.base import numbers, value_of
from pyrofit.model.slab import SlabExperiment
from pyrofit.provenance import source_fingerprint
from pyrofit_exchange.fds.depth import absorption
from pyrofit_exchange.fds.heated import virgin
from pyrofit_exchange.fds.layers import layer_keys, own_layers
from pyrofit_exchange.fds.materials import MaterialLines, Options, write_materials
from pyrofit_exchange.fds.namelists import Item, Namelist
from pyrofit_exchange.fds.remarks import Remark, once
from pyrofit_exchange.fds.slab import Deck
from pyrofit_exchange.fds.unwritten import unwritten
from pyrofit_exchange.fds.versions import Version
from pyrofit_exchange.sets import ParameterSet

GAS = "FUEL_GAS"
FACTOR = 0.5
"""CELL_SIZE_FACTOR of a fire. PMMA of 6 mm: 0.2 % at 25 kW/m2, 0.8 % at 60; default 6 and 34 %."""
OF_GAS = ("C", 5.0), ("H", 8.0), ("O", 2.0), ("SOOT_YIELD", 0.02)
USUAL_HEAT_KJ_KG = 25000.0


def include(study: Study, chosen: ParameterSet, version: Version) -> Deck:
    """Return the include file of the fitted material.

    Parameters
    ----------
    study
        The study.
    chosen
        Its set.
    version
        Version of FDS.
    """
    material, values = chosen.material, chosen.values
    slabs = [e for e in study.experiments.values() if isinstance(e, SlabExperiment)]
    sample = slabs[0].sample if slabs else None
    kappa, remarks = absorption(sample, material, values) if sample else ({}, [])
    names = list(material.composition)
    lines = write_materials(material, values, names, Options(version, GAS, kappa))
    found = [*remarks, *lines.remarks]
    for experiment in slabs[:1]:
        plain = experiment.model_copy(update={"signals": {}})
        found += [r for r in unwritten(plain, values) if "sample.edge" not in r.what]
    burnt = [value_of(r.heat_of_combustion_J_kg, values) for r in material.reactions.values()]
    heat = max(burnt, default=0.0)
    described = tuple(_described(study, chosen, lines))
    namelists = (gas_line(1e-3 * heat), *described, _surface(study, chosen, lines, slabs))
    return Deck("material", "the material", namelists, once(found))


def gas_line(heat: float) -> Namelist:
    """Return the REAC line of the gas, with a heat of combustion [kJ/kg] where it is known."""
    items: dict[str, Item] = {"ID": "PYROLYSIS GAS", "FUEL": GAS, **dict(OF_GAS)}
    stated = "as in the study" if heat else "not from the study"
    comment = (
        f"Not determined by pyrolysis tests: formula and soot; heat of combustion {stated}.",
        f"Change this line, or delete it and have FUEL='{GAS}' in yours.",
    )
    return Namelist("REAC", items | {"HEAT_OF_COMBUSTION": heat or USUAL_HEAT_KJ_KG}, comment)


def _described(study: Study, chosen: ParameterSet, lines: MaterialLines) -> Iterator[Namelist]:
    """Yield MATL and RAMP lines, with a comment on its parameters ahead of each component."""
    first = {of[0][0]: name for name, of in lines.parts.items()}
    for namelist in lines.namelists:
        name = first.get(str(namelist.items["ID"])) if namelist.group == "MATL" else None
        yield namelist if name is None else namelist._replace(comment=_about(study, chosen, name))


def _about(study: Study, chosen: ParameterSet, name: str) -> tuple[str, ...]:
    """Return comment lines on the parameters of a component and of its reactions."""
    parts: dict[str, object] = {"": chosen.material.components[name]}
    for key, reaction in chosen.material.reactions.items():
        if reaction.reactant == name:
            parts[f"reaction {key}: "] = reaction
    said = [
        f"  {place}{at} from {leaf} = {_value(study, chosen.values, leaf)}"
        for place, part in parts.items()
        for at, leaf, _ in numbers(part)
        if isinstance(leaf, str)
    ]
    return (f"Component '{name}'" + (":" if said else ": described, nothing fitted"), *said)


def _value(study: Study, values: Mapping[str, float], name: str) -> str:
    if not name.isidentifier():
        return f"{value_of(name, values):.6g} in SI units"
    parameter = study.parameters[name]
    return f"{values[name] / parameter.factor:.6g} {parameter.unit}"


def _surface(
    study: Study, chosen: ParameterSet, lines: MaterialLines, slabs: Sequence[SlabExperiment]
) -> Namelist:
    material, values = chosen.material, chosen.values
    layers = [
        layer
        for layer in (own_layers(slabs[0].sample, material, values) if slabs else [])
        if set(layer.shares) <= set(lines.parts)
    ][:1]
    if not layers:
        layers = [virgin(material, values)]
    comment = (
        "Thickness and backing are those of your fire, not of the tests.",
        "STRETCH_FACTOR and CELL_SIZE_FACTOR belong to the parameters. FDS's default grid is 6 %",
        "off at 25 kW/m2 and 34 % at 60 for PMMA of 6 mm (docs/fds.md); others were not measured.",
        "BACKING='EXPOSED' sends half of the gas of a layer out of its back (LAYER_DIVIDE).",
    )
    items = {
        "ID": study.name[:40].upper(),
        **layer_keys(layers, lines),
        "CELL_SIZE_FACTOR": FACTOR,
        "BACKING": "VOID",
    }
    return Namelist("SURF", items, comment)


def heading(study: Study, chosen: ParameterSet, version: Version) -> list[str]:
    """Return the first lines of every file: study, set, version, and parameters with notes."""
    used = sorted(parameters_in(chosen.material))
    lines = [
        f"pyrofit {__version__}, source {source_fingerprint('pyrofit_exchange.fds.export')}",
        f"study '{study.name}': {study.title}",
        f"set '{chosen.label}'",
        f"for FDS {version.name}: another version reads these lines otherwise",
    ]
    for name, given in study.with_effects.items():
        numbers_of = ", ".join(f"{key} {value}" for key, value in given.items())
        lines.append(f"effect of the model: {name}: {numbers_of}")
    lines.append("parameters of the material:")
    return [*lines, *(f"  {_parameter(study, chosen, name)}" for name in used)]


def _parameter(study: Study, chosen: ParameterSet, name: str) -> str:
    parameter = study.parameters[name]
    said = [f"{name} = {_value(study, chosen.values, name)}", parameter.label]
    if name in study.known:
        known = study.known[name]
        said.append(f"known: {known.value:g} +- {known.sd:g} ({known.source})")
    if data := _data(study, name):
        said.append(f"fitted to {data}")
    elif parameter.value is not None:
        said.append("given by the study, not fitted")
    said.append(chosen.notes.get(name, ""))
    return "; ".join(filter(None, said))


def _data(study: Study, name: str) -> str:
    """Return the signals that a parameter is fitted to."""
    kinetics = study.kinetics if study.kinetics and name in study.kinetics.estimate else None
    stage = kinetics or (study.imp if name in study.imp.estimate else None)
    channels = stage.channels if stage else ()
    return ", ".join(f"{c.experiment} {c.signal}" for c in channels)


def all_remarks(decks: list[Deck]) -> dict[Remark, list[str]]:
    """Return every remark with the decks that it belongs to."""
    found: dict[Remark, list[str]] = {}
    for deck in decks:
        for remark in deck.remarks:
            found.setdefault(remark, []).append(deck.name)
    return found
