"""The command that shows a study in the browser."""

import argparse
import sys
from pathlib import Path
from typing import Any

TWIN = Path("config/twin.yaml")
INSTALLED_TWIN = Path(__file__).with_name("twin.yaml")
"""The same study, for folders without the repository."""


def add(commands: Any) -> None:
    """Add this command."""
    words = "move the parameters of a study in the browser, and see its curves follow"
    command = commands.add_parser("explore", help=words, description=words)
    command.add_argument(
        "study", type=Path, nargs="?", help="study file; default: twin, of known truth"
    )
    command.add_argument("--results", type=Path, help="results folder; default results/<name>")
    command.add_argument(
        "--set", default="", help="a set to start from, such as a JSON file of values in SI units"
    )
    command.add_argument("--port", type=int, default=0, help="port; default: a free one")
    command.add_argument(
        "--no-browser", action="store_true", help="print the address, open no browser"
    )
    command.add_argument(
        "--static", type=Path, metavar="FILE", help="write a page that needs no server instead"
    )
    command.add_argument(
        "--sliders",
        nargs="+",
        default=[],
        metavar="NAME",
        help="with --static: one or two parameters; default: the two that move the signals most",
    )
    command.set_defaults(step=_explore)


def _study(given: argparse.Namespace) -> Path:
    return given.study or (TWIN if TWIN.exists() else INSTALLED_TWIN)


def _write(given: argparse.Namespace) -> None:
    from pyrofit_explore.session import session_of
    from pyrofit_explore.static import write_static

    session = session_of(_study(given), given.results, given.set, noise=False)
    write_static(session, given.sliders, given.set, given.static)
    print(given.static)


def _explore(given: argparse.Namespace) -> None:
    import webbrowser

    if given.static is not None:
        _write(given)
        return
    from pyrofit_explore.run import Explorer

    explorer = Explorer(_study(given), given.results, given.set, given.port)
    print(f"{explorer.address}\nCtrl-C ends it.", flush=True)
    if not given.no_browser:
        webbrowser.open(explorer.address)
    try:
        explorer.server.serve_forever()
    except KeyboardInterrupt:
        print("ended", file=sys.stderr)
    finally:
        explorer.close()
