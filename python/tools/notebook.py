"""Writes `examples/walkthrough.ipynb`, with its outputs, from the cells of `examples/walkthrough.py`.

    python tools/notebook.py           # writes and runs
    python tools/notebook.py --check   # fails if cells differ, or have no outputs
"""

from __future__ import annotations

import json
import re
import sys
import tempfile
from pathlib import Path
from typing import Any

SOURCE = Path(__file__).parents[1] / "examples" / "walkthrough.py"
NOTEBOOK = SOURCE.with_suffix(".ipynb")


def cells(source: str) -> list[dict[str, Any]]:
    """The cells between the lines that begin with `# %%`."""
    found: list[dict[str, Any]] = []
    for number, part in enumerate(re.split(r"^# %%", source, flags=re.M)[1:]):
        head, _, body = part.partition("\n")
        cell: dict[str, Any] = {"id": f"cell-{number}", "metadata": {}}
        if head.strip() == "[markdown]":
            cell["cell_type"], body = "markdown", re.sub(r"^# ?", "", body, flags=re.M)
        else:
            cell.update(cell_type="code", execution_count=None, outputs=[])
        cell["source"] = body.strip("\n").splitlines(keepends=True)
        found.append(cell)
    return found


def written() -> dict[str, Any]:
    """The notebook without outputs."""
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    notebook_cells = cells(SOURCE.read_text("utf-8"))
    return {"cells": notebook_cells, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


def run(notebook: dict[str, Any]) -> str:
    """The notebook's text after its cells have run, in a folder of their own."""
    import nbformat
    from nbclient import NotebookClient

    node = nbformat.reads(json.dumps(notebook), 4)
    with tempfile.TemporaryDirectory() as folder:
        resources = {"metadata": {"path": folder}}
        NotebookClient(node, timeout=600, record_timing=False, resources=resources).execute()
    for output in (output for cell in node["cells"] for output in cell.get("outputs", ())):
        if output.get("name") == "stderr":
            # Warnings name the place of a temporary file.
            output["text"] = re.sub(r"\S*ipykernel_\S+: ", "", output["text"])
    node["metadata"] = nbformat.from_dict(notebook["metadata"])
    return nbformat.writes(node) + "\n"


def main() -> None:
    """Writes or checks."""
    notebook = written()
    if "--check" not in sys.argv[1:]:
        NOTEBOOK.write_text(run(notebook), "utf-8")
        return
    found = json.loads(NOTEBOOK.read_text("utf-8"))
    outputs = [output for cell in found["cells"] for output in cell.get("outputs", ())]
    for cell in found["cells"]:
        if cell["cell_type"] == "code":
            cell.update(execution_count=None, outputs=[])
    needed = f"python {Path(__file__).parent.name}/{Path(__file__).name} writes it"
    if found != notebook:
        sys.exit(f"{NOTEBOOK.name} is not {SOURCE.name}: {needed}")
    pictures = sum("image/png" in output.get("data", ()) for output in outputs)
    if pictures < 5 or any(output["output_type"] == "error" for output in outputs):
        sys.exit(f"{NOTEBOOK.name} has {pictures} pictures among its outputs: {needed}")


if __name__ == "__main__":
    main()
