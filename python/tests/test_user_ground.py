"""GOAL: a ground written in Python acts as a ground of the package.
SCENE: a bed of springs and dashpots, under blocks in the plane, in plan and in a trench.
REFERENCE: `SpringGround`, the same bed in Rust; the energy balance; checkpoints of the same run.
"""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from conftest import same_bits

import basemat as bm
from basemat import _pickling

BLOCK = bm.RigidBlock(6.0, 9.0, 1000.0)
STRIP = bm.Strip(-3.0, 3.0, 8, grading="uniform")
STIFFNESS, DASHPOTS = (30e6, 20e6), (4e5, 3e5)


class Unsaved:
    """Springs and dashpots under each element, by the midpoint rule."""

    fails_after = 10**9

    def __init__(self, elements: object = STRIP, count: int = 8, directions: int = 2) -> None:
        self.elements = elements
        tangents = directions - 1
        self.stiffness = np.repeat([STIFFNESS[0], *[STIFFNESS[1]] * tangents], count)
        self.dashpot = np.repeat([DASHPOTS[0], *[DASHPOTS[1]] * tangents], count)
        self.steps = 0

    def static_compliance(self) -> np.ndarray:
        return np.diag(1.0 / self.stiffness)

    def step_compliance(self, time_step: float) -> np.ndarray:
        self.displacement = np.zeros(len(self.stiffness))
        self.impedance = 0.5 * self.stiffness + self.dashpot / time_step
        return np.diag(1.0 / self.impedance)

    def kept(self) -> np.ndarray:
        return (self.impedance - self.stiffness) / self.impedance * self.displacement

    def advance(self, traction: np.ndarray) -> np.ndarray:
        self.steps += 1
        if self.steps > self.fails_after:
            raise ArithmeticError("the bed")
        self.displacement = self.kept() + traction / self.impedance
        return self.kept()


class Bed(Unsaved):
    """The bed, for checkpoints too."""

    def save(self) -> np.ndarray:
        return self.displacement

    def restore(self, values: np.ndarray) -> None:
        self.displacement = values


class Helped(bm.SpringDashpots):
    """The bed by the class of the package."""

    elements = STRIP

    def __init__(self, dashpots: bool = True) -> None:
        super().__init__(np.repeat(STIFFNESS, 8), np.repeat(DASHPOTS, 8) if dashpots else None)


class FirstOrder(Helped):
    """Springs that follow the traction of the step: s₁ = τ/k."""

    def step_compliance(self, time_step: float) -> np.ndarray:
        return self.static_compliance()

    def advance(self, traction: np.ndarray) -> np.ndarray:
        return np.zeros_like(traction)


def springs() -> bm.SpringGround:
    return bm.SpringGround(STRIP, *STIFFNESS, dashpots=DASHPOTS)


KEYS = ("base_shear", "base_moment", "largest_slip", "uplifted_fraction")


def test_springs_in_python_have_the_bits_of_the_packages(rocking) -> None:
    bed = Bed()
    simulation = rocking(ground=bed)
    found, expected = simulation.run(400), rocking(ground=springs()).run(400)
    assert expected.uplifted_fraction.value > 0.2 and expected.largest_slip.value > 1e-3
    for key in KEYS:
        assert same_bits(found[key], expected[key]), key
    assert found.energy_error < 1e-9
    # A copy of its own.
    assert simulation.ground is not bed and simulation.ground.steps == 400 and bed.steps == 0
    assert simulation.elements == rocking(ground=springs()).elements
    assert simulation.history_choice is None


@pytest.mark.parametrize("dashpots", [True, False])
def test_springs_and_dashpots_of_the_package_in_a_ground_of_one_s_own(rocking, dashpots: bool) -> None:
    own = bm.SpringGround(STRIP, *STIFFNESS, dashpots=DASHPOTS if dashpots else None)
    found, expected = rocking(ground=Helped(dashpots)).run(400), rocking(ground=own).run(400)
    for key in KEYS:
        assert same_bits(found[key], expected[key]), key
    simulation = rocking(ground=Helped(dashpots))
    first = simulation.run(100)["base_shear"]
    checkpoint = simulation.checkpoint()
    other = rocking(ground=Helped(dashpots))
    other.resume(checkpoint)
    assert same_bits(np.concatenate([first, other.run(300)["base_shear"][1:]]), expected["base_shear"])


