"""A run as one page for a report."""

from __future__ import annotations

import base64
import inspect
import io
import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from html import escape
from typing import Any

import numpy as np

from . import _core
from ._animation import film_of
from ._core import DeformedShape, FemModel, Interaction, Record, Run, Simulation, Summary
from ._errors import InputError
from ._figures import axes_for, label_axes, pyplot, was_kept
from ._files import replace
from ._film import player
from ._report_model import model_of, table
from ._shell_moments import plot_shell_moments, shells_of
from ._walls import plot_wall_pressures, walls_of

_STYLE = """
body { font: 15px/1.45 sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; color: #222 }
h1 { font-size: 1.6rem } h2 { font-size: 1.2rem; border-bottom: 1px solid #ccc; margin-top: 2rem }
table { border-collapse: collapse } td, th { padding: .15rem .8rem; text-align: right; border-bottom: 1px solid #eee }
td:first-child, th:first-child { text-align: left } .words td { text-align: left; vertical-align: top }
img { max-width: 100% } pre { line-height: 1.2; overflow-x: auto } .warning { color: #a33 }
.wide { overflow-x: auto } .words td, p { overflow-wrap: anywhere }
.words th { text-align: left } .words td:nth-child(3) { white-space: nowrap }
@media (max-width: 40rem) { body { margin: 1rem auto; padding: 0 .7rem } td, th { padding: .15rem .4rem } }
"""
_LEFT_OUT = {"time", "sliding_safety", "overturning_safety", "overturning_safety_across"}
"""Time series that are left out of the table of peaks."""
_ROUNDING = 1e-6
"""Response on a fixed base, over the one on the ground, that is zero but for rounding."""


def report(
    self: Run,
    path: str | os.PathLike[str],
    simulation: Simulation | None = None,
    *,
    interaction: Interaction | None = None,
    height: float | Sequence[float | None] | None = None,
    title: str = "Earthquake response",
) -> None:
    """Writes the run as one page to the file at ``path``, which any browser opens without a network: pictures are in it.

    The page has the ground motion, the model, warnings, peaks, limits of service and the text of the run; pictures of time
    series, floor spectra of all acceleration probes, pressures on walls below the surface and, with snapshots (``contact_every`` and ``motion_every`` of
    `Simulation.run`), of the contact, the deformed structure, moments of a `FemModel`'s shells and all in motion. The model is a table of all parameters with
    their units and a program that makes the run again, with its arrays as a file that the page holds. A page that cannot
    be written leaves the one before as it was.

    Args:
        path: name of the file, such as "run.html".
        simulation: the simulation of the run, for its motion and model; only what the run knows unless given.
        interaction: peaks on a fixed base, from `Simulation.interaction`; none unless given.
        height: height of the box that stands for a rigid block, m, or a list of one for each structure of a group, as for
            `DeformedShape`; None for structures with a shape of their own.
        title: heading of the page, "Earthquake response" by default.
    """
    pyplot()
    shape = None
    with suppress(InputError):
        if simulation is not None:
            shape = DeformedShape(simulation.structure, height=height, joints=simulation.joints)
    parts = [
        f"<h1>{escape(title)}</h1>",
        "<h2>Ground motion</h2>",
        *_motion(self, simulation),
        *(() if simulation is None else ("<h2>Model</h2>", *model_of(self, simulation, os.path.basename(path)))),
        "<h2>Peaks</h2>",
        *(f'<p class="warning">{escape(text)}</p>' for text in self.warnings),
        _peaks(self, interaction),
        *_service(self),
        *_pictures(self, simulation, shape),
        "<h2>All results</h2>",
        f"<pre>{escape(str(self))}</pre>",
        f"<p>Computed by basemat {_core.__version__}.</p>",
    ]
    sizes = '<meta name="viewport" content="width=device-width, initial-scale=1">'
    heading = f'<meta charset="utf-8">{sizes}<title>{escape(title)}</title><style>{_STYLE}</style>'
    page = f'<!DOCTYPE html>\n<html lang="en"><head>{heading}</head><body>\n' + "\n".join(parts) + "\n</body></html>\n"
    replace(path, page.encode())


def _picture(figure: Any, text: str) -> str:
    """A figure as an image in the page."""
    file = io.BytesIO()
    figure.savefig(file, format="svg")
    pyplot().close(figure)
    data = base64.b64encode(file.getvalue()).decode("ascii")
    return f'<p><img alt="{escape(text)}" src="data:image/svg+xml;base64,{data}"></p>'


def _records(motion: Any) -> dict[str, Record]:
    """Records that a motion was made of, by the names of their directions."""
    if isinstance(motion, Record):
        return {"ground acceleration": motion}
    made = getattr(motion, "_made", None)
    if made is None:
        return {}
    function = made.owner if made.name is None else getattr(made.owner, made.name)
    named = {**dict(zip(inspect.signature(function).parameters, made.arguments)), **made.keywords}
    return {f"ground acceleration, {name}": value for name, value in named.items() if isinstance(value, Record)}


def _motion(run: Run, simulation: Simulation | None) -> Iterator[str]:
    """The ground motion in words, and its records with their spectra."""
    yield f"<p>{escape(run._ground_motion)}</p>"
    records = {} if simulation is None else _records(simulation.motion)
    if not records:
        return
    count = len(records)
    figure, axes = pyplot().subplots(
        count, 2, figsize=(9.0, 0.6 + 2.2 * count), layout="constrained", width_ratios=(2, 1), squeeze=False
    )
    periods = _core.log_spaced(0.05, 4.0, 100)
    for (left, right), (name, record) in zip(axes, records.items()):
        samples = np.asarray(record.accelerations)
        left.plot(record.time_step * np.arange(len(samples)), samples, color="black", linewidth=0.7)
        label_axes(left, "time, s", "m/s²")
        left.set_title(name, fontsize="medium", loc="left")
        record.response_spectrum(periods, 0.05).plot(right, title="spectrum, 5 %")
        right.get_legend().remove()
        right.set_ylabel("m/s²")
    yield _picture(figure, "ground motion")


