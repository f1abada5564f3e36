"""Springs of bearings that act in two directions."""

from __future__ import annotations

import pickle
from types import SimpleNamespace

import numpy as np
import pytest
from test_plan_parts import simulation

import basemat as bm


def test_bearings_slide_in_any_direction() -> None:
    """Friction is a circle of radius μ W, less the part W d/R by which the bearing climbs."""
    mat = bm.RigidBody.cuboid(6.0, 4.0, 1.0, 2400.0)
    floor = bm.PlanStorey(3.0, 60e3, (6.0, 4.0), (4e7, 3e7, 4e8))
    pendulum = bm.FrictionPendulum(1.2e6, 2.0, 0.02)
    building = bm.StoreyBuilding(mat, [floor] * 2, laws={(0, "xy"): pendulum})
    assert repr(pickle.loads(pickle.dumps(building))) == repr(building)
    probes = [bm.Probe.section(name, own) for name, own in zip(("Vx", "Vy"), building.shear(0))]
    drifts = building.drift(0)[:2]
    probes += [bm.Probe.displacement(name, row) for name, row in zip(("dx", "dy"), drifts)]
    run = simulation(building, bm.Bonded(), probes=probes).run(300, warn=False)
    parts = [run[v][1:] - 0.6e6 * 0.5 * (run[d][1:] + run[d][:-1]) for v, d in (("Vx", "dx"), ("Vy", "dy"))]
    friction = np.hypot(*parts)
    assert 0.9999 < friction.max() / 0.02 / 1.2e6 < 1.0 + 1e-6 and run.energy_error < 1e-9
    assert min(np.abs(part).max() for part in parts) > 1e4
    braced = bm.WithSprings(building, [(*drifts, bm.BoucWen(4e7, 1e5, 0.1)), (drifts[0], pendulum)])
    assert simulation(braced, bm.Bonded()).run(50).energy_error < 1e-9
    with pytest.raises(bm.InputError, match="exponent of the coupled Bouc–Wen spring"):
        bm.WithSprings(building, [(*drifts, bm.BoucWen(4e7, 1e5, 0.1, exponent=1.0, beta=0.5))])
    own = SimpleNamespace(force=lambda deformation: 1e6 * deformation)
    with pytest.raises(bm.InputError, match="acts in one direction"):
        bm.StoreyBuilding(mat, [floor], laws={(0, "xy"): own})
    with pytest.raises(TypeError, match=r"\(row_x, row_y, law\)"):
        bm.WithSprings(building, [(pendulum,)])


def test_a_pendulum_carries_the_block_on_it() -> None:
    """N = k ⟨d²/(2R) − d_z⟩ and N d/R; a block of 100 t on one bearing, its energy closed while N varies."""
    stiffness = 2.5e8
    bearing = bm.PendulumBearing(1e6, 2.0, 0.05, stiffness)
    assert repr(pickle.loads(pickle.dumps(bearing))) == repr(bearing)
    assert bearing.vertical_force((0.1, 0.0, 0.0025 - 0.004)) == pytest.approx(1e6)
    assert bearing.force((0.1, 0.0, -0.0015)) == pytest.approx([1e5, 0.0, -1e6])
    assert bearing.force((0.0, 0.0, 0.001)) == [0.0] * 3
    corners = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)]
    base = bm.BaseFaces([bm.BaseNode.rigid_face(corners, (0.0, 0.0), list(range(6)))])
    block = bm.MatrixModel(np.diag([1e4] * 6 + [1e5] * 3), np.zeros((9, 9)), base)
    rows = [{6 + k: 1.0, k: -1.0} for k in range(3)]
    isolated = bm.WithSprings(block, [(*rows, bearing)])
    probes = [bm.Probe.displacement(name, row) for name, row in zip(("dx", "dy", "dz"), rows)]
    own = simulation(isolated, bm.Bonded(), probes=probes)
    sink = own.static_displacement[2] - own.static_displacement[8]
    run = own.run(300, warn=False)
    assert run.energy_error < 1e-9 and max(np.ptp(run["dx"]), np.ptp(run["dy"])) > 1e-3
    assert sink == pytest.approx(1e5 * 9.80665 / stiffness, rel=1e-6)
    with pytest.raises(bm.InputError, match="vertical stiffness"):
        bm.PendulumBearing(1e6, 2.0, 0.05, 0.0)
    with pytest.raises(TypeError, match="a PendulumBearing for three rows"):
        bm.WithSprings(block, [(*rows, bm.FrictionPendulum(1e6, 2.0, 0.05))])
    with pytest.raises((TypeError, bm.InputError)):
        bm.WithSprings(block, [(*rows[:2], bearing)])
