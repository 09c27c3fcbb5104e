"""The check of sentences that readers see."""

import runpy
from collections.abc import Callable
from pathlib import Path

import pytest

TOOL = Path(__file__).parents[2] / "tools" / "plain_words.py"


@pytest.fixture(scope="module")
def findings() -> Callable[[Path], list[tuple[str, str]]]:
    tool = runpy.run_path(str(TOOL))
    return lambda path: list(tool["findings"](path))


@pytest.mark.parametrize(
    ("name", "text", "reasons"),
    [
        ("page.md", f"# What it is\n\n{'word ' * 25}.\n\n    {'code ' * 30}\n", []),
        ("page.md", f"{'word ' * 26}.\n", ["26 words"]),
        ("page.md", f"Keys {'`a`, ' * 25}and so on.\n", ["29 words"]),
        ("page.md", f"Units: {'`a`, ' * 30}`b`.\n", []),
        ("page.md", "It does what it says. What is it?\n", ["what"]),
        ("page.md", f"- {'word ' * 20}.\n- {'word ' * 20}\n", []),
        ("page.md", f"| {'word ' * 20} | what it is |\n|---|---|\n", ["what"]),
        ("code.py", f'"""What {"word " * 24}"""\nX = "short what"\n', []),
        ("code.py", f'"""Say.\n\n{"word " * 26}\n"""\n', ["26 words in a docstring"]),
        ("code.py", f'def f():\n    """{"word " * 26}"""\n', ["26 words in a docstring"]),
        ("code.py", f'def _f():\n    """{"word " * 26}"""\n', []),
        ("code.py", f'"""{"word " * 20}\n\n>>> {"word " * 20}\n{"1 " * 20}\n"""\n', []),
        ("code.py", f'"""{"word " * 20}{"x_1 + E " * 9}(Doe, doi 10.1/{"a " * 9})."""\n', []),
        ("code.py", f'X = f"{{X}} {"word " * 26}"\n', ["27 words"]),
        ("code.py", 'X = (\n    "this is what "\n    "readers see"\n)\n', ["what"]),
        ("x.html.j2", "<p>{{ x }} is what it is.</p>\n{# what a comment is #}\n", ["what"]),
    ],
)
def test_tool_finds_long_sentences_and_what(
    name: str,
    text: str,
    reasons: list[str],
    tmp_path: Path,
    findings: Callable[[Path], list[tuple[str, str]]],
) -> None:
    (tmp_path / name).write_text(text, encoding="utf-8")
    assert [reason for reason, _ in findings(tmp_path / name)] == reasons
