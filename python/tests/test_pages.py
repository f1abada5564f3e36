"""GOAL: programs of the documents run, say what the pages say, and pass strict type checkers.
SCENE: the tutorial and the guide in Python, the README, the examples.
REFERENCE: numbers that the pages quote; mypy and, where it is installed, pyright.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import basemat as bm

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tools"))
import pages  # noqa: E402

pytestmark = pytest.mark.filterwarnings("ignore::basemat.BasematWarning")


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[dict[str, Any], Path]]:
    """Names that the programs of each page leave, and the folder of its files."""
    for module in ("matplotlib", "pandas"):
        pytest.importorskip(module)
    found = {}
    for page in pages.PAGES:
        if page.stem.startswith("opensees") and not has_opensees():
            continue
        folder = tmp_path_factory.mktemp(page.stem)
        found[page.stem] = pages.run(page, folder), folder
    return found


def has_opensees() -> bool:
    """Whether OpenSees is there, with the system's BLAS."""
    try:
        import openseespy.opensees  # noqa: F401
    except (ImportError, RuntimeError):
        return False
    return True


def test_the_tutorial_says_what_its_programs_find(ran: dict[str, tuple[dict[str, Any], Path]]) -> None:
    names, folder = ran["tutorial"]
    text = (pages.DOCS / "tutorial.md").read_text("utf-8")
    # The table on the page is the table of the program, number by number.
    for line in str(names["table"]).splitlines():
        assert line.rstrip() in text
    # The page that the first program prints is shown line by line.
    printed = str(names["runs"]["bonded"]).splitlines()
    shown = text.split("```text\n")[1].split("```")[0].splitlines()
    assert len(shown) > 10 and [own for own in shown if own not in printed and own != "…"] == []
    assert names["refinements"]["slip"].extrapolated[0] == pytest.approx(6.0603e-2, rel=1e-4)
    run, shaken = names["run"], names["shaken"]
    assert isinstance(run, bm.Run) and run.uplifted_fraction.value == pytest.approx(0.58, abs=0.01)
    assert run.probes["shear of the columns"].magnitude == pytest.approx(2.31e6, abs=0.01e6)
    assert run.energy_error < 1e-9 and shaken.structure is names["model"]
    assert {own.name for own in folder.iterdir()} == {*pictures("tutorial"), "raft.html"}


def test_the_guides_parts_work(ran: dict[str, tuple[dict[str, Any], Path]]) -> None:
    names, folder = ran["guide"]
    assert names["table"]["error"].isna().all() and len(names["table"]) == 6
    assert 0.5 < names["ratio"] < 0.9 and names["anchored"].hysteresis[0].slack > 1e-3
    assert names["softened"].surface.peak_acceleration < names["linear"].peak_acceleration
    assert {own.name for own in folder.iterdir()} == {*pictures("guide"), "tower.html"}


def test_each_page_of_the_gallery_draws_its_picture(ran: dict[str, tuple[dict[str, Any], Path]]) -> None:
    gallery = sorted(own.stem for own in (pages.DOCS / "gallery").glob("*.md"))
    assert len(gallery) == 17
    listed = (pages.DOCS / "gallery.md").read_text("utf-8")
    for page in gallery:
        assert f"(gallery/{page}.md)" in listed
        assert pictures(f"gallery/{page}") == {f"{page}.png"}
        if page in ran:
            assert {own.name for own in ran[page][1].iterdir()} == {f"{page}.png"}
    assert len(ran["fragility"][0]["table"]) == 200 and ran["fragility"][0]["table"]["error"].isna().all()
    assert len(ran["fragility"][0]["analysis"]) < 150
    # Both methods have the same curve within its errors.
    stripes, capacities = ran["fragility"][0]["stripes"], ran["fragility"][0]["capacities"]
    assert abs(np.log(stripes.median / capacities.median)) < 2.0 * stripes.log_median_error
    yielding = ran["yielding"][0]
    assert f"reaches {1e-3 * yielding['linear_stress']:.0f} kPa" in (pages.DOCS / "gallery" / "yielding.md").read_text("utf-8")
    assert 35e3 < max(yielding["stress"]) < 40e3
    stacked, cap = ran["stacked_blocks"][0], ran["free_cap"][0]
    assert stacked["base_slips"][0] < stacked["base_slips"][2]
    for upright, expected in cap["quarters"].values():
        assert upright == pytest.approx(expected, rel=0.02)
    # The weak column yields, the strong one lifts its footing.
    weak, strong = ran["fiber_column"][0]["results"].values()
    assert np.abs(weak[0]).max() > 3.0 * np.abs(strong[0]).max() and np.abs(strong[1]).max() > 1.8 * np.abs(weak[1]).max()
    # Wide footings let the hinges yield, narrow ones lift off.
    (wide, narrow), rotations = ran["push_over"][0]["curves"].values(), list(ran["push_over"][0]["rotations"].values())
    assert wide.load_factor.max() == pytest.approx(400e3, rel=0.02) and narrow.load_factor.max() < 0.9 * wide.load_factor.max()
    assert wide.cause is None and narrow.cause is None and rotations[0] > 0.01 > 100.0 * rotations[1]
    incoherent = ran["incoherent"][0]
    assert incoherent["twists"][0] < 1e-6 < 0.5 < min(incoherent["twists"][1:])
    assert incoherent["run"].buoyancy == pytest.approx(1000.0 * bm.STANDARD_GRAVITY * 4.0 * 900.0, rel=1e-6)
    near_field = ran["near_field"][0]
    assert near_field["moments"]["yielding"] < 1.1 * near_field["capacity"] < 1.5 * near_field["moments"]["linear"]
    film = ran["law"][0]["film"]
    assert film.energy_error < 1e-9 and film.energy_balance.contact > 0.5 * film.energy_balance.input
    assert ran["hysteresis"][0]["columns"].path > 0.05 and ran["cask"][0]["run"].uplifted_fraction.value > 0.3


