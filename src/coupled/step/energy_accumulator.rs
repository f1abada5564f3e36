//! Adds an accepted step to the energy balance, each term from its own definition.
//!
//! | symbol | meaning |
//! |---|---|
//! | Δu, v, a | increment, velocity and acceleration of the structure, all total |
//! | τ | change of contact traction against the static state |
//! | s, `s_ff` | soil displacement by tractions; free field |
//! | τ_ff | tractions of the free field on faces below the surface |
//! | y, R | translation of the free field under a part; influence vectors |

use crate::bem::Ground;
use crate::coupled::base::transformation::Terms;
use crate::coupled::model::kinematics::Kinematics;
use crate::coupled::scene::Scene;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::state::State;
use crate::coupled::state::energy_balance::EnergyBalance;
use crate::coupled::step::forcing::{Forcing, StepData};
use crate::coupled::step::increment::Increment;
use crate::error::LawError;
use crate::linalg::matrix::spread;
use crate::linalg::{LatticeScratch, dot};
use crate::structure::Structure;

/// The energy balance so far, and data of the last step that the next one needs.
#[derive(Clone)]
pub(crate) struct EnergyAccumulator {
    pub(crate) energy_balance: EnergyBalance,
    /// Free field, soil displacement by tractions, and jump at the end of the last step, 2Q or 3Q each.
    pub(crate) free_field: Vec<f64>,
    pub(crate) soil_displacement: Vec<f64>,
    pub(crate) jump: Vec<f64>,
    /// Compliance of each element at the end of the last step; empty if all laws are hard.
    pub(crate) compliance: Vec<[f64; 2]>,
    /// Work of the nonlinear internal force so far; its stored energy, if that is known.
    pub(crate) nonlinear_work: f64,
    /// Per part: Rᵀ M Δu of the last step, and its Δy.
    pub(crate) momentum: Vec<[f64; 3]>,
    pub(crate) translation: Vec<[f64; 3]>,
    /// Per part: M R, and its mass Rᵀ M R.
    inertia: Vec<[Terms; 3]>,
    mass: Vec<[f64; 3]>,
    scratch: Scratch,
}

/// Scratch of a step; its contents do not outlive the step.
#[derive(Clone)]
struct Scratch {
    vector: Vec<f64>,
    product: Vec<f64>,
    means: Vec<f64>,
    lattice: LatticeScratch,
}

impl EnergyAccumulator {
    /// Accumulator at the beginning of a run; the energy of an initial motion counts as input.
    ///
    /// `compliant`: whether any law stores energy in its elements.
    pub(crate) fn new(
        scene: &Scene,
        structure: &dyn Structure,
        state: &State,
        compliant: bool,
    ) -> Result<Self, LawError> {
        let n = scene.model.coordinates;
        let size = scene.layout().len();
        let mut jump = scene.static_state.gap.clone();
        jump.resize(size, 0.0);
        let mut means = vec![0.0; size];
        scene.base.means(&state.kinematics.displacement, &mut means);
        for (jump, displacement) in jump.iter_mut().zip(&means) {
            *jump -= displacement;
        }
        let mut compliance = Vec::new();
        if compliant {
            for (e, &mode) in state.modes.iter().enumerate() {
                compliance.push(scene.compliance(e, mode, &state.start)?);
            }
        }
        let parts = scene.model.influence.parts();
        let mut inertia = Vec::new();
        let mut mass = Vec::new();
        for part in parts {
            let products = part.vectors.each_ref().map(|vector| {
                let vector = spread(vector, n);
                let mut product = vec![0.0; n];
                scene.model.mass.multiply_add(1.0, &vector, &mut product);
                (dot(&vector, &product), product)
            });
            mass.push(products.each_ref().map(|(mass, _)| *mass));
            inertia.push(products.map(|(_, product)| {
                product.into_iter().enumerate().filter(|(_, m)| *m != 0.0).collect()
            }));
        }
        let mut accumulator = Self {
            energy_balance: EnergyBalance::default(),
            free_field: vec![0.0; size],
            soil_displacement: vec![0.0; size],
            jump,
            compliance,
            nonlinear_work: 0.0,
            momentum: vec![[0.0; 3]; parts.len()],
            translation: vec![[0.0; 3]; parts.len()],
            inertia,
            mass,
            scratch: Scratch {
                vector: vec![0.0; n],
                product: vec![0.0; n],
                means,
                lattice: scene.soil.scratch(),
            },
        };
        accumulator.begin(scene, structure, state);
        Ok(accumulator)
    }

