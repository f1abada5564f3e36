//! Implementations of every trait from outside the crate, run in a simulation.

mod scene;

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use basemat::bem::{ContactElement, Ground, HalfPlaneGround, PatchKernel, SpringGround, Strip};
use basemat::coupled::{Midpoint, Run, SchemeCoefficients, SimulationBuilder, Theta, TimeScheme};
use basemat::fem::{Direction, Element, Layer, MassKind, Material, Mesh};
use basemat::fundamental::{FundamentalSolution, LoadHistory};
use basemat::history::{ConvolutionHistory, DirectHistory};
use basemat::interface::{
    Bonded, Condition, ContactState, Coulomb, InterfaceLaw, Mode, StepStart, Tolerance,
};
use basemat::motion::{FreeField, RickerDisplacement, TravellingWave};
use basemat::structure::{
    ContactNode, FemModel, RigidBlock, Structure, StructureGroup, Triplets, WithSprings,
};
use basemat::{Error, Result, Simulation, Soil};

use scene::{bed, block};

const STEP: f64 = 2e-3;

fn soil() -> Soil {
    Soil::new(30.0e6, 0.3, 1800.0).unwrap()
}

/// A push to either side, strong enough to slide and to rock.
fn push() -> RickerDisplacement {
    RickerDisplacement::new(0.05, 0.12, 0.6).unwrap()
}

fn shaken() -> SimulationBuilder {
    Simulation::builder(STEP).motion(push()).gravity(9.81)
}

#[track_caller]
fn run(builder: SimulationBuilder) -> (Run, Simulation) {
    let mut simulation = builder.build().unwrap();
    let run = simulation.run(600, |_| {}).unwrap();
    assert!(run.ledger_residual < 1e-9, "{run}");
    assert!(run.base_shear.value.abs() > 0.0, "{run}");
    (run, simulation)
}

#[track_caller]
fn assert_same_motion(a: &Simulation, b: &Simulation, tolerance: f64) {
    let (a, b) = (a.state().displacement(), b.state().displacement());
    let largest = a.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    assert!(largest > 0.0);
    for (x, y) in a.iter().zip(b) {
        assert!((x - y).abs() <= tolerance * largest, "{a:?} {b:?}");
    }
}

#[test]
fn all_parts_can_be_shown() {
    fn shown(part: &dyn std::fmt::Debug, words: &[&str]) {
        let text = format!("{part:?}");
        assert!(text.len() < 2000, "{text}");
        for word in words {
            assert!(text.contains(word), "{word} in {text}");
        }
    }
    let builder = || shaken().structure(block()).interface(Bonded);
    shown(&builder(), &["time_step: 0.002", "structure: true", "ground: false", "gravity: 9.81"]);
    // What is refused can be unwrapped.
    assert!(matches!(builder().build().unwrap_err(), Error::Scene { quantity: "ground", .. }));
    let mut simulation = builder().ground(bed(4)).build().unwrap();
    simulation.step().unwrap();
    shown(&simulation, &["unknowns: 3", "elements: 4", "step: 1"]);
    let ground = || HalfPlaneGround::strip(soil(), -2.0..2.0, 6).unwrap();
    shown(&ground(), &["Soil", "elements: 6"]);
    let kernel = Arc::new(PatchKernel::new(soil(), ground().elements().to_vec(), STEP).unwrap());
    shown(&DirectHistory::new(kernel), &["elements: 6", "steps: 0"]);
    shown(&WithSprings::new(block()), &["unknowns: 3", "springs: 0"]);
    shown(&StructureGroup::new(), &["structures: 0"]);
    shown(&TravellingWave::new(push(), 500.0, 1.0).unwrap(), &["500.0", "origin: 1.0"]);
    shown(&basemat::Sweep::new(3), &["count: 3"]);
}

#[test]
fn simulations_can_move_between_threads() {
    fn is_send<T: Send>() {}
    fn is_sync<T: Sync>() {}
    is_send::<Simulation>();
    is_send::<SimulationBuilder>();
    is_send::<Run>();
    is_send::<basemat::coupled::State>();
    is_sync::<basemat::structure::ReducedModel>();
    let mut simulation =
        shaken().structure(block()).ground(bed(4)).interface(Bonded).build().unwrap();
    let moved = std::thread::spawn(move || {
        simulation.run(10, |_| {}).unwrap();
        simulation.state().step
    });
    assert_eq!(moved.join().unwrap(), 10);
}

