"""The commands as a page of the documentation, read from the parser itself."""

import argparse
from collections import Counter
from collections.abc import Iterator

from pyrofit.cli.parser import Parser

_HEAD = """\
# Commands

Find a command and its arguments; `pyrofit COMMAND --help` prints the same. By hand you use `look`,
`init`, `explore`, `run`, `check`, `doctor`, `rescore`, `posterior`, `sensitivity`, `worth`,
`data`, `export`, `import`, `macfp` and `reference`; the [workflow](running.md) calls the others.

This page is generated: `pyrofit reference --of commands > docs/commands.md`.

## Arguments of many commands

"""
_MANY = 5
"""Lines that as many commands have stand at the head of the page."""


def commands_page(program: argparse.ArgumentParser) -> str:
    """Return the page: every command of the program with its arguments."""
    found = [(name, text, _rows(parser)) for name, text, parser in _commands(program)]
    counts = Counter(row for _, _, rows in found for row in rows)
    common = [row for row, count in counts.items() if count >= _MANY]
    sections = [_section(name, text, rows, common) for name, text, rows in found]
    return "\n".join([_HEAD + "\n".join(common) + "\n", *sections])


def _commands(
    parser: argparse.ArgumentParser,
) -> Iterator[tuple[str, str, argparse.ArgumentParser]]:
    """Yield name, description and parser of each command that has no commands of its own."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            texts = {choice.dest: choice.help or "" for choice in action._choices_actions}
            for name, inner in action.choices.items():
                if isinstance(inner, Parser):
                    inner.complete()
                deeper = list(_commands(inner))
                yield from deeper or [(inner.prog, texts.get(name, ""), inner)]


def _section(name: str, text: str, rows: list[str], common: list[str]) -> str:
    lines = [f"## `{name}`", "", f"{text[:1].upper()}{text[1:]}.", ""]
    own = [row for row in rows if row not in common]
    if own:
        lines += [*own, ""]
    names = [row.split("`")[1] for row in rows if row in common]
    if names:
        lines += [f"{'Also' if own else 'Takes'} {', '.join(f'`{name}`' for name in names)}.", ""]
    return "\n".join(lines)


def _rows(parser: argparse.ArgumentParser) -> list[str]:
    shown = (a for a in parser._actions if a.help is not argparse.SUPPRESS)
    return [_row(a) for a in shown if not isinstance(a, argparse._HelpAction)]


def _row(action: argparse.Action) -> str:
    """Return the line of an argument: its names, its value and its help."""
    names = ", ".join(f"`{name}`" for name in action.option_strings) or f"`{_value(action)}`"
    value = f" `{_value(action)}`" if action.option_strings and action.nargs != 0 else ""
    required = action.required and bool(action.option_strings)
    text = (action.help or "").replace("*", "\\*").replace("<", "\\<")
    meaning = f": {text}" if text else ""
    return f"- {names}{value}{', required' if required else ''}{meaning}"


def _value(action: argparse.Action) -> str:
    if action.metavar:
        return str(action.metavar)
    if action.choices:
        return "{" + ",".join(map(str, action.choices)) + "}"
    return action.dest if not action.option_strings else action.dest.upper()
