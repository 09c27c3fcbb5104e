"""An external program: its template, its command, and the columns of its output."""

import shlex
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from pyrofit.errors import suggest
from pyrofit.model.base import AboveZero, Part

Dialect = Literal["any", "fds"]
ROLES = "time", "temperature", "value"


def _words(given: Any) -> Any:
    """Return the words of a command that is given as one line."""
    if not isinstance(given, str):
        return given
    try:
        return shlex.split(given)
    except ValueError as error:
        raise ValueError(f"{error} in '{given}'; close it") from None


Command = Annotated[tuple[str, ...], Field(min_length=1), BeforeValidator(_words)]


class Reading(Part):
    """Where the output of a program holds a signal."""

    file: str = Field(description="file that the program writes, in the folder where it runs")
    columns: dict[str, str | int] = Field(
        description="headers, or numbers from 1 on, of the columns `value` and `time` (usual: "
        "Time), or `temperature` instead of `time`"
    )
    units: dict[str, str] = Field(
        description="unit of `value`, as in measured files, of `temperature`, and of `time` "
        "(usual: s)"
    )
    holds: Literal["point", "before"] = Field(
        "point",
        description="`point`: a value belongs to its time. `before`: it is the mean since the "
        "time of the row before, as in device files of FDS",
    )
    sample_mass_kg: AboveZero | None = Field(
        None, description="initial mass of the sample [kg]: powers and masses are divided by it"
    )
    sample_area_m2: AboveZero | None = Field(
        None,
        description="area of the sample [m2]: masses, their rates and heat rates are divided by it",
    )

    @property
    def abscissa(self) -> str:
        """Axis of the record: time or temperature."""
        return "temperature" if "temperature" in self.columns else "time"

    @property
    def heads(self) -> dict[str, str | int]:
        """Header or number of the columns by role."""
        return {"time": "Time", **self.columns} if self.abscissa == "time" else {**self.columns}

    @model_validator(mode="after")
    def _check(self) -> Self:
        for key in ("columns", "units"):
            given = getattr(self, key)
            for role in given:
                if role not in ROLES:
                    raise ValueError(f"{key}: unknown role '{role}'. {suggest(role, ROLES)}")
            for role in ("value", *({"temperature"} & {*self.columns})):
                if role not in given:
                    raise ValueError(f"{key}: name that of the {role}: `{key}: {{{role}: ...}}`")
        for role, head in self.columns.items():
            if isinstance(head, int) and head < 1:
                raise ValueError(
                    f"columns: the number of the {role} is {head}; the first column is 1"
                )
        if {"time", "temperature"} <= {*self.columns}:
            raise ValueError("columns: name the time or the temperature, not both")
        if self.holds == "before" and self.abscissa != "time":
            raise ValueError("holds: only values over time are means of the time before")
        if not _is_plain(self.file):
            raise ValueError(f"file: '{self.file}' must be a name in the folder of the run")
        return self


class Program(Part):
    """How an external program simulates an experiment."""

    template: str = Field(
        description="its input file with placeholders `#name#`, relative to the study file"
    )
    input: str = Field(
        "", description="file name of the filled template; usual: that of the template"
    )
    command: Command = Field(
        description="command, a list of words or one line, run without a shell. The first word is "
        "a program on the PATH, or a file relative to the study file"
    )
    files: tuple[str, ...] = Field(
        (), description="further files that a run needs, relative to the study file"
    )
    placeholders: dict[str, str | float] = Field(
        default_factory=dict,
        description="further placeholders: a number, or an expression of parameters in the units "
        "of the template, such as `T_p - 273.15`",
    )
    units: dict[str, str] = Field(
        default_factory=dict,
        description="unit in which the template takes a parameter; usual: that of the parameter",
    )
    reads: dict[str, Reading] = Field(description="where the output holds each signal")
    time_limit_s: AboveZero = Field(
        description="wall time [s] after which a run is killed and counts as failed"
    )
    dialect: Dialect = Field(
        "any",
        description="`fds`: the first word `fds` is found by PYROFIT_FDS or on the PATH. Its STOP "
        "line reports success, as its exit status is always 0",
    )
    succeeds: str = Field(
        "", description="regular expression that the terminal output contains after a success"
    )
    fails: str = Field("", description="regular expression that it contains after a failure")
    environment: dict[str, str] = Field(
        default_factory=dict, description="further environment variables of a run"
    )
    cores: int = Field(1, ge=1, description="cores of one run; OMP_NUM_THREADS is set to it")
    parallel: int = Field(1, ge=1, description="largest number of simultaneous runs in one step")
    keep_failed: int = Field(3, ge=0, description="largest number of kept folders of failed runs")
    store: str = Field(
        "",
        exclude=True,
        description="folder of the runs; set by the commands, leave it out",
    )

    @property
    def input_name(self) -> str:
        """Name of the filled template."""
        return self.input or _last(self.template)

    @property
    def own_files(self) -> tuple[str, ...]:
        """Files of the user that a run reads, the template first."""
        return (self.template, *self.files)

    @model_validator(mode="after")
    def _check(self) -> Self:
        if not _is_plain(self.input_name):
            raise ValueError(f"input: '{self.input}' must be a name in the folder of the run")
        names = [self.input_name, *map(_last, self.files)]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"files: two files of a run have the name '{name}'; rename one")
        for signal, reading in self.reads.items():
            if reading.file in names:
                raise ValueError(
                    f"reads.{signal}.file: '{reading.file}' exists before the run; name a "
                    "file that the program writes"
                )
        return self


def _is_plain(name: str) -> bool:
    """Return whether a name is that of a file in the folder itself."""
    return name not in ("", ".", "..") and "/" not in name and "\\" not in name


def _last(path: str) -> str:
    return path.replace("\\", "/").rpartition("/")[2]
