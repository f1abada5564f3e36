//! Accumulation of the energy balance: adds each accepted step, each term from its own definition.
//!
//! | symbol | meaning |
//! |---|---|
//! | Δu, v, a | increment, velocity and acceleration of the structure, all total |
//! | τ | change of contact traction against the static state |
//! | s, `s_ff` | soil displacement due to tractions; free field |
//! | τ_ff | tractions of the free field on faces below the surface |
//! | y, R | translation of the free field under a part; influence vectors |

use crate::bem::Ground;
use crate::coupled::base::transformation::SparseVector;
use crate::coupled::model::kinematics::Kinematics;
use crate::coupled::scene::Scene;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::state::State;
use crate::coupled::state::energy_balance::EnergyBalance;
use crate::coupled::step::forcing::{Forcing, StepData};
use crate::coupled::step::increment::Increment;
use crate::coupled::step::joint_losses::JointLosses;
use crate::error::LawError;
use crate::linalg::matrix::dense_vector;
use crate::linalg::{LatticeScratch, dot};
use crate::structure::{InternalEnergy, Structure};

/// The energy balance so far, with data of the last step for the next one.
#[derive(Clone)]
pub(crate) struct EnergyAccumulator {
    pub(crate) energy_balance: EnergyBalance,
    /// Free field at the end of the last step, m, 2Q or 3Q.
    pub(crate) free_field: Vec<f64>,
    /// Soil displacement due to tractions at the end of the last step, m, 2Q or 3Q.
    pub(crate) soil_displacement: Vec<f64>,
    /// Jump at the end of the last step, m, 2Q or 3Q.
    pub(crate) jump: Vec<f64>,
    /// Normal and shear compliance of each element at the end of the last step, m/Pa; empty without compliant laws.
    pub(crate) compliance: Vec<[f64; 2]>,
    /// Energy lost by friction and impact in each joint, J/m.
    pub(crate) joint_losses: JointLosses,
    /// Stored energy of the nonlinear force; its work so far if the stored energy is unknown.
    pub(crate) nonlinear_energy: f64,
    /// Rᵀ M Δu of the last step, for each part.
    pub(crate) momentum: Vec<[f64; 3]>,
    /// Δy of the last step, for each part.
    pub(crate) translation_increment: Vec<[f64; 3]>,
    /// M R, for each part.
    inertia: Vec<[SparseVector; 3]>,
    /// Mass Rᵀ M R of each part, in each direction.
    mass: Vec<[f64; 3]>,
    scratch: EnergyScratch,
}

/// Buffers of a step; the next step overwrites them.
#[derive(Clone)]
struct EnergyScratch {
    vector: Vec<f64>,
    product: Vec<f64>,
    means: Vec<f64>,
    lattice: LatticeScratch,
}

impl EnergyAccumulator {
    /// Accumulator at the start of a run; the energy of an initial motion counts as input.
    ///
    /// `is_compliant` states whether any law stores elastic energy.
    pub(crate) fn new(
        scene: &Scene,
        structure: &dyn Structure,
        state: &State,
        is_compliant: bool,
    ) -> Result<Self, LawError> {
        let coordinates = scene.model.coordinate_count;
        let component_count = scene.layout().len();
        let mut jump = scene.static_state.gap.clone();
        jump.resize(component_count, 0.0);
        let mut means = vec![0.0; component_count];
        scene.base.means(&state.kinematics.displacement, &mut means);
        for (jump, displacement) in jump.iter_mut().zip(&means) {
            *jump -= displacement;
        }
        let mut compliance = Vec::new();
        if is_compliant {
            for (e, start) in state.start.iter().enumerate() {
                compliance.push(scene.compliance(e, start.mode, &state.start)?);
            }
        }
        let parts = scene.model.influence.parts();
        let mut inertia = Vec::new();
        let mut mass = Vec::new();
        for part in parts {
            let products = part.vectors.each_ref().map(|vector| {
                let translation = dense_vector(vector, coordinates);
                let mut product = vec![0.0; coordinates];
                scene.model.mass.multiply_add(1.0, &translation, &mut product);
                (dot(&translation, &product), product)
            });
            mass.push(products.each_ref().map(|(mass, _)| *mass));
            inertia.push(products.map(|(_, product)| {
                product.into_iter().enumerate().filter(|(_, m)| *m != 0.0).collect()
            }));
        }
        let mut accumulator = Self {
            energy_balance: EnergyBalance::default(),
            free_field: vec![0.0; component_count],
            soil_displacement: vec![0.0; component_count],
            jump,
            compliance,
            joint_losses: JointLosses::new(scene),
            nonlinear_energy: 0.0,
            momentum: vec![[0.0; 3]; parts.len()],
            translation_increment: vec![[0.0; 3]; parts.len()],
            inertia,
            mass,
            scratch: EnergyScratch {
                vector: vec![0.0; coordinates],
                product: vec![0.0; coordinates],
                means,
                lattice: scene.step_compliance.scratch(),
            },
        };
        accumulator.add_initial_energy(scene, structure, state);
        Ok(accumulator)
    }

