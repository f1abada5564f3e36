//! A containment of shells on a raft that bends, lifts and slides.
//!
//! ```text
//! cargo run --release --example containment_in_space
//! ```
//!
//! Raft, wall and dome are shells. The raft bends: the ground acts on each cell of its underside. Three components of
//! an earthquake shake it. A bonded base is compared with a base that opens and slides, by the forces at the wall's
//! foot and by the largest bending moment in the raft. This moment decreases as the cells become smaller: 3.5, 3.4 and
//! 3.3 MNm/m on 132, 224 and 332 cells. `target/containment_raft.svg` shows the moments m_x in the raft that opens, at
//! the instant of its largest moment.

use basemat::fem::{Material, Mesh};
use basemat::motion::Triaxial;
use basemat::plot::shell_plan;
use basemat::prelude::*;
use basemat::structure::{FemModel, RayleighDamping};

/// Radius of the wall's middle surface, m.
const WALL_RADIUS: f64 = 20.0;
/// Height of the wall, m.
const WALL_HEIGHT: f64 = 30.0;
// Thicknesses of the shells, m.
const RAFT_THICKNESS: f64 = 3.0;
const WALL_THICKNESS: f64 = 1.2;
const DOME_THICKNESS: f64 = 1.0;
/// Number of elements around the axis.
const SECTOR_COUNT: usize = 24;
// Numbers of rows of elements along the meridian.
const RAFT_ROWS: usize = 5;
const WALL_ROWS: usize = 5;
const DOME_ROWS: usize = 4;
/// Time step, s.
const TIME_STEP: f64 = 0.01;
const STEP_COUNT: usize = 1000;

/// Points of the meridian from the centre of the raft along wall and spherical dome: radius and height, m.
fn meridian() -> Vec<[f64; 2]> {
    let fraction = |row: usize, rows: usize| row as f64 / rows as f64;
    let mut points = Vec::new();
    for row in 0..RAFT_ROWS {
        points.push([WALL_RADIUS * fraction(row, RAFT_ROWS), 0.0]);
    }
    for row in 0..WALL_ROWS {
        points.push([WALL_RADIUS, WALL_HEIGHT * fraction(row, WALL_ROWS)]);
    }
    for row in 0..=DOME_ROWS {
        let angle = std::f64::consts::FRAC_PI_2 * fraction(row, DOME_ROWS);
        let radius = if row == DOME_ROWS { 0.0 } else { WALL_RADIUS * angle.cos() };
        points.push([radius, WALL_HEIGHT + WALL_RADIUS * angle.sin()]);
    }
    points
}

/// Thickness (m) of the shells in a row of the meridian.
fn shell_thickness(row: usize) -> f64 {
    if row < RAFT_ROWS {
        RAFT_THICKNESS
    } else if row < RAFT_ROWS + WALL_ROWS {
        WALL_THICKNESS
    } else {
        DOME_THICKNESS
    }
}

/// The containment, and the shells of its raft.
fn containment() -> basemat::Result<(FemModel, Vec<usize>)> {
    let concrete = Material::new(32.0e9, 0.2, 2450.0)?;
    let mut mesh = Mesh::in_space();
    let surface = mesh.revolve([0.0; 2], &meridian(), SECTOR_COUNT)?;
    let shells = surface.shells(concrete, shell_thickness)?;
    let mut raft_shells = Vec::new();
    for (shell, (row, _)) in shells.into_iter().zip(surface.cells()) {
        let element = mesh.add(shell)?;
        if row < RAFT_ROWS {
            raft_shells.push(element);
        }
    }
    let damping = RayleighDamping::from_ratios([4.0, 25.0], [0.05, 0.05])?;
    Ok((FemModel::on_base(mesh)?.with_rayleigh(damping), raft_shells))
}

fn main() -> basemat::Result<()> {
    // The crate contains one record only. It also acts along y with 70 % half a second later, and upwards with 40 % a
    // second later.
    let record = el_centro_1940();
    let motion = Triaxial {
        x: Some(record.clone()),
        y: Some(record.scaled(0.7)?.padded(0.5, 0.0)?),
        up: Some(record.scaled(0.4)?.padded(1.0, 0.0)?),
    };
    let soil = Soil::from_shear_wave_speed(500.0, 1.0 / 3.0, 2000.0)?;
    let (model, raft_shells) = containment()?;
    // Bending moments at the nodes of the raft, in axes along x and across it.
    let moment_rows = model.shell_rows(&raft_shells, |_| [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])?;
    // Forces of the wall on the raft.
    let wall_foot = model.section_in_space(0.0, [0.0; 2])?;
    let mut critical_displacement = Vec::new();
    println!("{} degrees of freedom", model.dofs());
    let laws: [(&str, Box<dyn InterfaceLaw>); 2] =
        [("bonded", Box::new(Bonded)), ("opens, slides", Box::new(Coulomb::new(0.5)?))];
    for (name, law) in laws {
        let mut simulation = Simulation::builder(TIME_STEP)
            .ground(ElasticGround::under(soil, &model, 8)?)
            .structure(model.clone())
            .interface(law)
            .motion(motion.clone())
            .probe(Probe::section("shear", &wall_foot.shear[0]))
            .probe(Probe::section("moment", &wall_foot.moments[1]))
            .expected_steps(STEP_COUNT)
            .build()?;
        let at_rest = simulation.static_displacement().to_vec();
        let mut largest_moment = 0.0_f64;
        let run = simulation.run(STEP_COUNT, |state| {
            let changes = state.displacement().iter();
            let displacement: Vec<f64> =
                changes.zip(&at_rest).map(|(change, rest)| change + rest).collect();
            let moments =
                moment_rows.iter().flat_map(|row| row.value(&displacement).principal_moments());
            let step_moment = moments.fold(0.0_f64, |largest, moment| largest.max(moment.abs()));
            if step_moment > largest_moment {
                largest_moment = step_moment;
                critical_displacement = displacement;
            }
        })?;
        let whole = &run.whole;
        let largest_shear = whole.base_shear.magnitude().max(whole.shear_across.magnitude());
        println!(
            "{name}: base shear {:.1} MN; wall's foot {:.1} MN, {:.0} MNm; raft lifts off by {:.1} %, slips {:.2} mm, {:.2} MNm/m",
            1e-6 * largest_shear,
            1e-6 * run.probe("shear")?.magnitude(),
            1e-6 * run.probe("moment")?.magnitude(),
            100.0 * whole.uplifted_fraction.magnitude(),
            1e3 * whole.mean_slip.magnitude(),
            1e-6 * largest_moment,
        );
        for warning in &run.warnings {
            println!("  {warning}");
        }
        assert!(run.energy_error < 1e-9);
    }
    let mut mean_moments = Vec::new();
    for &shell in &raft_shells {
        let corners = model.shell_resultants(shell, &critical_displacement)?;
        let mut moments = Vec::new();
        for corner in &corners {
            moments.push(corner.in_axes([1.0, 0.0, 0.0], [0.0, 0.0, 1.0])?.moments[0]);
        }
        mean_moments.push((shell, 1e-6 * moments.iter().sum::<f64>() / moments.len() as f64));
    }
    let picture =
        shell_plan("Raft under a containment", "m_x, MNm/m", model.mesh(), &mean_moments)?;
    picture.save("target/containment_raft.svg")
}
