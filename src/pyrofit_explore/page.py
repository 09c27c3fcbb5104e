"""The page as one file: markup, style and script together, nothing from elsewhere."""

import json
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any


def page(data: Mapping[str, Any], nonce: str = "") -> str:
    """Return the page.

    Parameters
    ----------
    data
        Content of a page without a server; empty for a page that asks its server.
    nonce
        Word that a server's policy asks of scripts and styles.
    """
    text = json.dumps(data, ensure_ascii=False, allow_nan=False).replace("</", "<\\/")
    filled = _read("page.html").replace("NONCE", nonce)
    scripts = _read("plot.js") + _read("page.js")
    return (
        filled.replace("STYLE", _read("page.css")).replace("SCRIPT", scripts).replace("DATA", text)
    )


@cache
def _read(name: str) -> str:
    return files("pyrofit_explore").joinpath(name).read_text(encoding="utf-8")
