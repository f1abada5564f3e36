//! GOAL: on soil that settles in every cycle the energy balance closes, the soil returns no energy, and resumed runs
//! have the same bits.
//! SCENE: random blocks in the plane and bodies in space, rigid or of finite elements with a flexible base, that rock and
//! slide under a strong record, on springs and half-spaces.
//! REFERENCE: the energy balance; the run without interruption; the law with a rigid memory where the settlements vanish.
//! `SETTLING_SCENES=1000` runs 1000 scenes whose base can stand.

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Ground, SpringGround};
use basemat::coupled::{GravityStage, SimulationBuilder, State};
use basemat::fem::{Hex8, Layer, Material, Mesh};
use basemat::interface::{CyclicYielding, InterfaceLaw, Mode, Yielding};
use basemat::motion::{Record, STANDARD_GRAVITY, Triaxial, el_centro_1940};
use basemat::structure::{FemModel, RayleighDamping, RigidBlock, RigidBody, Structure};
use basemat::{Error, Result, Simulation, Soil};
use basemat_problems::random::Random;
use basemat_problems::settling_law::{SettlingLaw, SettlingState};

const SCENE_COUNT: usize = 40;
const STEP_COUNT: usize = 60;
/// Step after which a run is saved.
const SAVED_STEP: usize = 25;
const TIME_STEP: f64 = 0.01;
const BODY_DENSITY: f64 = 2000.0;
const BASE_WIDTH: f64 = 4.0;
/// Depth of a body in space, m.
const BASE_DEPTH: f64 = 3.2;

/// The strong part of a record, times a factor.
fn strong_record(factor: f64) -> Record {
    let record = el_centro_1940();
    let accelerations = record.accelerations().iter().skip(70).map(|a| factor * a).collect();
    Record::new(record.time_step(), accelerations).unwrap()
}

fn structural_damping() -> Result<RayleighDamping> {
    RayleighDamping::from_ratios([12.0, 120.0], [0.03; 2])
}

/// Parameters of a scene in the plane or in space.
#[derive(Debug, Clone, Copy)]
struct SettlingScene {
    is_in_space: bool,
    on_springs: bool,
    cells: usize,
    height: f64,
    shear_modulus: f64,
    motion_factor: f64,
    friction: f64,
    /// Bearing capacity, relative to the mean pressure.
    bearing_ratio: f64,
    reference_settlement: f64,
    elastic_range: f64,
    depth_gradient: f64,
    gravity_stage: GravityStage,
    /// Young's modulus of the structure, Pa; infinite if it is rigid.
    young: f64,
}

impl SettlingScene {
    fn random(random: &mut Random) -> Self {
        let is_in_space = random.chance(0.5);
        let friction = random.pick(&[0.0, 0.3, 0.7, 0.7, f64::INFINITY]);
        let short_range = random.within(0.01, 1.0);
        Self {
            is_in_space,
            on_springs: random.chance(0.4),
            cells: if is_in_space { random.pick(&[2, 3, 4, 8]) } else { random.pick(&[3, 8, 16]) },
            height: random.within(3.0, 10.0),
            shear_modulus: random.log_within(1e7, 1e8),
            motion_factor: random.within(1.0, 4.0),
            friction,
            bearing_ratio: random.log_within(1.5, 10.0),
            reference_settlement: random.pick(&[0.0, 1.0, 1.0]) * random.log_within(1e-4, 3e-2),
            elastic_range: random.pick(&[0.1, 1.0, short_range]),
            depth_gradient: random.pick(&[0.0, 1.0]) * random.log_within(1e5, 1e7),
            gravity_stage: random.pick(&[
                GravityStage::Frictionless,
                GravityStage::Frictionless,
                GravityStage::Frictional,
                GravityStage::Unloaded,
            ]),
            young: if random.chance(0.4) { random.log_within(3e7, 1e10) } else { f64::INFINITY },
        }
    }

    fn mean_pressure(&self) -> f64 {
        BODY_DENSITY * STANDARD_GRAVITY * self.height
    }

    fn parameters(&self) -> SettlingLaw {
        SettlingLaw {
            initial_capacity: self.bearing_ratio * self.mean_pressure(),
            depth_gradient: self.depth_gradient,
            reference_settlement: self.reference_settlement,
            elastic_range: self.elastic_range,
        }
    }

    fn law(&self) -> CyclicYielding {
        self.parameters().cyclic_yielding(self.friction)
    }

