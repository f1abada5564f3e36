"""Structures, laws, loads and motions written in Python."""

from __future__ import annotations

import numpy as np
import pytest

import basemat as bm


class Tuned:
    """A block with a mass on top on a spring that hardens; it may raise."""

    dofs = 4

    def __init__(self, block: bm.RigidBlock, breaks_at: float = np.inf) -> None:
        self.block, self.breaks_at = block, breaks_at
        self.committed: list[float] = []

    def __deepcopy__(self, memo: dict) -> "Tuned":
        return Tuned(self.block, self.breaks_at)

    def base(self) -> list[list[bm.BaseNode]] | bm.BaseFaces:
        return self.block.base()

    def mass(self) -> np.ndarray:
        mass = np.zeros((4, 4))
        mass[:3, :3] = self.block.mass()
        mass[3, 3] = 2.0e3
        return mass

    def stiffness(self) -> np.ndarray:
        spring = np.array([-1.0, 0.0, 9.0, 1.0])
        return 1.0e6 * np.outer(spring, spring)

    def stretch(self, u: np.ndarray) -> float:
        return u[3] - u[0] + 9.0 * u[2]

    def force(self, u: np.ndarray) -> np.ndarray:
        stretch = self.stretch(u)
        if abs(stretch) > self.breaks_at:
            raise ArithmeticError(f"broken at {stretch:.3f} m")
        return 1.0e10 * stretch**3 * np.array([-1.0, 0.0, 9.0, 1.0])

    def tangent(self, u: np.ndarray) -> np.ndarray:
        spring = np.array([-1.0, 0.0, 9.0, 1.0])
        return 3.0e10 * self.stretch(u) ** 2 * np.outer(spring, spring)

    def commit(self, u: np.ndarray) -> None:
        self.committed.append(self.stretch(u))

    def save(self) -> list[float]:
        return []

    def restore(self, values: np.ndarray) -> None:
        assert len(values) == 0


PROBE = bm.Probe.displacement("stretch", {3: 1.0, 0: -1.0, 2: 9.0})


def test_a_nonlinear_structure_is_called_and_the_energy_balance_closes(rocking, block) -> None:
    own = Tuned(block)
    run = rocking(structure=own, probes=[PROBE]).run(300)
    assert run.energy_error < 1e-9
    assert run.probes["stretch"].magnitude > 5e-3
    # Its strain energy is that of the spring: ½ k s² + ¼ k₃ s⁴.
    stretch = run["stretch"]
    expected = 0.5e6 * stretch**2 + 0.25e10 * stretch**4
    np.testing.assert_allclose(
        run.energy_balances["strain"], expected, rtol=0.0, atol=0.02 * expected.max()
    )
    assert own.committed == [], "a simulation has a copy of its own"


def test_an_exception_of_the_structure_comes_out_of_the_run(rocking, block) -> None:
    simulation = rocking(structure=Tuned(block, breaks_at=4e-3), probes=[PROBE])
    with pytest.raises(ArithmeticError, match="broken at"):
        simulation.run(500)
    state = simulation.state
    assert 10 < state.step < 500
    assert abs(state.probes[0]) <= 4e-3
    with pytest.raises(ArithmeticError, match="broken at"):
        simulation.step()
    assert simulation.state.step == state.step


@pytest.mark.parametrize("method", ["dofs", "base", "mass", "stiffness", "tangent"])
def test_an_exception_while_a_simulation_is_built(rocking, block, method: str) -> None:
    def fail(*_: object) -> None:
        raise NotImplementedError(method)

    own = type("Own", (Tuned,), {method: fail, "__deepcopy__": lambda self, memo: self})(block)
    with pytest.raises(NotImplementedError, match=method):
        rocking(structure=own)


