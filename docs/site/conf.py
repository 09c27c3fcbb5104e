"""The documentation as a site: `make docs` writes build/docs from the Markdown files.

The source folder is the repository, so that every link works on GitHub and on the site alike.
"""

import re
import sys
from pathlib import Path

from sphinx.application import Sphinx

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE))

from docstrings import literal_formulas  # noqa: E402
from notebooks import as_markdown  # noqa: E402

import pyrofit  # noqa: E402

project = "pyrofit"
author = "The pyrofit developers"
copyright = author
version = release = pyrofit.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
root_doc = "README"
include_patterns = [
    "*.md",
    "docs/*.md",
    "docs/verification/*.md",
    "docs/verification/figures/*.md",
    "docs/notebooks/*.ipynb",
    "docs/site/api.md",
    "config/README.md",
    "config/foreign_truth/README.md",
    "config/gpyro_truth/README.md",
]
exclude_patterns = [".*", "build", "results"]
source_suffix = {".md": "markdown", ".ipynb": "markdown"}
myst_heading_anchors = 6
default_role = "code"
autodoc_typehints = "none"
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_rtype = False
highlight_language = "text"

html_theme = "furo"
html_title = f"pyrofit {release}"
html_static_path = ["static"]
html_css_files = ["wide_tables.css"]
html_extra_path = ["extra"]
html_copy_source = False
html_show_sphinx = False


MORE = "```{toctree}\n:caption: More\n:hidden:\n"
"""Pages that have no place in the navigation yet."""


def prepare(app: Sphinx, page: str, source: list[str]) -> None:
    """Make Markdown of a notebook; append the navigation to the first page; turn HTML's anchors."""
    if Path(app.env.doc2path(page)).suffix == ".ipynb":
        source[0] = as_markdown(source[0])
    if page == root_doc:
        navigation = (HERE / "navigation.md").read_text(encoding="utf-8")
        pages = sorted(p.stem for p in (ROOT / "docs").glob("*.md"))
        new = [f"docs/{name}" for name in pages if f"docs/{name}" not in navigation]
        source[0] += "\n" + "\n".join([navigation, MORE, *new, "```"])
    source[0] = re.sub(r'<a id="([\w-]+)"></a>', r"(\1)=", source[0])


def setup(app: Sphinx) -> None:
    """Connect the steps that come before reading."""
    app.connect("source-read", prepare)
    app.connect("autodoc-process-docstring", literal_formulas, priority=100)
