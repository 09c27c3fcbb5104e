"""Find sentences that readers stumble over: more than 25 words, or a clause with "what".

Run: python tools/plain_words.py [FILE ...]   list the sentences of all files, or of some
     python tools/plain_words.py --check      fail if a file has more than its allowance
     python tools/plain_words.py --lower      lower the allowances to the present counts

Checked are the pages (Markdown), the texts of templates, and the strings of the library that are
longer than four words. A question may begin with "what". Of the docstrings of public modules,
classes and functions only the length of sentences is checked. Their symbols, citations and
examples do not count. Comments are not checked.
"""

import argparse
import ast
import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ALLOWED = Path(__file__).with_name("plain_words.json")
MOST_WORDS = 25
FEWEST_WORDS = 5
"""Shorter strings of the library are keys, not prose."""
_PAGES = ("*.md",)
_LIBRARY = ("src/**/*.py", "src/**/*.html.j2", "src/**/*.yaml.j2")
_LEFT_OUT = ("docs/verification/", "docs/site/")
_WORD = re.compile(r"[\w°%µ²³·/'’+−-]*[A-Za-z0-9][\w°%µ²³·/'’+−-]*")
_END = re.compile(r"(?<=[.!?])[\"')*]*\s+(?=\S)|\n\s*\n")
_EXAMPLE = re.compile(r"^ *>>> .*?(?:\n *\n|\Z)", re.M | re.S)
_CITATION = re.compile(r"\([^()]*\bdoi [^()]*\)|\bdoi \S+")
_PLAIN_WORD = re.compile(r"(?<![\w^.])[A-Za-z]{2,}(?:[-'’][A-Za-z]+)*(?![\w^(])")
"""A word of prose: no symbol of a formula, no name with an underscore, no number."""
_INDENTED = re.compile(r"^\S.*\n(?= {4}\S)|^ {4}.*\n(?=\S)", re.M)
"""The end of a line before one of another indentation, as of the terms of a section."""
_LIST = re.compile(r": CODE(?:,\s+CODE)+(?=\.?\s*\Z)")
_SHORT_FORMS = re.compile(r"\b(e\.g|i\.e|cf|vs|et al|Eqs?|Figs?|No|approx)\.")


def main() -> int:
    """Run the tool; return 1 where a file has more than its allowance."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--lower", action="store_true")
    given = parser.parse_args()
    found = {_name(path): list(findings(path)) for path in given.files or checked_files()}
    counts = {name: len(sentences) for name, sentences in found.items() if sentences}
    if given.lower:
        return lower(counts)
    if given.check:
        return check(counts, found)
    for name, sentences in found.items():
        for why, sentence in sentences:
            print(f"{name}: {why}: {sentence}")
    print(f"{sum(counts.values())} sentences in {len(counts)} files")
    return 0


def checked_files() -> list[Path]:
    """Return the files of the repository that readers see."""
    listed = subprocess.run(
        ["git", "ls-files", "--", *_PAGES, "src"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.splitlines()
    named = [Path(name) for name in listed if not name.startswith(_LEFT_OUT)]
    suffixes = (".md", ".py", ".html.j2", ".yaml.j2")
    return [
        ROOT / path for path in named if path.name.endswith(suffixes) and (ROOT / path).exists()
    ]


def check(counts: dict[str, int], found: dict[str, list[tuple[str, str]]]) -> int:
    """Compare the counts with the allowances, which may only become smaller."""
    allowed = json.loads(ALLOWED.read_text(encoding="utf-8"))
    worse = {name: n for name, n in counts.items() if n > allowed.get(name, 0)}
    for name, n in worse.items():
        print(*(f"{name}: {why}: {sentence}" for why, sentence in found[name]), sep="\n")
        print(f"{name}: {n} such sentences, {allowed.get(name, 0)} allowed; shorten the new ones")
    return int(bool(worse))


def lower(counts: dict[str, int]) -> int:
    """Write the present counts as allowances where they are lower."""
    before = json.loads(ALLOWED.read_text(encoding="utf-8"))
    kept = {name: min(n, counts.get(name, 0)) for name, n in before.items()}
    text = json.dumps({name: n for name, n in sorted(kept.items()) if n}, indent=1)
    ALLOWED.write_text(text + "\n", encoding="utf-8")
    return 0


def findings(path: Path) -> Iterator[tuple[str, str]]:
    """Yield the reason and the sentence of each finding in a file."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        blocks = [s for s in strings(text) if len(_WORD.findall(s)) >= FEWEST_WORDS]
    elif path.suffix == ".md":
        blocks = paragraphs(text)
    else:
        blocks = template_texts(text)
    for block in blocks:
        for sentence in sentences(block):
            words = _WORD.findall(sentence)
            if len(words) > MOST_WORDS:
                yield f"{len(words)} words", sentence
            elif re.search(r"\bwhat\b", sentence, re.I) and not sentence.rstrip("*_").endswith("?"):
                yield "what", sentence
    if path.suffix == ".py":
        yield from long_docstrings(text)


