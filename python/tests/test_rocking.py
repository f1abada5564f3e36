"""Settlement and rocking of a foundation: series, equivalent damping, limits and pictures."""

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