    /// Adds kinetic and strain energy of the motion at t = 0.
    fn begin(&mut self, scene: &Scene, structure: &dyn Structure, state: &State) {
        let Kinematics { displacement, velocity, .. } = &state.kinematics;
        let at_rest = self.static_energy(scene);
        let model = &scene.model;
        let energy_balance = &mut self.energy_balance;
        energy_balance.kinetic = 0.5 * model.mass.form(velocity, velocity);
        if !model.linear {
            let force_displacement = scene.force_displacement_of(&state.kinematics);
            if let Some((stored, dissipated)) = energies(scene, structure, &force_displacement) {
                self.nonlinear_work = stored;
                energy_balance.hysteresis = dissipated;
            }
        }
        let Scratch { vector, means, .. } = &mut self.scratch;
        vector.copy_from_slice(displacement);
        scene.subtract_base(vector, means);
        energy_balance.strain = 0.5 * model.stiffness.form(vector, vector) + self.nonlinear_work;
        energy_balance.input =
            energy_balance.kinetic + energy_balance.strain + energy_balance.hysteresis;
        energy_balance.largest = energy_balance.scale().max(at_rest);
    }

    /// Energy at rest of compliant interfaces, and of a nonlinear force with known energy.
    ///
    /// The balance counts these energies relative to the static state. Changes are rounded in proportion to it.
    fn static_energy(&self, scene: &Scene) -> f64 {
        let at_rest = &scene.static_state;
        let layout = scene.layout();
        let interfaces = at_rest.traction.iter().enumerate().map(|(i, traction)| {
            let [component, e] = layout.origin(i);
            let compliance = self.compliance.get(e).map_or(0.0, |c| c[component.min(1)]);
            0.5 * scene.base.area(i) * compliance * traction * traction
        });
        interfaces.sum::<f64>() + at_rest.energy.map_or(0.0, |energy| energy.stored.abs())
    }

    /// All numbers that a step passes to the next, for `directions` directions, always in this order.
    pub(crate) fn numbers(&mut self, directions: usize) -> Vec<&mut f64> {
        let mut all = vec![&mut self.nonlinear_work];
        all.extend(self.energy_balance.terms_mut());
        let contact = [&mut self.free_field, &mut self.soil_displacement, &mut self.jump];
        all.extend(contact.into_iter().flatten());
        all.extend(self.compliance.iter_mut().flatten());
        let parts = [&mut self.momentum, &mut self.translation].into_iter().flatten();
        all.extend(parts.flat_map(|values| values.iter_mut().take(directions)));
        all
    }

    /// Adds the step that leads from its state to its end.
    pub(crate) fn accumulate(
        &mut self,
        data: StepData<'_>,
        ground: &dyn Ground,
        increment: &Increment,
    ) {
        let StepData { scene, forcing, .. } = data;
        if forcing.loaded {
            self.energy_balance.input += dot(&forcing.load, &increment.total);
            self.energy_balance.relative_input += dot(&forcing.load, &increment.displacement);
        }
        if !scene.model.linear {
            self.add_nonlinear_force(data, increment);
        }
        self.add_structure(data, increment);
        self.add_relative_input(scene, forcing, increment);
        self.add_contact(data, ground, increment);
        self.update_largest(scene.time_step);
    }

