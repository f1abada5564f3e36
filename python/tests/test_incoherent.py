"""GOAL: incoherent motions and water tables in Python are those of the Rust crate, and do what their formulas say.
SCENE: mats in plan and strips in the plane, a box in a trench.
REFERENCE: numpy's factors of the coherence; statics of a rigid block; coherent runs.
"""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from conftest import same_bits

import basemat as bm

SOIL = bm.Soil.from_shear_wave_speed(300.0, poisson=1.0 / 3.0, density=1900.0)
RECORD = bm.el_centro_1940().with_baseline("rest_to_rest", degree=4).padded(4.0, 2.0)
BODY = bm.RigidBody.cuboid(30.0, 20.0, 15.0, 600.0)
BLOCK = bm.RigidBlock(20.0, 10.0, 1500.0)
WAVES = bm.LucoWong(0.25, 300.0)


def in_plan() -> bm.ElasticGround:
    return bm.ElasticGround.under(SOIL, BODY, 4)


def in_the_plane() -> bm.ElasticGround:
    return bm.ElasticGround.under(SOIL, BLOCK, 8)


def centers(ground: bm.Ground) -> np.ndarray:
    return np.column_stack([ground.elements.mean(axis=1), ground.depths.mean(axis=1)])


def test_models_are_their_formulas() -> None:
    assert WAVES.between(6.0, (0.0, 0.0), (0.0, 40.0)) == pytest.approx(
        np.exp(-((0.25 * 2 * np.pi * 6.0 * 40.0 / 300.0) ** 2)), rel=1e-14
    )
    # Figure 6-2 of the report at 10 m and 20 Hz.
    rock = bm.AbrahamsonCoherence("hard_rock_vertical")
    assert rock.between(20.0, (0.0, 0.0), (10.0, 0.0)) == pytest.approx(0.6758, abs=1e-4)
    with pytest.raises(bm.InputError, match="model"):
        bm.AbrahamsonCoherence("clay")  # type: ignore[arg-type]
    with pytest.raises(bm.InputError, match="parameter of the coherence"):
        bm.LucoWong(-0.1, 300.0)


def test_mean_coherence_is_a_mean_over_cells() -> None:
    ground = in_plan()
    frequency = 4.0
    matrix = bm.mean_coherence(WAVES, frequency, ground)
    ends = np.stack([ground.elements, ground.depths], axis=2)
    nodes = 0.5 + np.array([-1.0, 1.0]) / (2.0 * np.sqrt(3.0))
    sides = ends[:, 1] - ends[:, 0]
    grid = np.stack(np.meshgrid(nodes, nodes, indexing="ij"), axis=-1).reshape(-1, 2)
    points = ends[:, 0, None] + sides[:, None] * grid[None]
    distance = np.linalg.norm(points[:, None, :, None] - points[None, :, None, :], axis=-1)
    expected = np.exp(-((0.25 * 2 * np.pi * frequency * distance / 300.0) ** 2)).mean(axis=(2, 3))
    assert matrix.shape == expected.shape and np.allclose(matrix, expected, rtol=1e-12, atol=0.0)


@pytest.mark.parametrize("make", [in_plan, in_the_plane])
def test_functions_are_the_models_that_they_compute(make: object) -> None:
    ground = make()  # type: ignore[operator]

    def between(frequency: float, first: tuple[float, float], second: tuple[float, float]) -> float:
        return WAVES.between(frequency, first, second)

    def of_separation(frequency: float, separation: tuple[float, float]) -> float:
        return WAVES.between(frequency, (0.0, 0.0), separation)

    places = centers(ground)[:3]
    # Beside the axes of symmetry: pivots of equal size could be taken in another order.
    reference = (1.3, 0.7)
    expected = bm.Incoherence(WAVES, seed=3, reference=reference).motion(ground, x=RECORD)
    for coherence in (bm.CoherenceFn(between), bm.CoherenceFn(of_separation=of_separation)):
        motion = bm.Incoherence(coherence, seed=3, reference=reference).motion(ground, x=RECORD)
        for x, y in places:
            assert np.allclose(
                motion.displacement_at(x, y, 9.0), expected.displacement_at(x, y, 9.0), rtol=1e-9, atol=1e-12
            )
    other = bm.Incoherence(WAVES, seed=4).motion(ground, x=RECORD)
    x, y = places[0]
    assert other.displacement_at(x, y, 9.0) != expected.displacement_at(x, y, 9.0)