    /// Adds kinetic and strain energy of the motion at t = 0.
    fn add_initial_energy(&mut self, scene: &Scene, structure: &dyn Structure, state: &State) {
        let Kinematics { displacement, velocity, .. } = &state.kinematics;
        let static_energy = self.static_energy(scene);
        let model = &scene.model;
        let energy_balance = &mut self.energy_balance;
        energy_balance.kinetic = 0.5 * model.mass.form(velocity, velocity);
        if !model.is_linear {
            let force_displacement = scene.force_displacement_of(&state.kinematics);
            if let Some(InternalEnergy { stored, dissipated }) =
                nonlinear_energies(scene, structure, &force_displacement)
            {
                self.nonlinear_energy = stored;
                energy_balance.hysteresis = dissipated;
            }
        }
        let EnergyScratch { vector, means, .. } = &mut self.scratch;
        vector.copy_from_slice(displacement);
        scene.subtract_base_translation(vector, means);
        energy_balance.strain = 0.5 * model.stiffness.form(vector, vector) + self.nonlinear_energy;
        energy_balance.input =
            energy_balance.kinetic + energy_balance.strain + energy_balance.hysteresis;
        energy_balance.largest = energy_balance.scale().max(static_energy);
    }

    /// Energy of the static state in compliant interfaces and the nonlinear force.
    ///
    /// The balance counts energies relative to the static state. Rounding of changes is proportional to this energy.
    fn static_energy(&self, scene: &Scene) -> f64 {
        let static_state = &scene.static_state;
        let layout = scene.layout();
        let interface_energies = static_state.traction.iter().enumerate().map(|(i, traction)| {
            let [component, e] = layout.component_and_element(i);
            let compliance = self.compliance.get(e).map_or(0.0, |c| c[component.min(1)]);
            0.5 * scene.base.area(i) * compliance * traction * traction
        });
        interface_energies.sum::<f64>()
            + static_state.energy.map_or(0.0, |energy| energy.stored.abs())
    }

    /// All numbers that a step passes to the next, in a fixed order.
    ///
    /// `components`: number of displacement components, 2 in the plane, 3 in plan.
    pub(crate) fn numbers(&mut self, components: usize) -> Vec<&mut f64> {
        let mut numbers = vec![&mut self.nonlinear_energy];
        numbers.extend(self.energy_balance.terms_mut());
        let contact = [&mut self.free_field, &mut self.soil_displacement, &mut self.jump];
        numbers.extend(contact.into_iter().flatten());
        numbers.extend(self.compliance.iter_mut().flatten());
        numbers.extend(&mut self.joint_losses.0);
        let parts = [&mut self.momentum, &mut self.translation_increment].into_iter().flatten();
        numbers.extend(parts.flat_map(|values| values.iter_mut().take(components)));
        numbers
    }

    /// Adds the energies of a step to the balance.
    pub(crate) fn accumulate(
        &mut self,
        data: StepData<'_>,
        ground: &dyn Ground,
        increment: &Increment,
    ) {
        let StepData { scene, forcing, .. } = data;
        if forcing.has_load {
            self.energy_balance.input += dot(&forcing.load, &increment.total_displacement);
            self.energy_balance.relative_input += dot(&forcing.load, &increment.displacement);
        }
        if !scene.model.is_linear {
            self.add_nonlinear_force(data, increment);
        }
        self.add_structure(data, increment);
        self.add_relative_input(scene, forcing, increment);
        self.add_contact(data, ground, increment);
        self.update_largest(scene.time_step);
    }

    /// Updates the largest energy.
    ///
    /// It includes the kinetic energy of the structure moving with the ground, since a structure at rest on a moving ground
    /// has only rounding in its other energies.
    fn update_largest(&mut self, time_step: f64) {
        let kinetic_energies =
            self.mass.iter().zip(&self.translation_increment).map(|(mass, increment)| {
                let terms = [0, 1, 2].map(|k| 0.5 * mass[k] * (increment[k] / time_step).powi(2));
                terms[0] + terms[1] + terms[2]
            });
        self.energy_balance.largest = self.energy_balance.scale().max(kinetic_energies.sum());
    }

