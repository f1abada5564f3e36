//! The energy ledger: where every joule of a run went.

use std::fmt;

use crate::results::unit::number;

use super::coordinates::Motion;
use super::scheme::SchemeCoefficients;
use super::simulation::Simulation;
use super::step::Ride;
use crate::interface::law_of;
use crate::linalg::{dense_multiply_add, dot};

/// Energies since the start, J per metre of thickness.
///
/// ```text
/// kinetic + strain + hysteresis + damping + numerical + soil + contact + layer + preload = input
/// ```
///
/// holds exactly for the discrete equations. Every term is computed from its own definition and
/// none as the remainder, so that [`Ledger::residual`] checks the whole step. One thing it does not
/// check: energies that a nonlinear structure says it stores and dissipates. The difference between
/// them and the work of its force is in `numerical`, and falls with the square of the step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Ledger {
    /// ½ v·M v.
    pub kinetic: f64,
    /// ½ u·K u, plus what the nonlinear internal force stores: its work, where the structure does
    /// not tell stored from dissipated energy.
    pub strain: f64,
    /// What hysteretic parts of the structure have turned into heat
    /// ([`Structure::nonlinear_energy`](crate::structure::Structure::nonlinear_energy)); never less
    /// than before.
    pub hysteresis: f64,
    /// Work of the dashpots, on displacements relative to the free field.
    pub damping: f64,
    /// What the time scheme takes: of the structure (zero for the midpoint rule), and of compliant
    /// interfaces, whose traction is that of the end of the step all through it. With a nonlinear
    /// force of known energies, also its work in the discrete equation beyond them: the error of
    /// one point in a step, of either sign.
    pub numerical: f64,
    /// Work done on the soil by the changes of traction: radiated and stored.
    pub soil: f64,
    /// What friction and impact take, and what is lost with the springs of a compliant interface
    /// when its elements open and close: total tractions times minus the change of the jump, its
    /// elastic part left out. Never less from step to step, with any law of the crate.
    pub contact: f64,
    /// Elastic energy stored in compliant interfaces ([`crate::interface::InterfaceLaw::compliance`]),
    /// as a change against the static state; zero for hard contact.
    pub layer: f64,
    /// Potential of the static tractions against the change of the jump.
    pub preload: f64,
    /// Work of external loads and of the free field.
    pub input: f64,
    /// Bound on what is wrong with `soil`, Σ A |τ| |error of Δs|: zero unless the ground's history is
    /// approximate. The terms above balance with the history as it is, so nothing of the residual
    /// is due to it; but the soil of the equations may have taken this much more or less than it did here.
    pub soil_error_bound: f64,
}

impl Ledger {
    /// Left-hand side minus input, relative to the largest term.
    pub fn residual(&self) -> f64 {
        let left = [
            self.kinetic,
            self.strain,
            self.hysteresis,
            self.damping,
            self.numerical,
            self.soil,
            self.contact,
            self.layer,
            self.preload,
        ];
        let scale = left.iter().fold(self.input.abs(), |m, x| m.max(x.abs()));
        if scale > 0.0 { (left.iter().sum::<f64>() - self.input).abs() / scale } else { 0.0 }
    }
}

impl Simulation {
    /// Adds what the nonlinear force did: stored, dissipated, or just done.
    fn book_nonlinear_force(&mut self) {
        let Self { model, work, memory, state, .. } = self;
        let ledger = &mut state.ledger;
        let (u0, du) = (&state.motion.displacement, &work.increment);
        let done = dot(&work.force, du);
        for (i, x) in work.total.iter_mut().enumerate() {
            *x = self.static_state.displacement[i] + u0[i] + du[i];
        }
        let rest = self.static_energy.zip(model.structure.nonlinear_energy(&work.total));
        if let Some((start, energy)) = rest {
            // Forces count from the static ones, and so does the energy that they store.
            let against: f64 =
                self.static_force.iter().zip(u0).zip(du).map(|((f, u), du)| f * (u + du)).sum();
            let stored = energy.stored - start.stored - against;
            let dissipated = energy.dissipated - start.dissipated;
            ledger.numerical +=
                done - (stored - memory.nonlinear_work) - (dissipated - ledger.hysteresis);
            (memory.nonlinear_work, ledger.hysteresis) = (stored, dissipated);
        } else {
            memory.nonlinear_work += done;
        }
    }

