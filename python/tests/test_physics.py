"""Results against formulas and integrators that share no code with the crate."""

from __future__ import annotations

import numpy as np
import scipy.integrate
import scipy.linalg
import scipy.signal
import scipy.sparse

import basemat as bm


def stiff_ground(structure: bm.Structure, stiffness: float = 1.0e11) -> bm.SpringGround:
    """As good as rigid."""
    return bm.SpringGround.under(structure, 4, stiffness, stiffness)


def test_yielding_storey_against_scipys_integration() -> None:
    mass, stiffness, force, hardening, damping = 20.0e3, 4.0e6, 25.0e3, 0.1, 1.0e4
    storey = bm.Storey(3.0, mass, stiffness, damping=damping)
    laws = {0: bm.Bilinear(stiffness, force, hardening)}
    building = bm.ShearBuilding(20.0, 50.0e3, 1.0e6, [storey], laws=laws)
    record = bm.el_centro_1940()
    simulation = bm.Simulation(
        0.001,
        building,
        stiff_ground(building),
        bm.Bonded(),
        motion=record,
        probes=[bm.Probe.displacement("drift", building.drift(0))],
    )
    run = simulation.run(duration=8.0)

    # u'' m + c u' + α k u + (1 − α) k z = −m a, z the stretch of a spring on a slider.
    times, samples, limit = record.times, record.accelerations, force / stiffness

    def rates(time: float, state: np.ndarray) -> list[float]:
        u, v, z = state
        spring = hardening * stiffness * u + (1.0 - hardening) * stiffness * z
        ground = np.interp(time, times, samples)
        slides = abs(z) >= limit and z * v > 0.0
        return [v, -(damping * v + spring) / mass - ground, 0.0 if slides else v]

    found = scipy.integrate.solve_ivp(
        rates,
        (0.0, 8.0),
        [0.0, 0.0, 0.0],
        t_eval=run.time[::10],
        max_step=5e-4,
        rtol=1e-8,
        atol=1e-10,
    )
    drift, expected = run["drift"][::10], found.y[0]
    largest = np.abs(expected).max()
    assert largest > 3.0 * limit, "it must yield"
    assert abs(expected[-1]) > 0.1 * limit or abs(expected).argmax() < expected.size
    np.testing.assert_allclose(drift, expected, rtol=0.0, atol=5e-3 * largest)
    # The heat in the columns is the work of the slider.
    assert run.energy_balance.hysteresis > 0.1 * run.energy_balance.relative_input
    assert run.energy_error < 1e-9


def test_linear_oscillator_from_matrices_against_its_state_space() -> None:
    """A mass on a spring on a rigid base on stiff ground: ``lsim`` of the oscillator alone."""
    mass, omega, ratio = 1.0e4, 2.0 * np.pi * 2.0, 0.05
    height = 5.0
    stretch = scipy.sparse.csr_array(np.array([[-1.0, 0.0, height, 1.0]]))
    stiffness = mass * omega**2 * (stretch.T @ stretch)
    inertia = scipy.sparse.diags_array([2.0e5, 2.0e5, 2.0e6, mass])
    model = bm.MatrixModel(
        inertia,
        stiffness,
        bm.BaseNode.rigid_base(-10.0, 10.0, [0, 1, 2]),
        damping=2.0 * ratio / omega * stiffness,
    )
    record = bm.el_centro_1940()
    simulation = bm.Simulation(
        0.001,
        model,
        stiff_ground(model),
        bm.Bonded(),
        motion=record,
        probes=[
            bm.Probe.displacement("stretch", {3: 1.0, 0: -1.0, 2: height}),
            bm.Probe.acceleration("floor", 3),
        ],
    )
    run = simulation.run(duration=10.0)
    time = run.time
    ground = np.interp(time, record.times, record.accelerations)
    system = (
        [[0.0, 1.0], [-(omega**2), -2.0 * ratio * omega]],
        [[0.0], [-1.0]],
        [[1.0, 0.0]],
        [[0.0]],
    )
    _, expected, _ = scipy.signal.lsim(system, ground, time)
    np.testing.assert_allclose(
        run["stretch"], expected, rtol=0.0, atol=2e-3 * np.abs(expected).max()
    )

    # The floor spectrum, by the same means.
    floor = run.acceleration_record("floor").accelerations
    spectrum = run.floor_spectrum("floor", [0.1, 0.5, 1.0], damping=0.02)
    fine = np.arange(0.0, time[-1], 1e-4)
    for k, period in enumerate([0.1, 0.5, 1.0]):
        omega = 2.0 * np.pi / period
        system = (
            [[0.0, 1.0], [-(omega**2), -0.04 * omega]],
            [[0.0], [-1.0]],
            [[1.0, 0.0]],
            [[0.0]],
        )
        _, response, _ = scipy.signal.lsim(system, np.interp(fine, time, floor), fine)
        assert abs(spectrum.displacement[k] / np.abs(response).max() - 1.0) < 1e-4
        assert (
            abs(spectrum.pseudo_acceleration[k] / (omega**2 * spectrum.displacement[k]) - 1.0)
            < 1e-14
        )
    # It is largest at the oscillator's own period.
    assert spectrum.acceleration[1] > 3.0 * max(spectrum.acceleration[0], spectrum.acceleration[2])