def long_docstrings(source: str) -> Iterator[tuple[str, str]]:
    """Yield the length and the sentence where a docstring has one that is too long."""
    for block in docstrings(source):
        for sentence in sentences(block):
            words = _PLAIN_WORD.findall(sentence)
            if len(words) > MOST_WORDS:
                yield f"{len(words)} words in a docstring", sentence


def sentences(block: str) -> list[str]:
    """Split a block of prose into sentences.

    Inline code counts as a word. So does a list of it after a colon, which is no prose.

    >>> sentences("A `b c` is `d` or `e`. It is f, cf. Fig. 2.")
    ['A CODE is CODE or CODE.', 'It is f, cf Fig 2.']
    >>> sentences("Units: `m`, `mm`, `K`.")
    ['Units: CODE.']
    """
    plain = re.sub(r"`[^`]*`", "CODE", block)
    plain = _LIST.sub(": CODE", plain)
    plain = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", plain)
    plain = re.sub(r"<[^>]*>", " ", plain)
    plain = _SHORT_FORMS.sub(r"\1", plain)
    return [" ".join(part.split()) for part in _END.split(plain) if part.strip()]


def paragraphs(text: str) -> list[str]:
    """Return the paragraphs, list items and cells of a page, without code."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
    text = re.sub(r"^(?: {4}|\t)(?![-*] ).*$", "", text, flags=re.M)
    blocks: list[str] = []
    for part in re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )|\n(?=#)|(?<=\|)\n", text):
        if part.lstrip().startswith("|"):
            blocks += part.replace("\\|", " ").strip().strip("|").split("|")
        elif not part.startswith("#"):
            blocks.append(re.sub(r"^\s*(?:[-*]|\d+\.) ", "", part))
    return blocks


def template_texts(text: str) -> list[str]:
    """Return the texts of a template between its tags; the comments of a study are texts, too."""
    text = re.sub(r"\{%.*?%\}|\{#.*?#\}", "\n\n", text, flags=re.S)
    text = re.sub(r"\{\{.*?\}\}", "CODE", text, flags=re.S)
    text = re.sub(r"</?(?:p|li|div|h\d|td|th|section|summary|button|a)\b[^>]*>", "\n\n", text)
    text = re.sub(r"^\s*# ?", "", text, flags=re.M)
    return re.split(r"\n\s*\n|\n(?=\s*[\w<>.]+:)", text)


def strings(source: str) -> Iterator[str]:
    """Yield the strings of a module, docstrings left out; a value stands as CODE."""
    tree = ast.parse(source)
    inner = {
        id(part)
        for node in ast.walk(tree)
        if isinstance(node, ast.JoinedStr)
        for part in node.values
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            inner.add(id(node.value))
        elif isinstance(node, ast.JoinedStr):
            yield "".join(p.value if isinstance(p, ast.Constant) else "CODE" for p in node.values)
        elif (
            isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in inner
        ):
            yield node.value


def docstrings(source: str) -> Iterator[str]:
    """Yield the paragraphs of the docstrings of public parts of a module."""
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        if not isinstance(node, ast.Module) and node.name.startswith("_"):
            continue
        text = _EXAMPLE.sub("\n\n", ast.get_docstring(node) or "")
        text = _CITATION.sub("", text).replace("``", "`")
        text = _INDENTED.sub(r"\g<0>\n", text)
        yield from re.split(r"\n\s*\n|\n-{3,}\n|\n(?=[-*] )", text)


def _name(path: Path) -> str:
    return path.resolve().relative_to(ROOT).as_posix()


if __name__ == "__main__":
    sys.exit(main())