/// A mass on a hardening spring on a rigid base: force k d + 4 d³ · k per m².
struct Hardening {
    cubic: f64,
    commits: Arc<AtomicUsize>,
}

const SPRING: f64 = 4.0e6;
/// Drift: sway of the mass, minus that of the base, plus height × rotation.
const DRIFT: [(usize, f64); 3] = [(3, 1.0), (0, -1.0), (2, 3.0)];

impl Hardening {
    fn drift(displacement: &[f64]) -> f64 {
        DRIFT.iter().map(|&(index, weight)| weight * displacement[index]).sum()
    }
}

impl Structure for Hardening {
    fn unknowns(&self) -> usize {
        4
    }

    fn contact_nodes(&self) -> Vec<ContactNode> {
        ContactNode::rigid_base(-2.0, 2.0, [0, 1, 2])
    }

    fn mass(&self, matrix: &mut Triplets) {
        for (unknown, mass) in [1.0e4, 3.0e4, 8.0e4, 2.0e4].into_iter().enumerate() {
            matrix.add(unknown, unknown, mass);
        }
    }

    fn stiffness(&self, matrix: &mut Triplets) {
        matrix.add_outer(DRIFT, SPRING);
    }

    fn is_linear(&self) -> bool {
        false
    }

    fn nonlinear_force(&self, displacement: &[f64], force: &mut [f64]) {
        let f = self.cubic * Self::drift(displacement).powi(3);
        for (index, weight) in DRIFT {
            force[index] += weight * f;
        }
    }

    fn nonlinear_tangent(&self, displacement: &[f64], matrix: &mut Triplets) {
        matrix.add_outer(DRIFT, 3.0 * self.cubic * Self::drift(displacement).powi(2));
    }

    fn commit(&mut self, displacement: &[f64]) {
        assert_eq!(displacement.len(), 4);
        self.commits.fetch_add(1, Ordering::Relaxed);
    }
}

/// The same without its nonlinear part.
struct Linear(Hardening);

impl Structure for Linear {
    fn unknowns(&self) -> usize {
        self.0.unknowns()
    }

    fn contact_nodes(&self) -> Vec<ContactNode> {
        self.0.contact_nodes()
    }

    fn mass(&self, matrix: &mut Triplets) {
        self.0.mass(matrix);
    }

    fn stiffness(&self, matrix: &mut Triplets) {
        self.0.stiffness(matrix);
    }
}

#[test]
fn own_structure_linear_and_nonlinear() {
    let commits = Arc::new(AtomicUsize::new(0));
    let structure = |cubic| Hardening { cubic, commits: Arc::clone(&commits) };
    let scene = || shaken().ground(bed(6)).interface(Coulomb::new(0.5).unwrap());
    let (_, linear) = run(scene().structure(Linear(structure(0.0))));
    assert_eq!(commits.load(Ordering::Relaxed), 0, "a wrapper without `commit`");
    let (_, soft) = run(scene().structure(structure(0.0)));
    assert_eq!(commits.load(Ordering::Relaxed), 600, "once per accepted step");
    assert_same_motion(&linear, &soft, 1e-7);
    let (run, hard) = run(scene().structure(structure(1.0e4 * SPRING)));
    let drift = |simulation: &Simulation| Hardening::drift(simulation.state().displacement());
    assert!((drift(&hard) - drift(&soft)).abs() > 1e-5, "the cubic term acts: {run}");
}

/// A column that is only a spring between two heights.
struct Column([usize; 2]);

impl Element for Column {
    fn nodes(&self) -> &[usize] {
        &self.0
    }

    fn directions(&self) -> &[Direction] {
        &[Direction::X, Direction::Y]
    }

    fn stiffness(&self, coordinates: &[[f64; 2]], matrix: &mut [f64]) {
        // A strut along its axis, exact under rigid motions.
        let [dx, dy] = [0, 1].map(|k| coordinates[1][k] - coordinates[0][k]);
        let length = dx.hypot(dy);
        let axis = [-dx / length, -dy / length, dx / length, dy / length];
        for i in 0..4 {
            for j in 0..4 {
                matrix[4 * i + j] += 2.0e8 / length * axis[i] * axis[j];
            }
        }
    }

    fn mass(&self, _coordinates: &[[f64; 2]], _kind: MassKind, matrix: &mut [f64]) {
        for i in 0..4 {
            matrix[5 * i] += 500.0;
        }
    }
}