    /// Adds the step to the energy ledger, each term from its own definition.
    pub(super) fn book(&mut self, ride: &Ride) {
        if !self.model.linear {
            self.book_nonlinear_force();
        }
        let c = self.coefficients;
        let dt = self.time_step;
        let Self { model, work, memory, state, base, solver, start, laws, .. } = self;
        let ledger = &mut state.ledger;
        let Motion { displacement: u0, velocity: v0, acceleration: a0, .. } = &state.motion;
        let (v1, du) = (&work.new_velocity, &work.increment);

        ledger.kinetic = 0.5 * model.mass.form(v1, v1);
        let work_of_load: f64 = dot(&work.load, du);
        ledger.input += work_of_load;

        if !model.damping.is_empty() {
            let [horizontal, vertical] = &model.ride;
            for (i, x) in work.vector.iter_mut().enumerate() {
                *x = SchemeCoefficients::apply(c.velocity, du[i], v0[i], a0[i])
                    - horizontal[i] * ride.velocity[0]
                    - vertical[i] * ride.velocity[1];
            }
            work.total.fill(0.0);
            model.damping.multiply_add(1.0, &work.vector, &mut work.total);
            let dragged = ride.increment[0] * dot(&work.total, horizontal)
                + ride.increment[1] * dot(&work.total, vertical);
            ledger.damping += dot(&work.total, du) - dragged;
            ledger.input -= dragged;
        }

        if !self.conserves_energy {
            // Δu = Δt (v₀+v₁)/2 + r_d, a* = (v₁−v₀)/Δt + r_a, u* = (u₀+u₁)/2 + r_u
            let (change, rest) = (&mut work.vector, &mut work.total);
            for i in 0..du.len() {
                change[i] = (v1[i] - v0[i]) / dt;
                rest[i] = du[i] - 0.5 * dt * (v0[i] + v1[i]);
            }
            ledger.numerical += model.mass.form(rest, change);
            for i in 0..du.len() {
                rest[i] =
                    SchemeCoefficients::apply(c.acceleration, du[i], v0[i], a0[i]) - change[i];
            }
            ledger.numerical += model.mass.form(du, rest);
            for i in 0..du.len() {
                let there = SchemeCoefficients::apply(c.displacement, du[i], v0[i], a0[i]);
                rest[i] = there - 0.5 * du[i];
            }
            ledger.numerical += model.stiffness.form(du, rest);
        }
        for ((x, u), du) in work.vector.iter_mut().zip(u0).zip(du) {
            *x = u + du;
        }
        base.means(&work.vector, &mut work.means);
        model.spare(&mut work.vector, base.ride(&work.means));
        ledger.strain =
            0.5 * model.stiffness.form(&work.vector, &work.vector) + memory.nonlinear_work;

        work.soil_displacement.copy_from_slice(&work.history);
        dense_multiply_add(&self.soil, 1.0, &solver.traction, &mut work.soil_displacement);
        let count = base.lengths().len();
        let doubt = self.ground.increment_error_bound();
        for i in 0..2 * count {
            let area = base.length(i);
            let change = solver.traction[i];
            let at_rest = self.static_state.traction[i];
            let gap = if i < count { self.static_state.gap[i] } else { 0.0 };
            let jump = gap + work.free_field[i] + work.soil_displacement[i] - work.means[i];
            let opening = jump - memory.jump[i];
            memory.jump[i] = jump;
            ledger.soil +=
                area * change * (work.soil_displacement[i] - memory.soil_displacement[i]);
            ledger.soil_error_bound += area * change.abs() * doubt;
            let mut elastic = 0.0;
            if self.compliant {
                let (e, k) = (i % count, i / count);
                let law = law_of(laws, e);
                let [c0, c1] = [start[e].mode, work.modes[e]].map(|mode| law.compliance(mode)[k]);
                let t0 = [start[e].state.pressure, start[e].state.shear][k];
                let t1 = at_rest + change;
                elastic = c0 * t0 - c1 * t1;
                ledger.layer += 0.5 * area * (c1 * t1 * t1 - c0 * t0 * t0);
                // The work −t₁ Δ(elastic jump) is Δ(½ c t²) and this much more: what the step takes of
                // a spring that stays, what is lost with one that goes.
                let lag = 0.5 * area * (c0 * (t1 - t0).powi(2) + (c1 - c0) * t1 * t1);
                if c0 == c1 {
                    ledger.numerical += lag;
                } else {
                    ledger.contact += lag;
                }
            }
            ledger.contact -= area * (at_rest + change) * (opening - elastic);
            ledger.preload += area * at_rest * opening;
            ledger.input -= area * change * (work.free_field[i] - memory.free_field[i]);
        }
    }
}

/// Energies in kJ/m.
impl fmt::Display for Ledger {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shown = |energy: f64| number(1e-3 * energy);
        writeln!(f, "energy, kJ/m: input {}", shown(self.input))?;
        let pairs = [
            [("kinetic", self.kinetic), ("strain", self.strain)],
            [("soil", self.soil), ("contact", self.contact)],
            [("damping", self.damping), ("numerical", self.numerical)],
        ];
        for [(left, first), (right, second)] in pairs {
            let [first, second] = [first, second].map(shown);
            writeln!(f, "  {left:<12}{first:>12}    {right:<12}{second:>12}")?;
        }
        for (name, energy) in [("hysteresis", self.hysteresis), ("layer", self.layer)] {
            if energy != 0.0 {
                writeln!(f, "  {name:<12}{:>12}", shown(energy))?;
            }
        }
        let (preload, residual) = (shown(self.preload), self.residual());
        write!(f, "  {:<12}{preload:>12}    {:<12}{residual:>12.1e}", "preload", "residual")?;
        if self.soil_error_bound > 0.0 {
            let bound = shown(self.soil_error_bound);
            write!(f, "\n  {:<12}{bound:>12}    (approximate history)", "soil within")?;
        }
        Ok(())
    }
}
