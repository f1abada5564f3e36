"""The model of a run on its page: a table of parameters, and a program that makes the run again."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterator, Sequence
from html import escape

import numpy as np

from ._core import Run, Simulation
from ._parameters import rows_of
from ._program import Program


def table(rows: Sequence[Sequence[str]], kind: str = "") -> str:
    """Rows as a table, the first one its heading; it scrolls where the page is narrower."""
    lines = []
    for number, row in enumerate(rows):
        cell = "td" if number else "th"
        lines.append(f"<tr>{''.join(f'<{cell}>{escape(text)}</{cell}>' for text in row)}</tr>")
    return f'<div class="wide"><table{kind and f" class={kind}"}>{"".join(lines)}</table></div>'


def model_of(run: Run, simulation: Simulation, page: str) -> Iterator[str]:
    """Parameters of all parts with their units, and the program of the run; ``page``: name of the page's file."""
    rows = [("parameter", "value", "unit")]
    arguments = simulation._arguments
    known = {id(arguments[name]): f"the {name}" for name in ("structure", "ground", "motion")}
    for name, value in arguments.items():
        if value is None or isinstance(value, list) and not value:
            continue
        if name == "time_step":
            rows.append(("time step", f"{value:.9g}", "s"))
        else:
            rows += rows_of(name.replace("_", " "), value, known)
    rows.append(("contact elements", f"{len(simulation.elements)}", ""))
    if history := simulation.history_choice:
        rows.append(("history of the ground", history, ""))
    rows.append(("steps", f"{run.steps}", ""))
    yield "<p>SI units. In the plane masses, forces and stiffnesses are per metre of thickness, in plan of the whole body.</p>"
    yield table(rows, "words")
    program = Program(simulation)
    file = f"{page.rpartition('.')[0] or page}_model.npz"
    text = program.text(file) + _call(run, simulation)
    yield "<details><summary>Program that makes this run again</summary>"
    if program.arrays:
        data = io.BytesIO()
        np.savez_compressed(data, **program.arrays)
        encoded = base64.b64encode(data.getvalue()).decode("ascii")
        yield (
            f'<p>Save <a download="{escape(file)}" href="data:application/octet-stream;base64,{encoded}">{escape(file)}</a> '
            "beside the program, which reads its arrays.</p>"
        )
    for missing in program.missing:
        yield f'<p class="warning">The program needs {escape(missing)}, which this page does not hold.</p>'
    yield f'<pre class="program">{escape(text)}</pre></details>'


def _call(run: Run, simulation: Simulation) -> str:
    """Lines that run the simulation."""
    before = round(run.end / simulation.time_step) - run.steps
    first = f"simulation.run({before}, warn=False)\n" if before > 0 else ""
    return f"{first}run = simulation.run({run.steps})\nprint(run)\n"