#[test]
fn own_element() {
    let concrete = Material::new(20.0e9, 0.2, 2400.0).unwrap();
    let mut mesh = Mesh::layered_block(-2.0..2.0, 4, &[Layer::new(1.0, 1, concrete)]).unwrap();
    // A tripod of struts on the block.
    let top = mesh.add_node(0.0, 4.0).unwrap();
    for x in [-2.0, 2.0] {
        let foot = mesh.node_at(x, 1.0).unwrap();
        mesh.add(Column([foot, top])).unwrap();
    }
    let model = FemModel::on_base(mesh).unwrap();
    let tip = model.unknown(top, Direction::X).unwrap();
    let scene = shaken().structure(model).ground(bed(4)).interface(Coulomb::new(0.6).unwrap());
    let (_, simulation) = run(scene);
    assert!(simulation.state().displacement()[tip].is_finite());
}

/// Sticks until it once slid; from then on there is no friction at all.
struct Glaze(f64);

impl InterfaceLaw for Glaze {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::SlipLeft, Mode::SlipRight, Mode::Open]
    }

    fn conditions(&self, mode: Mode, start: &StepStart) -> [Condition; 2] {
        let law = if start.mode.is_slip() { 0.0 } else { self.0 };
        Coulomb::new(law).unwrap().conditions(mode, start)
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &StepStart,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        let law = Coulomb::new(self.0).unwrap();
        match law.next_mode(mode, start, trial, tolerance) {
            Mode::Stick if start.mode.is_slip() && mode.is_slip() => mode,
            next => next,
        }
    }
}

#[test]
fn own_law() {
    let scene = || shaken().structure(block()).ground(bed(4));
    let (own, _) = run(scene().interface(Glaze(0.3)));
    let (coulomb, _) = run(scene().interface(Coulomb::new(0.3).unwrap()));
    assert!(coulomb.largest_slip.value != 0.0, "{coulomb}");
    assert!(own.largest_slip.value.abs() > coulomb.largest_slip.value.abs(), "{own}\n{coulomb}");
}

/// Springs that know nothing of the crate's own bed.
struct Bed {
    elements: Vec<ContactElement>,
    stiffness: [f64; 2],
    displacement: Vec<f64>,
}

impl Bed {
    /// Midpoint rule of traction = k s: ½k (s₀ + s₁) = traction.
    fn stiffness(&self, i: usize) -> f64 {
        self.stiffness[usize::from(i >= self.elements.len())]
    }

    fn diagonal(&self, matrix: &mut [f64], factor: f64) {
        let size = self.displacement.len();
        matrix.fill(0.0);
        for i in 0..size {
            matrix[i * size + i] = factor / self.stiffness(i);
        }
    }
}

impl Ground for Bed {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(&mut self, _time_step: f64) -> Result<()> {
        self.displacement.fill(0.0);
        Ok(())
    }

    fn instantaneous(&self, matrix: &mut [f64]) -> Result<()> {
        self.diagonal(matrix, 2.0);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        for (out, s) in displacement.iter_mut().zip(&self.displacement) {
            *out = -s;
        }
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        assert_eq!(traction.len(), 2 * self.elements.len());
        for (i, traction) in traction.iter().enumerate() {
            self.displacement[i] = 2.0 * traction / self.stiffness(i) - self.displacement[i];
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.diagonal(matrix, 1.0);
        Ok(())
    }
}

#[test]
fn own_ground() {
    let elements = Strip::uniform(-2.0..2.0, 4).unwrap().elements();
    let own = Bed { elements, stiffness: [4.0e7, 2.0e7], displacement: vec![0.0; 8] };
    let scene = || shaken().structure(block()).interface(Coulomb::new(0.4).unwrap());
    let (_, own) = run(scene().ground(own));
    let (_, crate_bed) =
        run(scene().ground(SpringGround::new(-2.0..2.0, 4, 4.0e7, 2.0e7).unwrap()));
    assert_same_motion(&own, &crate_bed, 1e-7);
}

/// The convolution as a triple loop over the kernel's classes, with its own store.
struct Plain {
    kernel: Arc<PatchKernel>,
    past: Vec<Vec<f64>>,
}

impl ConvolutionHistory for Plain {
    fn steps(&self) -> usize {
        self.past.len()
    }

    fn reserve(&mut self, steps: usize) -> Result<()> {
        self.past.reserve(steps.saturating_sub(self.past.len()));
        Ok(())
    }

