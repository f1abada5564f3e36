//! A wind turbine on octagons that bend and lift in a gust.
//!
//! ```text
//! cargo run --release --example flexible_octagon
//! ```
//!
//! The tower is a tube of beams on a rigid pedestal, the octagon is made of shells. Octagons of three thicknesses have
//! the same weight of concrete and fill. The table shows from which thickness on the octagon is no longer practically
//! rigid.

use std::f64::consts::{PI, TAU};

use basemat::coupled::Load;
use basemat::fem::{BeamSection, Direction, LumpedMass, Material, Mesh, Shell, SpaceBeam};
use basemat::prelude::*;

/// Width of the octagon between parallel sides, m.
const OCTAGON_WIDTH: f64 = 20.0;
/// Radius of the pedestal, m.
const PEDESTAL_RADIUS: f64 = 3.0;
/// Height of the hub, m.
const HUB_HEIGHT: f64 = 92.0;
/// Mass of concrete and fill, kg/m².
const MASS_PER_AREA: f64 = 6600.0;
/// Mass of rotor and nacelle, kg.
const ROTOR_MASS: f64 = 200.0e3;
/// Number of sectors of the octagon.
const SECTOR_COUNT: usize = 16;
/// Number of rings of shells outside the pedestal.
const RING_COUNT: usize = 4;
/// Number of beam elements of the tower.
const BEAM_COUNT: usize = 6;
/// Thrust on the rotor in steady wind, N.
const STEADY_THRUST: f64 = 0.7e6;
/// Largest increase of the thrust in the gust, N.
const GUST_THRUST: f64 = 0.45e6;
/// Duration of the gust, s.
const GUST_DURATION: f64 = 10.5;
/// Number of steps of 0.01 s.
const STEP_COUNT: usize = 1500;

/// Thrust (N) over time (s) in a gust of the "Mexican hat" shape of IEC 61400-1, whose wind first decreases.
fn thrust(time: f64) -> f64 {
    let t = (time / GUST_DURATION).clamp(0.0, 1.0);
    STEADY_THRUST - 0.5 * GUST_THRUST * (3.0 * PI * t).sin() * (1.0 - (TAU * t).cos())
}

/// Distance of the octagon's edge from its centre in the direction `angle`, m.
fn edge(angle: f64) -> f64 {
    0.5 * OCTAGON_WIDTH / (angle - PI / 4.0 * (angle / (PI / 4.0)).round()).cos()
}

struct Turbine {
    model: FemModel,
    /// Indices of the octagon's elements outside the pedestal.
    octagon_shells: Vec<usize>,
    /// Node at the foot of the tower.
    foot: usize,
    /// Node at the top of the tower.
    hub: usize,
}

/// Nodes of the octagon on rings from the pedestal to the edge.
fn add_rings(mesh: &mut Mesh) -> basemat::Result<Vec<Vec<usize>>> {
    let mut rings = Vec::new();
    for ring in 0..=RING_COUNT {
        let fraction = ring as f64 / RING_COUNT as f64;
        let mut nodes = Vec::new();
        for sector in 0..SECTOR_COUNT {
            let angle = TAU * sector as f64 / SECTOR_COUNT as f64;
            let radius = PEDESTAL_RADIUS + fraction * (edge(angle) - PEDESTAL_RADIUS);
            nodes.push(mesh.add_node_at([radius * angle.cos(), radius * angle.sin(), 0.0])?);
        }
        rings.push(nodes);
    }
    Ok(rings)
}