def test_springs_and_dashpots_are_checked() -> None:
    for stiffness, dashpots, words in (
        ([1e6, 2e6], [1.0], r"shapes \(2,\) and \(1,\)"),
        ([[1e6]], None, r"shapes \(1, 1\)"),
        ([1e6, 0.0], None, "stiffness 0.0, but all must be finite and above zero"),
        ([1e6, np.nan], None, "stiffness nan"),
        ([1e6, 2e6], [0.0, -1.0], "dashpots -1.0"),
    ):
        with pytest.raises(ValueError, match=words):
            bm.SpringDashpots(stiffness, dashpots)


def test_energy_of_springs_returns_and_a_ground_of_first_order_is_named() -> None:
    def run(ground: object) -> bm.Run:
        # A bonded block that starts upwards, without weight.
        initial = bm.InitialConditions(gravity=0.0, velocity=[0.0, 0.1, 0.0])
        simulation = bm.Simulation(0.002, BLOCK, ground, bm.Bonded(), initial=initial)  # type: ignore[arg-type]
        return simulation.run(1000, warn=False)

    def soil_in_the_end(found: bm.Run) -> np.ndarray:
        energies = found.energy_balances
        return energies["soil"][-200:] / energies["input"][-1]

    kept, lost = run(Helped(dashpots=False)), run(FirstOrder(dashpots=False))
    assert soil_in_the_end(kept).min() < 0.02 and soil_in_the_end(kept).max() > 0.98
    assert soil_in_the_end(lost).min() > 0.9 and lost.energy_error < 1e-9
    assert [own for own in lost.warnings if own.startswith("ground of first order")]
    assert not [own for own in kept.warnings if own.startswith("ground of first order")]
    assert not [own for own in run(Helped()).warnings if own.startswith("ground of first order")]


def test_a_table_for_one_step_runs(rocking) -> None:
    class Table(Bed):
        def step_compliance(self, time_step: float) -> np.ndarray:
            if time_step != 0.01:
                raise ArithmeticError("a table for 10 ms")
            return super().step_compliance(time_step)

    found = [rocking(ground=ground).run(50)["base_shear"] for ground in (Table(), Bed())]
    assert same_bits(*found)


def test_in_plan_and_in_a_trench() -> None:
    body = bm.RigidBody.cuboid(6.0, 4.0, 8.0, 500.0)
    plan = bm.Plan([(-3.0, -2.0), (3.0, -2.0), (3.0, 2.0), (-3.0, 2.0)], 4).without_overhang()
    record = bm.el_centro_1940()
    motion = bm.triaxial(record, record.scaled(0.8))
    bed, own = Bed(plan, len(plan), 3), bm.SpringGround(plan, *STIFFNESS, dashpots=DASHPOTS)
    runs = [bm.Simulation(0.01, body, ground, bm.Coulomb(0.25), motion=motion).run(200) for ground in (bed, own)]
    assert same_bits(runs[0]["base_moment"], runs[1]["base_moment"]) and runs[0].in_plan
    # Walls on springs hold a block back that slides without them.
    block = bm.RigidBlock(12.0, 20.0, 900.0)
    trench = bm.Trench(-6.0, 6.0, 5.0).elements(4, 2)
    simulation = bm.Simulation(
        0.01,
        bm.WithWalls(block, 5.0),
        Bed(trench, 8),
        bm.Coulomb(0.5),
        loads=[bm.Load(0, lambda time: 1.5e6 * min(time, 1.0))],
    )
    pushed = simulation.run(200, contact_every=1)
    thrust = pushed.faces["right_wall"]["thrust"]
    assert pushed.energy_error < 1e-9 and thrust[0] == 0.0 and thrust[-1] > 1e5
    assert pushed.faces["left_wall"]["open_fraction"][-1] == 1.0


