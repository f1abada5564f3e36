"""Settlement and rocking of a foundation: series, equivalent damping, limits, pictures, and soil that settles in every cycle."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest

import basemat as bm

STIFFNESS = 4.0e7
"""Of the springs, Pa/m."""


def settling(steps: int = 1000, **options: object) -> bm.Run:
    """A block on springs that yield, under slow cycles of a moment of 4 s."""
    block = bm.RigidBlock(4.0, 5.0, 2000.0)
    ground = bm.SpringGround.under(block, 40, STIFFNESS, STIFFNESS)
    moment = bm.Load(2, lambda time: 2.6e5 * math.sin(0.5 * math.pi * time))
    simulation = bm.Simulation(0.01, block, ground, bm.Yielding(1.5e5, 0.6), loads=[moment], **options)  # type: ignore[arg-type]
    return simulation.run(steps, warn=False, foundations=True)


def test_series_of_a_foundation() -> None:
    run = settling(service_limits=bm.ServiceLimits(settlement=1e-3))
    rocking = run.rocking()
    assert list(rocking) == ["time", "rotation", "moment", "settlement", "work"]
    for name, series in (
        ("time", "time"),
        ("rotation", "base_rotation"),
        ("moment", "base_moment"),
        ("settlement", "settlement"),
        ("work", "rocking_work"),
    ):
        np.testing.assert_array_equal(rocking[name], run[series])
        np.testing.assert_array_equal(run.foundation_series(0)[series], run[series])
    assert run.units["settlement"] == "m" and run.units["rocking_work"] == "J/m"
    assert run.settlement.highest.value == run["settlement"].max() > 3e-3
    assert run.residual_settlement == run["settlement"][-1] == run.summary()["residual_settlement"]
    assert run.residual_rotation == run["base_rotation"][-1]
    assert run.rocking_work.largest.value == run.extremes("rocking_work").largest.value
    [foundation] = run.foundations
    assert foundation.residual_settlement == run.residual_settlement and run.residual_rotation_across == 0.0
    [check] = run.serviceability
    assert check.criterion == "settlement" and not check.is_met and check.largest == run.settlement.highest
    copy = pickle.loads(pickle.dumps(run))
    np.testing.assert_array_equal(copy.rocking()["work"], rocking["work"])
    with pytest.raises(bm.InputError, match="foundation"):
        run.rocking(1)
    with pytest.raises(bm.InputError, match="rocking about the axis along x"):
        run.rocking(across=True)
    assert settling(1).foundations[0].rocking_work.largest.value != 0.0


def test_damping_of_cycles() -> None:
    phase = np.linspace(0.0, 2.0 * np.pi, 4001)
    rotation, moment = 2e-3 * np.sin(phase), 7e4 * np.sin(phase + 0.3)
    assert bm.equivalent_damping(rotation, moment) == pytest.approx(0.5 * math.sin(0.3), rel=1e-5)
    with pytest.raises(bm.InputError, match="a cycle ends where it began"):
        bm.equivalent_damping(rotation[:2500], moment[:2500])
    run = settling()
    damping = run.equivalent_damping(5.0, 9.0)
    rocking = run.rocking()
    turns, moments = rocking["rotation"][500:901], rocking["moment"][500:901]
    work = rocking["work"][900] - rocking["work"][500] - 0.5 * (moments[0] + moments[-1]) * (turns[-1] - turns[0])
    assert damping == pytest.approx(2.0 * work / (math.pi * np.ptp(turns) * np.ptp(moments)), rel=1e-12)
    # The polygon of the recorded points has nearly this area.
    assert bm.equivalent_damping(turns, moments) == pytest.approx(damping, abs=0.01)
    with pytest.raises(bm.InputError, match="number of cycles of the rotation is 2"):
        run.equivalent_damping(1.0, 9.0)


def test_pictures_show_measured_points() -> None:
    pytest.importorskip("matplotlib").use("agg")
    run = settling()
    measured = ([1e-3, 2e-3], [1e5, 2e5])
    axes = run.plot_moment_rotation(between=(5.0, 9.0), measured=measured, label="model", title="packet a")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("rotation, mrad", "moment, kN·m/m")
    path, points = axes.get_lines()
    np.testing.assert_allclose(path.get_xydata(), run_pairs(run, "moment", 1e3, 1e-3)[500:901])
    np.testing.assert_allclose(points.get_xydata(), [[1.0, 100.0], [2.0, 200.0]])
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["model", "model, measured"]
    axes = run.plot_settlement_rotation()
    assert axes.get_ylabel() == "settlement, mm" and axes.get_legend() is None
    low, high = axes.get_ylim()
    assert low > high
    np.testing.assert_allclose(axes.get_lines()[0].get_xydata(), run_pairs(run, "settlement", 1e3, 1e3))
    # What is drawn later into the same axes is not cut off.
    run.plot_settlement_rotation(axes, measured=([0.0], [1.0]))
    assert axes.get_ylim()[0] > 1000.0 > 0.0 > axes.get_ylim()[1]


def run_pairs(run: bm.Run, name: str, rotation: float, factor: float) -> np.ndarray:
    """Rotations and another array of the rocking, each with its factor."""
    rocking = run.rocking()
    return np.stack([rotation * rocking["rotation"], factor * rocking[name]], axis=1)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"elastic_range": 0.0}, "elastic range is 0, but must be above 0, at most 1"),
        ({"elastic_range": 1.1}, "elastic range is 1.1"),
        ({"depth_gradient": -1.0}, "growth of the bearing pressure is -1"),
        ({"depth_gradient": math.inf}, "growth of the bearing pressure is inf"),
    ],
)
def test_parameters_of_soil_that_settles_in_every_cycle(parameters: dict[str, float], message: str) -> None:
    with pytest.raises(bm.InputError, match=message):
        bm.CyclicYielding(1.5e5, 5e-3, 0.6, **parameters)


def test_virgin_settlement_is_on_the_hyperbola() -> None:
    law = bm.CyclicYielding(1.5e5, 5e-3, 0.6, elastic_range=0.1, depth_gradient=1e6)
    assert law.virgin_settlement(0.0) == 0.0
    assert law.virgin_settlement(0.75e5) == pytest.approx(5e-3, rel=1e-12)
    assert law.virgin_settlement(1e5) == pytest.approx(1e-2, rel=1e-12)


def rocking_block(law: bm.InterfaceLaw) -> bm.Simulation:
    """The block of `settling` with dashpots, shaken by the strong part of El Centro."""
    block = bm.RigidBlock(4.0, 5.0, 2000.0)
    ground = bm.SpringGround.under(block, 12, STIFFNESS, STIFFNESS, dashpots=(3e5, 2e5))
    return bm.Simulation(0.01, block, ground, law, motion=bm.el_centro_1940())


def test_the_limit_without_settlement_is_yielding() -> None:
    yielding = rocking_block(bm.Yielding(1.5e5, 0.6)).run(600, warn=False)
    assert yielding.residual_settlement > 1e-3
    exact = rocking_block(bm.CyclicYielding(1.5e5, 0.0, 0.6)).run(600, warn=False)
    np.testing.assert_array_equal(exact["base_rotation"], yielding["base_rotation"])
    small = rocking_block(bm.CyclicYielding(1.5e5, 1e-9, 0.6)).run(600, warn=False)
    for series in ("base_rotation", "settlement"):
        scale = np.abs(yielding[series]).max()
        np.testing.assert_allclose(small[series], yielding[series], rtol=0.0, atol=1e-3 * scale)
    cyclic = rocking_block(bm.CyclicYielding(1.5e5, 5e-3, 0.6, elastic_range=0.1)).run(600, warn=False)
    assert cyclic.residual_settlement > 1.5 * yielding.residual_settlement


def test_checkpoints_keep_settlement_and_threshold() -> None:
    law = bm.CyclicYielding(1.5e5, 5e-3, 0.6, elastic_range=0.1, depth_gradient=1e6)
    simulation = rocking_block(law)
    simulation.run(250, warn=False)
    saved = pickle.loads(pickle.dumps(simulation.checkpoint()))
    settlement, threshold = simulation.state.state_variables(0)
    assert settlement > 1e-3 and 0.0 < threshold < 1.5e5 + 1e6 * settlement
    expected = simulation.run(250, warn=False)
    resumed = rocking_block(law)
    resumed.resume(saved)
    assert resumed.state.state_variables(0) == [settlement, threshold]
    run = resumed.run(250, warn=False)
    for series in ("base_rotation", "settlement", "rocking_work"):
        np.testing.assert_array_equal(run[series], expected[series])
    # A law with another number of state variables.
    with pytest.raises(bm.CheckpointError):
        rocking_block(bm.Yielding(1.5e5, 0.6)).resume(saved)
