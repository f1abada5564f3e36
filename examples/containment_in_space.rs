//! A containment of shells on a raft that bends, lifts and slides under three components of an earthquake.
//!
//! ```text
//! cargo run --release --example containment_in_space
//! ```
//!
//! Raft, wall and dome are shells. The raft bends: the ground acts on each cell of its underside. A bonded base is
//! compared with one that opens and slides: forces at the wall's foot, and the largest bending moment in
//! the raft, which falls with the size of the cells: 3.5, 3.4 and 3.3 MNm/m on 132, 224 and 332 cells.
//! `target/containment_raft.svg` has the moments along x of the raft that opens, when this one acts.

use basemat::fem::{Material, Mesh};
use basemat::motion::Triaxial;
use basemat::plot::shell_plan;
use basemat::prelude::*;
use basemat::results::Extremes;
use basemat::structure::{FemModel, RayleighDamping};

/// Radius of the wall's middle surface and its height, m.
const RADIUS: f64 = 20.0;
const HEIGHT: f64 = 30.0;
/// Thickness of raft, wall and dome, m.
const THICKNESS: [f64; 3] = [3.0, 1.2, 1.0];
/// Sectors round the axis, and rows of elements of raft, wall and dome.
const SECTORS: usize = 24;
const ROWS: [usize; 3] = [5, 5, 4];
/// Time step, s, and number of steps.
const STEP: f64 = 0.01;
const STEPS: usize = 1000;

/// The containment, a raft from its middle outwards, the wall upwards, a spherical dome; and the shells of the raft.
fn containment() -> basemat::Result<(FemModel, Vec<usize>)> {
    let concrete = Material::new(32.0e9, 0.2, 2450.0)?;
    let [raft, wall, dome] = ROWS;
    let part = |index: usize, of: usize| index as f64 / of as f64;
    let mut meridian: Vec<[f64; 2]> = (0..raft).map(|i| [RADIUS * part(i, raft), 0.0]).collect();
    meridian.extend((0..wall).map(|i| [RADIUS, HEIGHT * part(i, wall)]));
    meridian.extend((0..=dome).map(|i| {
        let angle = std::f64::consts::FRAC_PI_2 * part(i, dome);
        let radius = if i == dome { 0.0 } else { RADIUS * angle.cos() };
        [radius, HEIGHT + RADIUS * angle.sin()]
    }));
    let mut mesh = Mesh::in_space();
    let surface = mesh.revolve([0.0; 2], &meridian, SECTORS)?;
    let thickness = |row| THICKNESS[usize::from(row >= raft) + usize::from(row >= raft + wall)];
    let mut raft_shells = Vec::new();
    for (shell, (row, _)) in surface.shells(concrete, thickness)?.into_iter().zip(surface.cells()) {
        let element = mesh.add(shell)?;
        if row < raft {
            raft_shells.push(element);
        }
    }
    let damping = RayleighDamping::from_ratios([4.0, 25.0], [0.05, 0.05])?;
    Ok((FemModel::on_base(mesh)?.with_rayleigh(damping), raft_shells))
}

fn main() -> basemat::Result<()> {
    // One record is in the crate: it acts along y with 70 % and half a second later, and upwards with 40 %.
    let record = el_centro_1940();
    let late = |factor: f64, quiet: f64| record.scaled(factor)?.padded(quiet, 0.0);
    let (y, up) = (Some(late(0.7, 0.5)?), Some(late(0.4, 1.0)?));
    let motion = Triaxial { x: Some(record.clone()), y, up };
    let soil = Soil::from_shear_wave_speed(500.0, 1.0 / 3.0, 2000.0)?;
    let (model, raft) = containment()?;
    // Moments at the nodes of the raft, along x and y, tension below positive; forces of the wall on the raft.
    let rows = model.shell_rows(&raft, |_| [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])?;
    let mut at_largest = Vec::new();
    let foot = model.section_in_space(0.0, [0.0; 2])?;
    println!("{} degrees of freedom", model.dofs());
    let laws: [(&str, Box<dyn InterfaceLaw>); 2] =
        [("bonded", Box::new(Bonded)), ("opens, slides", Box::new(Coulomb::new(0.5)?))];
    for (name, law) in laws {
        let mut simulation = Simulation::builder(STEP)
            .ground(ElasticGround::under(soil, &model, 8)?)
            .structure(model.clone())
            .interface(law)
            .motion(motion.clone())
            .probe(Probe::section("shear", &foot.shear[0]))
            .probe(Probe::section("moment", &foot.moments[1]))
            .expected_steps(STEPS)
            .build()?;
        let rest = simulation.static_displacement().to_vec();
        let mut moment = 0.0_f64;
        let run = simulation.run(STEPS, |state| {
            let all = state.displacement().iter().zip(&rest).map(|(change, rest)| change + rest);
            let all: Vec<f64> = all.collect();
            let moments = rows.iter().flat_map(|own| own.value(&all).principal_moments());
            let largest = moments.fold(0.0_f64, |largest, own| largest.max(own.abs()));
            if largest > moment {
                (moment, at_largest) = (largest, all);
            }
        })?;
        let whole = &run.whole;
        let [shear, shear_across] =
            [&whole.base_shear, &whole.shear_across].map(Extremes::magnitude);
        println!(
            "{name}: base shear {:.1} MN; wall's foot {:.1} MN, {:.0} MNm; raft lifts off by {:.1} %, slips {:.2} mm, {:.2} MNm/m",
            1e-6 * shear.max(shear_across),
            1e-6 * run.probe("shear")?.magnitude(),
            1e-6 * run.probe("moment")?.magnitude(),
            100.0 * whole.uplifted_fraction.magnitude(),
            1e3 * whole.mean_slip.magnitude(),
            1e-6 * moment,
        );
        for warning in &run.warnings {
            println!("  {warning}");
        }
        assert!(run.energy_error < 1e-9);
    }
    let mut values = Vec::new();
    for &shell in &raft {
        let corners = model.shell_resultants(shell, &at_largest)?;
        let along_x = corners.iter().map(|own| own.in_axes([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
        let moments =
            along_x.map(|own| Ok(own?.moments[0])).collect::<basemat::Result<Vec<_>>>()?;
        values.push((shell, 1e-6 * moments.iter().sum::<f64>() / moments.len() as f64));
    }
    let picture = shell_plan("Raft under a containment", "m_x, MNm/m", model.mesh(), &values)?;
    picture.save("target/containment_raft.svg")
}
