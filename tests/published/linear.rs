//! GOAL: the linear problem: impedances, and structures under an SV pulse.
//! SCENE: rigid strips, rigid blocks, a cantilever and a shear building, bonded or relaxed.
//! REFERENCE: Luco & Westmann 1972, Karasudhi, Keer & Lee 1968, tables computed independently of
//! this crate.

use basemat::Soil;
use basemat::bem::{ElasticGround, Grading, Ground, Strip};
use basemat::coupled::State;
use basemat::structure::{RigidBlock, Structure};

use basemat_problems::impedance::{impedance_errors, ricker};
use basemat_problems::rigid_strip::{DrivenStrip, StripTractions};
use basemat_problems::sampled_block::{base_motion, moment, rotation, shear, under_pulse};
use basemat_problems::series::{RelativeError, TabledSeries, assert_within, nearest_integer};
use basemat_problems::table;
use basemat_problems::tabled_structures::{Cantilever, three_storeys};

/// Grading, number of elements, and time step of a strip of half width 1.
type StripMesh = (Grading, usize, f64);

/// Errors of `[uy_Fy, ux_Fx, th_Fx, ux_M, th_M]`.
fn transient_errors(
    file: &str,
    poisson: f64,
    mesh: StripMesh,
    bonded: bool,
    load: impl Fn(f64) -> f64,
) -> [f64; 5] {
    let (grading, elements, time_step) = mesh;
    let table = table(file);
    let vertical = TabledSeries::new(&table, "uy_Fy");
    let horizontal = TabledSeries::new(&table, "ux_Fx");
    let coupling = TabledSeries::new(&table, "th_Fx");
    let rocking = TabledSeries::new(&table, "th_M");
    let mut errors = [RelativeError::default(); 5];
    let contacts = if bonded {
        [StripTractions::Bonded, StripTractions::Bonded]
    } else {
        [StripTractions::Tangential, StripTractions::Normal]
    };
    let mut strips =
        contacts.map(|contact| DrivenStrip::new(poisson, grading, elements, time_step, contact));
    let steps = nearest_integer(vertical.duration() / time_step);
    for n in 1..=steps {
        let time = n as f64 * time_step;
        let force =
            (load(time - time_step) + 4.0 * load(time - 0.5 * time_step) + load(time)) / 6.0;
        let by_forces;
        let by_moment;
        if bonded {
            by_forces = strips[0].push([force, force, 0.0]);
            by_moment = strips[1].push([0.0, 0.0, force]);
        } else {
            let without_pressure = strips[0].push([force, 0.0, 0.0]);
            let without_shear = strips[1].push([0.0, force, force]);
            by_forces = [without_pressure[0], without_shear[1], 0.0];
            by_moment = [0.0, 0.0, without_shear[2]];
        }
        errors[0].add(by_forces[1], vertical.at(time));
        errors[1].add(by_forces[0], horizontal.at(time));
        errors[2].add(by_forces[2], coupling.at(time));
        errors[3].add(by_moment[0], coupling.at(time));
        errors[4].add(by_moment[2], rocking.at(time));
    }
    errors.map(RelativeError::relative)
}

/// A column, the same quantity of a state, and whether it is a mean over the step.
type StateCheck<'a> = (&'a str, &'a dyn Fn(&State) -> f64, bool);

/// Errors of a structure with degrees of freedom `[u_x, u_y, θ, …]` under the vertically incident S wave of
/// the tables.
fn structure_errors<const N: usize>(
    file: &str,
    structure: impl Structure + 'static,
    ground: impl Ground + 'static,
    time_step: f64,
    checks: [StateCheck; N],
) -> [f64; N] {
    let table = table(file);
    let columns = checks.map(|check| TabledSeries::new(&table, check.0));
    let mut simulation = under_pulse(structure, ground, time_step);
    let mut errors = [RelativeError::default(); N];
    let steps = nearest_integer(columns[0].duration() / time_step);
    let run = simulation
        .run(steps, |state| {
            for k in 0..N {
                let expected = if checks[k].2 {
                    columns[k].mean(state.time, time_step)
                } else {
                    columns[k].at(state.time)
                };
                errors[k].add(checks[k].1(state), expected);
            }
        })
        .unwrap();
    assert!(run.energy_error < 1e-9, "energy balance open by {:.1e}", run.energy_error);
    assert!(run.energy_balance.soil > 0.0, "energy radiated: {:e}", run.energy_balance.soil);
    errors.map(RelativeError::relative)
}

