"""Rules for the effects of the truth of synthetic data."""

from pyrofit.config.expand.effects import true_description
from pyrofit.config.keys.study import Study
from pyrofit.config.words import require
from pyrofit.effects import known_effects
from pyrofit.model.base import value_of
from pyrofit.model.material import REST


def check_true_effects(study: Study) -> None:
    """Check the effects of the truth: that they are others than the model's, and their numbers.

    Raises
    ------
    ValueError
        With place, rule and way out.
    """
    assert study.synthetic is not None
    place, catalogue = "synthetic.effects", known_effects()
    for name, numbers in study.synthetic.effects.items():
        require(
            name not in study.with_effects,
            f"{place}.{name}",
            "the model has this effect, too; leave it out, there or under effects",
        )
        quantities = catalogue[name].quantities if name in catalogue else {}
        for key in (key for key in quantities if key in numbers):
            q = quantities[key]
            require(
                q.lower <= numbers[key] <= q.upper,
                f"{place}.{name}.{key}",
                f"{numbers[key]:g} lies outside the limits {q.lower:g} to {q.upper:g} of the "
                "catalogue; correct it",
            )
    try:
        material, _ = true_description(study)
    except ValueError as error:
        raise ValueError(f"{place}: {error}") from None
    values = study.true_values()
    total = sum(value_of(x, values) for x in material.composition.values() if x != REST)
    require(
        total <= 1.0 + 1e-9, place, f"the mass fractions add up to {total:g}, above 1; lower one"
    )
