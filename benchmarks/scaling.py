"""How the time goes with cells, sets, threads, reactions and effects."""

from collections.abc import Mapping

import numpy as np
from case import FLUXES, Rates, Setup, rates, seconds, setup, study
from page import filed

from pyrofit.effects import known_effects
from pyrofit.effects.apply import with_effects
from pyrofit.effects.base import changed
from pyrofit.model.accuracy import Accuracy
from pyrofit.solver.run import LANES

LEAST_S = 1.0
CELLS = (16, 32, 64, 128, 256)
SETS = (1, 2, 4, 8, 16, 64, 256)
THREADS = (1, 2)
ALONE = 64
"""Sets of the box that are also run one by one."""
EFFECTS = (
    "k_T",
    "c_T",
    "in_depth",
    "emissivity_conversion",
    "swelling",
    "third_reaction",
    "volatile",
)
FIXED = Accuracy(cells=56)
"""Cells that do not change with the varied quantity."""
PER_CELL = (
    f"Lanes are {LANES} equal sets side by side. Rates are those of whole evaluations, times per "
    "cell and step those of the kernel alone. The last two columns give this time over the base's."
)
NOTES = {
    "Cells": f"25 kW/m², default tolerance; the base is 64 cells. {PER_CELL}",
    "Sets": "25 kW/m², the setting of 0.2 %, one thread. The second column repeats the published "
    "set. The third column has sets drawn from the limits of the study, which differ in their "
    f"steps and end times. The last column runs these sets one by one, at most {ALONE} of them.",
    "Threads": "25 kW/m², 256 equal sets in one call.",
    "Reactions": f"25 kW/m², {FIXED.cells} cells; parallel reactions. Those beyond two are "
    f"equal parts of reaction B; the base is the paper's two. {PER_CELL}",
    "Effects": f"{FIXED.cells} cells; each effect at a strength often met; the base is the model "
    f"without. {PER_CELL}",
}


def _row(label: object, found: Rates, base: Rates) -> list[str]:
    slower = (
        found.per_cell_step_ns("kernel_lanes") / base.per_cell_step_ns("kernel_lanes"),
        found.per_cell_step_ns("kernel_scalar") / base.per_cell_step_ns("kernel_scalar"),
    )
    return [
        str(label),
        str(found.steps),
        f"{found.scalar:,.0f}",
        f"{found.lanes:,.0f}",
        f"{found.per_cell_step_ns('kernel_scalar'):.1f}",
        f"{found.per_cell_step_ns('kernel_lanes'):.2f}",
        f"{slower[1]:.2f}",
        f"{slower[0]:.2f}",
    ]


HEAD = (
    "steps",
    "scalar 1/s",
    "lanes 1/s",
    "scalar kernel, ns per cell and step",
    "lanes kernel, ns",
    "scalar to base",
    "lanes to base",
)


def of_cells(name: str) -> str:
    """Return rates over the number of cells; the base is the middle one."""
    found = [rates(setup(name), Accuracy(cells=cells), LEAST_S) for cells in CELLS]
    base = found[len(CELLS) // 2]
    pairs = zip(CELLS, found, strict=True)
    rows = [_row(cells, f, base) for cells, f in pairs]
    return filed("scaling_cells", "Table", ("cells", *HEAD), rows)


def of_sets(name: str, cheap: Accuracy) -> str:
    """Return evaluations per second over the number of sets, equal ones and of Table 6's box."""
    drawn = boxed(name, max(SETS))
    alone = [
        seconds(lambda s=s: setup(name).run_sets(pick(drawn, s), 1, cheap), 0.05)
        for s in range(ALONE)
    ]
    rows = []
    for sets in SETS:
        values = pick(drawn, 0) if sets == 1 else {n: x[:sets] for n, x in drawn.items()}
        equal = seconds(lambda sets=sets: setup(name).run(cheap, sets), LEAST_S)
        mixed = seconds(lambda n=sets, v=values: setup(name).run_sets(v, n, cheap), LEAST_S)
        count = min(sets, ALONE)
        by_one = count / sum(alone[:count])
        rows.append((sets, f"{sets / equal:,.0f}", f"{sets / mixed:,.0f}", f"{by_one:,.0f}"))
    head = ("sets", "equal sets 1/s", "sets of the box 1/s", "these one by one 1/s")
    return filed("scaling_sets", "Table", head, rows)


def boxed(name: str, sets: int) -> dict[str, np.ndarray]:
    """Draw sets from the limits of the study."""
    generator = np.random.default_rng(6)
    limits = [(n, study().parameters[n]) for n in setup(name).values]
    return {n: p.factor * generator.uniform(p.lower, p.upper, sets) for n, p in limits}


def pick(values: Mapping[str, np.ndarray], s: int) -> dict[str, float]:
    """Return one of several sets."""
    return {n: float(x[s]) for n, x in values.items()}


def of_threads(name: str, cheap: Accuracy) -> str:
    """Return evaluations per second of 256 sets over the number of threads."""
    rows = []
    for label, accuracy in (("0.2 %", cheap), ("default", Accuracy())):
        times = [
            seconds(lambda n=n, a=accuracy: setup(name).run(a, 256, threads=n), LEAST_S)
            for n in THREADS
        ]
        rows.append([label, *(f"{256 / t:,.0f}" for t in times), f"{times[0] / times[-1]:.2f}"])
    head = ("setting", *(f"threads {n}, 1/s" for n in THREADS), "gain")
    return filed("scaling_threads", "Table", head, rows)


def with_reactions(name: str, count: int) -> Setup:
    """Return the set-up with one reaction, or with component B split into equal ones."""
    given = setup(name)
    material = given.material
    main = material.reactions["B"]
    names = [f"B{i}" for i in range(count - 1)] if count > 1 else []
    if count == 1:
        reactions, parts = {"B": main}, {"B": material.components["B"]}
        composition: dict[str, float | str] = {"B": 1.0}
    else:
        reactions = {"A": material.reactions["A"]}
        reactions |= {n: changed(main, reactant=n) for n in names}
        parts = {"A": material.components["A"], **dict.fromkeys(names, material.components["B"])}
        composition = {"A": 0.025, **dict.fromkeys(names[1:], 0.975 / len(names)), names[0]: "rest"}
    parts = {**parts, "residue": material.components["residue"]}
    made = changed(material, components=parts, reactions=reactions, composition=composition)
    return given._replace(material=made)


def of_reactions(name: str) -> str:
    """Return rates over the number of parallel reactions; the base is the paper's two."""
    found = {n: rates(with_reactions(name, n), FIXED, LEAST_S) for n in (1, 2, 3, 4)}
    rows = [_row(n, f, found[2]) for n, f in found.items()]
    return filed("scaling_reactions", "Table", ("reactions", *HEAD), rows)


def with_effect(name: str, effect: str) -> Setup:
    """Return the set-up with an effect at a strength often met."""
    given = setup(name)
    at = {q: x.typical for q, x in known_effects()[effect].quantities.items()}
    material, changed_to = with_effects(given.material, {name: given.experiment}, {effect: at})
    return given._replace(experiment=changed_to[name], material=material)


def of_effects(name: str) -> str:
    """Return rates with effects; the base is the model without."""
    base = rates(setup(name), FIXED, LEAST_S)
    rows = [_row("none", base, base)]
    rows += [_row(e, rates(with_effect(name, e), FIXED, LEAST_S), base) for e in EFFECTS]
    words = f"Table at {FLUXES[name]} kW/m²"
    return filed(f"scaling_effects_{name}", words, ("effect", *HEAD), rows)