/// The half-plane of the tables, of unit shear modulus and density, under a strip of half width 1.
fn half_plane(poisson: f64, (grading, elements, _): StripMesh) -> ElasticGround {
    let soil = Soil::new(1.0, poisson, 1.0).unwrap();
    let strip = Strip::new(-1.0..1.0, elements, grading).unwrap();
    ElasticGround::new(soil, strip).unwrap()
}

/// Horizontal displacement at `height` above a rigid base.
fn roof_displacement(state: &State, height: f64) -> f64 {
    state.absolute_displacement()[0] - height * state.absolute_displacement()[2]
}

pub(super) fn block_errors(
    file: &str,
    ground: impl Ground + 'static,
    height: f64,
    density: f64,
    time_step: f64,
) -> [f64; 5] {
    structure_errors(
        file,
        RigidBlock::new(2.0, height, density).unwrap(),
        ground,
        time_step,
        [
            ("u_base", &base_motion, false),
            ("theta", &rotation, false),
            ("u_roof", &|state| roof_displacement(state, height), false),
            ("V", &shear, true),
            ("M", &moment, true),
        ],
    )
}

/// Shear force in the cantilever above the mass of the base.
fn beam_shear(state: &State) -> f64 {
    -state.base_shear - state.acceleration()[0]
}

fn cantilever_errors(mesh: StripMesh, beams: usize) -> [f64; 6] {
    let cantilever = Cantilever::new(beams);
    let top = cantilever.top();
    structure_errors(
        "td_EBcantilever_SV_nu0333.csv",
        cantilever,
        half_plane(1.0 / 3.0, mesh),
        mesh.2,
        [
            ("u_base", &base_motion, false),
            ("theta", &rotation, false),
            ("u_top", &|state| state.absolute_displacement()[top], false),
            ("V_beam", &beam_shear, true),
            ("V", &shear, true),
            ("M", &moment, true),
        ],
    )
}

/// Displacement of storey `j` relative to the frame of the base.
fn storey_displacement(state: &State, j: usize) -> f64 {
    let u = state.absolute_displacement();
    u[2 + j] - u[0] + j as f64 * u[2]
}

fn building_errors(mesh: StripMesh) -> [f64; 7] {
    let building = three_storeys().unwrap();
    let first_shear = building.shear(0).unwrap();
    let storey_shear = move |s: &State| {
        first_shear.value(s.absolute_displacement(), s.velocity(), s.acceleration())
    };
    structure_errors(
        "td_shearbuilding3_SV_nu0333_sig1.csv",
        building,
        half_plane(1.0 / 3.0, mesh),
        mesh.2,
        [
            ("u_base", &base_motion, false),
            ("theta", &rotation, false),
            ("v1", &|state| storey_displacement(state, 1), false),
            ("v3", &|state| storey_displacement(state, 3), false),
            ("V1", &storey_shear, false),
            ("V", &shear, true),
            ("M", &moment, true),
        ],
    )
}

const UNIFORM_8: StripMesh = (Grading::Uniform, 8, 0.05);
const UNIFORM_16: StripMesh = (Grading::Uniform, 16, 0.05);
const UNIFORM_32: StripMesh = (Grading::Uniform, 32, 0.05);
const COSINE_8: StripMesh = (Grading::Cosine, 8, 0.05);
const COSINE_16: StripMesh = (Grading::Cosine, 16, 0.05);

/// Name in the tables, and value.
const POISSON_RATIOS: [(&str, f64); 3] = [("0", 0.0), ("025", 0.25), ("0333", 1.0 / 3.0)];

