//! GOAL: loads at t = 0 act as weight or as a slow ramp, by the rule of `GravityStage`.
//! SCENE: blocks on elastic ground in the plane and in plan, under weight, moment, side load and settlement.
//! REFERENCE: the closed form of a bonded and of a frictionless strip; the same weight as a mass; the same loads as
//! ramps in time.

use std::f64::consts::{PI, TAU};

use basemat::bem::{ContactElement, ElasticGround, Ground};
use basemat::coupled::{GravityStage, Load, State};
use basemat::interface::{Bonded, Cohesive, Coulomb, InterfaceLaw};
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::{RigidBlock, RigidBody, Structure};
use basemat::{Observer, Result, Simulation, Soil};

type BoxedLaw = Box<dyn InterfaceLaw>;

/// Half the width of both bases, m.
const BASE_HALF_WIDTH: f64 = 4.0;

fn soil() -> Soil {
    Soil::new(80.0e6, 0.33, 1900.0).unwrap()
}

fn laws() -> [(&'static str, BoxedLaw); 4] {
    [
        ("bonded", Box::new(Bonded)),
        ("friction 0.9", Box::new(Coulomb::new(0.9).unwrap())),
        ("friction 0.15", Box::new(Coulomb::new(0.15).unwrap())),
        ("cohesive", Box::new(Cohesive::new(1e9, 1e9, 0.5).unwrap())),
    ]
}

/// A rigid body on its ground, in the plane or in space.
struct BodyOnGround {
    structure: Box<dyn Structure>,
    ground: ElasticGround,
    weight: f64,
    /// Degrees of freedom along x, upwards and of the rotation about y.
    dofs: [usize; 3],
}

fn body_on_ground(in_space: bool) -> BodyOnGround {
    let width = 2.0 * BASE_HALF_WIDTH;
    if in_space {
        let body = RigidBody::cuboid([width, width, 10.0], 1000.0).unwrap();
        let ground = ElasticGround::under(soil(), &body, 6).unwrap();
        let weight = STANDARD_GRAVITY * 1000.0 * 4.0 * BASE_HALF_WIDTH * BASE_HALF_WIDTH * 10.0;
        return BodyOnGround { structure: Box::new(body), ground, weight, dofs: [0, 2, 4] };
    }
    let block = RigidBlock::new(width, 10.0, 1000.0).unwrap();
    let ground = ElasticGround::under(soil(), &block, 16).unwrap();
    let weight = STANDARD_GRAVITY * block.total_mass();
    BodyOnGround { structure: Box::new(block), ground, weight, dofs: [0, 1, 2] }
}

/// Largest difference of the tractions of two states over the largest pressure.
fn traction_difference(a: &State, b: &State) -> f64 {
    let mut largest_pressure = 0.0_f64;
    let mut largest_difference = 0.0_f64;
    for (a, b) in a.contact.iter().zip(&b.contact) {
        largest_pressure = largest_pressure.max(a.pressure.abs());
        for difference in
            [a.pressure - b.pressure, a.shear - b.shear, a.shear_across - b.shear_across]
        {
            largest_difference = largest_difference.max(difference.abs());
        }
    }
    largest_difference / largest_pressure
}

/// The body under its weight, half of which may act as a load instead.
fn under_weight(
    in_space: bool,
    stage: GravityStage,
    law: BoxedLaw,
    half_as_load: bool,
) -> Simulation {
    let BodyOnGround { structure, ground, weight, dofs } = body_on_ground(in_space);
    let mut builder = Simulation::builder(0.01)
        .structure(structure)
        .ground(ground)
        .interface(law)
        .gravity_stage(stage);
    if half_as_load {
        let load = Load::weight(dofs[1], -0.5 * weight);
        builder = builder.gravity(0.5 * STANDARD_GRAVITY).load(load);
    }
    builder.build().unwrap()
}

#[test]
fn weight_as_a_load_is_weight() {
    for in_space in [false, true] {
        let upwards = body_on_ground(in_space).dofs[1];
        for stage in [GravityStage::Frictionless, GravityStage::Frictional] {
            for ((name, law), (_, same_law)) in laws().into_iter().zip(laws()) {
                let as_load = under_weight(in_space, stage, law, true);
                let as_mass = under_weight(in_space, stage, same_law, false);
                let difference = traction_difference(as_mass.state(), as_load.state());
                let settlement_by_mass = as_mass.static_displacement()[upwards];
                let settlement_by_load = as_load.static_displacement()[upwards];
                let ratio = settlement_by_load / settlement_by_mass;
                println!(
                    "in space {in_space}, {stage:?}, {name}: tractions {difference:.1e}, {ratio}"
                );
                assert!(difference < 1e-9, "{name}: {difference}");
                assert!((ratio - 1.0).abs() < 1e-9, "{name}: {ratio}");
            }
        }
    }
}

/// Ground that approaches the static displacements of another exponentially in time.
struct RelaxingGround {
    ground: ElasticGround,
    compliance: Vec<f64>,
    /// Relaxation time over the time step.
    relaxation_steps: f64,
    displacement: Vec<f64>,
}

/// Relaxation time, s.
const RELAXATION_TIME: f64 = 0.1;

impl RelaxingGround {
    fn new(ground: ElasticGround, in_space: bool) -> Self {
        let count = ground.elements().len();
        let size = if in_space { 3 } else { 2 } * count;
        let mut compliance = vec![0.0; size * size];
        ground.static_compliance(&mut compliance).unwrap();
        // Displacements in the plane have no datum: the element that is farthest away does not move.
        if !in_space {
            for component in 0..2 {
                let places = component * count..(component + 1) * count;
                let entries = places
                    .clone()
                    .flat_map(|row| places.clone().map(move |column| row * size + column));
                let min_compliance =
                    entries.clone().map(|at| compliance[at]).fold(f64::INFINITY, f64::min);
                entries.for_each(|at| compliance[at] -= min_compliance);
            }
        }
        Self { ground, compliance, relaxation_steps: 0.0, displacement: vec![0.0; size] }
    }

    /// Factor of the static displacement S τ in S τ = (s₀ + s₁)/2 + r (s₁ − s₀)/Δt, solved for s₁.
    fn static_factor(&self) -> f64 {
        1.0 / (self.relaxation_steps + 0.5)
    }

    /// Factor of the displacement s₀ before the step in the same equation.
    fn history_factor(&self) -> f64 {
        (self.relaxation_steps - 0.5) / (self.relaxation_steps + 0.5)
    }
}

impl Ground for RelaxingGround {
    fn elements(&self) -> &[ContactElement] {
        self.ground.elements()
    }

    fn prepare(&mut self, step: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.relaxation_steps = RELAXATION_TIME / step;
        self.displacement.fill(0.0);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        let factor = self.static_factor();
        matrix.iter_mut().zip(&self.compliance).for_each(|(to, from)| *to = factor * from);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        let factor = self.history_factor();
        displacement
            .iter_mut()
            .zip(&self.displacement)
            .for_each(|(to, from)| *to = factor * from);
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        let static_factor = self.static_factor();
        let history_factor = self.history_factor();
        let rows = self.compliance.chunks(traction.len());
        for (displacement, row) in self.displacement.iter_mut().zip(rows) {
            let product: f64 = row.iter().zip(traction).map(|(s, t)| s * t).sum();
            *displacement = static_factor * product + history_factor * *displacement;
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        matrix.copy_from_slice(&self.compliance);
        Ok(())
    }
}

/// Side load over the weight, and moment over the weight times the width.
const SIDE_LOAD_RATIO: f64 = 0.08;
/// Additional vertical load over the weight.
const VERTICAL_LOAD_RATIO: f64 = 0.3;
/// Duration of the ramp, s.
const RAMP_DURATION: f64 = 10.0;

/// The body on relaxing ground under loads that act from the start or by a ramp.
fn under_loads(in_space: bool, law: BoxedLaw, by_ramp: bool) -> Simulation {
    let BodyOnGround { structure, ground, weight, dofs } = body_on_ground(in_space);
    let side_load = SIDE_LOAD_RATIO * weight;
    let moment = SIDE_LOAD_RATIO * weight * 2.0 * BASE_HALF_WIDTH;
    let mut builder = Simulation::builder(0.05)
        .structure(structure)
        .ground(RelaxingGround::new(ground, in_space))
        .interface(law);
    for (dof, force) in dofs.into_iter().zip([side_load, -VERTICAL_LOAD_RATIO * weight, moment]) {
        builder = builder.load(Load::new(dof, move |time: f64| {
            if by_ramp { force * (time / RAMP_DURATION).min(1.0) } else { force }
        }));
    }
    builder.build().unwrap()
}

/// Static state under loads beside the end of their slow ramp.
struct RampComparison {
    /// Largest difference of the tractions over the largest pressure.
    error: f64,
    /// The same difference between the static states with and without loads.
    change_by_loads: f64,
    elements_slid: usize,
    largest_friction_ratio: f64,
}

impl RampComparison {
    fn new(in_space: bool, law: &dyn Fn() -> BoxedLaw) -> Self {
        let static_loads = under_loads(in_space, law(), false);
        let mut ramp = under_loads(in_space, law(), true);
        let unloaded_state = ramp.state().clone();
        ramp.run(300, |_| {}).unwrap();
        let contact = &ramp.state().contact;
        let friction_ratios = contact.iter().map(|element| element.shear.abs() / element.pressure);
        Self {
            error: traction_difference(static_loads.state(), ramp.state()),
            change_by_loads: traction_difference(&unloaded_state, static_loads.state()),
            elements_slid: contact.iter().filter(|element| element.slip.abs() > 1e-8).count(),
            largest_friction_ratio: friction_ratios.fold(0.0, f64::max),
        }
    }
}

#[test]
fn the_static_state_of_loads_is_the_end_of_their_slow_ramp() {
    for in_space in [false, true] {
        let sticking_laws: [(&str, &dyn Fn() -> BoxedLaw); 3] = [
            ("bonded", &|| Box::new(Bonded)),
            ("friction 0.9", &|| Box::new(Coulomb::new(0.9).unwrap())),
            ("cohesive", &|| Box::new(Cohesive::new(1e9, 1e9, 0.5).unwrap())),
        ];
        let mut sticking_friction = 0.0;
        for (name, law) in sticking_laws {
            let RampComparison { error, change_by_loads, elements_slid, largest_friction_ratio } =
                RampComparison::new(in_space, law);
            println!(
                "in space {in_space}, {name}: {error:.1e}, change {change_by_loads:.2}, friction \
                 {largest_friction_ratio:.3}"
            );
            assert!(change_by_loads > 0.2, "{name}: {change_by_loads}");
            assert_eq!(elements_slid, 0, "{name}");
            assert!(error < 1e-6, "in space {in_space}, {name}: {error}");
            sticking_friction = largest_friction_ratio;
        }
        // Between the friction at which the whole base would slide, and the friction at which it sticks.
        let friction =
            0.6 * sticking_friction + 0.4 * SIDE_LOAD_RATIO / (1.0 + VERTICAL_LOAD_RATIO);
        let RampComparison { error, elements_slid, .. } =
            RampComparison::new(in_space, &|| Box::new(Coulomb::new(friction).unwrap()));
        println!("in space {in_space}, friction {friction:.3}: {error:.1e}, {elements_slid} slid");
        // Ten increments approximate the ramp.
        assert!(elements_slid > 0 && error < 0.01, "in space {in_space}: {elements_slid} {error}");
    }
}

/// Rocking stiffness of a rigid strip is π G b²/(2 (1 − ν)) if frictionless, 1 + 4 ε² times as much if bonded.
///
/// ε = ln(3 − 4ν)/2π (Muskhelishvili 1953, § 114).
#[test]
fn a_bonded_base_is_bonded_under_loads() {
    let soil = soil();
    let exponent = (3.0 - 4.0 * soil.poisson()).ln() / TAU;
    let frictionless_stiffness = PI * soil.shear_modulus() * BASE_HALF_WIDTH * BASE_HALF_WIDTH
        / (2.0 * (1.0 - soil.poisson()));
    let bonded = frictionless_stiffness * (1.0 + 4.0 * exponent * exponent);
    let cases: [(&str, BoxedLaw, f64); 3] = [
        ("bonded", Box::new(Bonded), bonded),
        ("sticks", Box::new(Coulomb::new(0.5).unwrap()), bonded),
        ("smooth", Box::new(Coulomb::new(0.0).unwrap()), frictionless_stiffness),
    ];
    for (name, law, expected) in cases {
        let BodyOnGround { structure, ground, weight, dofs } = body_on_ground(false);
        let moment = 0.1 * weight * 2.0 * BASE_HALF_WIDTH;
        let simulation = Simulation::builder(0.01)
            .structure(structure)
            .ground(ground)
            .interface(law)
            .load(Load::constant(dofs[2], moment))
            .build()
            .unwrap();
        let stiffness = moment / simulation.static_displacement()[dofs[2]];
        println!("{name}: {:.4} of the closed form", stiffness / expected);
        assert!((stiffness / expected - 1.0).abs() < 0.007, "{name}: {stiffness:e} {expected:e}");
    }
}
