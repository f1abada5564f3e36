//! A custom interface law: friction that decreases with the speed of sliding.
//!
//! ```text
//! cargo run --release --example your_own_law
//! ```
//!
//! A law describes one contact element at a time. It has one required method, which returns the limits of the element's
//! tractions in a step ([`InterfaceLaw::limits`]). The limits determine sticking, sliding and opening, in the plane and
//! in plan. A law of the plane that limits cannot describe defines its own modes and conditions instead
//! ([`PlaneLaw`](basemat::interface::PlaneLaw)).
//!
//! The contact at the end of the previous step is in [`PreviousContact`]; the law of this example uses the slip rate.
//! Values that a law keeps over several steps are its state variables ([`InterfaceLaw::state_variables`]).
//!
//! If only the friction coefficient changes, a closure in [`VariableFriction`] is enough, as in the third row of the
//! table.

use basemat::interface::{Limits, PreviousContact, VariableFriction};
use basemat::prelude::*;

/// Friction coefficient that decreases from μ₀ to μ₁ with the speed of sliding v: μ₁ + (μ₀ − μ₁) e^(−|v|/v₀).
struct VelocityWeakening {
    slow_friction: f64,
    fast_friction: f64,
    speed_scale: f64,
}

impl VelocityWeakening {
    /// Friction coefficient of the next step. It depends only on the start of the step, so it is constant while the
    /// contact modes of the step are determined.
    fn friction(&self, start: &PreviousContact) -> f64 {
        self.fast_friction
            + (self.slow_friction - self.fast_friction)
                * (-start.slip_rate.abs() / self.speed_scale).exp()
    }
}

impl InterfaceLaw for VelocityWeakening {
    fn limits(&self, start: &PreviousContact) -> basemat::Result<Limits> {
        Ok(Limits { friction: self.friction(start), ..Limits::default() })
    }
}

/// Runs 10 s of a squat block, which slides before it rocks, under El Centro scaled by 1.5.
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
    let weakening = VelocityWeakening { slow_friction: 0.3, fast_friction: 0.25, speed_scale: 0.1 };
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
