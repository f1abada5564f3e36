//! GOAL: a bed of many springs in plan, under a rigid base, needs no matrices between its elements.
//! SCENE: rigid bodies, also with P–Δ or two of them, that lift off and slide on 64 to 4096 elements.
//! REFERENCE: the same bed as a ground that does not say that its compliances are diagonal; the energy balance; what
//! matrices between all elements would take.

use basemat::bem::plan::Plan;
use basemat::bem::{ContactElement, Ground, GroundDescription, SpringGround};
use basemat::coupled::{Coordinates, GravityStage, Load};
use basemat::fem::{Material, Mesh, Shell};
use basemat::interface::{Bonded, Cohesive, Coulomb, InterfaceLaw, ThinLayer, Yielding};
use basemat::motion::{Triaxial, el_centro_1940};
use basemat::structure::{Bilinear, FemModel, PlanStorey, RigidBody, StoreyBuilding};
use basemat::{Error, Observer, Result, Simulation};
use basemat_problems::flexible_scenes::Sines;
use basemat_problems::random::Random;

/// A bed that keeps to itself that it is diagonal.
struct Undisclosed(SpringGround);

impl Ground for Undisclosed {
    fn elements(&self) -> &[ContactElement] {
        self.0.elements()
    }

    fn prepare(&mut self, step: f64, steps: Option<usize>, own: &mut Observer<'_>) -> Result<()> {
        self.0.prepare(step, steps, own)
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.0.step_compliance(matrix)
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        self.0.history(displacement)
    }

    fn commit(&mut self, traction: &[f64]) {
        self.0.commit(traction);
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.0.static_compliance(matrix)
    }

    fn description(&self) -> GroundDescription {
        self.0.description()
    }
}

const STEPS: usize = 60;
const SCENES: u64 = 24;

fn law(random: &mut Random, pressure: f64) -> Box<dyn InterfaceLaw> {
    let friction = random.within(0.1, 0.8);
    match random.pick(&[0, 0, 0, 1, 2, 3, 4, 5]) {
        0 => Box::new(Coulomb::new(friction).unwrap()),
        1 => Box::new(Yielding::new(random.within(2.0, 4.0) * pressure, friction).unwrap()),
        2 => {
            let [tension, cohesion] = [0.5, 0.5].map(|most| random.within(0.0, most) * pressure);
            Box::new(Cohesive::new(tension, cohesion, friction).unwrap())
        }
        3 => {
            let stiffness = random.log_within(3.0, 100.0);
            let layer = ThinLayer::from_stiffness(2.0 * stiffness, stiffness, friction).unwrap();
            Box::new(layer.with_debonded_ratio(0.0).unwrap())
        }
        4 => Box::new(Bonded),
        _ => Box::new(Coulomb::new(f64::INFINITY).unwrap()),
    }
}

/// A scene of the random numbers, on a bed as `disclosed` makes it a ground.
fn scene(number: u64, is_disclosed: bool) -> Simulation {
    let random = &mut Random(700 + number);
    let sides = [2.0, random.within(1.2, 2.0)];
    let height = random.within(0.5, 5.0);
    let gravity = random.log_within(1e-3, 1e-1);
    let mut body = RigidBody::cuboid([sides[0], sides[1], height], 1.0).unwrap();
    let pressure = gravity * height;
    if random.chance(0.3) && height < 2.0 {
        body = body.with_p_delta(gravity).unwrap();
    }
    let [x, y] = sides.map(|side| -0.5 * side..0.5 * side);
    let plan = Plan::rectangle(x, y, 8).unwrap();
    let stiffness = random.log_within(0.3, 3.0);
    let along = [1.0, random.within(0.4, 1.0), random.within(0.4, 1.0)].map(|own| own * stiffness);
    let frequency = (stiffness / height).sqrt();
    let step = random.log_within(0.02, 1.0) / frequency;
    let mut bed = SpringGround::in_plan(plan, along).unwrap();
    if random.chance(0.7) {
        let dashpot = random.log_within(0.02, 1.0) * stiffness / frequency;
        bed = bed.with_dashpots(dashpot, 0.7 * dashpot).unwrap();
    }
    let motion = Sines::random(random, step, gravity);
    let push = random.within(0.0, 0.05) * pressure * sides[0] * sides[1];
    let stage =
        if random.chance(0.2) { GravityStage::Frictional } else { GravityStage::Frictionless };
    let law = law(random, pressure);
    let builder = Simulation::builder(step).structure(body).motion(motion).gravity(gravity);
    let builder = builder.interface(law).gravity_stage(stage).load(Load::new(0, move |_| push));
    let builder = if is_disclosed { builder.ground(bed) } else { builder.ground(Undisclosed(bed)) };
    builder.expected_steps(STEPS).build().unwrap()
}

