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
        folder = tmp_path_factory.mktemp(page.stem)
        found[page.stem] = pages.run(page, folder), folder
    return found


def test_the_tutorial_says_what_its_programs_find(ran: dict[str, tuple[dict[str, Any], Path]]) -> None:
    names, folder = ran["tutorial"]
    text = (pages.DOCS / "python" / "tutorial.md").read_text("utf-8")
    # The table on the page is the table of the program, number by number.
    for line in str(names["table"]).splitlines():
        assert line.rstrip() in text
    assert "-943.195  2.490  766.709  2.185" in str(names["runs"]["bonded"]) and "-943.195  2.490  766.709  2.185" in text
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


def pictures(page: str) -> set[str]:
    """Pictures that a page shows; all are there."""
    text = (pages.DOCS / "python" / f"{page}.md").read_text("utf-8")
    found = set(re.findall(r"\]\(\.\./images/python/(.*?)\)", text))
    assert found and all((pages.DOCS / "images" / "python" / own).stat().st_size > 10_000 for own in found)
    return found


def written(folder: Path) -> list[str]:
    """Files with the programs of README and pages, and the examples but those of OpenSees, which has no types."""
    texts = {page.stem: pages.programs(page) for page in pages.PAGES}
    *programs, dask = pages.programs(ROOT / "README.md")
    texts.update(readme=programs, dask_sweep=[dask])
    for name, parts in texts.items():
        (folder / f"{name}.py").write_text("\n".join(parts), "utf-8")
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
