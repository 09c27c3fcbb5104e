"""Notebooks as Markdown."""

import json
from typing import Any


def as_markdown(notebook: str) -> str:
    """Return text, code and stored results of a notebook."""
    parts = []
    for cell in json.loads(notebook)["cells"]:
        text = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(text)
            continue
        parts.append(f"```python\n{text}\n```")
        parts += [_output(output) for output in cell["outputs"]]
    return "\n\n".join(parts) + "\n"


def _output(output: dict[str, Any]) -> str:
    """Return a result: a picture, a table, or text."""
    data = output.get("data", {"text/plain": output.get("text", [])})
    if "image/png" in data:
        picture = "".join(data["image/png"]).replace("\n", "")
        return f'<img src="data:image/png;base64,{picture}" alt="figure of the cell above">'
    if "text/html" in data:
        page = (line for line in "".join(data["text/html"]).splitlines() if line.strip())
        return "\n".join(page)  # a blank line would end the HTML
    return f"```text\n{''.join(data['text/plain']).rstrip()}\n```"
