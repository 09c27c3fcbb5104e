"""A kind of experiment whose sample follows a temperature programme."""

from pyrofit.experiments.base import Kind
from pyrofit.experiments.from_files import FromFiles
from pyrofit.experiments.heated.course import course
from pyrofit.experiments.heated.designs import designs
from pyrofit.experiments.heated.simulate import reference, request, simulate, synthetic
from pyrofit.model.heated import HeatedExperiment


def heated_kind(
    name: str, words: str, description: type[HeatedExperiment], files: FromFiles
) -> Kind:
    """Return a kind with the solvers, phases and new tests that all heated samples share."""
    return Kind(
        description=description,
        words=words,
        stage="kinetics",
        simulate=simulate,
        reference=reference,
        request=request,
        synthetic=synthetic,
        course=course,
        designs=lambda own, measured, recorded: designs(name, words, own, recorded),
        files=files,
    )