def test_no_incoherence_is_the_coherent_run() -> None:
    for ground, structure, coherent in (
        (in_plan(), BODY, bm.triaxial(x=RECORD)),
        (in_the_plane(), BLOCK, RECORD),
    ):
        motion = bm.Incoherence(bm.LucoWong(0.0, 300.0)).motion(ground, x=RECORD)
        runs = []
        for field in (motion, coherent):
            simulation = bm.Simulation(0.01, structure, ground, bm.Coulomb(0.5), motion=field)
            runs.append(simulation.run(700, warn=False)["base_shear"])
        assert np.abs(runs[0] - runs[1]).max() < 1e-12 * np.abs(runs[1]).max()


def test_motions_pickle_and_twist_a_mat() -> None:
    ground = in_plan()
    motion = bm.Incoherence(WAVES, seed=2, apparent_velocity=2000.0, azimuth=0.3).motion(ground, RECORD, up=RECORD.scaled(0.5))
    assert motion.min_eigenvalue == 0.0 and isinstance(motion, bm.IncoherentMotion)
    runs = []
    for field in (motion, pickle.loads(pickle.dumps(motion))):
        simulation = bm.Simulation(0.01, BODY, ground, bm.Coulomb(0.5), motion=field)
        runs.append(simulation.run(duration=12.0, warn=False))
    assert same_bits(runs[0]["twist"], runs[1]["twist"])
    assert np.abs(runs[0]["twist"]).max() > 1e-6 and runs[0].energy_error < 1e-9
    # It ends with its record.
    assert bm.Simulation(0.01, BODY, ground, bm.Bonded(), motion=motion).run(warn=False).end >= RECORD.duration
    with pytest.raises(bm.InputError, match="elements of this ground"):
        bm.Simulation(0.01, BODY, bm.ElasticGround.under(SOIL, BODY, 5), bm.Bonded(), motion=motion)


def test_wrong_coherence_is_an_error_with_its_reason() -> None:
    ground = in_the_plane()

    def fails(frequency: float, separation: tuple[float, float]) -> float:
        raise KeyError("no table")

    with pytest.raises(KeyError, match="no table"):
        bm.Incoherence(bm.CoherenceFn(of_separation=fails)).motion(ground, x=RECORD)
    with pytest.raises(bm.InputError, match="must be|invalid"):
        bm.Incoherence(bm.CoherenceFn(of_separation=lambda f, s: "one")).motion(ground, x=RECORD)  # type: ignore[arg-type,return-value]
    with pytest.raises(bm.InputError, match="coherence"):
        bm.Incoherence(bm.CoherenceFn(of_separation=lambda f, s: 2.0)).motion(ground, x=RECORD)
    with pytest.raises(bm.InputError, match="give a record"):
        bm.Incoherence(WAVES).motion(ground)
    with pytest.raises(bm.InputError, match="one of them"):
        bm.CoherenceFn()
    with pytest.raises(bm.InputError, match="apparent_velocity"):
        bm.Incoherence(WAVES, azimuth=1.0)
    with pytest.raises(bm.InputError, match="bandwidth"):
        bm.Incoherence(WAVES, bandwidth=0.0)
    # Abrahamson's matrices have negative eigenvalues on small cells.
    rock = bm.AbrahamsonCoherence("hard_rock_horizontal")
    cells = bm.ElasticGround(SOIL, bm.Strip(-10.0, 10.0, 16))
    with pytest.raises(bm.InputError, match=r"Hz.*clipped=True"):
        bm.Incoherence(rock).motion(cells, x=RECORD)
    assert -0.2 < bm.Incoherence(rock, clipped=True).motion(cells, x=RECORD).min_eigenvalue < 0.0


