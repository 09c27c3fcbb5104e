"""Which reaction scheme the thermogravimetric records support, and the study with it."""

from pyrofit.steps.base import Step

STEP = Step(
    place=60,
    words="choose the reaction scheme from TGA",
    message="Which reaction scheme the thermogravimetric records support",
    write="the study with the chosen scheme",
)
