"""The README's programs run, and do what they say."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import basemat as bm

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text("utf-8")
# The program for Dask is tested beside other sweeps on Dask.
PROGRAMS = re.findall(r"```python\n(.*?)```", README.partition("## On Dask")[0], re.S)


@pytest.fixture(scope="module")
def names() -> dict[str, object]:
    """Names that the first program defines."""
    found: dict[str, object] = {}
    exec(PROGRAMS[0], found)
    return found


def test_the_first_program_is_short_and_uplifts(names: dict[str, object]) -> None:
    lines = [line for line in PROGRAMS[0].splitlines() if line.strip()]
    assert len(lines) < 25
    run, spectra = names["run"], names["spectra"]
    assert isinstance(run, bm.Run)
    assert run.uplifted_fraction.value > 0.2
    assert run.energy_error < 1e-9
    assert isinstance(spectra, dict)
    # Short oscillators follow the floor.
    peak = run.probes["roof"].magnitude
    shortest = spectra["roof"].acceleration[0]
    assert peak < shortest < 2.0 * peak


def test_what_the_first_program_needs_comes_with_the_package() -> None:
    """It runs where numpy is all that is installed."""
    others = ("scipy", "pandas", "matplotlib", "distributed")
    without = f"import sys\nsys.modules.update(dict.fromkeys({others!r}))\n"
    done = subprocess.run([sys.executable, "-c", without + PROGRAMS[0]], capture_output=True)
    assert done.returncode == 0, done.stderr.decode()


def test_what_is_missing_is_named_as_pip_knows_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match="need pandas: pip install pandas$"):
        bm.sweep(lambda a: {"b": a}, {"a": [1]})


def test_its_matrices_are_those_of_a_shear_building(names: dict[str, object]) -> None:
    storeys = [bm.Storey(3.0, 20e3, 40e6)] * 5
    building = bm.ShearBuilding(6.0, 50e3, 400e3, storeys)
    model = names["model"]
    assert isinstance(model, bm.MatrixModel)
    np.testing.assert_allclose(model.mass(), building.mass(), rtol=1e-15)
    np.testing.assert_allclose(model.stiffness(), building.stiffness(), rtol=1e-14, atol=1e-6)


def test_the_others_run(
    names: dict[str, object], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Where they save a run.
    monkeypatch.chdir(tmp_path)
    for program in PROGRAMS[1:]:
        exec(program, names)
    table = names["table"]
    assert len(table) == 4 and table["error"].isna().all()  # type: ignore[attr-defined, arg-type]
    polished, soil, model = (names[name] for name in ("Polished", "soil", "model"))
    simulation = bm.Simulation(
        0.005,
        model,  # type: ignore[arg-type]
        bm.ElasticGround.under(soil, model, 6),  # type: ignore[arg-type]
        polished(),  # type: ignore[operator]
        motion=bm.el_centro_1940(),
    )
    assert simulation.run(200).steps == 200
    braced = names["braced"]
    ground = bm.ElasticGround.under(soil, braced, 6)  # type: ignore[arg-type]
    simulation = bm.Simulation(0.005, braced, ground, bm.Coulomb(0.5), motion=bm.el_centro_1940())  # type: ignore[arg-type]
    simulation.run(1000)
    assert simulation.hysteresis[0].slack > 1e-3


def test_the_containments_command_prints_its_table(capsys: pytest.CaptureFixture[str]) -> None:
    from basemat import containment

    containment.main(["--duration", "3", "--friction", "0.2"])
    lines = capsys.readouterr().out.splitlines()
    assert [line[:13].strip() for line in lines[2:5]] == ["bonded", "uplift only", "friction 0.2"]
    assert "\n".join(lines[5:]) == containment.NOTE


def test_every_public_name_has_a_docstring() -> None:
    for name in bm.__all__:
        value = getattr(bm, name)
        if name in ("MODES", "Mode", "STANDARD_GRAVITY"):
            continue
        assert value.__doc__, name
        if (
            isinstance(value, type)
            and value.__module__ == "basemat"
            and not issubclass(value, Exception)
        ):
            for own, member in vars(value).items():
                if not own.startswith("_") and not isinstance(member, int):
                    assert member.__doc__, f"{name}.{own}"
