"""The README of a submission."""

from collections.abc import Iterator, Sequence

from pyrofit.config import Study
from pyrofit.experiments import kind_of
from pyrofit_exchange.macfp.asked import Submission
from pyrofit_exchange.macfp.proof import Proof, calibration_signals
from pyrofit_exchange.macfp.schema import StrictSet
from pyrofit_exchange.sets import ParameterSet


def readme(
    study: Study,
    chosen: ParameterSet,
    strict: StrictSet,
    proofs: Sequence[Proof],
    written: Sequence[str],
    notes: Sequence[str],
    asked: Submission,
) -> str:
    """Return the text of the README: calibration, mechanism, parameters, proof, predictions."""
    lines = [
        f"# {asked.institute}: {asked.material}",
        "",
        "Contributor: CHANGE (names, institution, country)",
        "",
        *_approach(study, chosen),
        "",
        *_mechanism(strict),
        "",
        *_parameters(study, chosen),
        "",
        *_proofs(proofs),
        "",
        *_predictions(written, asked, strict),
    ]
    if notes:
        lines += ["", "## To mind", "", *[f"- {note}" for note in notes]]
    return "\n".join(lines) + "\n"


def _approach(study: Study, chosen: ParameterSet) -> Iterator[str]:
    yield "## Calibration"
    yield ""
    yield f"Set '{chosen.label}' of the pyrofit study '{study.name}': {study.title}"
    yield ""
    yield "| experiment | kind | laboratory | signals used |"
    yield "|---|---|---|---|"
    for name, signals in calibration_signals(study).items():
        test = study.experiments[name]
        words = kind_of(test).words
        yield f"| {test.title or name} | {words} | {test.laboratory} | {', '.join(signals)} |"
    held = [n for n in study.validation.experiments if n not in calibration_signals(study)]
    yield ""
    yield f"Held out, used by no cost: {', '.join(held) or 'none'}."


def _mechanism(strict: StrictSet) -> Iterator[str]:
    names, k = strict.composition.names, strict.kinetics
    yield "## Decomposition"
    yield ""
    yield "Rate of each reaction: A exp(-E/(R T)) m0 (m/m0)^n of its reactant."
    yield ""
    yield "| reaction | A [1/s] | E [J/mol] | n |"
    yield "|---|---|---|---|"
    for i, reactant in enumerate(k.reactants):
        product, nu = k.products[i][0], k.yields[i]
        right = f"{nu:.4g} {names[product - 1]} + {1.0 - nu:.4g} gas" if product else "gas"
        left = names[reactant[0] - 1]
        yield f"| {left} -> {right} | {k.A[i]:.5g} | {k.E[i]:.5g} | {k.order[i]:g} |"


def _parameters(study: Study, chosen: ParameterSet) -> Iterator[str]:
    yield "## Parameters"
    yield ""
    yield "| parameter | value | unit | searched within | how well it is known |"
    yield "|---|---|---|---|---|"
    for name, p in study.parameters.items():
        if name not in chosen.values:
            continue
        value = chosen.values[name] / p.factor
        given = p.lower is None or p.upper is None
        low, high = (0.0, 0.0) if given else study.search_limits(name)
        searched = "given" if given else f"{low:.5g} to {high:.5g}"
        note = chosen.notes.get(name, "")
        label = p.label or name
        yield f"| {label} | {value:.5g} | {p.unit} | {searched} | {note} |"


def _proofs(proofs: Sequence[Proof]) -> Iterator[str]:
    yield "## Proof of calibration"
    yield ""
    yield "Files in `proof_of_calibration`, at the times of the measured points."
    yield ""
    yield "| experiment | signal | rms of the difference | mean measured | file |"
    yield "|---|---|---|---|---|"
    for p in proofs:
        yield (
            f"| {p.experiment} | {p.signal} | {p.rms:.3g} {p.unit} | {p.mean:.4g} {p.unit} | "
            f"{p.file} |"
        )


def absent_parts(strict: StrictSet) -> list[str]:
    """Return the reactants that are neither in the virgin material nor made of it, as water."""
    of, k = strict.composition, strict.kinetics
    made = {product for products in k.products for product in products}
    given = sorted({reactant for (reactant,) in k.reactants} - made)
    return [of.names[n - 1] for n in given if of.fractions[n - 1] == 0.0]


def _predictions(written: Sequence[str], asked: Submission, strict: StrictSet) -> Iterator[str]:
    yield "## Predictions"
    yield ""
    if 4 in asked.forms:
        yield (
            "MaCFP-4: STA of 5 mg from 300 K; slabs of 100 mm by 100 mm from 300 K, no convection, "
            "back insulated. Mass and mass loss rate are both given; read the columns by name."
        )
    if 3 in asked.forms:
        place = f"the apparatus of '{asked.like}'" if asked.like else "an ideal slab of 6 mm"
        yield f"MaCFP-3: {place}, at 25 and 50 kW/m2."
    if absent := absent_parts(strict):
        yield f"The predicted samples contain no {', no '.join(absent)}: they have the initial "
        yield "mass fractions of the set."
    yield ""
    yield from (f"- {name}" for name in written)