def test_snap_back_is_a_cosine() -> None:
    block = bm.RigidBlock(4.0, 2.0, 2000.0)
    stiffness = 5.0e7
    force = -1.0e5
    simulation = bm.Simulation(
        1e-4,
        block,
        bm.SpringGround.under(block, 4, stiffness, stiffness),
        bm.Bonded(),
        loads=[bm.Load.released(bm.RigidBlock.VERTICAL, force)],
        probes=[bm.Probe.displacement("down", bm.RigidBlock.VERTICAL)],
    )
    run = simulation.run(duration=0.5)
    omega = np.sqrt(4.0 * stiffness / block.total_mass)
    expected = -force / (4.0 * stiffness) * (1.0 - np.cos(omega * run.time))
    np.testing.assert_allclose(run["down"], expected, rtol=0.0, atol=1e-3 * np.abs(expected).max())
    assert run["down"].max() > 1.9 * abs(force) / (4.0 * stiffness)


def test_frame_from_arrays_has_a_cantilevers_frequency_and_deflection() -> None:
    """A steel column of 8 beams, clamped at its foot: 1.875104²/2π · √(EI/ρA)/L² and P L³/3 E I."""
    modulus, area, second_moment, density, length = 2.1e11, 0.02, 2.0e-4, 7850.0, 10.0
    nodes = np.column_stack([np.zeros(9), np.linspace(0.0, length, 9)])
    mesh = bm.Mesh(np.vstack([nodes, [[-1.0, 0.0], [1.0, 0.0]]]))
    mesh.add_beams(
        np.column_stack([np.arange(8), np.arange(1, 9)]), modulus, area, second_moment, density
    )
    mesh.add_beams([[9, 0], [0, 10]], modulus, 1.0, [1.0, 1.0], 1.0)
    model = bm.FemModel(mesh, [9, 0, 10])
    stiffness, mass = model.stiffness(), model.mass()
    np.testing.assert_allclose(stiffness, stiffness.T, atol=1e-9 * stiffness.max())
    base = [model.dof_at(node, way) for node in (9, 0, 10) for way in ("x", "y", "rotation")]
    free = np.setdiff1d(np.arange(model.dofs), base)
    squares = scipy.linalg.eigh(
        stiffness[np.ix_(free, free)], mass[np.ix_(free, free)], eigvals_only=True
    )
    expected = 1.875104**2 * np.sqrt(modulus * second_moment / (density * area)) / length**2
    assert abs(np.sqrt(squares[0]) / expected - 1.0) < 1e-4
    load = np.zeros(model.dofs)
    load[model.dof_at(8, "x")] = 1000.0
    deflection = np.linalg.solve(stiffness[np.ix_(free, free)], load[free])
    tip = deflection[list(free).index(model.dof_at(8, "x"))]
    assert abs(tip / (1000.0 * length**3 / (3.0 * modulus * second_moment)) - 1.0) < 1e-9


def test_layer_on_rigid_base_amplifies_as_one_over_two_ratios_over_pi() -> None:
    """At its first frequency c/4H a damped layer amplifies by about 2/(π ξ)."""
    clay = bm.Soil.from_shear_wave_speed(200.0, 0.3, 1800.0)
    law = bm.DampingLaw.constant_q(0.05, (0.5, 50.0), 5.0)
    profile = bm.SoilProfile([bm.SoilLayer(clay, 10.0, law)])
    assert profile.first_frequency == 5.0
    [value] = bm.SoilColumn(profile).transfer([5.0], control="within")
    assert abs(abs(value) - 2.0 / (np.pi * 0.05)) < 0.3
    # Without damping 1/cos(2π f H/c), between the resonances.
    elastic = bm.SoilColumn(bm.SoilProfile([bm.SoilLayer(clay, 10.0)]))
    frequencies = np.array([0.5, 2.0, 4.0, 7.0, 12.0])
    expected = 1.0 / np.cos(2.0 * np.pi * frequencies * 10.0 / 200.0)
    np.testing.assert_allclose(elastic.transfer(frequencies, control="within"), expected, rtol=1e-9)
