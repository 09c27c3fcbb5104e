"""What every part of a description shares."""

from collections.abc import Iterator, Mapping
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Number = Annotated[
    float | str,
    Field(union_mode="left_to_right", description="a number, or the name of a parameter"),
]


class Part(BaseModel):
    """A frozen piece of a description; unknown keys are errors."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, protected_namespaces=()
    )


def value_of(number: float | str, values: Mapping[str, float]) -> float:
    """Return a number itself, or the value of the parameter it names."""
    return values[number] if isinstance(number, str) else number


def names_in(part: object) -> Iterator[str]:
    """Yield the names of the parameters that stand where a `Number` may stand."""
    if isinstance(part, Part):
        for name, field in type(part).model_fields.items():
            value = getattr(part, name)
            if isinstance(value, str):
                if field.annotation is not str and _is_number(field.metadata, field.annotation):
                    yield value
            else:
                yield from names_in(value)
    elif isinstance(part, dict):
        for value in part.values():
            yield from names_in(value)
    elif isinstance(part, list | tuple):
        for value in part:
            yield from names_in(value)


def _is_number(metadata: list[object], annotation: object) -> bool:
    return "float" in str(annotation)
