//! A free cap on free columns: the colonnade of an ancient temple.
//!
//! Two columns stand freely on stiff ground, and an architrave lies freely on them. Between impacts the frame rocks like
//! one column whose rate falls by the mass of the architrave: a heavy cap makes it more stable, not less (Makris and
//! Vassiliou 2013). Frames are tilted to half of their slenderness and released; the table has the time until the
//! columns are upright.
//!
//! ```text
//! cargo run --release --example free_cap
//! ```

use basemat::Result;
use basemat::bem::SpringGround;
use basemat::coupled::{GravityStage, Joint, Theta};
use basemat::prelude::*;

const COLUMN_WIDTH: f64 = 1.0;
const COLUMN_HEIGHT: f64 = 6.0;
const ELEMENT_COUNT: usize = 16;
const TIME_STEP: f64 = 5e-4;

/// Time from a tilt (rad) until the columns are upright, with a cap of `mass_ratio` times the mass of the columns.
fn time_to_upright(mass_ratio: f64, tilt: f64) -> Result<f64> {
    let column = RigidBlock::new(COLUMN_WIDTH, COLUMN_HEIGHT, 2500.0)?;
    let cap_mass = mass_ratio * 2.0 * column.total_mass();
    // The weight of a tilted column, and of the cap on its top, overturns it: P–Δ.
    let half_cap_weight = 0.5 * STANDARD_GRAVITY * cap_mass;
    let column = column
        .with_p_delta(STANDARD_GRAVITY)?
        .with_carried_weight(half_cap_weight, COLUMN_HEIGHT)?;
    let cap = RigidBlock::from_mass(5.0, cap_mass, 3.0 * cap_mass, 0.5)?;
    let top = column.contact_nodes(&[
        [-0.5 * COLUMN_WIDTH, COLUMN_HEIGHT],
        [0.5 * COLUMN_WIDTH, COLUMN_HEIGHT],
    ])?;
    let ends = [[-2.5, 0.0], [-1.5, 0.0], [1.5, 0.0], [2.5, 0.0]];
    let left = cap.contact_nodes(&ends[..2])?;
    let right = cap.contact_nodes(&ends[2..])?;
    let group = StructureGroup::new()
        .with(column.clone(), -2.0)?
        .with(column, 2.0)?
        .with_above(cap, [0.0, COLUMN_HEIGHT])?;

    // Columns rotate about the middles of the outer elements; the cap rises with their raised corners.
    let lever = 0.5 * COLUMN_WIDTH * (1.0 - 1.0 / ELEMENT_COUNT as f64);
    let tilted_column = [0.0, lever * tilt, tilt];
    let raised_cap = [-COLUMN_HEIGHT * tilt, 2.0 * lever * tilt, 0.0];
    let displacement = [tilted_column, tilted_column, raised_cap].concat();

    let mut builder = Simulation::builder(TIME_STEP);
    for (column, bottom) in [left, right].into_iter().enumerate() {
        let upper = group.contact_nodes(2, bottom)?;
        let lower = group.contact_nodes(column, top.clone())?;
        builder = builder
            .joint(Joint::between(upper, lower, ELEMENT_COUNT)?.with_law(Coulomb::new(1.0)?));
    }
    let mut simulation = builder
        .ground(SpringGround::under(&group, ELEMENT_COUNT, 1e13, 1e13)?)
        .structure(group)
        .interface(Coulomb::new(1.0)?)
        .scheme(Theta::new(1.0)?)
        .gravity_stage(GravityStage::Unloaded)
        .initial_displacement(displacement)
        .build()?;
    while simulation.step()?.displacement()[2] > 0.0 {}
    Ok(simulation.state().time)
}

fn main() -> Result<()> {
    let slenderness = COLUMN_WIDTH / COLUMN_HEIGHT * (1.0 - 1.0 / ELEMENT_COUNT as f64);
    let tilt = 0.5 * slenderness;
    println!(
        "Columns {COLUMN_WIDTH} m × {COLUMN_HEIGHT} m, released at a tilt of {:.0} mrad\n",
        1e3 * tilt
    );
    println!(
        "| mass of the cap over the columns' | time until upright, s | Makris and Vassiliou, s |"
    );
    println!("|---|---|---|");
    for mass_ratio in [0.5, 1.0, 4.0] {
        let computed = time_to_upright(mass_ratio, tilt)?;
        let squared_rate = 1.5 * STANDARD_GRAVITY / COLUMN_WIDTH.hypot(COLUMN_HEIGHT);
        let rate = (squared_rate * (1.0 + 2.0 * mass_ratio) / (1.0 + 3.0 * mass_ratio)).sqrt();
        let expected = 2.0_f64.acosh() / rate;
        println!("| {mass_ratio} | {computed:.3} | {expected:.3} |");
        assert!((computed / expected - 1.0).abs() < 0.02);
    }
    Ok(())
}
