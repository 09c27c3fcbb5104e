"""Read the arguments of a command, and run it."""

import argparse
import contextlib
import logging
import os
import signal
import sys
import threading
import traceback
from collections.abc import Iterator, Sequence
from types import FrameType

from pyrofit.cli import diagnosing, fitting, running, showing, starting, stepping
from pyrofit.cli.parser import Parser
from pyrofit.discovery import added, loaded
from pyrofit.errors import BY_RUN, INTERRUPTED, RUN, PyrofitError
from pyrofit.logs import Tee, open_log

_GROUPS = (
    starting,
    running,
    fitting,
    stepping,
    diagnosing,
    showing,
)
"""Modules of the commands, in the order of the help; those of other packages follow."""


def run(arguments: Sequence[str] | None = None) -> int:
    """Run a command; return its status, or 2 with a message if the user can correct a mistake."""
    # Threads of linear algebra would get in the way of the workflow's jobs, and change last bits:
    # Snakemake asks for as many as a job has cores.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    try:
        given = whole_parser().parse_args(arguments)
    except PyrofitError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    if not logging.root.handlers and logging.lastResort is not None:
        # SPOTPY sets one up for all where there is none, with the names of functions.
        logging.root.addHandler(logging.lastResort)
    if getattr(given, "log", None) is None:
        return _run(given)
    try:
        log = open_log(given.log)
    except OSError as error:
        print(
            f"error: {given.log}: cannot be written ({error.strerror}); make room or name "
            "another file with --log. Everything finished before is kept.",
            file=sys.stderr,
        )
        return 2
    usual = sys.stderr
    sys.stderr = Tee(usual, log)
    try:
        return _run(given)
    finally:
        sys.stderr = usual
        # Where the disk is full, closing fails once more.
        with contextlib.suppress(OSError):
            log.close()


def _run(given: argparse.Namespace) -> int:
    with _interruptible() as signals:
        try:
            with contextlib.ExitStack() as given.until_end:
                status: int = given.step(given) or 0
                return status
        except PyrofitError as error:
            said = sys.stderr
            text = f"error: {error}\n"
            if not (BY_RUN in os.environ and isinstance(said, Tee) and said.log(text)):
                print(text, end="", file=said)
            return 2
        except KeyboardInterrupt:
            return _interrupted()
        except BrokenPipeError:  # its reader, such as `head`, has read enough
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return 0
        except Exception:
            if signals:  # compiled code may turn the interruption into another error
                return _interrupted()
            if isinstance(sys.stderr, Tee):  # the log needs it as well
                traceback.print_exc()
                return 1
            raise


def _interrupted() -> int:
    """Say how to go on, and return the status; for a job of a run, the run says it."""
    said = sys.stderr
    if RUN in os.environ and isinstance(said, Tee):
        said.log(f"{INTERRUPTED}\n")
    elif RUN not in os.environ:
        print(INTERRUPTED, file=said)
    return 130


@contextlib.contextmanager
def _interruptible() -> Iterator[list[int]]:
    """Treat SIGTERM, which schedulers send, as Ctrl-C: all that a step has started ends with it.

    Yields the signals that arrive.
    The first signal counts; a second one, sent by a run to its jobs, would break its answer off.
    """
    arrived: list[int] = []
    if threading.current_thread() is not threading.main_thread():
        yield arrived
        return
    numbers = (signal.SIGINT, signal.SIGTERM)

    def answer(number: int, frame: FrameType | None) -> None:
        for each in numbers:
            signal.signal(each, lambda number, frame: None)
        arrived.append(number)
        raise KeyboardInterrupt

    before = [(number, signal.signal(number, answer)) for number in numbers]
    try:
        yield arrived
    finally:
        for number, old in before:
            signal.signal(number, old)


def whole_parser() -> argparse.ArgumentParser:
    """Return the parser of all commands, those of other packages among them."""
    parser = Parser(
        prog="pyrofit",
        description="Estimate the parameters of a pyrolysis model from measurements. A whole study "
        "runs by: pyrofit run STUDY.",
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for group in _GROUPS:
        group.add(commands)
    for point in added("commands").values():
        loaded(point)(commands)
    parser.set_defaults(program=parser)
    return parser