    fn builder(&self, law: impl InterfaceLaw + 'static) -> Result<SimulationBuilder> {
        let Self {
            is_in_space,
            on_springs,
            cells,
            shear_modulus,
            motion_factor,
            gravity_stage,
            ..
        } = *self;
        let half_space = Soil::new(shear_modulus, 0.3, 1900.0)?;
        let stiffness = shear_modulus / (0.5 * BASE_WIDTH);
        let dashpot = (shear_modulus * 1900.0).sqrt();
        let scene = Simulation::builder(TIME_STEP).gravity_stage(gravity_stage).interface(law);
        if !is_in_space {
            let structure = self.structure_in_plane()?;
            let ground: Box<dyn Ground> = if on_springs {
                let bed = SpringGround::under(&*structure, cells, stiffness, 0.7 * stiffness)?;
                Box::new(bed.with_dashpots(dashpot, 0.5 * dashpot)?)
            } else {
                Box::new(ElasticGround::under(half_space, &*structure, cells)?)
            };
            return Ok(scene
                .structure(structure)
                .ground(ground)
                .motion(strong_record(motion_factor)));
        }
        let half = [BASE_WIDTH, BASE_DEPTH].map(|side| 0.5 * side);
        let plan = Plan::rectangle(-half[0]..half[0], -half[1]..half[1], cells)?;
        let ground: Box<dyn Ground> = if on_springs {
            let bed = SpringGround::in_plan(plan, [stiffness, 0.7 * stiffness, 0.7 * stiffness])?;
            Box::new(bed.with_dashpots(dashpot, 0.5 * dashpot)?)
        } else {
            Box::new(ElasticGround::in_plan(half_space, plan)?)
        };
        let motion = Triaxial {
            x: Some(strong_record(motion_factor)),
            y: Some(strong_record(0.6 * motion_factor)),
            up: Some(strong_record(0.3 * motion_factor)),
        };
        Ok(scene.structure(self.structure_in_space()?).ground(ground).motion(motion))
    }

    fn structure_in_plane(&self) -> Result<Box<dyn Structure>> {
        if self.young == f64::INFINITY {
            return Ok(Box::new(RigidBlock::new(BASE_WIDTH, self.height, BODY_DENSITY)?));
        }
        let half = 0.5 * BASE_WIDTH;
        let layers = [Layer::new(self.height, 4, self.material()?)];
        let mesh = Mesh::layered_block(-half..half, 3, &layers)?;
        Ok(Box::new(FemModel::on_base(mesh)?.with_rayleigh(structural_damping()?)))
    }

    fn structure_in_space(&self) -> Result<Box<dyn Structure>> {
        if self.young == f64::INFINITY {
            let sides = [BASE_WIDTH, BASE_DEPTH, self.height];
            return Ok(Box::new(RigidBody::cuboid(sides, BODY_DENSITY)?));
        }
        let mut mesh = Mesh::in_space();
        let base = mesh.add_grid(3, 3, |row, column| {
            let position = [column, row].map(|index| 0.5 * index as f64 - 0.5);
            [BASE_WIDTH * position[0], BASE_DEPTH * position[1], 0.0]
        })?;
        let heights = [0.3, 0.6, 1.0].map(|fraction| fraction * self.height);
        for brick in base.extrude(&mut mesh, &heights)? {
            mesh.add(Hex8::new(brick, self.material()?))?;
        }
        Ok(Box::new(FemModel::on_base(mesh)?.with_rayleigh(structural_damping()?)))
    }

    fn material(&self) -> Result<Material> {
        Material::new(self.young, 0.2, BODY_DENSITY)
    }

    /// A simulation; `None` if the base cannot stand.
    fn simulation(&self) -> Option<Simulation> {
        match self.builder(self.law()).and_then(SimulationBuilder::build) {
            Ok(simulation) => Some(simulation),
            Err(Error::Stability(_) | Error::Preload { .. }) => None,
            Err(error) => panic!("{self:?}: {error}"),
        }
    }
}

/// A state as text that differs if any bit differs.
fn words_of(state: &State) -> String {
    format!("{:?} {:?} {:?}", state.contact, state.displacement(), state.energy_balance)
}

/// Level and threshold of all elements.
fn settling_states(simulation: &Simulation) -> Vec<SettlingState> {
    let state = simulation.state();
    (0..state.contact.len())
        .map(|e| {
            let [level, threshold] = *state.state_variables(e) else {
                panic!("two variables")
            };
            SettlingState { level, threshold }
        })
        .collect()
}