    /// Adds stored and dissipated energy of the nonlinear force, or its work if they are unknown.
    ///
    /// The rest of the work is the force's remainder inside the step. Without a remainder it counts as algorithmic.
    fn add_nonlinear_force(&mut self, data: StepData<'_>, increment: &Increment) {
        let StepData { scene, structure, .. } = data;
        let work = dot(&increment.nonlinear_force, &increment.total_displacement);
        let Increment { midstep_displacement, force_displacement, .. } = increment;
        // The remainder first: elements with internal variables then store their energies at the end.
        let remainder = structure
            .nonlinear()
            .and_then(|force| force.remainder(midstep_displacement, force_displacement));
        let Some(InternalEnergy { stored, dissipated }) =
            nonlinear_energies(scene, structure, force_displacement)
        else {
            self.nonlinear_energy += work;
            return;
        };
        let energy_balance = &mut self.energy_balance;
        match remainder {
            Some(remainder) => energy_balance.midstep_remainder += remainder,
            None => {
                energy_balance.algorithmic += work
                    - (stored - self.nonlinear_energy)
                    - (dissipated - energy_balance.hysteresis);
            }
        }
        self.nonlinear_energy = stored;
        energy_balance.hysteresis = dissipated;
    }

    /// Adds kinetic and strain energy, damping, and the dissipation of the time scheme.
    fn add_structure(&mut self, data: StepData<'_>, increment: &Increment) {
        let StepData { scene, state, forcing, .. } = data;
        let c = &scene.coefficients;
        let model = &scene.model;
        let dt = scene.time_step;
        let Kinematics { velocity: v0, acceleration: a0, .. } = &state.kinematics;
        let v1 = &increment.end_velocity;
        let energy_balance = &mut self.energy_balance;
        let EnergyScratch { vector, product, means, .. } = &mut self.scratch;
        let du = &increment.total_displacement;
        energy_balance.kinetic = 0.5 * model.mass.form(v1, v1);
        if model.is_damped {
            SchemeCoefficients::combine(c.velocity, du, v0, a0, vector);
            vector.iter_mut().zip(&forcing.translation_velocity).for_each(|(v, y)| *v -= y);
            product.fill(0.0);
            model.damping.multiply_add(1.0, vector, product);
            let parts = model.influence.parts().iter().zip(&forcing.translations);
            let translation_work: f64 = parts
                .map(|(part, y)| {
                    let [right, up, along_y] = part.resultants(product);
                    y.increment[0] * right + y.increment[1] * up + y.increment[2] * along_y
                })
                .sum();
            energy_balance.damping += dot(product, du) - translation_work;
            energy_balance.input -= translation_work;
        }
        if !scene.conserves_energy {
            // Residuals against the midpoint rule: Δu = Δt (v₀+v₁)/2 + r_d, a* = (v₁−v₀)/Δt + r_a, u* = (u₀+u₁)/2 + r_u.
            let acceleration = &mut *vector;
            let residual = product;
            for i in 0..du.len() {
                acceleration[i] = (v1[i] - v0[i]) / dt;
                residual[i] = du[i] - 0.5 * dt * (v0[i] + v1[i]);
            }
            energy_balance.algorithmic += model.mass.form(residual, acceleration);
            for i in 0..du.len() {
                residual[i] = SchemeCoefficients::apply(c.acceleration, du[i], v0[i], a0[i])
                    - acceleration[i];
            }
            energy_balance.algorithmic += model.mass.form(du, residual);
            let du = &increment.displacement;
            for i in 0..du.len() {
                let scheme_change = SchemeCoefficients::apply(c.displacement, du[i], v0[i], a0[i]);
                residual[i] = scheme_change - 0.5 * du[i];
            }
            energy_balance.algorithmic += model.stiffness.form(du, residual);
        }
        vector.copy_from_slice(&increment.end_displacement);
        scene.subtract_base_translation(vector, means);
        energy_balance.strain = 0.5 * model.stiffness.form(vector, vector) + self.nonlinear_energy;
    }

