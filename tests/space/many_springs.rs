//! GOAL: a bed of many springs in plan, under a rigid base, has no matrices between its elements.
//! SCENE: rigid bodies, also with P–Δ or two of them, that lift off and slide on 64 to 4096 elements.
//! REFERENCE: the same bed as a ground that hides that its compliances are diagonal; the energy balance; the memory of
//! matrices between all elements.

use basemat::bem::plan::Plan;
use basemat::bem::{ContactElement, Ground, GroundDescription, SpringGround};
use basemat::coupled::{Coordinates, GravityStage, Load, SimulationBuilder};
use basemat::fem::{Material, Mesh, Shell};
use basemat::interface::{Bonded, Cohesive, Coulomb, InterfaceLaw, ThinLayer, Yielding};
use basemat::motion::{Record, Triaxial, el_centro_1940};
use basemat::structure::{Bilinear, FemModel, PlanStorey, RigidBody, StoreyBuilding};
use basemat::{Error, Observer, Result, Simulation};
use basemat_problems::flexible_scenes::Sines;
use basemat_problems::random::Random;

/// A bed that hides that its compliances are diagonal.
struct UndisclosedBed(SpringGround);

impl Ground for UndisclosedBed {
    fn elements(&self) -> &[ContactElement] {
        self.0.elements()
    }

