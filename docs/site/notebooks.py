"""Notebooks as Markdown."""

import json


def as_markdown(notebook: str) -> str:
    """Return text and code of a notebook; notebooks are stored without results."""
    parts = []
    for cell in json.loads(notebook)["cells"]:
        text = "".join(cell["source"])
        parts.append(text if cell["cell_type"] == "markdown" else f"```python\n{text}\n```")
    return "\n\n".join(parts) + "\n"