    /// Updates the largest energy, including the energy of a structure that moves with the ground.
    ///
    /// The latter counts for a structure that the ground leaves behind, whose own energy is only rounding.
    fn update_largest(&mut self, time_step: f64) {
        let carried = self.mass.iter().zip(&self.translation).map(|(mass, increment)| {
            let energy = [0, 1, 2].map(|k| 0.5 * mass[k] * (increment[k] / time_step).powi(2));
            energy[0] + energy[1] + energy[2]
        });
        self.energy_balance.largest = self.energy_balance.scale().max(carried.sum());
    }

    /// Adds the energies of the nonlinear force: stored and dissipated, or its work if they are unknown.
    fn add_nonlinear_force(&mut self, data: StepData<'_>, increment: &Increment) {
        let StepData { scene, structure, .. } = data;
        let work = dot(&increment.force, &increment.total);
        let Some((stored, dissipated)) = energies(scene, structure, &increment.force_displacement)
        else {
            self.nonlinear_work += work;
            return;
        };
        let energy_balance = &mut self.energy_balance;
        energy_balance.algorithmic +=
            work - (stored - self.nonlinear_work) - (dissipated - energy_balance.hysteresis);
        self.nonlinear_work = stored;
        energy_balance.hysteresis = dissipated;
    }

    /// Adds kinetic and strain energy, damping, and the dissipation of the time scheme.
    fn add_structure(&mut self, data: StepData<'_>, increment: &Increment) {
        let StepData { scene, state, forcing, .. } = data;
        let c = &scene.coefficients;
        let model = &scene.model;
        let dt = scene.time_step;
        let Kinematics { velocity: v0, acceleration: a0, .. } = &state.kinematics;
        let v1 = &increment.velocity;
        let energy_balance = &mut self.energy_balance;
        let Scratch { vector, product, means, .. } = &mut self.scratch;
        let du = &increment.total;
        energy_balance.kinetic = 0.5 * model.mass.form(v1, v1);
        if model.damped {
            SchemeCoefficients::combine(c.velocity, du, v0, a0, vector);
            vector.iter_mut().zip(&forcing.dragged).for_each(|(v, dragged)| *v -= dragged);
            product.fill(0.0);
            model.damping.multiply_add(1.0, vector, product);
            let parts = model.influence.parts().iter().zip(&forcing.translations);
            let dragged: f64 = parts
                .map(|(part, y)| {
                    let [right, up, away] = part.resultants(product);
                    y.increment[0] * right + y.increment[1] * up + y.increment[2] * away
                })
                .sum();
            energy_balance.damping += dot(product, du) - dragged;
            energy_balance.input -= dragged;
        }
        if !scene.conserves_energy {
            // Δu = Δt (v₀+v₁)/2 + r_d, a* = (v₁−v₀)/Δt + r_a, u* = (u₀+u₁)/2 + r_u
            let change = &mut *vector;
            let rest = product;
            for i in 0..du.len() {
                change[i] = (v1[i] - v0[i]) / dt;
                rest[i] = du[i] - 0.5 * dt * (v0[i] + v1[i]);
            }
            energy_balance.algorithmic += model.mass.form(rest, change);
            for i in 0..du.len() {
                rest[i] =
                    SchemeCoefficients::apply(c.acceleration, du[i], v0[i], a0[i]) - change[i];
            }
            energy_balance.algorithmic += model.mass.form(du, rest);
            let du = &increment.displacement;
            for i in 0..du.len() {
                let there = SchemeCoefficients::apply(c.displacement, du[i], v0[i], a0[i]);
                rest[i] = there - 0.5 * du[i];
            }
            energy_balance.algorithmic += model.stiffness.form(du, rest);
        }
        vector.copy_from_slice(&increment.end);
        scene.subtract_base(vector, means);
        energy_balance.strain = 0.5 * model.stiffness.form(vector, vector) + self.nonlinear_work;
    }