def test_checkpoints_and_runs_beyond_the_expected_steps(rocking) -> None:
    whole = rocking(ground=Bed()).run(300)["base_shear"]
    simulation = rocking(ground=Bed(), solver=bm.SolverOptions(expected_steps=50))
    first = simulation.run(120)["base_shear"]
    checkpoint = pickle.loads(pickle.dumps(simulation.checkpoint()))
    second = simulation.run(180)["base_shear"]
    assert same_bits(np.concatenate([first, second[1:]]), whole)
    other = rocking(ground=Bed())
    other.resume(checkpoint)
    assert same_bits(other.run(180)["base_shear"], second)
    simulation.reset()
    assert same_bits(simulation.run(120)["base_shear"], first)


def test_a_bed_without_save_runs_but_has_no_checkpoints(rocking) -> None:
    simulation = rocking(ground=Unsaved())
    found = [simulation.run(100)["base_shear"], simulation.run(100)["base_shear"][1:]]
    assert same_bits(np.concatenate(found), rocking(ground=springs()).run(200)["base_shear"])
    with pytest.raises(bm.CheckpointError, match="ground"):
        simulation.checkpoint()


def test_an_exception_of_advance_ends_the_run_and_the_ground_is_refused_after_it(rocking) -> None:
    bed = Bed()
    bed.fails_after = 30
    simulation = rocking(ground=bed)
    simulation.run(20)
    checkpoint = simulation.checkpoint()
    with pytest.raises(ArithmeticError, match="the bed"):
        simulation.run(100)
    assert simulation.state.step == 31
    with pytest.raises(bm.StepError, match="`advance` failed after the last step"):
        simulation.step()
    with pytest.raises(bm.CheckpointError, match="ground"):
        simulation.checkpoint()
    simulation.ground.fails_after = 10**9
    simulation.resume(checkpoint)
    expected = rocking(ground=springs()).run(120)["base_shear"][20:]
    assert same_bits(simulation.run(100)["base_shear"], expected)


@pytest.mark.parametrize(
    ("method", "value", "words"),
    [
        ("step_compliance", np.eye(3), r"step_compliance of the ground returned an array of shape \(3, 3\), but must return one of \(16, 16\)"),
        ("step_compliance", np.ones((16, 4)), r"shape \(16, 4\), but must return one of \(16, 16\)"),
        ("step_compliance", np.ones(16), r"shape \(16,\), but must be of shape \(n, n\)"),
        ("step_compliance", np.full((16, 16), np.nan), "step_compliance of the ground returned the number NaN"),
        ("step_compliance", "soft", "must be"),
        ("static_compliance", np.eye(8), r"static_compliance of the ground returned an array of shape \(8, 8\)"),
        ("advance", np.zeros(8), r"advance of the ground returned an array of shape \(8,\), but must return one of \(16,\)"),
        ("advance", np.full(16, np.inf), "advance of the ground returned the number inf"),
        ("advance", None, "advance of the ground"),
        ("save", np.full(16, 1j), "save of the ground"),
    ],
)
def test_wrong_shapes_are_named(rocking, method: str, value: object, words: str) -> None:
    own = type("Wrong", (Bed,), {method: lambda self, *_: value})()
    with pytest.raises(bm.InputError, match=words):
        simulation = rocking(ground=own)
        simulation.run(3)
        simulation.checkpoint()


def test_no_ground() -> None:
    for ground, kind, words in (
        (BLOCK, TypeError, "of the type RigidBlock, but must be a Ground, or an object with the methods of UserGround"),
        (Bed, bm.InputError, "the class Bed itself"),
        (Bed(elements=3.0), bm.InputError, "elements of the ground: of the type float, but must be a Strip"),
    ):
        with pytest.raises(kind, match=words):
            bm.Simulation(0.01, BLOCK, ground, bm.Bonded())  # type: ignore[arg-type]


def test_a_bed_is_a_part_and_stays_what_it_is() -> None:
    bed = Bed()
    assert _pickling._kept([bed])[0] is bed


def test_the_speed_of_shear_waves_is_for_warnings(rocking) -> None:
    bed = Bed(bm.Strip(-3.0, 3.0, 3), 3)
    still = rocking(ground=bed).run(300, warn=False).warnings
    bed.shear_wave_speed = 200.0  # type: ignore[attr-defined]
    told = rocking(ground=bed).run(300, warn=False).warnings
    assert set(told) - set(still) == {"elements under foundation 0: 3, its rocking needs 4"}