def test_water_lifts_a_base() -> None:
    weight = 1500.0 * bm.STANDARD_GRAVITY * 200.0
    buoyancy = 1025.0 * bm.STANDARD_GRAVITY * 3.0 * 20.0

    def run(initial: bm.InitialConditions) -> bm.Run:
        simulation = bm.Simulation(
            0.01, BLOCK, in_the_plane(), bm.Coulomb(0.4), motion=bm.el_centro_1940().scaled(2.0), initial=initial
        )
        return simulation.run(1000, contact_every=1, warn=False)

    water = bm.WaterTable(-3.0, density=1025.0)
    found = run(bm.InitialConditions(water_table=water))
    assert found.buoyancy == pytest.approx(buoyancy, rel=1e-12)
    assert found.static_normal_force == pytest.approx(weight - buoyancy, rel=1e-9)
    assert f"buoyancy {1e-3 * buoyancy:.1f} kN/m" in str(found) and found.energy_error < 1e-9
    # The same mass under less gravity.
    gravity = bm.STANDARD_GRAVITY * (1.0 - buoyancy / weight)
    other = run(bm.InitialConditions(gravity=gravity))
    difference = np.abs(found["normal_force"] - other["normal_force"]).max()
    assert difference < 1e-12 * np.abs(other["normal_force"]).max()
    copy = copied(found)
    assert isinstance(copy, bm.Run) and other.buoyancy == 0.0 and copy.buoyancy == found.buoyancy
    with pytest.raises(bm.InputError, match=r"floats: the water lifts it"):
        run(bm.InitialConditions(water_table=bm.WaterTable(-16.0)))
    with pytest.raises(TypeError, match=r"InitialConditions\(water_table="):
        bm.Simulation(0.01, BLOCK, in_the_plane(), bm.Bonded(), water_table=water)  # type: ignore[call-arg]
    assert repr(water) == "WaterTable(-3.0, density=1025.0)" and copied(water) == water


def copied(value: object) -> object:
    return pickle.loads(pickle.dumps(value))


def test_water_around_a_trench() -> None:
    elements = bm.Trench(-6.0, 6.0, 5.0).elements(4, 3)
    block = bm.WithWalls(bm.RigidBlock(12.0, 20.0, 900.0), 5.0)
    soil = bm.Soil.from_shear_wave_speed(200.0, poisson=0.33, density=2000.0)
    water = bm.WaterTable(1.0)
    ground = bm.TrenchGround(soil, elements, pressure_at_rest=0.5, water_table=water)
    simulation = bm.Simulation(0.01, block, ground, bm.Coulomb(0.5))
    effective = (900.0 * 20.0 - 1000.0 * 4.0) * bm.STANDARD_GRAVITY * 12.0
    assert simulation.state.normal_force == pytest.approx(effective, rel=1e-9)
    # K₀ σ'_v, summed over the depth.
    thrust = 0.5 * bm.STANDARD_GRAVITY * (2000.0 * 0.5 + 2000.0 * 4.0 + 1000.0 * 8.0)
    assert simulation.state.face("left_wall").thrust == pytest.approx(thrust, rel=1e-9)
    active = ground.interfaces(bm.Coulomb(0.5), bm.SoilStrength(0.5))[0]
    dry = bm.TrenchGround(soil, elements, pressure_at_rest=0.5).interfaces(bm.Coulomb(0.5), bm.SoilStrength(0.5))[2]
    assert repr(active) != repr(dry)
    with pytest.raises(bm.InputError, match="zero or more"):
        bm.TrenchGround(soil, elements, water_table=bm.WaterTable(-1.0))
    with pytest.raises(bm.InputError, match=r"TrenchGround\(water_table=…\)"):
        bm.Simulation(
            0.01,
            block,
            bm.TrenchGround(soil, elements),
            bm.Coulomb(0.5),
            initial=bm.InitialConditions(water_table=water),
        )
