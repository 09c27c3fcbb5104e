"""A parser whose commands may get options late."""

import argparse
import re
from collections.abc import Callable
from typing import Any, NoReturn


def commands_of(commands: Any, name: str) -> Any:
    """Return the commands below a command, such as `data`, to which others may be added."""
    actions = commands.choices[name]._actions
    return next(action for action in actions if isinstance(action, argparse._SubParsersAction))


class Parser(argparse.ArgumentParser):
    """A parser that may take options which are known only after slow imports."""

    late: Callable[["Parser"], None] | None = None
    """Adds them; it is called when the command is given."""

    def complete(self) -> None:
        """Add the late options, once."""
        if self.late is not None:
            add, self.late = self.late, None
            add(self)

    def parse_known_args(self, *given: Any, **named: Any) -> Any:
        """Parse arguments as usual."""
        self.complete()
        return super().parse_known_args(*given, **named)

    def error(self, message: str) -> NoReturn:
        """End with a message; for an unknown command, without the list of some forty."""
        if unknown := re.match(r"argument COMMAND: invalid choice: (\S+)", message):
            message = (
                f"there is no command {unknown[1]}; a whole study runs by `pyrofit run STUDY`, "
                "and `pyrofit --help` lists all commands"
            )
        super().error(message)
