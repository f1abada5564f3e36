//! A wind turbine on octagons of one weight and three thicknesses, which bend and lift in a gust.
//!
//! ```text
//! cargo run --release --example flexible_octagon
//! ```
//!
//! The tower is a tube of beams on a rigid pedestal, the octagon is made of shells. Concrete and fill weigh the same
//! for each thickness. The table shows when the octagon no longer counts as rigid.

use std::f64::consts::{PI, TAU};

use basemat::coupled::Load;
use basemat::fem::{BeamSection, Direction, LumpedMass, Material, Mesh, Shell, SpaceBeam};
use basemat::prelude::*;

/// Width of the octagon across flats, radius of the pedestal, height of the hub, m.
const WIDTH: f64 = 20.0;
const PEDESTAL: f64 = 3.0;
const HUB: f64 = 92.0;
/// Weight of concrete and fill, kg/m²; mass of rotor and nacelle, kg.
const SURFACE: f64 = 6600.0;
const TOP: f64 = 200.0e3;
/// Sectors and rings of shells outside the pedestal; beams of the tower.
const SECTORS: usize = 16;
const RINGS: usize = 4;
const BEAMS: usize = 6;
/// Thrust on the rotor in steady wind and its largest increase in the gust, N; duration of the gust, s.
const THRUST: f64 = 0.7e6;
const GUST: f64 = 0.45e6;
const DURATION: f64 = 10.5;

/// Thrust of a gust that first falls, as the "Mexican hat" of IEC 61400-1.
fn thrust(time: f64) -> f64 {
    let t = (time / DURATION).clamp(0.0, 1.0);
    THRUST - 0.5 * GUST * (3.0 * PI * t).sin() * (1.0 - (TAU * t).cos())
}

/// Distance of the octagon's edge from its centre in the direction of this angle, m.
fn edge(angle: f64) -> f64 {
    0.5 * WIDTH / (angle - PI / 4.0 * (angle / (PI / 4.0)).round()).cos()
}

/// Turbine on an octagon of this thickness, m; the shells outside the pedestal, and the hub.
fn turbine(thickness: f64) -> basemat::Result<(FemModel, Vec<usize>, usize)> {
    let concrete = Material::new(32.0e9, 0.2, SURFACE / thickness)?;
    let mut mesh = Mesh::in_space();
    let foot = mesh.add_node_at([0.0; 3])?;
    let mut rings: Vec<Vec<usize>> = Vec::new();
    for ring in 0..=RINGS {
        let share = ring as f64 / RINGS as f64;
        let node = |sector: usize| {
            let angle = TAU * sector as f64 / SECTORS as f64;
            let radius = PEDESTAL + share * (edge(angle) - PEDESTAL);
            mesh.add_node_at([radius * angle.cos(), radius * angle.sin(), 0.0])
        };
        rings.push((0..SECTORS).map(node).collect::<basemat::Result<_>>()?);
    }
    let mut shells = Vec::new();
    for sector in 0..SECTORS {
        let next = (sector + 1) % SECTORS;
        shells.push(Shell::new([foot, rings[0][sector], rings[0][next]], concrete, thickness)?);
        for pair in rings.windows(2) {
            let corners = [pair[0][sector], pair[1][sector], pair[1][next], pair[0][next]];
            shells.push(Shell::new(corners, concrete, thickness)?);
        }
    }
    Shell::match_sides(&mut shells);
    let all: Vec<usize> = shells.into_iter().map(|own| mesh.add(own)).collect::<Result<_, _>>()?;
    let outside = all.into_iter().filter(|shell| shell % (RINGS + 1) > 0).collect();

    // A tube 4.2 m wide, 30 mm thick; bolts and fittings in the density.
    let steel = Material::new(210.0e9, 0.3, 8500.0)?;
    let (radius, wall) = (2.1_f64, 0.030);
    let moment = PI * radius.powi(3) * wall;
    let tube = BeamSection::new(TAU * radius * wall, [moment; 2], 2.0 * moment)?;
    let mut below = foot;
    for k in 1..=BEAMS {
        let above = mesh.add_node_at([0.0, 0.0, HUB * k as f64 / BEAMS as f64])?;
        mesh.add(SpaceBeam::new([below, above], steel, tube, [1.0, 0.0, 0.0])?)?;
        below = above;
    }
    mesh.add(LumpedMass::in_space(below, TOP, [0.0; 3])?)?;
    let damping = RayleighDamping::from_ratios([0.3, 3.0], [0.04, 0.02])?;
    let model = FemModel::on_base(mesh)?.with_rigid_link(foot, &rings[0])?;
    Ok((model.with_rayleigh(damping), outside, below))
}

fn main() -> basemat::Result<()> {
    let soil = Soil::from_shear_wave_speed(160.0, 0.4, 1900.0)?;
    println!("thickness, m  hub, m  foot's tilt, mrad  open, %  moment, MNm/m  energy error");
    for thickness in [3.0, 2.0, 1.2] {
        let (model, shells, hub) = turbine(thickness)?;
        let rows = model.shell_rows(&shells, |_| [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])?;
        let (top, foot) = (model.row(hub, Direction::X)?, model.row(0, Direction::RotationY)?);
        let mut simulation = Simulation::builder(0.01)
            .ground(ElasticGround::under(soil, &model, 12)?)
            .structure(model)
            .interface(Coulomb::new(0.6)?)
            .load(Load::new(top.clone(), thrust))
            .expected_steps(1500)
            .build()?;
        let rest = simulation.static_displacement().to_vec();
        let [mut hub, mut tilt, mut open, mut moment] = [0.0_f64; 4];
        let run = simulation.run(1500, |state| {
            let u: Vec<f64> = rest.iter().zip(state.displacement()).map(|(a, b)| a + b).collect();
            (hub, tilt) = (hub.max(top.value(&u)), tilt.max(foot.value(&u)));
            open = open.max(state.uplifted_fraction);
            let moments = rows.iter().flat_map(|own| own.value(&u).principal_moments());
            moment = moments.fold(moment, |largest, own| largest.max(own.abs()));
        })?;
        let (tilt, open, moment) = (1e3 * tilt, 100.0 * open, 1e-6 * moment);
        println!(
            "{thickness:>12.1} {hub:>7.3} {tilt:>18.2} {open:>8.0} {moment:>14.2} {:>13.1e}",
            run.energy_error
        );
        assert!(run.energy_error < 1e-9);
    }
    Ok(())
}