    /// Adds the work of −M R ÿ between the middles of the last two steps.
    ///
    /// ÿ = (Δy₁ − Δy₀)/Δt² at the time between the two steps.
    fn add_relative_input(&mut self, scene: &Scene, forcing: &Forcing, increment: &Increment) {
        let squared_step = scene.time_step * scene.time_step;
        for (k, inertia) in self.inertia.iter().enumerate() {
            let translation_increment = forcing.translations[k].increment;
            for direction in 0..scene.layout().components() {
                let terms = inertia[direction].iter();
                let momentum: f64 = terms.map(|&(i, m)| m * increment.displacement[i]).sum();
                let acceleration = (translation_increment[direction]
                    - self.translation_increment[k][direction])
                    / squared_step;
                let mean_momentum = 0.5 * (momentum + self.momentum[k][direction]);
                self.energy_balance.relative_input -= acceleration * mean_momentum;
                self.momentum[k][direction] = momentum;
            }
            self.translation_increment[k] = translation_increment;
        }
    }

    /// Adds energies of soil, contact, compliant interfaces and static contact.
    ///
    /// The jump comes from the contact problem. If the structure moved differently, its energies would not balance the work
    /// of the tractions.
    fn add_contact(&mut self, data: StepData<'_>, ground: &dyn Ground, increment: &Increment) {
        let StepData { scene, state, forcing, .. } = data;
        let EnergyScratch { means: soil_displacement, lattice, .. } = &mut self.scratch;
        let energy_balance = &mut self.energy_balance;
        soil_displacement.copy_from_slice(&forcing.history);
        scene
            .step_compliance
            .multiply_add_with(lattice, &increment.traction, soil_displacement);
        let layout = scene.layout();
        let ground_count = scene.base.elements().len();
        let joint_losses = &mut self.joint_losses;
        let error_bound = ground.increment_error_bound();
        for i in 0..layout.len() {
            let [k, e] = layout.component_and_element(i);
            let area = scene.base.area(i);
            let change = increment.traction[i];
            let static_traction = scene.static_state.traction[i];
            let end = &increment.contact[e];
            let jump = end.jump()[k];
            let opening = jump - self.jump[i];
            self.jump[i] = jump;
            let free_traction = forcing.free_traction.get(i).copied().unwrap_or(0.0);
            let soil_increment = soil_displacement[i] - self.soil_displacement[i];
            energy_balance.soil += area * (change - free_traction) * soil_increment;
            let error_bound = if e < ground_count { error_bound } else { 0.0 };
            energy_balance.soil_error_bound += area * (change - free_traction).abs() * error_bound;
            // Elastic increment of the jump.
            let mut elastic_opening = 0.0;
            if !self.compliance.is_empty() {
                let c0 = self.compliance[e][k.min(1)];
                let c1 = increment.compliance[e][k.min(1)];
                let t0 = state.start.state(e).traction()[k];
                let t1 = static_traction + change;
                elastic_opening = c0 * t0 - c1 * t1;
                energy_balance.interface += 0.5 * area * (c1 * t1 * t1 - c0 * t0 * t0);
                // The work −t₁ Δ(elastic jump) is Δ(½ c t²) plus this loss: the algorithmic dissipation of a spring with
                // constant compliance, otherwise the energy that is lost with a released spring.
                let loss = 0.5 * area * (c0 * (t1 - t0).powi(2) + (c1 - c0) * t1 * t1);
                if c0 == c1 {
                    energy_balance.algorithmic += loss;
                } else {
                    energy_balance.contact += loss;
                    joint_losses.add(scene, e, loss);
                }
            }
            let work = area * (static_traction + change) * (opening - elastic_opening);
            energy_balance.contact -= work;
            joint_losses.add(scene, e, -work);
            energy_balance.static_contact += area * static_traction * opening;
            energy_balance.input -= area * change * (forcing.free_field[i] - self.free_field[i]);
            if free_traction != 0.0 {
                energy_balance.input -= area * free_traction * soil_increment;
            }
        }
        self.free_field.copy_from_slice(&forcing.free_field);
        self.compliance.copy_from_slice(&increment.compliance);
        std::mem::swap(&mut self.soil_displacement, soil_displacement);
    }
}

/// Energies of the nonlinear force since the static state; `None` if they are unknown.
///
/// The stored energy does not contain the work of the static forces.
fn nonlinear_energies(
    scene: &Scene,
    structure: &dyn Structure,
    force_displacement: &[f64],
) -> Option<InternalEnergy> {
    let static_state = &scene.static_state;
    let static_energy = static_state.energy?;
    let energy = structure.nonlinear()?.energy(force_displacement)?;
    let pairs = force_displacement.iter().zip(&static_state.displacement);
    let displacements = pairs.map(|(u, static_u)| u - static_u);
    let static_work: f64 = static_state.force.iter().zip(displacements).map(|(f, u)| f * u).sum();
    Some(InternalEnergy {
        stored: energy.stored - static_energy.stored - static_work,
        dissipated: energy.dissipated - static_energy.dissipated,
    })
}
