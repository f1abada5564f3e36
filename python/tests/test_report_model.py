"""GOAL: a reviewer repeats the run from its page, and reads the page on a phone.
SCENE: storeys on layers, matrices on springs, a raft of shells with a law of the user's; records, loads, options.
REFERENCE: the run itself, to the last bit; the widths that Chromium finds.
"""

from __future__ import annotations

import base64
import os
import re
import shutil
import subprocess
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_report import BROWSERS, SOIL, cells

import basemat as bm

pytest.importorskip("matplotlib").use("agg")

RECORD = bm.el_centro_1940().scaled(0.8)


class Sliding:
    """Friction that a user wrote."""

    modes = ("stick", "slip_left", "slip_right", "open")

    def __init__(self, friction: float) -> None:
        self.friction = friction
        self.law = None

    def limits(self, start: bm.PreviousContact) -> bm.Limits:
        return bm.Limits(friction=self.friction)


def storeys() -> bm.Simulation:
    building = bm.ShearBuilding(8.0, 50e3, 4e5, [bm.Storey(3.0, 20e3, 20e6)] * 3 + [bm.Storey(2.5, 15e3, 20e6)], damping=0.05)
    probes = [bm.Probe.acceleration("roof", building.roof), bm.Probe.displacement("drift", {3: 1.0, 4: -1.0})]
    return bm.Simulation(
        0.01,
        building,
        bm.ElasticGround.under(bm.SoilProfile([bm.SoilLayer(bm.Soil(40e6, 0.3, 1800.0), 3.0)], SOIL), building, 8),
        bm.Cohesive(50e3, 80e3, 0.4),
        motion=bm.vertical_incidence(RECORD, bm.el_centro_1940()),
        loads=[bm.Load.constant(building.roof, 3e3)],
        probes=probes,
        solver=bm.SolverOptions(scheme=bm.TimeScheme.newmark(0.6, beta=0.3025), coordinates="physical"),
        service_limits=bm.ServiceLimits(slip=0.005, rotation=0.1),
    )


def matrices() -> bm.Simulation:
    turned = np.hstack([[[-1.0, 0.0, 3.0]] + 5 * [[0.0, 0.0, 3.0]], np.eye(6) - np.eye(6, k=-1)])
    stiffness = 40e6 * turned.T @ turned
    mass = np.diag([50e3, 150e3, 400e3] + 6 * [20e3])
    model = bm.MatrixModel(mass, stiffness, bm.BaseNode.rigid_base(-3.0, 3.0, [0, 1, 2]), damping=0.004 * stiffness)
    ground = bm.SpringGround(bm.Strip(-3.0, 3.0, 8), 4e7, 3e7, dashpots=(4e5, 3e5))
    return bm.Simulation(0.01, model, ground, bm.Coulomb(0.5), motion=RECORD, fixed_base=False)


def raft() -> bm.Simulation:
    mesh, line, concrete = bm.Mesh.in_space(), np.linspace(-3.0, 3.0, 4), bm.Material(30e9, 0.2, 2500.0)
    x, y = np.meshgrid(line, line)
    mesh.add_shells(mesh.add_grid(np.stack([x, y, 0.0 * x], axis=2)).cells, concrete, 0.6)
    foot, top = mesh.node_at(1.0, 1.0), mesh.add_node(1.0, 1.0, 8.0)
    mesh.add_space_beams([[foot, top]], concrete, bm.BeamSection(1.0, (0.1, 0.1), 0.15), (1.0, 0.0, 0.0))
    mesh.add_mass(top, 30e3)
    model = bm.FemModel(mesh)
    motion = bm.triaxial(x=RECORD, y=bm.el_centro_1940())
    return bm.Simulation(0.01, model, bm.ElasticGround.under(SOIL, model, 4), Sliding(0.3), motion=motion)


def program_of(page: str, folder: Path) -> str:
    """The program of a page, beside which its file of arrays is saved."""
    for name, data in re.findall(r'<a download="([^"]+)" href="data:application/octet-stream;base64,([^"]+)"', page):
        (folder / name).write_bytes(base64.b64decode(data))
    [program] = re.findall(r'<pre class="program">(.*?)</pre>', page, re.S)
    return unescape(program)


@pytest.mark.parametrize("scene", [storeys, matrices, raft])
def test_the_program_of_a_page_makes_the_run_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, scene: Any) -> None:
    simulation = scene()
    simulation.run(20, warn=False)
    run = simulation.run(150, warn=False)
    run.report(tmp_path / "run.html", simulation)
    page = (tmp_path / "run.html").read_text("utf-8")
    program = program_of(page, tmp_path)
    assert "which this page does not hold" not in page
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(program, names)
    again = names["run"]
    assert again.steps == 150 and again.end == run.end and set(again.series) == set(run.series)
    for name, values in run.series.items():
        np.testing.assert_array_equal(again.series[name], values)
    assert float(np.abs(run.series["base_shear"]).max()) > 1e3