class Weakening:
    """Friction that falls with the way that an element has slid."""

    modes = ("stick", "slip_left", "slip_right", "open")
    state_variables = 1
    fails_in = ""
    fails_at = 0.5

    def __init__(self) -> None:
        self.calls = 0

    def law(self, start: bm.PreviousContact) -> bm.Coulomb:
        return bm.Coulomb(0.15 + 0.25 * np.exp(-start.state_variables[0] / 0.01))

    def called(self, method: str) -> None:
        self.calls += 1
        if method == self.fails_in and self.calls > 3000:
            raise TimeoutError(method)

    def conditions(self, mode: str, start: bm.PreviousContact):
        self.called("conditions")
        return self.law(start).conditions(mode, start)

    def next_mode(self, mode, start, trial, tolerance):
        self.called("next_mode")
        return self.law(start).next_mode(mode, start, trial, tolerance)

    def commit(self, start, end, mode):
        self.called("commit")
        return [start.state_variables[0] + (abs(end.slip - start.slip) if mode.startswith("slip") else 0.0)]


def test_a_law_remembers(rocking) -> None:
    simulation = rocking(interface=Weakening(), motion=bm.el_centro_1940().scaled(1.5))
    run = simulation.run(600)
    slid = simulation.state.state_variables(3)[0]
    assert slid > 0.01
    assert slid >= abs(simulation.state.slip[3]) - 1e-12
    assert run.energy_error < 1e-9
    # Between the limits of its friction.
    strong, weak = (
        rocking(f, motion=bm.el_centro_1940().scaled(1.5)).run(600) for f in (0.4, 0.15)
    )
    assert strong.slip_path < run.slip_path < weak.slip_path


class WeakeningLimits:
    """The same law by its limits."""

    state_variables = 1

    def limits(self, start: bm.PreviousContact) -> bm.Limits:
        return bm.Limits(0.15 + 0.25 * np.exp(-start.state_variables[0] / 0.01))

    def commit(self, start: bm.PreviousContact, end: bm.ContactState, mode: str) -> list[float]:
        slip = abs(end.slip - start.slip) if mode.startswith("slip") else 0.0
        return [start.state_variables[0] + slip]


def test_a_law_of_the_plane_needs_only_limits(rocking) -> None:
    motion = bm.el_centro_1940().scaled(1.5)
    simulation = rocking(interface=WeakeningLimits(), motion=motion)
    run = simulation.run(600, contact_every=1)
    assert run.energy_error < 1e-9
    # Every traction is within the largest friction, and open elements have none.
    pressure, shear, gap = (run.contact[name] for name in ("pressure", "shear", "gap"))
    assert (pressure >= 0.0).all() and (np.abs(shear) <= 0.4 * pressure * (1.0 + 1e-9)).all()
    assert gap.max() > 1e-4 and (pressure[gap > 1e-9] == 0.0).all()
    # The law with conditions of its own has the same motion.
    reference = rocking(interface=Weakening(), motion=motion).run(600)
    for name in ("base_shear", "mean_slip", "base_rotation"):
        np.testing.assert_allclose(run[name], reference[name], rtol=0.0, atol=1e-9 * np.abs(reference[name]).max())
    assert np.abs(run["mean_slip"]).max() > 0.01


def test_an_exception_of_limits_in_the_plane_comes_out_of_the_run(rocking) -> None:
    class Failing(WeakeningLimits):
        def limits(self, start: bm.PreviousContact) -> bm.Limits:
            if start.gap > 1e-3:
                raise TimeoutError("limits")
            return super().limits(start)

    simulation = rocking(interface=Failing(), motion=bm.el_centro_1940().scaled(1.5))
    with pytest.raises(TimeoutError, match="limits"):
        simulation.run(600)
    assert simulation.state.step > 10


@pytest.mark.parametrize("method", ["conditions", "next_mode", "commit"])
def test_an_exception_of_a_law_comes_out_of_the_run(rocking, method: str) -> None:
    law = Weakening()
    law.fails_in = method
    simulation = rocking(interface=law)
    accepted = []
    with pytest.raises(TimeoutError, match=method):
        simulation.run(2000, observe=lambda state: accepted.append(state.base_shear))
    state = simulation.state
    assert state.step == len(accepted) > 10
    assert state.base_shear == accepted[-1]
    law.fails_in = ""
    assert simulation.step().step == state.step + 1