def _shown(unit: str) -> tuple[float, str]:
    """Factor and unit for the table."""
    if unit[:1] in ("N", "J"):
        return 1e-3, f"k{unit}"
    return {"m": (1e3, "mm"), "rad": (1e3, "mrad"), "": (1.0, "ratio")}.get(unit, (1.0, unit))


def _peaks(run: Run, interaction: Interaction | None) -> str:
    """Largest values with their times, beside those on a fixed base."""
    heads = ["largest value of", "unit", "value", "at s"]
    fixed = None if interaction is None else interaction.on_fixed_base
    if fixed is not None:
        heads += ["fixed base", "ratio"]
    units, rows = run.units, [heads]
    terms = set(run.energy_balance.to_dict())
    for name in (series_name for series_name in units if series_name not in terms | _LEFT_OUT):
        peak = _largest(run, name)
        if peak is None:
            continue
        factor, unit = _shown(units[name])
        row = [name.replace("_", " "), unit, f"{factor * peak.value:.4g}", f"{peak.time:.3f}"]
        if fixed is not None:
            other = _largest(fixed, name)
            row += ["0", ""]
            # Less is rounding, and no ratio says anything.
            if other is not None and abs(other.value) > _ROUNDING * abs(peak.value):
                row[4:] = [f"{factor * other.value:.4g}", f"{abs(peak.value / other.value):.3f}"]
        rows.append(row)
    modes = () if interaction is None else str(interaction).splitlines()
    words = "".join(f"<p>{escape(line)}</p>" for line in modes if "T̃" in line)
    return f"{table(rows)}{words}"


def _service(run: Run) -> Iterator[str]:
    """Limits of service beside the run."""
    if not run.serviceability:
        return
    rows = [["limit of service", "unit", "limit", "largest value", "at s", "of the limit", "exceeded from s", ""]]
    units = {"slip": "m", "gap": "m", "uplifted_fraction": "", "rotation": "rad", "settlement": "m"}
    for check in run.serviceability:
        factor, unit = _shown(units[check.criterion])
        used = 1.0 - check.margin
        rows.append(
            [
                check.criterion.replace("_", " "),
                unit,
                f"{factor * check.limit:.4g}",
                f"{factor * check.largest.value:.4g}",
                f"{check.largest.time:.3f}",
                f"{100.0 * used:.1f} %" if np.isfinite(used) else "",
                "" if check.first_excess is None else f"{check.first_excess:.3f}",
                "met" if check.is_met else "exceeded",
            ]
        )
    yield "<h2>Limits of service</h2>"
    yield table(rows)


def _largest(run: Run, name: str) -> _core.Peak | None:
    """Largest value of a scalar or a probe; None if it never differs from zero."""
    probes = run.probes
    summary: Summary = run
    found = probes[name].largest if name in probes else summary.extremes(name).largest  # type: ignore[arg-type]
    return found if np.isfinite(found.value) and found.value != 0.0 else None


def _pictures(run: Run, simulation: Simulation | None, shape: DeformedShape | None) -> Iterator[str]:
    """Pictures of all that the run recorded."""
    try:
        axes = run.plot()
    except InputError:
        # Without time series there are no pictures.
        return
    yield "<h2>Over time</h2>"
    yield _picture(axes[0].figure, "time series")
    units = run.units
    floors = [name for name in run.probes if units[name] == "m/s²"]
    if floors:
        yield "<h2>Floor spectra, 5 %</h2>"
        [panel] = axes_for(None, 1, figsize=(8.0, 3.6))
        shortest = max(0.02, 10.0 * run.time_step)
        for name in floors:
            run.floor_spectrum(name, _core.log_spaced(shortest, 4.0, 120), 0.05).plot(panel, label=name)
        yield _picture(panel.figure, "floor spectra")
    has_contact, has_motion = was_kept(run, "contact"), was_kept(run, "motion")
    if has_contact and run.in_plan:
        yield "<h2>The base when most of it is open</h2>"
        yield _picture(run.plot_contact_plan().figure, "contact in plan")
    if len(walls_of(run)[0]):
        yield "<h2>Earth pressures on the walls</h2>"
        interface = None if simulation is None else simulation.interface
        yield _picture(plot_wall_pressures(run, interface)[0].figure, "pressures on the walls")
    if shape is not None and has_motion:
        yield "<h2>Largest deformation</h2>"
        moved = [float(np.abs(shape.displacements(displacement)).max()) for displacement in run.motion["displacement"]]
        frame = int(np.argmax(moved))
        text = f"{run.motion['time'][frame]:.2f} s"
        yield _picture(shape.plot(run.motion["displacement"][frame], label=text).figure, "deformed structure")
        structure = None if simulation is None else simulation.structure
        if isinstance(structure, FemModel) and shells_of(structure):
            yield f"<h2>Bending moments of the shells at {text}</h2>"
            state = run.static_displacement + run.motion["displacement"][frame]
            yield _picture(plot_shell_moments(structure, state).figure, "moments of the shells")
    if has_contact:
        yield "<h2>In motion</h2>"
        film = film_of(run, None, shape if has_motion else None, None, 120, None)
        yield player(film)
        pyplot().close(film.figure)
