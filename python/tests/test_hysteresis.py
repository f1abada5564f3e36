"""Springs with a memory written in Python."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from conftest import same_bits
from scipy.integrate import solve_ivp

import basemat as bm

STIFFNESS, YIELD, HARDENING = 40e6, 100e3, 0.05
STOREYS = [bm.Storey(3.0, 20e3, 40e6)] * 3


class Slider:
    """The rule of :class:`basemat.Bilinear`: a spring beside an elastic slider."""

    def __init__(self) -> None:
        self.slip, self.dissipated = 0.0, 0.0
        self.series, self.limit = (1.0 - HARDENING) * STIFFNESS, (1.0 - HARDENING) * YIELD

    def slide(self, deformation: float) -> tuple[float, float]:
        """Force of the slider and where it is."""
        trial = self.series * (deformation - self.slip)
        force = max(-self.limit, min(self.limit, trial))
        return force, self.slip if force == trial else deformation - force / self.series

    def force(self, deformation: float) -> float:
        return HARDENING * STIFFNESS * deformation + self.slide(deformation)[0]

    def commit(self, deformation: float) -> None:
        slip = self.slide(deformation)[1]
        self.dissipated += self.limit * abs(slip - self.slip)
        self.slip = slip


class Whole(Slider):
    """The same with all that may be given."""

    def tangent(self, deformation: float) -> float:
        held = self.slide(deformation)[1] == self.slip
        return HARDENING * STIFFNESS + (self.series if held else 0.0)

    def energy(self, deformation: float) -> tuple[float, float]:
        force, slip = self.slide(deformation)
        stored = 0.5 * (HARDENING * STIFFNESS * deformation**2 + force**2 / self.series)
        return stored, self.dissipated + self.limit * abs(slip - self.slip)

    def save(self) -> list[float]:
        return [self.slip, self.dissipated]

    def restore(self, values: np.ndarray) -> None:
        self.slip, self.dissipated = values


def building(law: object) -> bm.ShearBuilding:
    return bm.ShearBuilding(8.0, 50e3, 4e5, STOREYS, damping=0.05, laws={0: law})  # type: ignore[dict-item]


def simulation(structure: object, soil: bm.Soil) -> bm.Simulation:
    ground = bm.ElasticGround.under(soil, structure, 6)  # type: ignore[arg-type]
    drift = bm.Probe.displacement("drift", building(bm.Bilinear(1e6, 1e6, 0.0)).drift(0))
    motion = bm.el_centro_1940()
    return bm.Simulation(0.005, structure, ground, bm.Coulomb(0.4), motion=motion, probes=[drift])  # type: ignore[arg-type]


@pytest.mark.parametrize("own", [Slider, Whole])
def test_the_same_rule_gives_the_same_run(soil: bm.Soil, own: type[Slider]) -> None:
    rust = simulation(building(bm.Bilinear(STIFFNESS, YIELD, HARDENING)), soil).run(800)
    made = simulation(building(own()), soil)
    run = made.run(800)
    assert rust.probes["drift"].magnitude > 3.0 * YIELD / STIFFNESS
    for name in ("base_shear", "drift"):
        scale = np.abs(rust[name]).max()
        np.testing.assert_allclose(run[name], rust[name], rtol=0.0, atol=1e-9 * scale)
    assert run.energy_error < 1e-9
    dissipated = rust.energy_balance.hysteresis
    if own is Whole:
        assert run.energy_balance.hysteresis == pytest.approx(dissipated, rel=1e-9)
    else:
        # It is taken to unload with its first stiffness; work is by the trapezoidal rule.
        assert run.energy_balance.hysteresis == pytest.approx(dissipated, rel=0.05)
    [spring] = made.hysteresis
    assert spring.dissipated == pytest.approx(dissipated, rel=1e-9)


def test_a_description_is_not_changed_by_its_runs(soil: bm.Soil) -> None:
    law = Slider()
    structure = building(law)
    first, second = (simulation(structure, soil) for _ in range(2))
    assert same_bits(first.run(300)["base_shear"], second.run(300)["base_shear"])
    assert law.slip == 0.0 != first.hysteresis[0].slip
    again = pickle.loads(pickle.dumps(structure))
    assert same_bits(simulation(again, soil).run(300)["drift"], simulation(structure, soil).run(300)["drift"])


def test_checkpoints_keep_the_state_of_springs(soil: bm.Soil) -> None:
    made = simulation(building(Whole()), soil)
    whole = made.run(900)["drift"]
    made.reset()
    made.run(600)
    saved, slip = made.checkpoint(), made.hysteresis[0].slip
    assert slip != 0.0
    other = simulation(building(Whole()), soil)
    other.resume(saved)
    assert other.hysteresis[0].slip == slip
    assert same_bits(other.run(300)["drift"], whole[600:])
    forgetful = simulation(building(Slider()), soil)
    forgetful.run(10)
    for call in (forgetful.checkpoint, forgetful.reset):
        with pytest.raises(bm.Error, match="the hysteresis cannot save or restore its state"):
            call()
    assert forgetful.run(10).end == pytest.approx(0.1)


class Smooth:
    """Bouc's rule with exponent 1, exact along straight paths: ż = ḋ (1 − z/z_y) while z grows, else ḋ."""

    stiffness, knee, hardening = 8e5, 0.01, 0.1

    def __init__(self) -> None:
        self.at, self.z = 0.0, 0.0

    def reached(self, deformation: float) -> float:
        way, knee = deformation - self.at, self.knee
        sense = math.copysign(1.0, way)
        z = sense * self.z
        if z < 0.0:
            if abs(way) <= -z:
                return self.z + way
            way, z = way + self.z, 0.0
        return sense * (knee - (knee - z) * math.exp(-abs(way) / knee))

    def force(self, deformation: float) -> float:
        z = self.reached(deformation)
        return self.stiffness * (self.hardening * deformation + (1.0 - self.hardening) * z)

    def commit(self, deformation: float) -> None:
        self.z, self.at = self.reached(deformation), deformation