/// Errors of the impedances on four meshes, their limits, and the order in the element size.
fn check_impedances(bonded: bool) {
    let kind = if bonded { "bonded" } else { "relaxed" };
    let names = if bonded { &["khh", "kvv", "krr", "khr"][..] } else { &["khh", "kvv", "krr"] };
    let count = names.len();
    for (name, poisson) in POISSON_RATIOS {
        let file = format!("strip_{kind}_nu{name}_xi00.csv");
        let limits = [
            (UNIFORM_8, [4e-2, 4e-2, 1.3e-1, 7.3e-2]),
            (UNIFORM_16, [2e-2, 2e-2, 6.2e-2, 3.5e-2]),
            (COSINE_8, [1.3e-2, 1.3e-2, 3.9e-2, 1.9e-2]),
            (COSINE_16, [3.5e-3, 3.3e-3, 9.7e-3, 6.2e-3]),
        ];
        let mesh_errors = limits.map(|(mesh, limits)| {
            let errors = impedance_errors(&file, poisson, mesh, bonded);
            let scene = format!("{kind} {name} {:?} {}", mesh.0, mesh.1);
            assert_within(&scene, names, &errors[..count], &limits[..count]);
            errors
        });
        for k in 0..3 {
            let uniform = (mesh_errors[0][k] / mesh_errors[1][k]).log2();
            let cosine = (mesh_errors[2][k] / mesh_errors[3][k]).log2();
            assert!((0.9..1.2).contains(&uniform), "order of {}: {uniform}", names[k]);
            assert!((1.7..2.3).contains(&cosine), "order of {}: {cosine}", names[k]);
        }
    }
}

/// GOAL: the soil operator alone, all components, converges to that of the half-plane.
/// SCENE: massless rigid strip, bonded; a Ricker pulse of each rigid motion, Fourier transformed.
/// REFERENCE: impedances over a₀, the problem of Luco & Westmann 1972, by a spectral method.
#[test]
fn impedances_of_bonded_strips_are_those_of_luco_westmann_1972() {
    check_impedances(true);
    let file = "strip_bonded_nu0333_xi00.csv";
    let errors = impedance_errors(file, 1.0 / 3.0, UNIFORM_32, true);
    let limits = [8.5e-3, 9.5e-3, 2.9e-2, 1.8e-2];
    assert_within("bonded 0333 Uniform 32", &["khh", "kvv", "krr", "khr"], &errors, &limits);
}

/// GOAL: as above for the diagonal parts of the operator, without their coupling.
/// SCENE: the strip transmits pressure without shear, or shear without pressure.
/// REFERENCE: relaxed impedances, the problem of Karasudhi, Keer & Lee 1968.
#[test]
fn impedances_of_relaxed_strips_are_those_of_karasudhi_keer_lee_1968() {
    check_impedances(false);
}

fn gauss_pulse(t: f64) -> f64 {
    (-((t - 3.0) / 0.5).powi(2)).exp()
}

/// GOAL: the operator in time, with forces prescribed.
/// SCENE: massless rigid strip under a Gaussian or Ricker pulse of each force.
/// REFERENCE: `td_strip_*`, Fourier syntheses of the impedances, in time.
#[test]
fn strips_under_force_pulses_move_as_in_the_tables_td_strip() {
    let names = ["uy_Fy", "ux_Fx", "th_M", "th_Fx", "ux_M"];
    let order = [0, 1, 4, 2, 3];
    for (kind, count) in [("bonded", 5), ("relaxed", 3)] {
        for (name, poisson) in &POISSON_RATIOS[1..] {
            for (pulse, limits) in [
                (
                    "gauss",
                    [
                        [7e-3, 6.4e-3, 3e-2, 2.6e-2, 2.6e-2],
                        [1.8e-3, 1.6e-3, 7.5e-3, 6.6e-3, 6.6e-3],
                    ],
                ),
                (
                    "ricker2",
                    [[1.2e-2, 1e-2, 3.5e-2, 3.9e-2, 3.9e-2], [3.1e-3, 2.6e-3, 8.4e-3, 1e-2, 1e-2]],
                ),
            ] {
                let file = format!("td_strip_{kind}_nu{name}_{pulse}.csv");
                for (mesh, limits) in [COSINE_8, COSINE_16].into_iter().zip(limits) {
                    let errors = transient_errors(&file, *poisson, mesh, kind == "bonded", |t| {
                        if pulse == "gauss" { gauss_pulse(t) } else { ricker(t, 1.0, 5.0) }
                    });
                    let errors = order.map(|k| errors[k]);
                    let scene = format!("{kind} {name} {pulse} cosine {}", mesh.1);
                    assert_within(&scene, &names[..count], &errors[..count], &limits[..count]);
                }
            }
        }
    }
}

