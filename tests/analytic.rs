//! Contact on the half-plane against closed forms and exact limits.

mod support;

use basemat::bem::{Grading, HalfPlaneGround, Strip};
use basemat::interface::Coulomb;
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::reference::{NoTensionStrip, SlidingBlock};
use basemat::structure::{ContactNode, RigidBlock, Structure, Triplets};
use basemat::{Simulation, Soil};
use support::series::{Error, whole, within};
use support::table;

/// Rigid block with a moment (counter-clockwise, about the middle of the base) that varies in time.
struct Pushed<F> {
    block: RigidBlock,
    moment: F,
}

impl<F: Fn(f64) -> f64 + Send> Structure for Pushed<F> {
    fn unknowns(&self) -> usize {
        self.block.unknowns()
    }

    fn contact_nodes(&self) -> Vec<ContactNode> {
        self.block.contact_nodes()
    }

    fn mass(&self, matrix: &mut Triplets) {
        self.block.mass(matrix);
    }

    fn stiffness(&self, matrix: &mut Triplets) {
        self.block.stiffness(matrix);
    }

    fn load(&self, time: f64, load: &mut [f64]) {
        load[RigidBlock::ROTATION] += (self.moment)(time);
    }
}

fn half_plane(soil: Soil, half_width: f64, elements: usize, grading: Grading) -> HalfPlaneGround {
    let strip = Strip::new(-half_width..half_width, elements, grading).unwrap();
    HalfPlaneGround::new(soil, &[strip]).unwrap()
}

/// Tilt and length of contact of a strip of half width 1 under a unit load.
fn punch(poisson: f64, eccentricity: f64, elements: usize, grading: Grading) -> [f64; 2] {
    let soil = Soil::new(1.0, poisson, 1.0).unwrap();
    let block = RigidBlock::new(2.0, 1.0, 0.5).unwrap();
    let simulation = Simulation::builder(0.1)
        .structure(Pushed { block, moment: move |_| -eccentricity })
        .ground(half_plane(soil, 1.0, elements, grading))
        .interface(Coulomb::new(0.0).unwrap())
        .gravity(1.0)
        .build()
        .unwrap();
    let state = simulation.state();
    assert!((state.normal_force - 1.0).abs() < 1e-9, "normal force {}", state.normal_force);
    assert!((state.base_moment + eccentricity).abs() < 1e-9, "moment {}", state.base_moment);
    [simulation.static_displacement()[2], 2.0 * (1.0 - state.uplifted_fraction)]
}

#[test]
fn explore_punch() {
    for nu in [0.0, 1.0 / 3.0] {
        let strip = NoTensionStrip::new(Soil::new(1.0, nu, 1.0).unwrap(), 1.0, 0.0).unwrap();
        let limit = (1.0 - nu) / std::f64::consts::PI;
        for e in [0.3, 0.6, 0.75, 0.9] {
            let exact = strip.contact(1.0, e).unwrap();
            for grading in [Grading::Uniform, Grading::Cosine] {
                for n in [10, 20, 40, 80] {
                    let s = std::time::Instant::now();
                    let [tilt, length] = punch(nu, e, n, grading);
                    let moment = if e > 0.5 { 1.0 + limit / (2.0 * tilt) } else { -tilt / (2.0 * limit) };
                    println!("nu {nu:.2} e {e} {grading:?} {n}: tilt {:.2e} length {:.2e} moment {:.2e}  {:?}",
                        tilt / exact.tilt - 1.0, length - exact.length(), moment - e, s.elapsed());
                }
            }
        }
    }
}

