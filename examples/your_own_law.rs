//! An interface law of your own: friction that falls with the speed of sliding.
//!
//! ```text
//! cargo run --release --example your_own_law
//! ```
//!
//! A law handles one contact element at a time. It provides three things:
//!
//! 1. the list of possible modes ([`InterfaceLaw::modes`]);
//! 2. the conditions of a mode at the end of the step: two linear equations between gap, slip, pressure and
//!    shear ([`InterfaceLaw::conditions`]);
//! 3. whether a trial is admissible, and if not, the mode to try next ([`InterfaceLaw::next_mode`]).
//!
//! The end of the previous step is in [`PreviousContact`]; here the law uses the speed at which the element
//! slid. Values that a law needs for longer are its state variables ([`InterfaceLaw::state_variables`]).
//!
//! If only the coefficient changes, a closure in [`VariableFriction`] is enough, as in the last but one row.

use basemat::interface::{
    Condition, ContactState, Mode, PreviousContact, Tolerance, VariableFriction,
};
use basemat::prelude::*;

/// Friction that decreases with the speed of sliding (m/s): fast + (slow − fast) e^(−|v|/speed).
struct VelocityWeakening {
    slow: f64,
    fast: f64,
    speed: f64,
}

impl VelocityWeakening {
    /// Coefficient of this step. It depends on the start of the step alone, so it is constant in the search
    /// of modes.
    fn friction(&self, start: &PreviousContact) -> f64 {
        self.fast + (self.slow - self.fast) * (-start.slip_rate.abs() / self.speed).exp()
    }
}

impl InterfaceLaw for VelocityWeakening {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::SlipLeft, Mode::SlipRight, Mode::Open]
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        // ±shear − friction · pressure = 0, divided by the friction where the friction is large. The
        // condition thus stays valid up to infinite friction.
        let cone = |side: f64| {
            let friction = self.friction(start);
            let [shear, pressure] =
                if friction > 1.0 { [side / friction, -1.0] } else { [side, -friction] };
            Condition { shear, pressure, ..Condition::default() }
        };
        let closed = Condition::gap_is(0.0);
        match mode {
            // The structure slides to the right and drags the soil with it: shear is positive.
            Mode::SlipRight => [closed, cone(1.0)],
            Mode::SlipLeft => [closed, cone(-1.0)],
            Mode::Open => [Condition::pressure_is(0.0), Condition::shear_is(0.0)],
            _ => [closed, Condition::slip_is(start.state.slip)],
        }
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        let limit = self.friction(start) * trial.pressure.max(0.0) + tolerance.traction;
        let advance = trial.slip - start.state.slip;
        match mode {
            // An open element that would penetrate the soil closes; a closed element in tension opens.
            Mode::Open if trial.gap < -tolerance.length => Mode::Stick,
            Mode::Open => Mode::Open,
            _ if trial.pressure < -tolerance.traction => Mode::Open,
            Mode::Stick if trial.shear > limit => Mode::SlipRight,
            Mode::Stick if trial.shear < -limit => Mode::SlipLeft,
            // Shear opposite to the direction of slip means a negative pressure.
            Mode::SlipRight if trial.shear < -tolerance.traction => Mode::Open,
            Mode::SlipLeft if trial.shear > tolerance.traction => Mode::Open,
            // Friction must not drive the motion: an element that slides the wrong way sticks.
            Mode::SlipRight if advance < -tolerance.length => Mode::Stick,
            Mode::SlipLeft if advance > tolerance.length => Mode::Stick,
            admissible => admissible,
        }
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
    let own = VelocityWeakening { slow: 0.3, fast: 0.25, speed: 0.1 };
    let closure = VariableFriction::new(|start| 0.25 + 0.05 * (-start.slip_rate.abs() / 0.1).exp());
    let cases = [
        ("Coulomb, 0.30", slide(Coulomb::new(0.3)?)?),
        ("0.30 slow, 0.25 fast", slide(own)?),
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
