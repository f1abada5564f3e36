"""GOAL: a checkpoint goes on in its own scene alone; own laws in plan are placed under their own limits.
SCENE: blocks on springs in the plane and in plan, one thing changed at a time.
REFERENCE: the uninterrupted run, the package's own laws, a body in free fall.
"""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable
from typing import Any

import pytest

import basemat as bm

RECORD = bm.el_centro_1940()
BLOCK = bm.RigidBlock(4.0, 3.0, 2000.0)
BODY = bm.RigidBody.cuboid(4.0, 4.0, 2.0, 2000.0)
PRESSURE = 2000.0 * 2.0 * bm.STANDARD_GRAVITY


class Limited:
    """A law by its limits alone."""

    def __init__(self, *limits: float, **others: Any) -> None:
        self.own = bm.Limits(*limits, **others)

    def limits(self, start: bm.PreviousContact) -> bm.Limits:
        return self.own


def push(factor: float) -> bm.Load:
    return bm.Load(0, lambda time: factor * math.sin(9.0 * time))


def plane(law: Any = None, motion: Any = RECORD, load: float = 1e3, **others: Any) -> bm.Simulation:
    ground = bm.SpringGround(bm.Strip(-2.0, 2.0, 4, grading="uniform"), 5e7, 4e7, dashpots=(4e5, 3e5))
    law = bm.Coulomb(0.3) if law is None else law
    return bm.Simulation(0.01, BLOCK, ground, law, motion=motion, loads=[push(load)], **others)


def plan(law: Any = None, motion: Any = RECORD, load: float = 1e3, **others: Any) -> bm.Simulation:
    ground = bm.SpringGround.under(BODY, 4, 30e6, 20e6, dashpots=(4e5, 3e5))
    law = Limited(0.3) if law is None else law
    return bm.Simulation(0.01, BODY, ground, law, motion=motion, loads=[push(load)], **others)


OTHERS = [
    ("label", "interface_law", {"law": bm.Coulomb(0.31), "results": bm.ResultOptions(label="friction 0.31")}),
    ("label", "ground_motion", {"motion": RECORD.scaled(1.01), "results": bm.ResultOptions(label="101 %")}),
    ("label", "load", {"load": 1.1e3, "results": bm.ResultOptions(label="1.1 kN")}),
    ("gravity stage", "gravity_stage", {"initial": bm.InitialConditions(gravity_stage="frictional")}),
]


@pytest.mark.parametrize("scene", [plane, plan])
@pytest.mark.parametrize(("quantity", "change", "other"), OTHERS)
def test_another_scene_is_refused_by_name(
    scene: Callable[..., bm.Simulation], quantity: str, change: Any, other: dict[str, Any]
) -> None:
    one = scene()
    one.run(150)
    saved = pickle.loads(pickle.dumps(one.checkpoint()))
    same = scene()
    same.resume(saved)
    assert (same.run(20)["base_shear"] == one.run(20)["base_shear"]).all()
    changed = scene(**other)
    with pytest.raises(bm.CheckpointError, match=f"the {quantity} differs"):
        changed.resume(saved)
    assert changed.state.step == 0
    if change != "gravity_stage":
        changed.resume(saved, [change])
        assert changed.state.step == 150
    with pytest.raises(bm.InputError, match="no change of a scene 'colour'"):
        changed.resume(saved, ["colour"])


def test_caps_of_own_laws_are_bearing_failure() -> None:
    texts = []
    for law in (Limited(0.3, pressure_cap=1e3), bm.Yielding(1e3, 0.3)):
        with pytest.raises(bm.Error, match="39.227 times") as refused:
            plan(law)
        texts.append(str(refused.value))
    assert texts[0] == texts[1]


def test_own_bonds_hold_while_the_weight_comes_on() -> None:
    inertia = [[2e5, 0.0, 0.0], [0.0, 2e5, 0.0], [0.0, 0.0, 2e5]]
    corners = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)]
    leaning = bm.RigidBody.from_mass(corners, 64e3, inertia, (1.0, 0.0, 1.0))
    ground = bm.SpringGround.under(leaning, 4, 30e6, 20e6)

    def pressures(law: Any) -> Any:
        return bm.Simulation(0.01, leaning, ground, law).state.pressure

    bonded = pressures(bm.Bonded())
    assert min(bonded) < -0.1 * PRESSURE
    for law in (Limited(bonded=True), Limited(0.3, tension=PRESSURE)):
        assert pressures(law) == pytest.approx(bonded, abs=1e-6 * PRESSURE)
    assert min(pressures(Limited(0.3))) == 0.0


@pytest.mark.parametrize("law", [Limited(0.3, pressure_cap=1e3), bm.Yielding(1e3, 0.3)])
def test_sinking_warns(law: Any) -> None:
    with pytest.warns(bm.BasematWarning, match="settles by 1.911e1 m"):
        plan(law, initial=bm.InitialConditions(gravity_stage="unloaded"), motion=None).run(200)