    /// Adds the work of −M R ÿ between the middles of the last two steps, and of the loads.
    ///
    /// ÿ = (Δy₁ − Δy₀)/Δt² at the time between the two steps.
    fn add_relative_input(&mut self, scene: &Scene, forcing: &Forcing, increment: &Increment) {
        let square = scene.time_step * scene.time_step;
        for (k, inertia) in self.inertia.iter().enumerate() {
            let next = forcing.translations[k].increment;
            for direction in 0..scene.layout().components() {
                let terms = inertia[direction].iter();
                let momentum: f64 = terms.map(|&(i, m)| m * increment.displacement[i]).sum();
                let acceleration = (next[direction] - self.translation[k][direction]) / square;
                let mean = 0.5 * (momentum + self.momentum[k][direction]);
                self.energy_balance.relative_input -= acceleration * mean;
                self.momentum[k][direction] = momentum;
            }
            self.translation[k] = next;
        }
    }

    /// Adds energies of soil, contact, compliant interfaces and static contact.
    ///
    /// The jump is taken from the contact problem: if the structure moved otherwise, its energies would not
    /// balance the work of the tractions.
    fn add_contact(&mut self, data: StepData<'_>, ground: &dyn Ground, increment: &Increment) {
        let StepData { scene, state, forcing, .. } = data;
        let Scratch { means: soil, lattice, .. } = &mut self.scratch;
        let energy_balance = &mut self.energy_balance;
        soil.copy_from_slice(&forcing.history);
        scene.soil.multiply_add_with(lattice, &increment.traction, soil);
        let layout = scene.layout();
        let error_bound = ground.increment_error_bound();
        for i in 0..layout.len() {
            let [k, e] = layout.origin(i);
            let area = scene.base.area(i);
            let change = increment.traction[i];
            let at_rest = scene.static_state.traction[i];
            let end = &increment.contact[e];
            let jump = end.jump()[k];
            let opening = jump - self.jump[i];
            self.jump[i] = jump;
            let free = forcing.free_traction.get(i).copied().unwrap_or(0.0);
            let moved = soil[i] - self.soil_displacement[i];
            energy_balance.soil += area * (change - free) * moved;
            energy_balance.soil_error_bound += area * (change - free).abs() * error_bound;
            let mut elastic = 0.0;
            if !self.compliance.is_empty() {
                let c0 = self.compliance[e][k.min(1)];
                let c1 = increment.compliance[e][k.min(1)];
                let t0 = state.start.state(e).traction()[k];
                let t1 = at_rest + change;
                elastic = c0 * t0 - c1 * t1;
                energy_balance.interface += 0.5 * area * (c1 * t1 * t1 - c0 * t0 * t0);
                // The work −t₁ Δ(elastic jump) is Δ(½ c t²) plus this: the dissipation of the step for a spring
                // that stays, and the energy lost with a spring that is released.
                let lag = 0.5 * area * (c0 * (t1 - t0).powi(2) + (c1 - c0) * t1 * t1);
                if c0 == c1 {
                    energy_balance.algorithmic += lag;
                } else {
                    energy_balance.contact += lag;
                }
            }
            energy_balance.contact -= area * (at_rest + change) * (opening - elastic);
            energy_balance.static_contact += area * at_rest * opening;
            energy_balance.input -= area * change * (forcing.free_field[i] - self.free_field[i]);
            if free != 0.0 {
                energy_balance.input -= area * free * moved;
            }
        }
        self.free_field.copy_from_slice(&forcing.free_field);
        self.compliance.copy_from_slice(&increment.compliance);
        std::mem::swap(&mut self.soil_displacement, soil);
    }
}

/// Stored energy and dissipation of the nonlinear force since the static state; `None` if unknown.
///
/// Forces count from their static values, and so does the energy that they store.
fn energies(
    scene: &Scene,
    structure: &dyn Structure,
    force_displacement: &[f64],
) -> Option<(f64, f64)> {
    let at_rest = &scene.static_state;
    let start = at_rest.energy?;
    let energy = structure.nonlinear()?.energy(force_displacement)?;
    let moved = force_displacement.iter().zip(&at_rest.displacement).map(|(u, start)| u - start);
    let against: f64 = at_rest.force.iter().zip(moved).map(|(f, moved)| f * moved).sum();
    Some((energy.stored - start.stored - against, energy.dissipated - start.dissipated))
}