def test_the_basement_has_the_numbers_of_the_example_in_rust(ran: dict[str, tuple[dict[str, Any], Path]]) -> None:
    names, _ = ran["basement"]
    below, above, wall = names["below"], names["above"], names["wall"]
    text = " ".join((ROOT.parent / "examples" / "README.md").read_text("utf-8").split())
    rotations, drifts = (
        [f"{1e3 * own.magnitude:.{digits}f}" for own in both]
        for both, digits in (
            ((below.base_rotation, above.base_rotation), 2),
            ((below.probes["drift"], above.probes["drift"]), 1),
        )
    )
    thrusts = [f"{1e-3 * own:.0f}" for own in (wall["thrust"].max(), wall["thrust"][0])]
    assert f"rotates by {rotations[0]} mrad instead of {rotations[1]} on the surface" in text
    assert f"drifts by {drifts[0]} mm instead of {drifts[1]}." in text
    assert f"increases from {thrusts[1]} kN/m at rest to {thrusts[0]}, and" in text and wall["open_fraction"].max() == 1.0
    assert max(below.energy_error, above.energy_error) < 1e-9
    page = (pages.DOCS / "gallery" / "basement.md").read_text("utf-8")
    assert all(f"{own} " in page for own in (*rotations, *drifts, *thrusts))


def test_the_site_has_no_warnings(tmp_path: Path) -> None:
    for module in ("mkdocs", "material", "mkdocstrings"):
        pytest.importorskip(module)
    # Warnings are errors in its settings.
    checked(["-m", "mkdocs", "build", "--quiet", "--site-dir", str(tmp_path)])
    names = {own.relative_to(tmp_path).as_posix() for own in tmp_path.rglob("*.html")}
    assert {"index.html", "tutorial.html", "gallery/cask.html", "reference.html", "reference/basemat.opensees.html"} <= names
    check_reference(tmp_path / "reference")
    for page in ("tutorial.html", "guide.html"):
        assert 'href="warnings.html"' in (tmp_path / page).read_text("utf-8")
    warnings = (tmp_path / "warnings.html").read_text("utf-8")
    assert warnings.count("<tr>") > 20 and "TimeScheme.midpoint()" in warnings and ">Midpoint<" not in warnings
    assert 'src="../images/cask.png"' in (tmp_path / "gallery" / "cask.html").read_text("utf-8")


def check_reference(folder: Path) -> None:
    """Each name has a page with its members, and with links to other pages."""
    for name in bm.__all__:
        value = getattr(bm, name)
        page = folder / ("functions" if callable(value) and not isinstance(value, type) else "") / f"{name}.html"
        text = page.read_text("utf-8")
        assert "<header" in text and f'id="basemat.{name}"' in text, name
    run = (folder / "Run.html").read_text("utf-8")
    assert 'id="basemat.Run.plot"' in run and 'href="BasematWarning.html' in run
    simulation = (folder / "Simulation.html").read_text("utf-8")
    assert "fixed_base" in simulation.partition("</pre>")[0]
    assert 'href="../reference.html"' in simulation and 'href="../index.html"' in simulation
    # No text is left as it stands in the source.
    assert re.findall(r":(?:class|meth|attr|func|data):", run + simulation) == []


def pictures(page: str) -> set[str]:
    """Pictures that a page shows; all are there."""
    own = pages.DOCS / f"{page}.md"
    found = set(re.findall(r"\]\((\S+\.png)\)", own.read_text("utf-8")))
    assert found and all((own.parent / name).stat().st_size > 10_000 for name in found)
    return {Path(name).name for name in found}


def written(folder: Path) -> list[str]:
    """Files with the programs of README and pages, and the examples but those of OpenSees, which has no types."""
    texts = {page.stem: pages.programs(page) for page in pages.PAGES if not page.stem.startswith("opensees")}
    *programs, dask = pages.programs(ROOT / "README.md")
    texts.update(readme=programs, dask_sweep=[dask])
    for name, parts in texts.items():
        (folder / f"page_{name}.py").write_text("\n".join(parts), "utf-8")
    examples = (own for own in (ROOT / "examples").glob("*.py") if "opensees" not in own.name)
    return [str(own) for own in (*sorted(folder.glob("*.py")), *sorted(examples))]


def test_programs_pass_mypy(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    # Dask's own functions have no types.
    options = ["--strict", "--untyped-calls-exclude", "distributed", "--config-file", str(ROOT / "pyproject.toml")]
    checked(["-m", "mypy", *options, *written(tmp_path)])


def test_programs_pass_pyright(tmp_path: Path) -> None:
    pytest.importorskip("pyright")
    checked(["-m", "pyright", "--pythonpath", sys.executable, *written(tmp_path)])


def checked(command: list[str]) -> None:
    done = subprocess.run([sys.executable, *command], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
