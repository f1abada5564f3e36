//! A custom interface law: friction that decreases with the speed of sliding.
//!
//! ```text
//! cargo run --release --example your_own_law
//! ```
//!
//! A law handles one contact element at a time. It needs one method: the limits of the element's tractions in a
//! step ([`InterfaceLaw::limits`]). Sticking, sliding and opening follow from them, in the plane and in plan. A
//! law of the plane that no limits describe states its modes and conditions instead
//! ([`PlaneLaw`](basemat::interface::PlaneLaw)).
//!
//! The end of the previous step is in [`PreviousContact`]; here the law uses the speed at which the element
//! slid. Values that a law needs for longer are its state variables ([`InterfaceLaw::state_variables`]).
//!
//! If only the coefficient changes, a closure in [`VariableFriction`] is enough, as in the last but one row.

use basemat::interface::{Limits, PreviousContact, VariableFriction};
use basemat::prelude::*;

/// Friction that decreases with the speed of sliding (m/s): fast + (slow − fast) e^(−|v|/speed).
struct VelocityWeakening {
    slow: f64,
    fast: f64,
    speed: f64,
}

impl VelocityWeakening {
    /// Coefficient of this step. It depends on the start of the step alone, so it is constant in the search of
    /// modes.
    fn friction(&self, start: &PreviousContact) -> f64 {
        self.fast + (self.slow - self.fast) * (-start.slip_rate.abs() / self.speed).exp()
    }
}

impl InterfaceLaw for VelocityWeakening {
    fn limits(&self, start: &PreviousContact) -> basemat::Result<Limits> {
        Ok(Limits { friction: self.friction(start), ..Limits::default() })
    }
}

/// Runs a squat block, which slides before it rocks, under 10 s of El Centro scaled by 1.5.
fn slide(law: impl InterfaceLaw + 'static) -> basemat::Result<Run> {
    let soil = Soil::new(80.0e6, 0.33, 1900.0)?;
    let block = RigidBlock::new(8.0, 4.0, 2000.0)?;
    Simulation::builder(5.0e-3)
        .ground(ElasticGround::under(soil, &block, 8)?)
        .structure(block)
        .interface(law)
        .motion(el_centro_1940().scaled(1.5)?)
        .build()?
        .run(2000, |_| {})
}

fn main() -> basemat::Result<()> {
    let weakening = VelocityWeakening { slow: 0.3, fast: 0.25, speed: 0.1 };
    let closure = VariableFriction::new(|start| 0.25 + 0.05 * (-start.slip_rate.abs() / 0.1).exp());
    let cases = [
        ("Coulomb, 0.30", slide(Coulomb::new(0.3)?)?),
        ("0.30 slow, 0.25 fast", slide(weakening)?),
        ("the same, from a closure", slide(closure)?),
        ("Coulomb, 0.25", slide(Coulomb::new(0.25)?)?),
    ];
    println!("{:<28}{:>14}{:>14}{:>16}", "law", "largest slip", "residual slip", "energy error");
    for (name, run) in cases {
        println!(
            "{name:<28}{:>11.1} mm{:>11.1} mm{:>16.1e}",
            1e3 * run.whole.largest_slip.largest().value,
            1e3 * run.whole.residual_slip,
            run.energy_error
        );
    }
    Ok(())
}
