"""Time to ignition of slabs, and properties of the material from a series of radiant fluxes."""

from pyrofit.steps.base import Step

STEP = Step(
    place=65,
    words="times to ignition, critical heat flux and thermal response parameter",
    message="Times to ignition and critical heat flux",
)
