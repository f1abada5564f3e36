"""Writes `examples/walkthrough.ipynb`, without outputs, from the cells of `examples/walkthrough.py`.

    python tools/notebook.py           # writes
    python tools/notebook.py --check   # fails if they differ
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

SOURCE = Path(__file__).parents[1] / "examples" / "walkthrough.py"
NOTEBOOK = SOURCE.with_suffix(".ipynb")


def cells(source: str) -> list[dict[str, Any]]:
    """The cells between the lines that begin with `# %%`."""
    found: list[dict[str, Any]] = []
    for number, part in enumerate(re.split(r"^# %%", source, flags=re.M)[1:]):
        head, _, body = part.partition("\n")
        own: dict[str, Any] = {"id": f"cell-{number}", "metadata": {}}
        if head.strip() == "[markdown]":
            own["cell_type"], body = "markdown", re.sub(r"^# ?", "", body, flags=re.M)
        else:
            own.update(cell_type="code", execution_count=None, outputs=[])
        own["source"] = body.strip("\n").splitlines(keepends=True)
        found.append(own)
    return found


def main() -> None:
    """Writes or checks."""
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    notebook = {"cells": cells(SOURCE.read_text("utf-8")), "metadata": {"kernelspec": kernel}}
    text = json.dumps({**notebook, "nbformat": 4, "nbformat_minor": 5}, indent=1, ensure_ascii=False) + "\n"
    if "--check" not in sys.argv[1:]:
        NOTEBOOK.write_text(text, "utf-8")
    elif NOTEBOOK.read_text("utf-8") != text:
        sys.exit(f"{NOTEBOOK.name} is not {SOURCE.name}: python tools/notebook.py writes it")


if __name__ == "__main__":
    main()