    fn prepare(
        &mut self,
        time_step: f64,
        steps: Option<usize>,
        observer: &mut Observer<'_>,
    ) -> Result<()> {
        self.0.prepare(time_step, steps, observer)
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

const STEP_COUNT: usize = 60;
const SCENE_COUNT: u64 = 24;

fn random_law(random: &mut Random, pressure: f64) -> Box<dyn InterfaceLaw> {
    let friction = random.within(0.1, 0.8);
    match random.pick(&[0, 0, 0, 1, 2, 3, 4, 5]) {
        0 => Box::new(Coulomb::new(friction).unwrap()),
        1 => Box::new(Yielding::new(random.within(2.0, 4.0) * pressure, friction).unwrap()),
        2 => {
            let tension = random.within(0.0, 0.5) * pressure;
            let cohesion = random.within(0.0, 0.5) * pressure;
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

/// A bed as a ground that shows or hides that its compliances are diagonal.
fn disclosed_ground(bed: SpringGround, is_disclosed: bool) -> Box<dyn Ground> {
    if is_disclosed { Box::new(bed) } else { Box::new(UndisclosedBed(bed)) }
}

/// A random scene.
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
    let half = sides.map(|side| 0.5 * side);
    let plan = Plan::rectangle(-half[0]..half[0], -half[1]..half[1], 8).unwrap();
    let vertical_stiffness = random.log_within(0.3, 3.0);
    let ratio_along = random.within(0.4, 1.0);
    let ratio_across = random.within(0.4, 1.0);
    let stiffness = [1.0, ratio_along, ratio_across].map(|ratio| ratio * vertical_stiffness);
    let frequency = (vertical_stiffness / height).sqrt();
    let time_step = random.log_within(0.02, 1.0) / frequency;
    let mut bed = SpringGround::in_plan(plan, stiffness).unwrap();
    if random.chance(0.7) {
        let dashpot = random.log_within(0.02, 1.0) * vertical_stiffness / frequency;
        bed = bed.with_dashpots(dashpot, 0.7 * dashpot).unwrap();
    }
    let motion = Sines::random(random, time_step, gravity);
    let push = random.within(0.0, 0.05) * pressure * sides[0] * sides[1];
    let stage = if random.chance(0.2) {
        GravityStage::Frictional
    } else {
        GravityStage::Frictionless
    };
    Simulation::builder(time_step)
        .structure(body)
        .motion(motion)
        .gravity(gravity)
        .interface(random_law(random, pressure))
        .gravity_stage(stage)
        .load(Load::new(0, move |_| push))
        .ground(disclosed_ground(bed, is_disclosed))
        .expected_steps(STEP_COUNT)
        .build()
        .unwrap()
}

/// Largest difference of a quantity, and its largest value.
#[derive(Default)]
struct MaxDifference {
    difference: f64,
    max_reference: f64,
}

impl MaxDifference {
    fn add(&mut self, value: f64, reference: f64) {
        self.difference = self.difference.max((value - reference).abs());
        self.max_reference = self.max_reference.max(reference.abs());
    }

    fn relative(&self) -> f64 {
        self.difference / self.max_reference
    }
}

/// Numbers of steps with uplift and with slip.
#[derive(Default)]
struct UpliftCounts {
    uplift: usize,
    slip: usize,
}

/// Steps both simulations, on the bed and on the ground with matrices, and compares them.
fn compare(
    name: &str,
    mut on_bed: Simulation,
    mut on_matrices: Simulation,
    steps: usize,
) -> UpliftCounts {
    let mut counts = UpliftCounts::default();
    let mut displacements = MaxDifference::default();
    let mut tractions = MaxDifference::default();
    for _ in 0..steps {
        let state = on_bed.step().unwrap();
        let reference = on_matrices.step().unwrap();
        for (u, expected) in state.displacement().iter().zip(reference.displacement()) {
            displacements.add(*u, *expected);
        }
        for (contact, expected) in state.contact.iter().zip(&reference.contact) {
            tractions.add(contact.pressure, expected.pressure);
            tractions.add(contact.shear, expected.shear);
        }
        let balance = &state.energy_balance;
        assert!(balance.residual() < 1e-9, "{name}: {balance}");
        counts.uplift += usize::from(state.uplifted_fraction > 0.0);
        counts.slip += usize::from(state.contact.iter().any(|contact| contact.slip != 0.0));
    }
    let errors = [displacements.relative(), tractions.relative()];
    println!("{name}: {errors:?}, {} steps with uplift, {} with slip", counts.uplift, counts.slip);
    // Steps accept a residual of 1e-11 of the tractions, which accumulates on a bed without dashpots.
    assert!(errors[0] < 1e-10 && errors[1] < 1e-9, "{name}: {errors:?}");
    // Both condition numbers are estimates from below, within a factor of three.
    let conditions = [on_bed.conditioning().delassus, on_matrices.conditioning().delassus];
    assert!((0.3..3.0).contains(&(conditions[0] / conditions[1])), "{name}: {conditions:?}");
    counts
}

#[test]
fn a_bed_moves_like_the_same_ground_with_matrices() {
    let mut total = UpliftCounts::default();
    for number in 0..SCENE_COUNT {
        let counts =
            compare(&number.to_string(), scene(number, true), scene(number, false), STEP_COUNT);
        total.uplift += counts.uplift;
        total.slip += counts.slip;
    }
    assert!(total.uplift > 300 && total.slip > 300, "{} {}", total.uplift, total.slip);
}

/// El Centro, scaled.
fn scaled_record(factor: f64) -> Record {
    el_centro_1940().scaled(factor).unwrap()
}

/// A building on a bed of 8 cells a side.
fn building_scene(
    building: &StoreyBuilding,
    coordinates: Coordinates,
    is_disclosed: bool,
) -> Simulation {
    let bed = SpringGround::under(building, 8, 3e7, 2e7).unwrap();
    let bed = bed.with_dashpots(4e5, 3e5).unwrap();
    Simulation::builder(0.01)
        .structure(building.clone())
        .motion(Triaxial { x: Some(scaled_record(2.5)), y: Some(scaled_record(-1.5)), up: None })
        .interface(Coulomb::new(0.25).unwrap())
        .coordinates(coordinates)
        .ground(disclosed_ground(bed, is_disclosed))
        .build()
        .unwrap()
}

/// Storeys on a mat, in degrees of freedom, in modes, and with storeys that yield.
#[test]
fn buildings_on_a_bed_move_like_on_the_ground_with_matrices() {
    let sides = [8.0, 6.0];
    let storey = PlanStorey::new(3.0, 4.0e4, sides, [6.0e7, 5.0e7, 1.0e9]);
    let storey = PlanStorey { stiffness_center: [0.5, -0.3], ..storey };
    let mat = RigidBody::cuboid([sides[0], sides[1], 1.0], 2400.0).unwrap();
    let elastic = StoreyBuilding::new(mat, &[storey; 3]).unwrap();
    let law = Bilinear::new(6.0e7, 2.0e5, 0.1).unwrap();
    let yielding_building =
        elastic.clone().with_law(0, StoreyBuilding::DIRECTION_ALONG, law).unwrap();
    for (name, building, coordinates) in [
        ("degrees of freedom", &elastic, Coordinates::Physical),
        ("modes", &elastic, Coordinates::Modes),
        ("yielding", &yielding_building, Coordinates::Physical),
    ] {
        let on_bed = building_scene(building, coordinates, true);
        let on_matrices = building_scene(building, coordinates, false);
        let counts = compare(name, on_bed, on_matrices, 300);
        assert!(
            counts.uplift > 20 && counts.slip > 20,
            "{name}: {} {}",
            counts.uplift,
            counts.slip
        );
    }
}

/// A building of 8 m × 8 m × 16 m.
fn tower() -> RigidBody {
    RigidBody::cuboid([8.0, 8.0, 16.0], 600.0).unwrap()
}

/// A bed of 64 × 64 cells under the tower.
fn tower_bed() -> SpringGround {
    let bed = SpringGround::under(&tower(), 64, 3e7, 2e7).unwrap();
    assert_eq!(bed.elements().len(), 64 * 64);
    bed.with_dashpots(1e6, 7e5).unwrap()
}

/// Peak memory of the process, bytes; `None` where the system does not report it.
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    Some(1024.0 * line.split_whitespace().nth(1)?.parse::<f64>().ok()?)
}

#[test]
fn a_tower_rocks_and_slides_on_thousands_of_springs() {
    let mut simulation = Simulation::builder(0.02)
        .structure(tower())
        .ground(tower_bed())
        .interface(Coulomb::new(0.3).unwrap())
        .motion(Triaxial { x: Some(scaled_record(2.0)), y: Some(scaled_record(-1.2)), up: None })
        .build()
        .unwrap();
    let conditioning = simulation.conditioning();
    assert!(conditioning.ground == 1.0 && conditioning.delassus < 1e3, "{conditioning}");
    let run = simulation.run(300, |_| {}).unwrap();
    let open_fraction = run.whole.uplifted_fraction.magnitude();
    let slip = run.whole.largest_slip.magnitude();
    println!("{open_fraction:.2} open, slip {slip:.3} m, energy error {:.1e}", run.energy_error);
    assert!(
        open_fraction > 0.3 && slip > 0.01 && run.energy_error < 1e-9,
        "{open_fraction} {slip} {run:?}"
    );
}

fn tower_scene(ground: impl Ground + 'static) -> SimulationBuilder {
    let builder = Simulation::builder(0.02).structure(tower()).ground(ground);
    builder.interface(Coulomb::new(0.3).unwrap())
}

/// Whether matrices between the elements need more memory than is allowed.
fn exceeds_memory(result: Result<Simulation>) -> bool {
    match result {
        Err(Error::Memory(error)) => {
            error.quantity == "contact elements" && error.asked == 4096.0 && error.needed > 1e10
        }
        _ => false,
    }
}

/// A slab of 8 m × 8 m that bends.
fn slab() -> FemModel {
    let mut mesh = Mesh::in_space();
    let grid = mesh
        .add_grid(3, 3, |row, column| [4.0 * column as f64 - 4.0, 4.0 * row as f64 - 4.0, 0.0])
        .unwrap();
    let concrete = Material::new(30e9, 0.2, 2500.0).unwrap();
    for (_, cell) in grid.cells() {
        mesh.add(Shell::new(cell, concrete, 0.5).unwrap()).unwrap();
    }
    FemModel::on_base(mesh).unwrap()
}

/// Scenes that need matrices between the elements are errors before the matrices are allocated.
#[test]
fn matrices_between_thousands_of_springs_are_errors() {
    let bed = tower_bed();
    let memory_before = peak_memory();
    // A fixed base needs no such matrices, either.
    tower_scene(bed.clone()).on_fixed_base().build().unwrap();
    assert!(exceeds_memory(tower_scene(UndisclosedBed(bed.clone())).build()));
    let builder = Simulation::builder(0.02).structure(slab()).ground(bed).interface(Bonded);
    assert!(exceeds_memory(builder.build()));
    if let (Some(before), Some(after)) = (memory_before, peak_memory()) {
        // The limit includes the memory of other tests of this program.
        assert!(after - before < 1e9, "{before:e}, then {after:e} bytes");
    }
}