/// Counts and extremes over the steps of all scenes.
#[derive(Debug, Default)]
struct SettlingTotals {
    /// Scenes whose base can stand.
    scenes: usize,
    /// Scenes with a flexible base among them.
    flexible_scenes: usize,
    refused_scenes: usize,
    steps: usize,
    yielding_steps: usize,
    open_steps: usize,
    max_residual: f64,
    /// Largest distance of a pressure from the law, relative to the capacity.
    max_violation: f64,
    /// Smallest dissipation in a step, relative to the largest energy.
    min_dissipation: f64,
    trials: usize,
}

impl SettlingTotals {
    fn run(&mut self, number: usize) {
        let scene = SettlingScene::random(&mut Random(900 + number as u64));
        let Some(mut simulation) = scene.simulation() else {
            self.refused_scenes += 1;
            return;
        };
        self.scenes += 1;
        self.flexible_scenes += usize::from(scene.young.is_finite());
        let mut dissipated_energy = 0.0;
        let mut checkpoint = None;
        let law = scene.parameters();
        let mut starts = settling_states(&simulation);
        for step in 1..=STEP_COUNT {
            let state =
                simulation.step().unwrap_or_else(|error| panic!("{number}: {error} {scene:?}"));
            let energy = &state.energy_balance;
            assert!(energy.residual() < 1e-9, "{number}, {step}: {energy} {scene:?}");
            let change = (energy.contact - dissipated_energy) / energy.largest;
            assert!(change >= -1e-10, "{number}, {step}: {change:e} {scene:?}");
            dissipated_energy = energy.contact;
            self.min_dissipation = self.min_dissipation.min(change);
            self.max_residual = self.max_residual.max(energy.residual());
            self.steps += 1;
            self.trials += state.trials;
            let yields = [Mode::Yield, Mode::YieldLeft, Mode::YieldRight, Mode::YieldSlip];
            self.yielding_steps +=
                usize::from(state.modes.iter().any(|mode| yields.contains(mode)));
            self.open_steps += usize::from(state.modes.contains(&Mode::Open));
            for (start, contact) in starts.iter().zip(&state.contact) {
                let violation = law.violation(start, contact.pressure, contact.gap);
                self.max_violation = self.max_violation.max(violation);
                assert!(
                    violation < 1e-6,
                    "{number}, {step}: {violation:e} {contact:?} {start:?} {scene:?}"
                );
            }
            starts = settling_states(&simulation);
            if step == SAVED_STEP {
                checkpoint = Some(simulation.checkpoint().unwrap());
            }
        }
        let mut resumed_simulation = scene.simulation().unwrap();
        resumed_simulation.resume(&checkpoint.unwrap()).unwrap();
        for _ in SAVED_STEP..STEP_COUNT {
            resumed_simulation.step().unwrap();
        }
        assert_eq!(
            words_of(resumed_simulation.state()),
            words_of(simulation.state()),
            "{number}: {scene:?}"
        );
    }
}

#[test]
fn random_scenes_balance_and_resume() {
    let count = std::env::var("SETTLING_SCENES").map_or(SCENE_COUNT, |text| text.parse().unwrap());
    let mut totals = SettlingTotals::default();
    let mut number = 0;
    while totals.scenes < count {
        totals.run(number);
        number += 1;
        // A few refusals may come first.
        assert!(totals.refused_scenes * 4 <= totals.scenes + 20, "{totals:?}");
    }
    println!("{totals:?}");
    assert!(totals.flexible_scenes * 4 > totals.scenes, "{totals:?}");
    assert!(totals.yielding_steps * 3 > totals.steps, "{totals:?}");
    assert!(totals.open_steps * 10 > totals.steps, "{totals:?}");
}

/// Largest difference of pressures and positions of two runs, relative to their largest values.
fn difference_of_runs(scene: &SettlingScene, laws: [Box<dyn InterfaceLaw>; 2]) -> f64 {
    let [mut one, mut other] = laws.map(|law| scene.builder(law).unwrap().build().unwrap());
    let mut differences = [0.0_f64; 2];
    let mut scales = [0.0_f64; 2];
    for _ in 0..STEP_COUNT {
        let [a, b] = [one.step().unwrap(), other.step().unwrap()];
        for (a, b) in a.contact.iter().zip(&b.contact) {
            scales[0] = scales[0].max(a.pressure.abs());
            differences[0] = differences[0].max((a.pressure - b.pressure).abs());
        }
        for (a, b) in a.displacement().iter().zip(b.displacement()) {
            scales[1] = scales[1].max(a.abs());
            differences[1] = differences[1].max((a - b).abs());
        }
    }
    (differences[0] / scales[0]).max(differences[1] / scales[1])
}