/// Turbine on an octagon of this thickness, m.
fn turbine(thickness: f64) -> basemat::Result<Turbine> {
    let concrete = Material::new(32.0e9, 0.2, MASS_PER_AREA / thickness)?;
    let mut mesh = Mesh::in_space();
    let foot = mesh.add_node_at([0.0; 3])?;
    let rings = add_rings(&mut mesh)?;
    let mut shells = Vec::new();
    for sector in 0..SECTOR_COUNT {
        let next_sector = (sector + 1) % SECTOR_COUNT;
        shells.push(Shell::new(
            [foot, rings[0][sector], rings[0][next_sector]],
            concrete,
            thickness,
        )?);
        for pair in rings.windows(2) {
            let corners =
                [pair[0][sector], pair[1][sector], pair[1][next_sector], pair[0][next_sector]];
            shells.push(Shell::new(corners, concrete, thickness)?);
        }
    }
    Shell::match_sides(&mut shells);
    let mut octagon_shells = Vec::new();
    for (k, shell) in shells.into_iter().enumerate() {
        let element = mesh.add(shell)?;
        // The first shell of each sector is the pedestal's.
        if k % (RING_COUNT + 1) > 0 {
            octagon_shells.push(element);
        }
    }

    // A tube 4.2 m wide and 30 mm thick; the density includes bolts and fittings.
    let steel = Material::new(210.0e9, 0.3, 8500.0)?;
    let tube_radius = 2.1_f64;
    let wall_thickness = 0.030;
    let second_moment = PI * tube_radius.powi(3) * wall_thickness;
    let tube = BeamSection::new(
        TAU * tube_radius * wall_thickness,
        [second_moment; 2],
        2.0 * second_moment,
    )?;
    let mut lower_node = foot;
    for k in 1..=BEAM_COUNT {
        let upper_node = mesh.add_node_at([0.0, 0.0, HUB_HEIGHT * k as f64 / BEAM_COUNT as f64])?;
        mesh.add(SpaceBeam::new([lower_node, upper_node], steel, tube, [1.0, 0.0, 0.0])?)?;
        lower_node = upper_node;
    }
    let hub = lower_node;
    mesh.add(LumpedMass::in_space(hub, ROTOR_MASS, [0.0; 3])?)?;
    let damping = RayleighDamping::from_ratios([0.3, 3.0], [0.04, 0.02])?;
    let model = FemModel::on_base(mesh)?.with_rigid_link(foot, &rings[0])?;
    Ok(Turbine { model: model.with_rayleigh(damping), octagon_shells, foot, hub })
}

fn main() -> basemat::Result<()> {
    let soil = Soil::from_shear_wave_speed(160.0, 0.4, 1900.0)?;
    println!("thickness, m  hub, m  foot's tilt, mrad  open, %  moment, MNm/m  energy error");
    for thickness in [3.0, 2.0, 1.2] {
        let Turbine { model, octagon_shells, foot, hub } = turbine(thickness)?;
        let moment_rows =
            model.shell_rows(&octagon_shells, |_| [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])?;
        let hub_displacement = model.row(hub, Direction::X)?;
        let foot_tilt = model.row(foot, Direction::RotationY)?;
        let mut simulation = Simulation::builder(0.01)
            .ground(ElasticGround::under(soil, &model, 12)?)
            .structure(model)
            .interface(Coulomb::new(0.6)?)
            .load(Load::new(hub_displacement.clone(), thrust))
            .expected_steps(STEP_COUNT)
            .build()?;
        let at_rest = simulation.static_displacement().to_vec();
        let mut largest_displacement = 0.0_f64;
        let mut largest_tilt = 0.0_f64;
        let mut largest_opening = 0.0_f64;
        let mut largest_moment = 0.0_f64;
        let run = simulation.run(STEP_COUNT, |state| {
            let changes = state.displacement().iter();
            let displacement: Vec<f64> =
                at_rest.iter().zip(changes).map(|(rest, change)| rest + change).collect();
            largest_displacement = largest_displacement.max(hub_displacement.value(&displacement));
            largest_tilt = largest_tilt.max(foot_tilt.value(&displacement));
            largest_opening = largest_opening.max(state.uplifted_fraction);
            let moments =
                moment_rows.iter().flat_map(|row| row.value(&displacement).principal_moments());
            largest_moment = moments.fold(largest_moment, |largest, m| largest.max(m.abs()));
        })?;
        println!(
            "{thickness:>12.1} {largest_displacement:>7.3} {:>18.2} {:>8.0} {:>14.2} {:>13.1e}",
            1e3 * largest_tilt,
            100.0 * largest_opening,
            1e-6 * largest_moment,
            run.energy_error
        );
        assert!(run.energy_error < 1e-9);
    }
    Ok(())
}
