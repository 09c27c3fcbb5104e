"""Options of the steps of their own: each step declares its own in its folder."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

from pydantic import Field, create_model

from pyrofit.model.base import Part
from pyrofit.steps import known_steps


def _fields() -> dict[str, Any]:
    return {
        name: (step.options, Field(default_factory=step.options, description=step.words))
        for name, step in known_steps().items()
        if step.options is not None
    }


if TYPE_CHECKING:
    Steps: TypeAlias = Part
else:
    Steps = create_model("Steps", __base__=Part, __doc__="Options of the steps.", **_fields())


def with_options(steps: Steps, step: str, given: Mapping[str, Any]) -> Steps:
    """Return the options of all steps with some of one step changed.

    Raises
    ------
    pydantic.ValidationError
        An option is unknown or breaks its rule.
    """
    before = dict(steps)[step]
    after = type(before).model_validate({**before.model_dump(), **given})
    return steps.model_copy(update={step: after})
