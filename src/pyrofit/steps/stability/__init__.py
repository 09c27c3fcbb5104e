"""How stable the result of a diagnosis is: the same diagnosis on slightly changed data."""

from pyrofit.steps.base import Step

STEP = Step(
    place=90,
    words="diagnose disturbed data: how stable the result is",
    message="Stability of the diagnosis: tables and figure",
    part="draw",
    part_message="Diagnosis of disturbed data, draw {wildcards.part}",
    page="diagnosis",
)