/// Steps both simulations, on the bed and on the ground with matrices, and compares them; returns the numbers of steps with
/// uplift and with slip.
fn compare(name: &str, [mut own, mut whole]: [Simulation; 2], steps: usize) -> [usize; 2] {
    let [mut opened, mut slid] = [0; 2];
    let (mut apart, mut largest) = ([0.0_f64; 2], [0.0_f64; 2]);
    for _ in 0..steps {
        let [a, b] = [own.step().unwrap(), whole.step().unwrap()];
        for (a, b) in a.displacement().iter().zip(b.displacement()) {
            (apart[0], largest[0]) = (apart[0].max((a - b).abs()), largest[0].max(b.abs()));
        }
        for (a, b) in a.contact.iter().zip(&b.contact) {
            for (a, b) in [(a.pressure, b.pressure), (a.shear, b.shear)] {
                (apart[1], largest[1]) = (apart[1].max((a - b).abs()), largest[1].max(b.abs()));
            }
        }
        let balance = &a.energy_balance;
        assert!(balance.residual() < 1e-9, "{name}: {balance}");
        opened += usize::from(a.uplifted_fraction > 0.0);
        slid += usize::from(a.contact.iter().any(|own| own.slip != 0.0));
    }
    let apart = [0, 1].map(|k| apart[k] / largest[k]);
    println!("{name}: {apart:?}, {opened} steps with uplift, {slid} with slip");
    // Steps accept a residual of 1e-11 of the tractions, and a bed without dashpots adds it up.
    assert!(apart[0] < 1e-10 && apart[1] < 1e-9, "{name}: {apart:?}");
    // Estimates from below, within a factor of three.
    let conditions = [own.conditioning().delassus, whole.conditioning().delassus];
    assert!((0.3..3.0).contains(&(conditions[0] / conditions[1])), "{name}: {conditions:?}");
    [opened, slid]
}

#[test]
fn a_bed_moves_like_the_same_ground_with_matrices() {
    let [mut opened, mut slid] = [0; 2];
    for number in 0..SCENES {
        let both = [true, false].map(|is_disclosed| scene(number, is_disclosed));
        let [more_opened, more_slid] = compare(&number.to_string(), both, STEPS);
        (opened, slid) = (opened + more_opened, slid + more_slid);
    }
    assert!(opened > 300 && slid > 300, "{opened} {slid}");
}

/// Storeys on a mat, in degrees of freedom, in modes, and with storeys that yield.
#[test]
fn buildings_on_a_bed_move_like_on_the_ground_with_matrices() {
    let sides = [8.0, 6.0];
    let storey = PlanStorey::new(3.0, 4.0e4, sides, [6.0e7, 5.0e7, 1.0e9]);
    let storey = PlanStorey { stiffness_center: [0.5, -0.3], ..storey };
    let mat = RigidBody::cuboid([sides[0], sides[1], 1.0], 2400.0).unwrap();
    let building = StoreyBuilding::new(mat, &[storey; 3]).unwrap();
    let law = Bilinear::new(6.0e7, 2.0e5, 0.1).unwrap();
    let yielding = building.clone().with_law(0, StoreyBuilding::ALONG, law).unwrap();
    for (name, structure, coordinates) in [
        ("degrees of freedom", &building, Coordinates::Physical),
        ("modes", &building, Coordinates::Modes),
        ("yielding", &yielding, Coordinates::Physical),
    ] {
        let both = [true, false].map(|is_disclosed| {
            let bed = SpringGround::under(structure, 8, 3e7, 2e7).unwrap();
            let bed = bed.with_dashpots(4e5, 3e5).unwrap();
            let shake = |factor: f64| Some(el_centro_1940().scaled(factor).unwrap());
            let motion = Triaxial { x: shake(2.5), y: shake(-1.5), up: None };
            let builder = Simulation::builder(0.01).structure(structure.clone()).motion(motion);
            let builder = builder.interface(Coulomb::new(0.25).unwrap()).coordinates(coordinates);
            let builder =
                if is_disclosed { builder.ground(bed) } else { builder.ground(Undisclosed(bed)) };
            builder.build().unwrap()
        });
        let [opened, slid] = compare(name, both, 300);
        assert!(opened > 20 && slid > 20, "{name}: {opened} {slid}");
    }
}

