"""Results are Rust's, bit for bit."""

from __future__ import annotations

import math
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import same_bits

import basemat as bm
from basemat import containment

SERIES = [
    "time",
    "base_shear",
    "base_moment",
    "normal_force",
    "uplifted_fraction",
    "mean_slip",
    "largest_slip",
    "base_rotation",
    "free_field_horizontal",
    "free_field_vertical",
    "sliding_safety",
    "overturning_safety",
    "roof x",
    "roof y",
    "base shear",
    "sway",
]


@pytest.mark.parametrize("friction", [None, math.inf, 0.2])
def test_containment(reference: Path, friction: float | None) -> None:
    steps = 5000
    name = "bonded" if friction is None else repr(friction)
    command = [str(reference), "containment", name, str(steps)]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    bits = np.array(
        [[int(word, 16) for word in line.split()] for line in text.splitlines()], np.uint64
    )
    rust = bits.view(np.float64)

    run = containment.scene(friction, steps=steps).simulation.run(steps)
    assert rust.shape == (steps + 1, len(SERIES) + 1)
    for column, key in enumerate(SERIES):
        assert same_bits(run[key], np.ascontiguousarray(rust[:, column])), key
    assert same_bits(run.energy_balances["input"], np.ascontiguousarray(rust[:, -1]))
    # It shook, and where it may it opened: zeros would be equal, too.
    assert run.base_shear.magnitude > 1.0e5
    assert (run.uplifted_fraction.value > 0.0) == (friction is not None)


def test_steps_and_runs_are_the_same(rocking) -> None:
    whole = rocking(expected_steps=300)
    run = whole.run(300, motion_every=1)
    parts = rocking(expected_steps=300)
    shears = [parts.state.base_shear]
    shears += [state.base_shear for state in parts.steps(100)]
    shears += list(parts.run(120)["base_shear"][1:])
    shears += [parts.step().base_shear for _ in range(80)]
    assert same_bits(np.array(shears), run["base_shear"])
    assert same_bits(parts.state.displacement, run.motion["displacement"][-1])


def test_python_structure_and_law_give_the_same_bits(soil: bm.Soil, rocking, block) -> None:
    class Own:
        dofs = 3

        def contact_nodes(self):
            return block.contact_nodes()

        def mass(self):
            return block.mass()

        def stiffness(self):
            return np.zeros((3, 3))

    class Friction:
        modes = ("stick", "slip left", "slip right", "open")
        friction_coefficient = 0.4
        law = bm.Coulomb(0.4)

        def conditions(self, mode, start):
            return self.law.conditions(mode, start)

        def next_mode(self, mode, start, trial, tolerance):
            return self.law.next_mode(mode, start, trial, tolerance)

    own = Own()
    expected = rocking(0.4).run(400)
    assert expected.uplifted_fraction.value > 0.2
    for parts in (
        {"structure": own},
        {"ground": bm.ElasticGround.under(soil, own, 8)},
        {"interface": Friction()},
        {"interface": [Friction()] * 8},
        {"interface": bm.VariableFriction(lambda start: 0.4)},
    ):
        run = rocking(0.4, **parts).run(400)
        for key in ("base_shear", "base_moment", "largest_slip", "roof"):
            assert same_bits(run[key], expected[key]), (parts, key)
