//! Free columns that rock under a free rigid cap, after Makris and Vassiliou (2013).
//!
//! | symbol | meaning |
//! |---|---|
//! | b, h, α, R | half width and half height of a column, α = b/h, R² = b² + h² |
//! | γ | mass of the cap over the mass of all columns |
//! | p̂ | p √((1 + 2γ)/(1 + 3γ)), p² = 3g/(4R): rate of the rocking frame |
//!
//! Contact by means over n equal elements makes the half width b (1 − 1/n).

use basemat::bem::SpringGround;
use basemat::coupled::{GravityStage, Joint, SimulationBuilder, Theta};
use basemat::interface::Coulomb;
use basemat::motion::{Record, STANDARD_GRAVITY};
use basemat::structure::{RigidBlock, StructureGroup};
use basemat::{Result, Simulation};

const HALF_WIDTH: f64 = 0.2;
const HALF_HEIGHT: f64 = 2.0;
const COLUMN_DENSITY: f64 = 2500.0;
const COLUMN_SPACING: f64 = 3.0;

/// A frame of columns under a cap, with `elements` under and on each column; and its degrees of freedom.
fn frame(
    columns: usize,
    mass_ratio: f64,
    elements: usize,
    step: f64,
) -> Result<(SimulationBuilder, usize)> {
    let gravity = STANDARD_GRAVITY;
    let column_mass = COLUMN_DENSITY * 4.0 * HALF_WIDTH * HALF_HEIGHT;
    let cap_mass = mass_ratio * columns as f64 * column_mass;
    let height = 2.0 * HALF_HEIGHT;
    let mut group = StructureGroup::new();
    let mut tops = Vec::new();
    for k in 0..columns {
        let mut column =
            RigidBlock::new(2.0 * HALF_WIDTH, height, COLUMN_DENSITY)?.with_p_delta(gravity)?;
        if cap_mass > 0.0 {
            column = column.with_carried_weight(gravity * cap_mass / columns as f64, height)?;
        }
        tops.push(column.contact_nodes(&[[-HALF_WIDTH, height], [HALF_WIDTH, height]])?);
        group = group.with(column, COLUMN_SPACING * k as f64)?;
    }
    let mut joints = Vec::new();
    let middle = 0.5 * COLUMN_SPACING * (columns - 1) as f64;
    if cap_mass > 0.0 {
        let width = 2.0 * (middle + HALF_WIDTH);
        let cap = RigidBlock::from_mass(width, cap_mass, cap_mass * width * width / 12.0, 0.25)?;
        let mut bottoms = Vec::new();
        for k in 0..columns {
            let x = COLUMN_SPACING * k as f64 - middle;
            bottoms.push(cap.contact_nodes(&[[x - HALF_WIDTH, 0.0], [x + HALF_WIDTH, 0.0]])?);
        }
        group = group.with_above(cap, [middle, height])?;
        for (k, (bottom, top)) in bottoms.into_iter().zip(tops).enumerate() {
            let upper = group.contact_nodes(columns, bottom)?;
            let joint = Joint::between(upper, group.contact_nodes(k, top)?, elements)?;
            joints.push(joint.with_law(Coulomb::new(2.0)?));
        }
    }
    let dofs = 3 * (columns + usize::from(cap_mass > 0.0));
    let mut builder = Simulation::builder(step)
        .ground(SpringGround::under(&group, elements, 1e14, 1e14)?)
        .structure(group)
        .interface(Coulomb::new(2.0)?)
        .scheme(Theta::new(1.0)?);
    for joint in joints {
        builder = builder.joint(joint);
    }
    Ok((builder, dofs))
}

/// Slenderness of contact by means over n elements.
fn slenderness(elements: usize) -> f64 {
    HALF_WIDTH / HALF_HEIGHT * (1.0 - 1.0 / elements as f64)
}

/// Rate p̂ of the frame, 1/s.
fn rate(mass_ratio: f64) -> f64 {
    let squared_rate = 0.75 * STANDARD_GRAVITY / HALF_WIDTH.hypot(HALF_HEIGHT);
    (squared_rate * (1.0 + 2.0 * mass_ratio) / (1.0 + 3.0 * mass_ratio)).sqrt()
}

/// REFERENCE: acosh(1/(1 − θ₀/α))/p̂.
#[test]
fn a_released_frame_has_the_quarter_period_of_one_column() -> Result<()> {
    for (columns, mass_ratio, elements) in [(2, 0.5, 16), (2, 4.0, 16), (4, 1.0, 8)] {
        let step = 2e-4;
        let (builder, dofs) = frame(columns, mass_ratio, elements, step)?;
        let alpha = slenderness(elements);
        let tilt = 0.5 * alpha;
        let lever = alpha * HALF_HEIGHT;
        let mut displacement = vec![0.0; dofs];
        for column in 0..columns {
            displacement[3 * column + 1] = lever * tilt;
            displacement[3 * column + 2] = tilt;
        }
        // The cap moves with the raised corners of the columns.
        displacement[3 * columns] = -2.0 * HALF_HEIGHT * tilt;
        displacement[3 * columns + 1] = 2.0 * lever * tilt;
        let mut simulation = builder
            .initial_displacement(displacement)
            .gravity_stage(GravityStage::Unloaded)
            .build()?;
        let expected = (1.0 / (1.0 - tilt / alpha)).acosh() / rate(mass_ratio);
        let mut previous_tilt = tilt;
        let quarter = loop {
            let state = simulation.step()?;
            let rotation = state.displacement()[2];
            if rotation <= 0.0 || state.time > 2.0 * expected {
                break state.time - step * rotation / (rotation - previous_tilt);
            }
            previous_tilt = rotation;
        };
        println!(
            "N = {columns}, γ = {mass_ratio}: {quarter} s of {expected} s, {:e}",
            quarter / expected - 1.0
        );
        assert!((quarter / expected - 1.0).abs() < 5e-3, "{quarter} s of {expected} s");
    }
    Ok(())
}

/// Whether the frame overturns under one cycle of a sine of this amplitude (α g) and rate 3p.
fn overturns(mass_ratio: f64, elements: usize, amplitude: f64) -> Result<bool> {
    let alpha = slenderness(elements);
    let pulse_rate = 3.0 * rate(0.0);
    let duration = std::f64::consts::TAU / pulse_rate;
    let step = 5e-4;
    let record = Record::from_fn(step, 20.0, |time| {
        let inside = time < duration;
        if inside {
            amplitude * alpha * STANDARD_GRAVITY * (pulse_rate * time).sin()
        } else {
            0.0
        }
    })?;
    let (builder, _) = frame(2, mass_ratio, elements, step)?;
    let mut simulation = builder.motion(record).rotation_limit(3.0 * alpha).build()?;
    let run = simulation.run(simulation.steps_for(10.0), |_| {})?;
    Ok(run.is_overturned)
}

/// REFERENCE: amplitudes for α = 0.1 and the restitution of the frame.
#[test]
fn a_sine_cycle_overturns_a_frame_at_the_published_amplitude() -> Result<()> {
    for (mass_ratio, amplitude) in [(0.0, 1.372), (0.5, 1.457), (4.0, 1.530)] {
        for (factor, is_overturned) in [(0.98, false), (1.02, true)] {
            let result = overturns(mass_ratio, 16, factor * amplitude)?;
            println!("γ = {mass_ratio}, {factor} of {amplitude}: {result}");
            assert_eq!(result, is_overturned, "γ = {mass_ratio}, {factor} of {amplitude}");
        }
    }
    Ok(())
}
