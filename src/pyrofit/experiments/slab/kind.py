"""A kind of experiment whose sample is a slab under radiant heat."""

from pyrofit.experiments.base import Designs, Kind
from pyrofit.experiments.from_files import FromFiles
from pyrofit.experiments.slab.course import course
from pyrofit.experiments.slab.simulate import reference, request, simulate, synthetic
from pyrofit.model.slab import SlabExperiment


def slab_kind(description: type[SlabExperiment], designs: Designs, files: FromFiles) -> Kind:
    """Return a kind with the solvers and phases that all slabs share."""
    return Kind(
        description=description,
        words=description.APPARATUS,
        stage="imp",
        simulate=simulate,
        reference=reference,
        request=request,
        synthetic=synthetic,
        course=course,
        designs=designs,
        files=files,
    )
