"""Copies of shipped studies with one error each: in the description, or in a file."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.effects.base import changed

Frames = Mapping[tuple[str, str], pd.DataFrame]
Broken = tuple[Study, Frames]
Error = Callable[[Study, Frames], Broken]
MLR, BACK, MASS = "mlr", "back_temperature", "mass_fraction"


@dataclass(frozen=True)
class Planted:
    """An error, and the cause that must be named at a place."""

    words: str
    study: str
    error: Error
    cause: str
    place: str


def _with(study: Study, name: str, part: str, **keys: Any) -> Study:
    experiment = study.experiments[name]
    if part:
        keys = {part: changed(getattr(experiment, part), **keys)}
    experiments = {**study.experiments, name: changed(experiment, **keys)}
    return study.model_copy(update={"experiments": experiments})


def described(name: str, part: str, **keys: Any) -> Error:
    """Return other values of a part of the description."""
    return lambda study, frames: (_with(study, name, part, **keys), frames)


def shifted(name: str, signal: str, column: str, by: float) -> Error:
    """Return a record with a column shifted by a number."""

    def error(study: Study, frames: Frames) -> Broken:
        frame = frames[name, signal]
        return study, {**frames, (name, signal): frame.assign(**{column: frame[column] + by})}

    return error


def times(name: str, factor: float, by: float = 0.0) -> Error:
    """Return the records of a test with other times; none before the start is left."""

    def error(study: Study, frames: Frames) -> Broken:
        made = dict(frames)
        for key in [key for key in frames if key[0] == name]:
            frame = frames[key].assign(time_s=factor * frames[key]["time_s"] + by)
            made[key] = frame[frame["time_s"] >= 0.0].reset_index(drop=True)
        return study, made

    return error


def scaled(name: str, signal: str, factor: float) -> Error:
    """Return a record with its values and uncertainties times a factor."""

    def error(study: Study, frames: Frames) -> Broken:
        frame = frames[name, signal]
        own = [c for c in frame if c not in ("time_s", "temperature_K")]
        made = frame.assign(**{column: factor * frame[column] for column in own})
        return study, {**frames, (name, signal): made}

    return error


def heated(name: str, factor: float) -> Error:
    """Return a test whose heating rate, and with it the times, are wrong by a factor."""

    def error(study: Study, frames: Frames) -> Broken:
        rate = factor * study.experiments[name].heating_rate_K_min
        study = _with(study, name, "", heating_rate_K_min=rate)
        return times(name, 1.0 / factor)(study, frames)

    return error


def swapped(one: str, other: str, *signals: str) -> Error:
    """Return records of two tests in each other's place."""

    def error(study: Study, frames: Frames) -> Broken:
        made = dict(frames)
        for signal in signals:
            made[one, signal], made[other, signal] = frames[other, signal], frames[one, signal]
        return study, made

    return error


def limited(name: str, lower: float, upper: float) -> Error:
    """Return other limits of a parameter."""

    def error(study: Study, frames: Frames) -> Broken:
        own = study.parameters[name].model_copy(update={"lower": lower, "upper": upper})
        return study.model_copy(update={"parameters": {**study.parameters, name: own}}), frames

    return error


UNIT, FLUX, THICKNESS, CLOCK = "unit of temperature", "flux", "thickness", "clock"
RATE, SWAPPED, SAMPLE = "heating rate", "swapped files", "sample area or mass"
AROUND, LIMITS = "gas or wall temperature", "limits"
_T, _BACK_T = "temperature_K", "back_temperature_K"
PLANTED = (
    Planted("°C as K", "smoke", shifted("slab_25", BACK, _BACK_T, -273.15), UNIT, "slab_25"),
    Planted("K as °C", "twin", shifted("capa_60", BACK, _BACK_T, 273.15), UNIT, "capa_60"),
    Planted("K as °C, TGA", "twin", shifted("tga_10K", MASS, _T, 273.15), UNIT, "tga_10K"),
    Planted("flux x 10", "smoke", described("slab_25", "front", flux_W_m2=2.5e5), FLUX, "slab_25"),
    Planted("flux / 10", "twin", described("capa_60", "front", flux_W_m2=6e3), FLUX, "capa_60"),
    Planted(
        "thickness in cm",
        "twin",
        described("capa_25", "sample", layers=({"thickness_m": 0.058},)),
        THICKNESS,
        "capa_25",
    ),
    Planted(
        "thickness / 10",
        "smoke",
        described("slab_60", "sample", layers=({"thickness_m": 4e-4},)),
        THICKNESS,
        "slab_60",
    ),
    Planted("minutes as s", "smoke", times("slab_25", 1.0 / 60.0), CLOCK, "slab_25"),
    Planted("clock 60 s late", "twin", times("capa_60", 1.0, -60.0), CLOCK, "capa_60"),
    Planted("K/s as K/min", "smoke", heated("tga_5K", 60.0), RATE, "tga_5K"),
    Planted("rate / 10", "twin", heated("tga_50K", 0.1), RATE, "tga_50K"),
    Planted("swapped", "twin", swapped("capa_25", "capa_60", MLR, BACK), SWAPPED, "capa_25"),
    Planted("one swapped", "smoke", swapped("slab_25", "slab_60", MLR), SWAPPED, "slab_60"),
    Planted("g for mg", "twin", scaled("capa_25", MLR, 1e-3), SAMPLE, "capa_25"),
    Planted("area / 10", "smoke", scaled("slab_60", MLR, 10.0), SAMPLE, "slab_60"),
    Planted("radius for diameter", "twin", scaled("capa_60", MLR, 4.0), SAMPLE, "capa_60"),
    Planted(
        "wall of 950 K",
        "smoke",
        described("slab_25", "front", wall_temperature_K=950.0),
        AROUND,
        "slab_25",
    ),
    Planted(
        "gas of 1200 K",
        "twin",
        described("capa_25", "front", gas_temperature_K=1200.0),
        AROUND,
        "capa_25",
    ),
    Planted("narrow limits of T_B", "twin", limited("T_B", 560.0, 590.0), LIMITS, "T_B"),
    Planted("narrow limits of rho", "smoke", limited("rho", 300.0, 700.0), LIMITS, "rho"),
)
"""Twenty errors, at least two of each kind."""