/// In the limit of vanishing settlements the law is `Yielding`.
#[test]
fn the_limit_without_settlements_is_yielding() {
    for is_in_space in [false, true] {
        for on_springs in [false, true] {
            let scene = SettlingScene {
                is_in_space,
                on_springs,
                cells: if is_in_space { 4 } else { 12 },
                height: 6.0,
                shear_modulus: 4e7,
                motion_factor: 2.0,
                friction: 0.6,
                bearing_ratio: 3.0,
                reference_settlement: 0.0,
                elastic_range: 1.0,
                depth_gradient: 0.0,
                gravity_stage: GravityStage::Frictionless,
                young: f64::INFINITY,
            };
            let yielding = Yielding::new(3.0 * scene.mean_pressure(), 0.6).unwrap();
            let laws: [Box<dyn InterfaceLaw>; 2] = [Box::new(scene.law()), Box::new(yielding)];
            assert_eq!(difference_of_runs(&scene, laws), 0.0, "{scene:?}");
            // The weight acts from t = 0: so small a reference settlement is below the rounding of the settlement of a
            // half-space.
            let scene = SettlingScene { gravity_stage: GravityStage::Unloaded, ..scene };
            let sharp = SettlingScene { reference_settlement: 1e-12, ..scene };
            let laws: [Box<dyn InterfaceLaw>; 2] = [Box::new(sharp.law()), Box::new(yielding)];
            let difference = difference_of_runs(&scene, laws);
            println!("{is_in_space} {on_springs}: {difference:e}");
            assert!(difference < 1e-6, "{scene:?}");
        }
    }
}

/// A block of the plane, and a body one metre wide on two rows of cells, on the same springs.
#[test]
fn space_and_plane_are_the_same_on_springs() {
    const CELL_COUNT: usize = 10;
    let height = 6.0;
    let law = SettlingLaw {
        initial_capacity: 3.0 * BODY_DENSITY * STANDARD_GRAVITY * height,
        depth_gradient: 1e6,
        reference_settlement: 4e-3,
        elastic_range: 0.15,
    };
    let law = law.cyclic_yielding(0.6);
    let stiffness = [2e7, 1.4e7];
    let dashpots = [2e5, 1e5];
    let builder = || Simulation::builder(TIME_STEP).interface(law).motion(strong_record(2.0));
    let block = RigidBlock::new(BASE_WIDTH, height, BODY_DENSITY).unwrap();
    let bed = SpringGround::under(&block, CELL_COUNT, stiffness[0], stiffness[1]).unwrap();
    let bed = bed.with_dashpots(dashpots[0], dashpots[1]).unwrap();
    let mut plane = builder().structure(block).ground(bed).build().unwrap();
    let body = RigidBody::cuboid([BASE_WIDTH, 1.0, height], BODY_DENSITY).unwrap();
    let pitch = [BASE_WIDTH / CELL_COUNT as f64, 0.5];
    let plan = Plan::masked([-0.5 * BASE_WIDTH, -0.5], pitch, CELL_COUNT, &[true; 2 * CELL_COUNT])
        .unwrap();
    let bed = SpringGround::in_plan(plan, [stiffness[0], stiffness[1], stiffness[1]]).unwrap();
    let bed = bed.with_dashpots(dashpots[0], dashpots[1]).unwrap();
    let mut space = builder().structure(body).ground(bed).build().unwrap();
    let mut max_value = 0.0_f64;
    for step in 0..400 {
        let [plane_state, space_state] = [plane.step().unwrap(), space.step().unwrap()];
        for (e, contact) in plane_state.contact.iter().enumerate() {
            for row in [0, CELL_COUNT] {
                let in_plan = &space_state.contact[row + e];
                max_value = max_value.max(contact.pressure);
                let difference = (contact.pressure - in_plan.pressure).abs();
                assert!(difference < 1e-6 * max_value, "{step}, {e}: {contact:?} {in_plan:?}");
                assert!((contact.gap - in_plan.gap).abs() < 1e-9, "{step}, {e}");
            }
        }
    }
    let levels: Vec<f64> = settling_states(&plane).iter().map(|state| state.level).collect();
    println!("{levels:?}");
    assert!(levels[0] > 5e-3, "{levels:?}");
}
