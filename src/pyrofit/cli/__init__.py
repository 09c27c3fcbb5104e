"""The command line: the commands that the workflow's rules call, usable by hand."""

import importlib
import os
import sys
from collections.abc import Sequence

from pyrofit.errors import INTERRUPTED, RUN


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; return its status, or 2 with a message if the user can correct a mistake."""
    try:
        # Not above: Ctrl-C while modules are loaded ends with one line as well.
        status: int = importlib.import_module("pyrofit.cli.command").run(arguments)
        return status
    except KeyboardInterrupt:
        if RUN not in os.environ:  # of a job, the run says it
            print(INTERRUPTED, file=sys.stderr)
        return 130