def test_every_parameter_stands_in_the_table_with_its_unit(tmp_path: Path) -> None:
    simulation = storeys()
    run = simulation.run(400, warn=False)
    run.report(tmp_path / "run.html", simulation)
    page = (tmp_path / "run.html").read_text("utf-8")
    table = cells(page)
    for name, row in {
        "time step": ["0.01", "s"],
        "structure": ["ShearBuilding", ""],
        "structure: width": ["8", "m"],
        "structure: base mass": ["50000", "kg/m"],
        "structure: base inertia": ["400000", "kg m²/m"],
        "structure: damping": ["0.05", ""],
        "structure: storeys 0 to 2: stiffness": ["20000000", "N/m"],
        "structure: storeys 3: height": ["2.5", "m"],
        "interface: tension": ["50000", "Pa"],
        "interface: cohesion": ["80000", "Pa"],
        "interface: friction": ["0.4", ""],
        "ground: count": ["8", ""],
        "ground: structure": ["the structure", ""],
        "ground: soil: layers 0: thickness": ["3", "m"],
        "ground: soil: bedrock: density": ["1900", "kg/m³"],
        "motion: horizontal: time step": ["0.02", "s"],
        "solver: scheme: gamma": ["0.6", ""],
        "service limits: slip": ["0.005", "m"],
        "service limits: rotation": ["0.1", "rad"],
    }.items():
        assert table.get(name) == row, (name, table.get(name), [own for own in table if own.startswith(name.split(":")[0])])
    [slip, rotation] = run.serviceability
    assert table["slip"][:2] == ["mm", "5"] and table["slip"][-1] == ("met" if slip.is_met else "exceeded")
    assert table["rotation"][:2] == ["mrad", "100"] and table["rotation"][-1] == "met"


def test_what_a_program_cannot_say_is_said(tmp_path: Path) -> None:
    block = bm.RigidBlock(6.0, 9.0, 1000.0)
    motion = bm.free_field(acceleration=lambda t: 0.4 * np.sin(6.0 * t), time_step=0.01, duration=2.0)
    simulation = bm.Simulation(0.01, block, bm.ElasticGround.under(SOIL, block, 4), bm.Coulomb(0.5), motion=motion)
    run = simulation.run(20, warn=False)
    run.report(tmp_path / "run.html", simulation)
    page = unescape((tmp_path / "run.html").read_text("utf-8"))
    assert "The program needs the function <lambda> of the argument motion, which this page does not hold." in page


def test_no_ratio_to_what_is_zero_but_for_rounding(tmp_path: Path) -> None:
    """The base of a building on a fixed base rotates by rounding alone."""
    building = bm.ShearBuilding(8.0, 50e3, 4e5, [bm.Storey(3.0, 20e3, 20e6)] * 3, damping=0.05)
    ground = bm.ElasticGround.under(SOIL, building, 8)
    probe = bm.Probe.displacement("turn", building.dof("base_rotation"), unit="rad")
    simulation = bm.Simulation(0.01, building, ground, bm.Coulomb(0.4), motion=RECORD, probes=[probe])
    run, twin = simulation.run(300, warn=False), simulation.interaction(3.0)
    run.report(tmp_path / "run.html", simulation, interaction=twin)
    table = cells((tmp_path / "run.html").read_text("utf-8"))
    ratios = [float(row[4]) for row in table.values() if len(row) == 5 and re.fullmatch(r"[\d.]+", row[4])]
    assert len(ratios) > 3 and max(ratios) < 1e4
    assert table["turn"][3:] == ["0", ""]
    assert not re.search(r"\d{7}\.\d{3}", str(twin))


def test_a_page_that_cannot_be_written_leaves_the_one_before(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = matrices().run(10, series=False, warn=False)
    for write, name in ((run.report, "run.html"), (run.save, "run.basemat")):
        path = tmp_path / name
        write(path)
        before = path.read_bytes()

        def full(*_: object) -> None:
            raise OSError(28, "No space left on device")

        with monkeypatch.context() as patched:
            patched.setattr(os, "fsync", full)
            with pytest.raises(bm.FileError, match=rf"{name} cannot be written: No space"):
                write(path)
        assert path.read_bytes() == before
        assert sorted(own.name for own in tmp_path.glob(f"{name}*")) == [name]


def test_nothing_is_wider_than_a_phone(tmp_path: Path) -> None:
    browser = next((own for own in BROWSERS if shutil.which(own)), None)
    if browser is None:
        pytest.skip("no Chromium: the page was not opened in a browser")
    simulation = storeys()
    run = simulation.run(300, contact_every=50, motion_every=50, warn=False)
    page = tmp_path / "run.html"
    run.report(page, simulation, interaction=simulation.interaction(3.0))
    text = page.read_text("utf-8")
    # A frame as wide as a phone: headless windows have a least width of their own.
    script = (
        "<script>onload = () => { const inner = document.getElementById('phone').contentDocument;"
        "document.title = inner.documentElement.scrollWidth; }</script>"
    )
    outer = tmp_path / "outer.html"
    inner = text.replace("&", "&amp;").replace('"', "&quot;")
    outer.write_text(f'<iframe id="phone" width="390" height="800" style="border: 0" srcdoc="{inner}"></iframe>{script}', "utf-8")
    command = [browser, "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom", f"--user-data-dir={tmp_path / 'user'}"]
    done = subprocess.run(
        [*command, "--virtual-time-budget=2000", outer.as_uri()], capture_output=True, text=True, encoding="utf-8", timeout=120
    )
    [width] = re.findall(r"<title>(\d+)</title>", done.stdout)
    assert int(width) <= 390 and 'name="viewport" content="width=device-width' in text
