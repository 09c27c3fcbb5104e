"""The study with the chosen scheme, as keys that can be written and run."""

from collections.abc import Mapping
from typing import Any

from pyrofit.config import Study, parameters_in
from pyrofit.config.resolve import diagnosed_parameters, nuisances_of_tests
from pyrofit.scheme.fit import FittedScheme
from pyrofit.scheme.masses import masses_of

Keys = dict[str, Any]


def scheme_keys(
    study: Study, chosen: FittedScheme, signals: Mapping[tuple[str, str], Keys]
) -> Keys:
    """Return a study's keys with the chosen scheme at its fitted values.

    The parameters of the scheme have both limits and fitted values. Inverse modelling and diagnosis
    take the values, `imp.kinetics: described`; the fit of the kinetics estimates them again. In a
    study without that stage, the inverse modelling and the diagnosis estimate them again.

    Parameters
    ----------
    study
        The study.
    chosen
        The chosen scheme as it was fitted.
    signals
        Keys that replace those of a signal, by (experiment, signal): where its file lies.
    """
    posed = chosen.posed
    made = posed.study
    keys: Keys = made.model_dump(mode="json", exclude_defaults=True)
    keys["name"] = f"{study.name}_scheme"
    keys["title"] = f"{study.title or study.name}, with {posed.words}"
    values = {n: v / made.parameters[n].factor for n, v in chosen.values.items()}
    for name, value in values.items():
        keys["parameters"][name]["value"] = value
    gone = [n for n in masses_of(study).estimate if n not in values]
    used = parameters_in(made.material, *made.experiments.values()) | set(values)
    for name in gone:
        if name not in used:
            keys["parameters"].pop(name, None)
            keys.get("known", {}).pop(name, None)
    kept = [n for n in study.imp.estimate if n in used]
    if study.kinetics is None:
        kept = list(dict.fromkeys([*values, *kept]))
    else:
        keys["kinetics"]["estimate"] = list(values)
        keys["kinetics"].pop("sets", None)
    keys["imp"]["estimate"] = kept
    keys["imp"]["kinetics"] = "described"
    # All but the kinetics; differences between tests are estimated by themselves.
    rest = used - set(values) - set(nuisances_of_tests(study))
    kinetics = [] if study.kinetics else list(values)
    keys.setdefault("diagnosis", {})["estimate"] = [
        *kinetics,
        *(n for n in diagnosed_parameters(study) if n in rest),
    ]
    keys.get("diagnosis", {}).pop("kinetics", None)
    for (experiment, signal), given in signals.items():
        keys["experiments"][experiment]["signals"][signal] |= given
    files = [s["file"] for e in keys["experiments"].values() for s in e["signals"].values()]
    if "synthetic" not in files:
        keys.pop("synthetic", None)
    return keys