def test_a_law_without_memory_that_raises_in_next_mode_commits_nothing(rocking) -> None:
    class Brittle:
        modes = ("stick", "slip_left", "slip_right", "open")
        law = bm.Coulomb(0.4)

        def conditions(self, mode, start):
            return self.law.conditions(mode, start)

        def next_mode(self, mode, start, trial, tolerance):
            if trial.gap > 1e-3:
                raise BlockingIOError(f"{trial.gap}")
            return self.law.next_mode(mode, start, trial, tolerance)

    simulation = rocking(interface=Brittle())
    shears = []
    with pytest.raises(BlockingIOError):
        simulation.run(1000, observe=lambda state: shears.append(state.base_shear))
    state = simulation.state
    assert (state.step, state.base_shear) == (len(shears), shears[-1])
    assert state.gap.max() <= 1e-3
    expected = rocking(interface=bm.Coulomb(0.4)).run(state.step)["base_shear"][1:]
    assert list(expected) == shears


@pytest.mark.parametrize("method", ["initial_state_variables", "commit"])
def test_a_law_says_how_many_numbers_it_commits(method: str, rocking) -> None:
    class Forgetful:
        modes = ("stick", "slip_left", "slip_right", "open")
        law = bm.Coulomb(0.4)

        def conditions(self, mode, start):
            return self.law.conditions(mode, start)

        def next_mode(self, mode, start, trial, tolerance):
            return self.law.next_mode(mode, start, trial, tolerance)

    setattr(Forgetful, method, lambda self, *arguments: [0.0])
    with pytest.raises(bm.InputError, match=f"has `{method}`, but no `state_variables`"):
        rocking(interface=Forgetful())


def test_functions_may_raise(rocking) -> None:
    def late(time: float) -> float:
        if time > 0.2:
            raise OverflowError("the load")
        return 0.0

    def shaken(x: float, time: float) -> tuple[float, float]:
        if time > 0.3:
            raise OverflowError("the motion")
        return 1e-3 * np.sin(10.0 * time) ** 2, 0.0

    for parts, text, last in (
        ({"loads": [bm.Load(0, late)], "motion": None}, "the load", 20),
        ({"motion": bm.free_field(displacement=shaken)}, "the motion", 30),
        ({"interface": bm.VariableFriction(lambda start: 1 / 0)}, "division", None),
    ):
        with pytest.raises((OverflowError, ZeroDivisionError), match=text):
            simulation = rocking(**parts)
            simulation.run(100)
        if last is not None:
            assert abs(simulation.state.step - last) <= 1


def test_bad_shapes_are_named(rocking, block) -> None:
    own = Tuned(block)
    own.mass = lambda: np.eye(3)  # type: ignore[method-assign]
    own.__class__ = type("Bad", (Tuned,), {"__deepcopy__": lambda self, memo: self})
    with pytest.raises(bm.InputError, match=r"mass of the structure returned a matrix of shape \(3, 3\), but must return one of \(4, 4\)"):
        rocking(structure=own)


def test_active_law_without_modes_is_refused(rocking) -> None:
    law = Weakening()
    law.modes = ("glide",)
    with pytest.raises(bm.InputError, match="no contact mode 'glide', only stick"):
        rocking(interface=law)


def raises(*_: object) -> float:
    raise KeyError("its own")


FALLING = bm.free_field(displacement=raises)
START = bm.PreviousContact(bm.ContactState(pressure=1e5), "stick", 0.01)


@pytest.mark.parametrize(
    "call",
    [
        lambda: bm.VariableFriction(raises).conditions("slip_left", START),
        lambda: bm.VariableFriction(raises).next_mode(
            "stick", START, bm.ContactState(pressure=1e5), bm.Tolerance(1e-9, 1.0)
        ),
        lambda: bm.travelling_wave(FALLING, 100.0, 0.0).displacement(0.0, 1.0),
        lambda: bm.travelling_wave(FALLING, 100.0, 0.0).velocity(0.0, 1.0),
    ],
)
def test_an_exception_comes_out_of_the_call_that_met_it(rocking, call) -> None:
    simulation = rocking()
    with pytest.raises(KeyError, match="its own"):
        call()
    simulation.checkpoint()
    with pytest.raises(bm.InputError, match="friction coefficient is -1"):
        bm.Coulomb(-1.0)