/// GOAL: structure, soil and incident wave together, forces on the soil included.
/// SCENE: rigid blocks of three slendernesses, bonded, vertically incident SV Ricker pulse.
/// REFERENCE: `td_block_SV_*`, frequency domain; forces as their means over the step.
#[test]
fn blocks_under_an_sv_pulse_move_as_in_the_tables_td_block() {
    let names = ["u_base", "theta", "u_roof", "V", "M"];
    let third = 1.0 / 3.0;
    for (name, poisson, height, density, limits) in [
        ("nu025_h1_rho1", 0.25, 1.0, 1.0, [4e-3, 8.5e-3, 9.3e-3, 2e-3, 1.5e-2]),
        ("nu025_h2_rho1", 0.25, 2.0, 1.0, [4.5e-3, 5.2e-3, 8.2e-3, 2.7e-3, 1.5e-2]),
        ("nu025_h4_rho0.5", 0.25, 4.0, 0.5, [3.6e-3, 3.8e-3, 4.8e-3, 2.9e-3, 1.6e-2]),
        ("nu0333_h1_rho1", third, 1.0, 1.0, [3.6e-3, 8.5e-3, 8.7e-3, 2e-3, 1.4e-2]),
        ("nu0333_h2_rho1", third, 2.0, 1.0, [4.2e-3, 5.1e-3, 8.3e-3, 2.4e-3, 1.5e-2]),
        ("nu0333_h4_rho0.5", third, 4.0, 0.5, [3.4e-3, 3.7e-3, 5e-3, 2.7e-3, 1.6e-2]),
    ] {
        let file = format!("td_block_SV_{name}.csv");
        let errors =
            block_errors(&file, half_plane(poisson, COSINE_16), height, density, COSINE_16.2);
        assert_within(&format!("block {name} cosine 16"), &names, &errors, &limits);
    }
    for (mesh, limits) in [
        (UNIFORM_8, [4.8e-2, 5.9e-2, 1e-1, 3e-2, 1.8e-1]),
        (UNIFORM_16, [2.3e-2, 2.8e-2, 5e-2, 1.5e-2, 8.5e-2]),
        (UNIFORM_32, [1.2e-2, 1.4e-2, 2.4e-2, 7.3e-3, 4.2e-2]),
        (COSINE_8, [1.5e-2, 1.8e-2, 3.2e-2, 9.2e-3, 5.3e-2]),
    ] {
        let ground = half_plane(third, mesh);
        let errors = block_errors("td_block_SV_nu0333_h2_rho1.csv", ground, 2.0, 1.0, mesh.2);
        assert_within(
            &format!("block nu0333_h2_rho1 {:?} {}", mesh.0, mesh.1),
            &names,
            &errors,
            &limits,
        );
    }
}

/// GOAL: a user's flexible structure of finite elements with damping.
/// SCENE: Euler–Bernoulli cantilever (8 beams) on a bonded rigid base, SV Ricker pulse.
/// REFERENCE: `td_EBcantilever_SV_nu0333.csv`, exact beam functions in the frequency domain.
#[test]
fn a_cantilever_under_an_sv_pulse_moves_as_in_its_table() {
    let names = ["u_base", "theta", "u_top", "V_beam", "V", "M"];
    let limits = [3.8e-3, 6.9e-3, 6.1e-3, 3.6e-3, 3.2e-3, 1.3e-2];
    assert_within("cantilever cosine 16", &names, &cantilever_errors(COSINE_16, 8), &limits);
}

/// GOAL: the shear building, its storeys' dashpots and section forces.
/// SCENE: three storeys on a massive bonded base, SV Ricker pulse.
/// REFERENCE: `td_shearbuilding3_SV_nu0333_sig1.csv`, frequency domain.
#[test]
fn a_shear_building_under_an_sv_pulse_moves_as_in_its_table() {
    let names = ["u_base", "theta", "v1", "v3", "V1", "V", "M"];
    let limits = [3.3e-3, 4.5e-3, 3.8e-3, 7.6e-3, 3.4e-3, 2.1e-3, 1.15e-2];
    assert_within("shear building cosine 16", &names, &building_errors(COSINE_16), &limits);
}