@pytest.mark.parametrize("place", ["storey", "isolators", "spring"])
def test_an_oscillator_follows_its_differential_equation(place: str) -> None:
    """On ground as good as rigid, against an integrator that knows the rule as a rate."""
    mass, step, steps = 20e3, 0.001, 8000
    storeys = [bm.Storey(3.0, mass, Smooth.stiffness if place == "storey" else 0.0)]
    if place == "storey":
        structure: object = bm.ShearBuilding(8.0, 50e3, 4e5, storeys, laws={0: Smooth()})  # type: ignore[dict-item]
    elif place == "isolators":
        # The storey above moves with the slab.
        stiff = bm.ShearBuilding(8.0, 50e3, 4e5, [bm.Storey(1e-3, 1.0, 1e12)])
        structure = bm.ShearBuilding.isolated(stiff, Smooth(), height=1e-3, slab_mass=mass - 1.0)
    else:
        row = {0: -1.0, 3: 1.0}
        matrices = np.diag([50e3, 50e3, 4e5, mass]), np.zeros((4, 4))
        base = bm.BaseNode.rigid_base(-4.0, 4.0, [0, 1, 2])
        structure = bm.WithSprings(bm.MatrixModel(*matrices, base), [(row, Smooth())])
    ground = bm.SpringGround.under(structure, 4, 1e13, 1e13)  # type: ignore[arg-type]
    record = bm.el_centro_1940()
    probe = bm.Probe.displacement("drift", {0: -1.0, 3: 1.0})
    made = bm.Simulation(
        step,
        structure,  # type: ignore[arg-type]
        ground,
        bm.Bonded(),
        motion=record,
        initial=bm.InitialConditions(gravity=0.0),
        probes=[probe],
    )
    found = made.run(steps, warn=False)["drift"]
    time, acceleration = record.time_step * np.arange(len(record)), record.accelerations
    stiffness, hardening, knee = Smooth.stiffness, Smooth.hardening, Smooth.knee

    def rate(now: float, y: np.ndarray) -> list[float]:
        d, v, z = y
        force = stiffness * (hardening * d + (1.0 - hardening) * z)
        return [v, -np.interp(now, time, acceleration) - force / mass, v * (1.0 - (abs(z) / knee if z * v > 0.0 else 0.0))]

    times = step * np.arange(steps + 1)
    exact = solve_ivp(rate, (0.0, times[-1]), [0.0] * 3, t_eval=times, rtol=1e-8, atol=1e-11, max_step=0.02)
    scale = np.abs(exact.y[0]).max()
    assert scale > 3.0 * knee
    np.testing.assert_allclose(found, exact.y[0], rtol=0.0, atol=2e-4 * scale)