    fn evaluate(&mut self, displacement: &mut [f64]) -> Result<()> {
        displacement.fill(0.0);
        let (count, past) = (self.kernel.elements().len(), self.past.len());
        let mut lags = Vec::new();
        for class in 0..self.kernel.classes() {
            let [mut zz, mut xx, mut zx] = [(); 3].map(|()| vec![0.0; past]);
            if past > 0 {
                self.kernel.coefficients(class, 2, &mut zz, &mut xx, &mut zx)?;
            }
            lags.push([zz, xx, zx]);
        }
        for (m, traction) in self.past.iter().enumerate() {
            let lag = past - 1 - m;
            for (p, pairs) in self.kernel.pairs().chunks(count).enumerate() {
                for (q, pair) in pairs.iter().enumerate() {
                    let [zz, xx, zx] = [0, 1, 2].map(|k| pair.scale * lags[pair.class][k][lag]);
                    displacement[p] += zz * traction[q] + pair.sign * zx * traction[count + q];
                    displacement[count + p] +=
                        xx * traction[count + q] - pair.sign * zx * traction[q];
                }
            }
        }
        Ok(())
    }

    fn push(&mut self, traction: &[f64]) {
        assert_eq!(traction.len(), 2 * self.kernel.elements().len());
        self.past.push(traction.to_vec());
    }
}

#[test]
fn own_history() {
    let inner = || HalfPlaneGround::strip(soil(), -2.0..2.0, 4).unwrap();
    let march = |scene: SimulationBuilder| {
        let law = Coulomb::new(0.4).unwrap();
        let mut simulation = scene.structure(block()).interface(law).build().unwrap();
        simulation.run(120, |_| {}).unwrap();
        simulation
    };
    let scene = || Simulation::builder(1e-2).motion(push()).gravity(9.81);
    let plain =
        |kernel| Box::new(Plain { kernel, past: Vec::new() }) as Box<dyn ConvolutionHistory>;
    let own = march(scene().ground(inner().with_history(plain)));
    let crate_history = march(scene().ground(inner()));
    assert_same_motion(&own, &crate_history, 1e-6);
}

#[test]
fn histories_agree_with_the_direct_sum() {
    let elements = Strip::uniform(0.0..3.0, 3).unwrap().elements();
    let kernel = Arc::new(PatchKernel::new(soil(), elements, 2e-3).unwrap());
    let mut plain = Plain { kernel: Arc::clone(&kernel), past: Vec::new() };
    let mut direct = DirectHistory::new(kernel);
    let (mut a, mut b) = ([f64::NAN; 6], [f64::NAN; 6]);
    for step in 0..40 {
        plain.evaluate(&mut a).unwrap();
        direct.evaluate(&mut b).unwrap();
        let largest = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(a.iter().zip(&b).all(|(x, y)| (x - y).abs() <= 1e-12 * largest), "{a:?} {b:?}");
        let traction: [f64; 6] = std::array::from_fn(|i| (1.7 * (i + 7 * step) as f64).sin());
        plain.push(&traction);
        direct.push(&traction);
        assert_eq!(plain.steps(), direct.steps());
    }
}

/// Newmark's average acceleration, not one of the crate's.
struct AverageAcceleration;

impl TimeScheme for AverageAcceleration {
    fn coefficients(&self, time_step: f64) -> SchemeCoefficients {
        let h = time_step;
        // Everything at the end of the step: a₁ = 4Δu/h² − 4v₀/h − a₀, v₁ = 2Δu/h − v₀.
        let acceleration = [4.0 / (h * h), -4.0 / h, -1.0];
        let velocity = [2.0 / h, -1.0, 0.0];
        SchemeCoefficients {
            displacement: [1.0, 0.0, 0.0],
            velocity,
            acceleration,
            new_velocity: velocity,
            new_acceleration: acceleration,
            load_fraction: 1.0,
        }
    }
}

#[test]
fn own_time_scheme() {
    let scene = || {
        let structure = Linear(Hardening { cubic: 0.0, commits: Arc::default() });
        shaken().structure(structure).ground(bed(4)).interface(Bonded)
    };
    let (_, midpoint) = run(scene().scheme(Midpoint));
    let (_, newmark) = run(scene().scheme(AverageAcceleration));
    let (_, theta) = run(scene().scheme(Theta::new(0.52).unwrap()));
    assert!(theta.state().ledger.numerical > 0.0);
    assert_eq!(midpoint.state().ledger.numerical, 0.0);
    // Different second-order rules of one problem.
    assert_same_motion(&midpoint, &newmark, 0.05);
}

/// A wave that runs along the surface, so that the elements do not move alike.
struct Passing {
    speed: f64,
}

impl FreeField for Passing {
    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        let late = time - (x + 10.0) / self.speed;
        if late > 0.0 {
            let angle = 6.0 * late;
            [0.01 * (1.0 - angle.cos()), 0.004 * (angle - angle.sin())]
        } else {
            [0.0; 2]
        }
    }