fn sliding(shear_wave_speed: f64, friction: f64, time_step: f64, elements: usize) -> ([f64; 2], f64, f64) {
    let soil = Soil::from_wave_speeds(shear_wave_speed, 2.0 * shear_wave_speed, 2000.0).unwrap();
    let record = el_centro_1940();
    let exact = SlidingBlock::new(friction, STANDARD_GRAVITY).unwrap().slide(&record);
    let steps = whole(record.duration() / time_step);
    let mut simulation = Simulation::builder(time_step)
        .structure(RigidBlock::new(4.0, 0.4, 2000.0).unwrap())
        .ground(half_plane(soil, 2.0, elements, Grading::Uniform))
        .interface(Coulomb::new(friction).unwrap())
        .motion(record)
        .gravity(STANDARD_GRAVITY)
        .build()
        .unwrap();
    let mut error = Error::default();
    let mut extremes = [0.0_f64; 2];
    let mut up = 0.0_f64;
    let run = simulation
        .run(steps, |state| {
            error.add(state.mean_slip(), exact.slip(state.time));
            extremes = [extremes[0].min(state.mean_slip()), extremes[1].max(state.mean_slip())];
            up = up.max(state.uplifted_fraction);
        })
        .unwrap();
    println!("cs {shear_wave_speed} f {friction} dt {time_step} n {elements}: error {:.2e} residual {:.2e} ({:.5}) min {:.2e} max {:.2e} exact {:.5} {:.5} up {up} wall {:?} ledger {:.1e}",
        error.relative(), run.residual_slip - exact.residual(), run.residual_slip, extremes[0] - exact.minimum(), extremes[1] - exact.maximum(), exact.minimum(), exact.maximum(), run.wall, run.ledger_residual);
    ([error.relative(), run.residual_slip], extremes[0], extremes[1])
}

#[test]
fn explore_sliding() {
    for f in [0.1, 0.2] {
        for cs in [100.0, 200.0, 400.0, 800.0, 1600.0] {
            sliding(cs, f, 0.01, 6);
        }
    }
    sliding(1600.0, 0.1, 0.005, 6);
    sliding(1600.0, 0.2, 0.005, 6);
    sliding(400.0, 0.1, 0.005, 6);
    sliding(400.0, 0.1, 0.01, 12);
}

fn rocking(cs: f64, elements: usize, time_step: f64) {
    let (b, h, g) = (0.5, 2.0, 9.81);
    let soil = Soil::from_wave_speeds(cs, 2.0 * cs, 2000.0).unwrap();
    let block = RigidBlock::new(2.0 * b, 2.0 * h, 2500.0).unwrap().with_p_delta(g).unwrap();
    let weight = block.total_mass() * g;
    let moment = move |t: f64| if t < 0.5 { -1.6 * weight * b * (std::f64::consts::PI * t / 0.5).sin() } else { 0.0 };
    let corner = block.base_inertia() + block.total_mass() * b * b;
    let p = (weight * h / corner).sqrt();
    let alpha = b / h;
    let mut simulation = Simulation::builder(time_step)
        .structure(Pushed { block, moment })
        .ground(half_plane(soil, b, elements, Grading::Cosine))
        .interface(Coulomb::uplift_only())
        .gravity(g)
        .build()
        .unwrap();
    let mut history = vec![0.0];
    let run = simulation.run(whole(4.0 / time_step), |state| history.push(state.displacement[2])).unwrap();
    let s = -1.0;
    let quarter = |amp: f64| (1.0 / (1.0 - amp.abs() / alpha)).acosh() / p;
    // events
    let mut peaks = vec![];
    let mut zeros = vec![];
    for i in 1..history.len() - 1 {
        let t = i as f64 * time_step;
        if t < 0.5 { continue; }
        let (x0, x1, x2) = (history[i - 1], history[i], history[i + 1]);
        if x1.abs() > x0.abs() && x1.abs() >= x2.abs() && x1.abs() > 0.002 {
            peaks.push((t + 0.5 * time_step * (x0 - x2) / (x0 - 2.0 * x1 + x2), x1));
        }
        if x1 * x2 < 0.0 { zeros.push(t + time_step * x1 / (x1 - x2)); }
    }
    let _ = s;
    println!("cs {cs} n {elements} dt {time_step} wall {:?} ledger {:.1e} soil {:.2e} rest {:.3}", run.wall, run.ledger_residual, run.ledger.soil,
       1.0 - 1.5 * (alpha.atan()).sin().powi(2));
    println!("  peaks {:?} zeros {:?}", &peaks[..peaks.len().min(4)], &zeros[..zeros.len().min(4)]);
    let q = zeros.iter().find(|z| **z > peaks[0].0).unwrap() - peaks[0].0;
    println!("  theta0/alpha {:.3} quarter {:.4} housner {:.4} ratio {:.4}", peaks[0].1.abs() / alpha, q, quarter(peaks[0].1), q / quarter(peaks[0].1));
}

#[test]
fn explore_rocking() {
    for cs in [100.0, 200.0, 400.0, 800.0] {
        rocking(cs, 16, 0.0025);
    }
    rocking(400.0, 32, 0.0025);
    rocking(400.0, 16, 0.00125);
}
