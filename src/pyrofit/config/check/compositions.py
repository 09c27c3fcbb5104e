"""Rules for compositions: sums, shares, layers, published kinetics."""

from collections.abc import Mapping

from pyrofit.config.check.expressions import check_expression, ends_of
from pyrofit.config.check.numbers import check_entry
from pyrofit.config.keys.stages import KineticSet
from pyrofit.config.keys.study import Study
from pyrofit.config.words import require
from pyrofit.effects.base import ADDED
from pyrofit.effects.substance import main_reaction
from pyrofit.errors import suggest
from pyrofit.model.base import FRACTION
from pyrofit.model.material import REST, check_composition
from pyrofit.model.slab import SlabExperiment


def _check_sum(study: Study, shares: Mapping[str, float | str], place: str) -> None:
    """Refuse mass fractions or yields that may add up to more than one."""
    most = (max(ends_of(study, share)) for share in shares.values() if share != REST)
    total = sum(most)
    require(
        total <= 1.0 + 1e-9,
        place,
        f"with the upper limits of parameters these add up to {total:g}, above 1; lower a limit",
    )


def check_compositions(study: Study) -> None:
    """Refuse compositions and yields that cannot add up, of the material and of layers.

    Raises
    ------
    ValueError
        With place, rule and way out.
    """
    material = study.material
    compositions: dict[str, Mapping[str, float | str]]
    compositions = {"material.composition": material.composition} if material.components else {}
    for name, experiment in study.experiments.items():
        if not isinstance(experiment, SlabExperiment):
            continue
        for i, layer in enumerate(experiment.sample.layers):
            key = "beside" if layer.beside else "composition"
            if (composed := layer.composed(material.composition)) is not material.composition:
                compositions[f"experiments.{name}.sample.layers.{i}.{key}"] = composed
        _check_adhesive(study, name, experiment)
        _check_backing(study, name, experiment)
    for label, chosen in (study.kinetics.sets if study.kinetics else {}).items():
        place = f"kinetics.sets.{label}"
        require(
            label not in ("described", "fitted"),
            place,
            f"'{label}' is a reserved name; choose another",
        )
        described = {n for n in study.material.reactions if not n.startswith(ADDED)}
        missing = described ^ set(chosen.reactions)
        require(
            not missing,
            place,
            f"reactions differ from the material's: {sorted(missing)}; give each of them, no other",
        )
        compositions[f"{place}.composition"] = study.material_with(label).composition
        if label == study.imp.kinetics:
            _check_kept(study, label, chosen)
    for place, composition in compositions.items():
        try:
            check_composition(composition, study.material.components)
        except ValueError as error:
            raise ValueError(f"{place}: {error}") from None
        for share in composition.values():
            if isinstance(share, str) and share.isidentifier() and share != REST:
                check_entry(study, share, (FRACTION,), place)
            elif isinstance(share, str) and share != REST:
                check_expression(study, share, (FRACTION,), place)
        _check_sum(study, composition, place)
    for name, reaction in study.material.reactions.items():
        _check_sum(study, reaction.products, f"material.reactions.{name}.products")


def _check_adhesive(study: Study, name: str, experiment: SlabExperiment) -> None:
    """Refuse an adhesive of an unknown component."""
    glue, known = experiment.sample.adhesive, study.material.components
    require(
        glue is None or glue.component in known,
        f"experiments.{name}.sample.adhesive.component",
        f"unknown component '{glue.component if glue else ''}'. "
        + suggest(glue.component if glue else "", known),
    )


def _check_backing(study: Study, name: str, experiment: SlabExperiment) -> None:
    """Refuse layers behind the sample that are unknown, react or swell."""
    material = study.material
    reactants = {reaction.reactant for reaction in material.reactions.values()}
    for i, layer in enumerate(experiment.sample.backing):
        place = f"experiments.{name}.sample.backing.{i}.component"
        known = set(material.components) - reactants
        require(
            layer.component in material.components,
            place,
            f"unknown component '{layer.component}'. {suggest(layer.component, known)}",
        )
        require(
            layer.component not in reactants,
            place,
            f"'{layer.component}' reacts; a layer behind the sample is inert: describe it as a "
            "layer of the sample",
        )
        require(
            material.components[layer.component].expansion == 1.0,
            f"material.components.{layer.component}.expansion",
            f"a layer behind the sample keeps its volume ({place}); leave it out",
        )


def _check_kept(study: Study, label: str, chosen: KineticSet) -> None:
    """Refuse published kinetics that give a number which an effect of the model gives, too."""
    for effect, keys in study.kept_of_kinetics().items():
        values = chosen.reactions[main_reaction(study.material)[0]]
        for key in keys:
            require(
                getattr(values, key) == type(values).model_fields[key].default,
                f"effects.{effect}",
                f"imp.kinetics '{label}' brings an {key} of its own; leave the effect out, or "
                "describe or fit the kinetics",
            )