/// A building of 8 m × 8 m × 16 m on 64 × 64 cells.
fn tower() -> (RigidBody, SpringGround) {
    let body = RigidBody::cuboid([8.0, 8.0, 16.0], 600.0).unwrap();
    let bed = SpringGround::under(&body, 64, 3e7, 2e7).unwrap();
    assert_eq!(bed.elements().len(), 64 * 64);
    (body, bed.with_dashpots(1e6, 7e5).unwrap())
}

/// Memory of the process: the most so far, bytes; none where the system does not tell.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    Some(1024.0 * line.split_whitespace().nth(1)?.parse::<f64>().ok()?)
}

#[test]
fn a_tower_rocks_and_slides_on_thousands_of_springs() {
    let (body, bed) = tower();
    let shake = |factor: f64| Some(el_centro_1940().scaled(factor).unwrap());
    let motion = Triaxial { x: shake(2.0), y: shake(-1.2), up: None };
    let mut simulation = Simulation::builder(0.02)
        .structure(body)
        .ground(bed)
        .interface(Coulomb::new(0.3).unwrap())
        .motion(motion)
        .build()
        .unwrap();
    let conditioning = simulation.conditioning();
    assert!(conditioning.ground == 1.0 && conditioning.delassus < 1e3, "{conditioning}");
    let run = simulation.run(300, |_| {}).unwrap();
    let whole = &run.whole;
    let [open, slip] =
        [&whole.uplifted_fraction, &whole.largest_slip].map(basemat::results::Extremes::magnitude);
    println!("{open:.2} open, slip {slip:.3} m, energy error {:.1e}", run.energy_error);
    assert!(open > 0.3 && slip > 0.01 && run.energy_error < 1e-9, "{open} {slip} {run:?}");
}

/// What needs matrices between the elements is an error before they are made.
#[test]
fn matrices_between_thousands_of_springs_are_refused() {
    let (body, bed) = tower();
    let build = |ground: Box<dyn Ground>| {
        let builder = Simulation::builder(0.02).structure(body.clone()).ground(ground);
        builder.interface(Coulomb::new(0.3).unwrap())
    };
    let before = peak();
    // A held base needs none either.
    build(Box::new(bed.clone())).on_fixed_base().build().unwrap();
    let is_refused = |built: Result<Simulation>| match built {
        Err(Error::Memory(error)) => {
            error.quantity == "contact elements" && error.asked == 4096.0 && error.needed > 1e10
        }
        _ => false,
    };
    assert!(is_refused(build(Box::new(Undisclosed(bed.clone()))).build()));
    // Plates bend.
    let mut mesh = Mesh::in_space();
    let plate =
        mesh.add_grid(3, 3, |row, column| [4.0 * column as f64 - 4.0, 4.0 * row as f64 - 4.0, 0.0]);
    for (_, cell) in plate.unwrap().cells() {
        let concrete = Material::new(30e9, 0.2, 2500.0).unwrap();
        mesh.add(Shell::new(cell, concrete, 0.5).unwrap()).unwrap();
    }
    let slab = FemModel::on_base(mesh).unwrap();
    let builder = Simulation::builder(0.02).structure(slab).ground(bed).interface(Bonded);
    assert!(is_refused(builder.build()));
    if let (Some(before), Some(after)) = (before, peak()) {
        // With room for the other tests of this program.
        assert!(after - before < 1e9, "{before:e}, then {after:e} bytes");
    }
}
