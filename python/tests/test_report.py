"""GOAL: the page of a run is whole by itself, and says what the run says.
SCENE: five storeys under El Centro with uplift, their twin on a fixed base; a body in plan; a run alone.
REFERENCE: the run, the interaction and the parts of the simulation themselves; Chromium, where it is installed.
"""

from __future__ import annotations

import base64
import json
import re
import shutil
import subprocess
from html import unescape
from html.parser import HTMLParser
from pathlib import Path

import pytest

import basemat as bm

pytest.importorskip("matplotlib").use("agg")

SOIL = bm.Soil(76e6, 0.33, 1900.0)


class Page(HTMLParser):
    """Tags that are open, and addresses of what the page loads."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.sources: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.sources += [value or "" for name, value in attrs if name in ("src", "href")]
        if tag not in ("meta", "img", "br", "input"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def cells(text: str) -> dict[str, list[str]]:
    """Rows of all tables by their first cell."""
    rows = (re.findall(r"<t[dh]>(.*?)</t[dh]>", row) for row in re.findall(r"<tr>(.*?)</tr>", text))
    return {row[0]: [unescape(own) for own in row[1:]] for row in rows}


def test_a_page_has_motion_model_peaks_pictures_and_film(tmp_path: Path) -> None:
    building = bm.ShearBuilding(8.0, 50e3, 4e5, [bm.Storey(3.0, 20e3, 20e6)] * 3, damping=0.05)
    ground, law = bm.ElasticGround.under(SOIL, building, 8), bm.Coulomb(0.4)
    probes = [bm.Probe.acceleration("roof <top>", building.roof)]
    simulation = bm.Simulation(0.01, building, ground, law, motion=bm.el_centro_1940(), probes=probes)
    assert simulation.ground is ground and simulation.interface is law and isinstance(simulation.motion, bm.Record)
    run = simulation.run(duration=6.0, contact_every=20, motion_every=20)
    twin = simulation.interaction(6.0)
    run.report(tmp_path / "run.html", simulation, interaction=twin, title="Three <storeys>")
    text = (tmp_path / "run.html").read_text("utf-8")
    page = Page(text)
    assert page.open == [] and "Three &lt;storeys&gt;" in text and "<storeys>" not in text
    # All that it loads is in it.
    assert len(page.sources) == 4 and all(own.startswith("data:image/svg+xml;base64,") for own in page.sources)
    assert all(b"</svg>" in base64.b64decode(own.partition(",")[2]) for own in page.sources)
    assert not re.search(r"https?://", text)
    frames = json.loads(re.search(r"const frames = (\[.*?\])", text)[1])  # type: ignore[index]
    assert len(frames) == len(run.contact["time"]) and all(base64.b64decode(own)[1:4] == b"PNG" for own in frames)
    table = cells(text)
    assert table["structure"] == ["ShearBuilding", ""] and table["interface"] == ["Coulomb", ""]
    shear, fixed = run.base_shear.largest, twin.on_fixed_base.base_shear.largest
    assert table["base shear"] == [
        "kN/m", f"{1e-3 * shear.value:.4g}", f"{shear.time:.3f}", f"{1e-3 * fixed.value:.4g}", f"{abs(shear.value / fixed.value):.3f}"
    ]  # fmt: skip
    assert table["roof &lt;top&gt;"][1] == f"{run.probes['roof <top>'].largest.value:.4g}"
    assert table["mean slip"][0] == "mm" and "T̃/T" in text
    assert all(f'<p class="warning">{own}</p>' in unescape(text) for own in run.warnings)
    with pytest.raises(bm.FileError, match="cannot be written"):
        run.report(tmp_path / "no" / "run.html")


def test_pages_in_plan_and_of_a_run_alone(tmp_path: Path) -> None:
    body = bm.RigidBody.cuboid(6.0, 5.0, 12.0, 400.0)
    motion = bm.triaxial(x=bm.el_centro_1940(), y=bm.el_centro_1940().scaled(0.7))
    simulation = bm.Simulation(0.01, body, bm.ElasticGround.under(SOIL, body, 4), bm.Coulomb(0.4), motion=motion)
    run = simulation.run(300, contact_every=50, motion_every=50)
    run.report(tmp_path / "plan.html", simulation, height=12.0)
    text = (tmp_path / "plan.html").read_text("utf-8")
    titles = re.findall("<h2>(.*?)</h2>", text)
    assert titles == [
        "Ground motion", "Model", "Peaks", "Over time", "The base when most of it is open", "Largest deformation", "In motion",
        "All results",
    ]  # fmt: skip
    table = cells(text)
    assert table["torque"][0] == "kN·m" and table["uplifted area"][0] == "m²" and len(table["torque"]) == 3
    alone = simulation.run(5, series=False, warn=False)
    alone.report(tmp_path / "alone.html")
    text = (tmp_path / "alone.html").read_text("utf-8")
    assert re.findall("<h2>(.*?)</h2>", text) == ["Ground motion", "Peaks", "All results"] and not Page(text).sources


BROWSERS = ("chromium", "google-chrome", "google-chrome-stable", "chromium-browser")


def opened(page: Path, profile: Path, milliseconds: int) -> tuple[str, list[str], list[str]]:
    """A page after so long in a browser: its elements, addresses that it loads, texts on its console."""
    browser = next((own for own in BROWSERS if shutil.which(own)), None)
    if browser is None:
        pytest.skip("no Chromium: pages were not opened in a browser")
    log = profile / "requests.json"
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--dump-dom"]
    options += [f"--user-data-dir={profile}", f"--log-net-log={log}", f"--virtual-time-budget={milliseconds}"]
    done = subprocess.run(
        [browser, *options, page.as_uri()], capture_output=True, text=True, encoding="utf-8", timeout=120
    )
    assert done.returncode == 0, done.stderr
    # The browser's own requests have "not an origin" as their initiator, or none.
    requests = re.findall(r'"initiator":"(?!not an origin").*?"url":"(.*?)"', log.read_text("utf-8"))
    outside = [own for own in requests if not own.startswith(("file:", "data:"))]
    return done.stdout, outside, [line for line in done.stderr.splitlines() if "CONSOLE" in line]


def test_a_browser_plays_a_page_without_network(tmp_path: Path) -> None:
    block = bm.RigidBlock(3.0, 9.0, 2000.0)
    ground = bm.ElasticGround.under(SOIL, block, 8)
    simulation = bm.Simulation(0.01, block, ground, bm.Coulomb(0.4), motion=bm.el_centro_1940())
    run = simulation.run(300, contact_every=10, motion_every=10)
    page = tmp_path / "run.html"
    run.report(page, simulation, height=9.0)
    film = re.compile(r'<img id="film"[^>]*src="(data:image/png;base64,[^"]+)"')
    frames = []
    for milliseconds in (100, 1500):
        elements, outside, console = opened(page, tmp_path / str(milliseconds), milliseconds)
        assert outside == [] and console == []
        frames += film.findall(elements)
    assert len(frames) == 2 and frames[0] != frames[1]
    # What the test looks for is seen where it is.
    bad = tmp_path / "bad.html"
    bad.write_text('<img src="http://127.0.0.1:9/picture.png"><script>missing()</script>', "utf-8")
    _, outside, console = opened(bad, tmp_path / "bad", 100)
    assert outside == ["http://127.0.0.1:9/picture.png"] and "missing is not defined" in console[0]