class Broken(Slider):
    """A spring whose force may be anything."""

    def __init__(self, gives: object) -> None:
        super().__init__()
        self.gives = gives

    def force(self, deformation: float) -> float:
        if abs(deformation) < 5e-4:
            return super().force(deformation)
        if isinstance(self.gives, Exception):
            raise self.gives
        return self.gives  # type: ignore[return-value]


@pytest.mark.parametrize(
    ("gives", "error", "text"),
    [
        (ArithmeticError("torn"), ArithmeticError, "torn"),
        ("soft", bm.InputError, "force of the hysteresis is 'soft', but must be a real number"),
        (1j, bm.InputError, "force of the hysteresis is 1j, but must be a real number"),
        (math.nan, bm.StepError, "finite"),
    ],
)
def test_what_a_spring_raises_comes_out_of_the_run(soil: bm.Soil, gives: object, error: type, text: str) -> None:
    made = simulation(building(Broken(gives)), soil)
    with pytest.raises(error, match=text):
        made.run(800)
    assert 10 < made.state.step < 800


@pytest.mark.parametrize("law", [Slider, 3.0, "bilinear", object()])
def test_what_is_no_spring_is_refused(law: object) -> None:
    for call in (
        lambda: building(law),
        lambda: bm.WithSprings(building(Slider()), [({0: -1.0, 3: 1.0}, law)]),  # type: ignore[list-item]
    ):
        with pytest.raises(bm.InputError, match="is no hysteresis: it must be a Hysteresis or an object"):
            call()


class Plastic:
    """Elastic and perfectly plastic, without a word on its energy."""

    slip = 0.0

    def force(self, deformation: float) -> float:
        return max(-1e5, min(1e5, 20e6 * (deformation - self.slip)))

    def commit(self, deformation: float) -> None:
        self.slip = deformation - self.force(deformation) / 20e6


class Elastic:
    """The same without a memory: a spring that stores all work."""

    force = Plastic.force
    slip = 0.0


def test_energy_that_a_spring_does_not_tell(soil: bm.Soil) -> None:
    def shares(law: object) -> tuple[float, float, float]:
        building = bm.ShearBuilding(8.0, 50e3, 4e5, [bm.Storey(3.0, 20e3, 20e6)] * 2, laws={0: law})
        ground = bm.ElasticGround.under(soil, building, 8)
        run = bm.Simulation(0.002, building, ground, bm.Coulomb(0.6), motion=bm.el_centro_1940()).run(duration=6.0)
        assert run.energy_error < 1e-9
        return run.energy_balance.hysteresis, run.energy_balance.strain, run.energy_balance.input

    heat, strain, total = shares(Plastic())
    expected = shares(bm.Bilinear(20e6, 1e5, 0.0))[0]
    assert heat == pytest.approx(expected, rel=1e-2) and heat > 0.3 * total and strain < 0.1 * total
    assert shares(Elastic())[0] == 0.0
