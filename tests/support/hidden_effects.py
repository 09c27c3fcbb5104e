"""What the diagnosed twins hide."""

from collections.abc import Callable

from pyrofit.diagnose.diagnosis import DiagnosisWork

HIDDEN: dict[str, dict[str, float]] = {
    "nothing": {},
    "k_T": {"k_T": -1e-3},
    "in_depth": {"in_depth": 3.5e-4},
    "heater_ramp": {"heater_ramp": 8.0},
    "volatile": {"volatile": 0.015},
}
SEED = 2

Diagnosed = Callable[[str], DiagnosisWork]
