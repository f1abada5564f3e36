//! A bridge pier on a strip footing, whose soil yields.
//!
//! ```text
//! cargo run --release --example near_field
//! ```
//!
//! The pier stands on clay that carries 2.5 times its weight. A box of finite elements is the soil around the footing;
//! the soil around the box stays linear. In the first run the box is elastic as well: the footing lifts off, and the
//! soil under its edge carries any pressure. In the second run the clay has a strength: the edge presses into the soil,
//! which limits the moment, dissipates energy and leaves a settlement and a tilt. The example writes the loops of moment
//! over rotation to `target/near_field.svg`.

use basemat::bem::SharedKernels;
use basemat::bem::embedded::NearField;
use basemat::coupled::Joint;
use basemat::plot::{self, Curve};
use basemat::prelude::*;
use basemat::site::TrenchMotion;
use basemat::{Result, unobserved};

/// Half the width of the footing, m.
const HALF_WIDTH: f64 = 3.0;
/// Strength of the clay, Pa.
const CLAY_STRENGTH: f64 = 60.0e3;
/// Bearing capacity over weight.
const SAFETY_FACTOR: f64 = 2.5;
/// Height of the centre of mass of pier and deck, m.
const CENTER_HEIGHT: f64 = 7.0;
/// Radius of inertia about it, m.
const INERTIA_RADIUS: f64 = 3.0;
/// Ratio of horizontal to vertical pressure at rest.
const PRESSURE_RATIO: f64 = 0.8;

/// Bearing capacity of the strip, N/m.
fn bearing_capacity() -> f64 {
    (2.0 + std::f64::consts::PI) * CLAY_STRENGTH * 2.0 * HALF_WIDTH
}

/// Results of a run.
struct PierResponse {
    run: Run,
    /// Deck: acceleration.
    time_series: TimeSeries,
    /// Rotation (mrad) and moment (MN·m/m) after each step.
    path: Vec<(f64, f64)>,
    /// Settlement of the footing (mm) since t = 0 at the end.
    settlement: f64,
}

/// Runs 15 s of El Centro on this soil.
fn shake(near_field: &NearField, kernels: &SharedKernels) -> Result<PierResponse> {
    let mass = bearing_capacity() / SAFETY_FACTOR / STANDARD_GRAVITY;
    let inertia = mass * INERTIA_RADIUS * INERTIA_RADIUS;
    let pier = RigidBlock::from_mass(2.0 * HALF_WIDTH, mass, inertia, CENTER_HEIGHT)?;
    let deck = pier.horizontal_at(CENTER_HEIGHT);
    let soil = FemModel::on_soil_at_rest(near_field.mesh()?)?;

    // The footing stands on the nodes of the soil, and lifts off.
    let lower = soil.contact_nodes(&near_field.foundation_nodes(soil.mesh())?)?;
    let upper = pier.contact_nodes(&[[-HALF_WIDTH, 0.0], [HALF_WIDTH, 0.0]])?;
    let group = StructureGroup::new().with(soil, 0.0)?.with_above(pier, [0.0, 0.0])?;
    let joint =
        Joint::around_nodes(group.contact_nodes(1, upper)?, group.contact_nodes(0, lower)?)?;
    let deck = Probe::acceleration("deck", group.row(1, deck)?);
    let up = Probe::displacement("up", group.row(1, RigidBlock::VERTICAL_DOF)?);
    let rotation = Probe::displacement("rotation", group.row(1, RigidBlock::ROTATION_DOF)?);

    let ground = near_field.ground()?.with_shared_kernels(kernels);
    // Time for the waves to pass the box before the record begins.
    let record = el_centro_1940().padded(0.2, 0.0)?;
    let motion = TrenchMotion::new(&ground, record, &mut unobserved)?;
    let mut simulation = Simulation::builder(0.01)
        .ground(ground)
        .structure(group)
        .interface(Bonded)
        .joint(joint.with_law(Coulomb::new(0.7)?))
        .motion(motion)
        .probes([deck, up, rotation])
        .build()?;
    let steps = simulation.steps_for(15.0);
    let mut time_series = Recorder::new().start(&simulation)?;
    let mut path = Vec::with_capacity(steps);
    let run = simulation.run(steps, |state| {
        path.push((1e3 * state.probes[2], 1e-6 * state.joints[0].moment));
        time_series.record(state)
    })?;
    let settlement = -1e3 * simulation.state().probes[1];
    Ok(PierResponse { run, time_series, path, settlement })
}

fn main() -> Result<()> {
    let clay = Soil::from_shear_wave_speed(150.0, 0.45, 1800.0)?;
    let elastic = NearField::new(clay, HALF_WIDTH)?
        .with_pressure_at_rest(STANDARD_GRAVITY, PRESSURE_RATIO)?;
    let yielding_field = elastic.clone().with_strength_profile(|_| CLAY_STRENGTH);
    let weight = bearing_capacity() / SAFETY_FACTOR;
    let capacity = 1e-6 * weight * HALF_WIDTH * (1.0 - 1.0 / SAFETY_FACTOR);
    println!("moment capacity {capacity:.2} MN·m/m\n");
    println!(
        "soil      moment, MN·m/m   rotation, mrad       at end   settled, mm   deck, m/s²   at 0.5 s, m/s²"
    );
    let kernels = SharedKernels::default();
    let mut curves = Vec::new();
    for (name, near_field) in [("linear", elastic), ("yielding", yielding_field)] {
        let PierResponse { run, time_series, path, settlement } = shake(&near_field, &kernels)?;
        let peak =
            |values: &mut dyn Iterator<Item = f64>| values.fold(0.0_f64, |a, b| a.max(b.abs()));
        let moment = peak(&mut path.iter().map(|point| point.1));
        let deck = peak(&mut time_series.probe("deck")?.iter().copied());
        let spectrum = time_series.floor_spectrum("deck", &[0.5], 0.05)?;
        println!(
            "{name:8}{moment:16.2}{:17.2}{:13.2}{settlement:14.1}{deck:13.2}{:17.2}",
            peak(&mut path.iter().map(|point| point.0)),
            path.last().map_or(0.0, |point| point.0),
            spectrum[0].pseudo_acceleration,
        );
        assert!(run.energy_error < 1e-9);
        curves.push(Curve { name: format!("{name} soil"), points: path });
    }
    curves.push(Curve {
        name: "capacity".into(),
        points: [-capacity, capacity]
            .iter()
            .flat_map(|moment| [(-10.0, *moment), (10.0, *moment), (f64::NAN, f64::NAN)])
            .collect(),
    });
    plot::curves("Pier on a strip", "rotation, mrad", "moment, MN·m/m", &curves)?
        .save("target/near_field.svg")
}