    fn velocity(&self, x: f64, time: f64) -> [f64; 2] {
        let late = time - (x + 10.0) / self.speed;
        if late > 0.0 {
            let angle = 6.0 * late;
            [0.06 * angle.sin(), 0.024 * (1.0 - angle.cos())]
        } else {
            [0.0; 2]
        }
    }
}

#[test]
fn own_free_field() {
    let scene = Simulation::builder(STEP).gravity(9.81).motion(Passing { speed: 100.0 });
    let law = Coulomb::new(0.4).unwrap();
    let (run, _) = run(scene.structure(block()).ground(bed(8)).interface(law));
    assert!(run.base_rotation.value != 0.0, "a wave that passes turns the base");
}

/// Kelvin's plane in antiplane disguise: not a solution of anything, but it has the shape of one.
struct Toy(Soil);

impl FundamentalSolution for Toy {
    fn soil(&self) -> Soil {
        self.0
    }

    fn displacement(&self, offset: [f64; 2], time: f64, _: LoadHistory) -> Result<[[f64; 2]; 2]> {
        let distance = offset[0].hypot(offset[1]);
        if !(distance > 0.0 && distance.is_finite()) {
            return Err(basemat::Error::Input {
                quantity: "distance from the load",
                value: distance,
                needed: "finite and above zero",
            });
        }
        let arrived = time * self.0.pressure_wave_speed() > distance;
        let u = if arrived { 1.0 / self.0.shear_modulus() } else { 0.0 };
        Ok([[u, 0.0], [0.0, u]])
    }

    fn traction(&self, _: [f64; 2], _: [f64; 2], _: f64, _: LoadHistory) -> Result<[[f64; 2]; 2]> {
        Ok([[0.0; 2]; 2])
    }
}

#[test]
fn own_fundamental_solution() {
    let solutions: Vec<Box<dyn FundamentalSolution>> = vec![Box::new(Toy(soil()))];
    let speed = soil().pressure_wave_speed();
    for solution in &solutions {
        let at = |time| solution.displacement([3.0, 4.0], time, LoadHistory::Step).unwrap();
        assert_eq!(at(4.9 / speed), [[0.0; 2]; 2], "nothing before the first arrival");
        assert!(at(5.1 / speed)[0][0] > 0.0);
        assert!(solution.displacement([0.0; 2], 1.0, LoadHistory::Step).is_err());
    }
}

#[test]
fn all_of_one_s_own_together() {
    let elements = Strip::uniform(-2.0..2.0, 4).unwrap().elements();
    let ground = Bed { elements, stiffness: [4.0e7, 2.0e7], displacement: vec![0.0; 8] };
    let scene = Simulation::builder(STEP)
        .structure(Hardening { cubic: 100.0 * SPRING, commits: Arc::default() })
        .ground(ground)
        .interface(Glaze(0.4))
        .motion(Passing { speed: 80.0 })
        .scheme(AverageAcceleration)
        .gravity(9.81);
    let mut simulation = scene.build().unwrap();
    let run = simulation.run(300, |_| {}).unwrap();
    assert!(run.time > 0.59 && run.base_shear.value != 0.0, "{run}");
}

#[test]
fn a_wrapped_block_is_the_block() {
    struct Wrapped(RigidBlock);
    impl Structure for Wrapped {
        fn unknowns(&self) -> usize {
            self.0.unknowns()
        }
        fn contact_nodes(&self) -> Vec<ContactNode> {
            self.0.contact_nodes()
        }
        fn mass(&self, matrix: &mut Triplets) {
            self.0.mass(matrix);
        }
        fn stiffness(&self, matrix: &mut Triplets) {
            self.0.stiffness(matrix);
        }
    }
    let scene = || shaken().ground(bed(4)).interface(Coulomb::new(0.4).unwrap());
    let (_, own) = run(scene().structure(Wrapped(block())));
    let (_, plain) = run(scene().structure(block()));
    assert_same_motion(&own, &plain, 0.0);
}