def test_an_exception_of_a_run_is_not_taken_by_a_call_inside_it(rocking) -> None:
    armed, asked, caught = False, 0, []

    def friction(start: bm.PreviousContact) -> float:
        nonlocal asked
        asked += armed
        if asked == 1:
            raise OverflowError("of the run")
        try:
            bm.VariableFriction(raises).conditions("slip_left", start)
        except Exception as error:
            caught.append(error)
        return 0.4

    simulation = rocking(interface=bm.VariableFriction(friction))
    armed = True
    with pytest.raises(OverflowError, match="of the run"):
        simulation.run(50)
    assert asked > 1, "no call came after the exception"
    assert caught and all(isinstance(error, KeyError) for error in caught)


class TwoFibres:
    """A mass on two fibres and a shear spring: base to the right, up, rotation; mass to the right, up, rotation."""

    dofs = 6
    rows = tuple(np.array([0.0, -1.0, -y, 0.0, 1.0, y]) for y in (1.0, -1.0))

    def __init__(self, eccentricity: float) -> None:
        self.eccentricity = eccentricity

    def base(self) -> list[list[bm.BaseNode]]:
        return bm.BaseNode.rigid_base(-1.0, 1.0, [0, 1, 2])

    def mass(self) -> np.ndarray:
        mass = np.diag([1e3] * 3 + [1e5] * 3)
        mass[4, 5] = mass[5, 4] = 1e5 * self.eccentricity
        return mass

    def stiffness(self) -> np.ndarray:
        spring = np.array([-1.0, 0.0, 2.0, 1.0, 0.0, 0.0])
        return 1e9 * np.outer(spring, spring)

    def force(self, u: np.ndarray) -> np.ndarray:
        return sum(1e11 * ((u[4] + y * u[5]) - (u[1] + y * u[2])) * row for y, row in zip((1.0, -1.0), self.rows))

    def tangent(self, u: np.ndarray) -> np.ndarray:
        return sum(1e11 * np.outer(row, row) for row in self.rows)


@pytest.mark.parametrize("eccentricity", [1e-7, 2e-7, 3e-7, 5e-7, 1e-6, 3e-6])
def test_rounding_of_a_settled_structure_is_no_support(eccentricity: float) -> None:
    """It has settled by 124.5 mm; moved by 1 mm its displacements round at another digit, beyond 1/8 m."""
    own = TwoFibres(eccentricity)
    stiffness = 101e3 * bm.STANDARD_GRAVITY / (2.0 * 0.1245)
    at_rest = bm.Simulation(0.01, own, bm.SpringGround.under(own, 4, stiffness, stiffness), bm.Bonded())
    assert at_rest.static_displacement[1] == pytest.approx(-0.1245, rel=1e-9)


class Held(TwoFibres):
    """The same with a support that takes 1e-8 of the fibres' stiffness."""

    def force(self, u: np.ndarray) -> np.ndarray:
        force = super().force(u)
        force[4] += 1e3 * u[4]
        return force

    def tangent(self, u: np.ndarray) -> np.ndarray:
        return super().tangent(u) + np.diag([0.0] * 4 + [1e3, 0.0])


def test_a_weak_support_of_a_settled_structure_is_one() -> None:
    own = Held(1e-6)
    with pytest.raises(bm.InputError, match="must translate freely"):
        bm.Simulation(0.01, own, bm.SpringGround.under(own, 4, 4e6, 4e6), bm.Bonded())


def test_what_is_no_law_leads_to_one(rocking) -> None:
    with pytest.raises(bm.InputError, match=r"float is no interface law: Coulomb\(0.4\) has this friction"):
        rocking(interface=0.4)
    with pytest.raises(bm.InputError, match=r"function is no interface law: VariableFriction\(function\)"):
        rocking(interface=lambda start: 0.4)
    with pytest.raises(bm.InputError, match="str is no interface law: it has no method `limits`"):
        rocking(interface="friction")
