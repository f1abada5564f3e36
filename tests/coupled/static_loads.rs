//! GOAL: loads at t = 0 come on by the rule that `GravityStage` states, as weight or as a slow ramp would.
//! SCENE: blocks on elastic ground in the plane and in plan, under weight, moment, side load and settlement.
//! REFERENCE: the closed form of a bonded and of a smooth strip; the same weight as a mass; the same loads as ramps in
//! time.

use std::f64::consts::{PI, TAU};

use basemat::bem::{ContactElement, ElasticGround, Ground};
use basemat::coupled::{GravityStage, Load, SimulationBuilder, State};
use basemat::interface::{Bonded, Cohesive, Coulomb, InterfaceLaw};
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::{RigidBlock, RigidBody, Structure};
use basemat::{Observer, Result, Simulation, Soil};

type Law = Box<dyn InterfaceLaw>;

/// Half the width of both bases, m.
const HALF: f64 = 4.0;

fn soil() -> Soil {
    Soil::new(80.0e6, 0.33, 1900.0).unwrap()
}

fn laws() -> [(&'static str, Law); 4] {
    [
        ("bonded", Box::new(Bonded)),
        ("friction 0.9", Box::new(Coulomb::new(0.9).unwrap())),
        ("friction 0.15", Box::new(Coulomb::new(0.15).unwrap())),
        ("cohesive", Box::new(Cohesive::new(1e9, 1e9, 0.5).unwrap())),
    ]
}

/// A body, its ground, weight, and numbers of its degrees of freedom: along x, up, rotation about y.
struct Scene {
    structure: Box<dyn Structure>,
    ground: ElasticGround,
    weight: f64,
    dofs: [usize; 3],
}

fn scene(plan: bool) -> Scene {
    if plan {
        let body = RigidBody::cuboid([2.0 * HALF, 2.0 * HALF, 10.0], 1000.0).unwrap();
        let ground = ElasticGround::under(soil(), &body, 6).unwrap();
        let weight = STANDARD_GRAVITY * 1000.0 * 4.0 * HALF * HALF * 10.0;
        return Scene { structure: Box::new(body), ground, weight, dofs: [0, 2, 4] };
    }
    let block = RigidBlock::new(2.0 * HALF, 10.0, 1000.0).unwrap();
    let ground = ElasticGround::under(soil(), &block, 16).unwrap();
    let weight = STANDARD_GRAVITY * block.total_mass();
    Scene { structure: Box::new(block), ground, weight, dofs: [0, 1, 2] }
}

/// Largest difference of the tractions of two states over the largest pressure.
fn difference(a: &State, b: &State) -> f64 {
    let pressure = a.contact.iter().fold(0.0_f64, |most, own| most.max(own.pressure.abs()));
    let pairs = a.contact.iter().zip(&b.contact);
    let errors = pairs.flat_map(|(a, b)| {
        [a.pressure - b.pressure, a.shear - b.shear, a.shear_across - b.shear_across]
    });
    errors.fold(0.0_f64, |most, error| most.max(error.abs())) / pressure
}

#[test]
fn weight_as_a_load_is_weight() {
    for plan in [false, true] {
        for stage in [GravityStage::Frictionless, GravityStage::Frictional] {
            for (name, law) in laws() {
                let build = |builder: SimulationBuilder, law: Law| {
                    builder.interface(law).gravity_stage(stage).build().unwrap()
                };
                let Scene { structure, ground, weight, dofs } = scene(plan);
                let as_load = Simulation::builder(0.01)
                    .structure(structure)
                    .ground(ground)
                    .gravity(0.5 * STANDARD_GRAVITY)
                    .load(Load::weight(dofs[1], -0.5 * weight));
                let as_load = build(as_load, law);
                let Scene { structure, ground, .. } = scene(plan);
                let as_mass = Simulation::builder(0.01).structure(structure).ground(ground);
                let law = laws().into_iter().find(|own| own.0 == name).unwrap().1;
                let as_mass = build(as_mass, law);
                let tractions = difference(as_mass.state(), as_load.state());
                let [mass, load] =
                    [&as_mass, &as_load].map(|own| own.static_displacement()[dofs[1]]);
                println!(
                    "plan {plan}, {stage:?}, {name}: tractions {tractions:.1e}, {mass} {load}"
                );
                assert!(tractions < 1e-9, "{name}: {tractions}");
                assert!((load / mass - 1.0).abs() < 1e-9, "{name}: {load} {mass}");
            }
        }
    }
}

/// The static compliance of another ground, and its relaxation in time.
struct Relaxing {
    ground: ElasticGround,
    compliance: Vec<f64>,
    /// Relaxation time over the time step.
    steps: f64,
    displacement: Vec<f64>,
}

/// Relaxation time, s.
const RELAXATION: f64 = 0.1;

impl Relaxing {
    fn new(ground: ElasticGround, plan: bool) -> Self {
        let count = ground.elements().len();
        let size = if plan { 3 } else { 2 } * count;
        let mut compliance = vec![0.0; size * size];
        ground.static_compliance(&mut compliance).unwrap();
        // Displacements in the plane have no datum: the farthest element does not move.
        if !plan {
            for component in 0..2 {
                let places = component * count..(component + 1) * count;
                let entries = places
                    .clone()
                    .flat_map(|row| places.clone().map(move |column| row * size + column));
                let lowest = entries.clone().map(|at| compliance[at]).fold(f64::INFINITY, f64::min);
                entries.for_each(|at| compliance[at] -= lowest);
            }
        }
        Self { ground, compliance, steps: 0.0, displacement: vec![0.0; size] }
    }

    /// S τ = (s₀ + s₁)/2 + r (s₁ − s₀)/Δt: factors of S τ and of s₀.
    fn factors(&self) -> [f64; 2] {
        [1.0 / (self.steps + 0.5), (self.steps - 0.5) / (self.steps + 0.5)]
    }
}

impl Ground for Relaxing {
    fn elements(&self) -> &[ContactElement] {
        self.ground.elements()
    }

    fn prepare(&mut self, step: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.steps = RELAXATION / step;
        self.displacement.fill(0.0);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        let [gained, _] = self.factors();
        matrix.iter_mut().zip(&self.compliance).for_each(|(to, from)| *to = gained * from);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        let [_, kept] = self.factors();
        displacement.iter_mut().zip(&self.displacement).for_each(|(to, from)| *to = kept * from);
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        let [gained, kept] = self.factors();
        let rows = self.compliance.chunks(traction.len());
        for (moved, row) in self.displacement.iter_mut().zip(rows) {
            let product: f64 = row.iter().zip(traction).map(|(s, t)| s * t).sum();
            *moved = gained * product + kept * *moved;
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        matrix.copy_from_slice(&self.compliance);
        Ok(())
    }
}

/// The side load and the moment over the width, and the settling load, over the weight.
const SIDE: f64 = 0.08;
const DOWN: f64 = 0.3;

/// Largest difference over the largest pressure between the tractions of the static state and of the ramp's end, and
/// between these and the tractions under weight; number of elements that slid; largest ratio of shear to pressure.
fn static_state_and_ramp(plan: bool, law: &dyn Fn() -> Law) -> ([f64; 2], usize, f64) {
    const RAMP: f64 = 10.0;
    let start = |in_time: bool| {
        let Scene { structure, ground, weight, dofs } = scene(plan);
        let forces = [SIDE * weight, -DOWN * weight, SIDE * weight * 2.0 * HALF];
        let mut builder = Simulation::builder(0.05)
            .structure(structure)
            .ground(Relaxing::new(ground, plan))
            .interface(law());
        for (dof, force) in dofs.into_iter().zip(forces) {
            let value =
                move |time: f64| if in_time { force * (time / RAMP).min(1.0) } else { force };
            builder = builder.load(Load::new(dof, value));
        }
        builder.build().unwrap()
    };
    let at_rest = start(false);
    let mut in_time = start(true);
    let before = in_time.state().clone();
    in_time.run(300, |_| {}).unwrap();
    let error = difference(at_rest.state(), in_time.state());
    let change = difference(&before, at_rest.state());
    let contacts = &in_time.state().contact;
    let slid = contacts.iter().filter(|contact| contact.slip.abs() > 1e-8).count();
    let ratios = contacts.iter().map(|contact| contact.shear.abs() / contact.pressure);
    ([error, change], slid, ratios.fold(0.0, f64::max))
}

#[test]
fn the_static_state_of_loads_is_the_end_of_their_slow_ramp() {
    for plan in [false, true] {
        let sticks: [(&str, &dyn Fn() -> Law); 3] = [
            ("bonded", &|| Box::new(Bonded)),
            ("friction 0.9", &|| Box::new(Coulomb::new(0.9).unwrap())),
            ("cohesive", &|| Box::new(Cohesive::new(1e9, 1e9, 0.5).unwrap())),
        ];
        let mut needed = 0.0;
        for (name, law) in sticks {
            let ([error, change], slid, ratio) = static_state_and_ramp(plan, law);
            println!("plan {plan}, {name}: {error:.1e}, change {change:.2}, ratio {ratio:.3}");
            assert!(change > 0.2 && slid == 0, "{name}: {change} {slid}");
            assert!(error < 1e-6, "plan {plan}, {name}: {error}");
            needed = ratio;
        }
        // Between the friction at which the whole base would slide, and the friction at which it sticks.
        let friction = 0.6 * needed + 0.4 * SIDE / (1.0 + DOWN);
        let law = move || -> Law { Box::new(Coulomb::new(friction).unwrap()) };
        let ([error, _], slid, _) = static_state_and_ramp(plan, &law);
        println!("plan {plan}, friction {friction:.3}: {error:.1e}, {slid} elements slid");
        // Ten increments stand for the ramp.
        assert!(slid > 0 && error < 0.01, "plan {plan}: {slid} {error}");
    }
}

/// Rocking stiffness of a rigid strip: π G b²/(2 (1 − ν)) if smooth, and 1 + 4 ε² times as much if bonded, with
/// ε = ln(3 − 4ν)/2π (Muskhelishvili 1953, § 114).
#[test]
fn a_bonded_base_is_bonded_under_loads() {
    let soil = soil();
    let exponent = (3.0 - 4.0 * soil.poisson()).ln() / TAU;
    let smooth = PI * soil.shear_modulus() * HALF * HALF / (2.0 * (1.0 - soil.poisson()));
    let bonded = smooth * (1.0 + 4.0 * exponent * exponent);
    let coulomb = |friction: f64| Box::new(Coulomb::new(friction).unwrap());
    let cases: [(&str, Law, f64); 3] = [
        ("bonded", Box::new(Bonded), bonded),
        ("sticks", coulomb(0.5), bonded),
        ("smooth", coulomb(0.0), smooth),
    ];
    for (name, law, expected) in cases {
        let Scene { structure, ground, weight, dofs } = scene(false);
        let moment = 0.1 * weight * 2.0 * HALF;
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
