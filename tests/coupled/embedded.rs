//! A structure in the ground: static state, free field with tractions and energy, on a bed of springs around a trench.

use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::bem::{ContactElement, Ground, GroundDescription};
use basemat::coupled::{Face, GravityStage, Load};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw};
use basemat::motion::{Record, STANDARD_GRAVITY, VerticalIncidence, el_centro_1940};
use basemat::site::TrenchMotion;
use basemat::structure::{RigidBlock, WithWalls};
use basemat::{Error, Observer, Result, Simulation, Soil, unobserved};

/// Independent springs and dashpots at all faces, Pa/m and Pa s/m.
#[derive(Clone)]
pub(super) struct Bed {
    elements: Vec<ContactElement>,
    stiffness: f64,
    dashpots: f64,
    pressures: Vec<f64>,
    masses: Vec<f64>,
    decay: f64,
    moved: Vec<f64>,
}

pub(super) const DENSITY: f64 = 1900.0;
/// Outer point of Gauss's rule with three points.
const GAUSS: f64 = 0.774_596_669_241_483_4;

impl Bed {
    pub(super) fn new(elements: &TrenchElements, stiffness: f64, dashpots: f64) -> Self {
        let elements = elements.elements();
        let pressure = |own: &ContactElement| -0.5 * DENSITY * own.center()[2];
        let pressures = elements.iter().map(pressure).collect();
        let moved = vec![0.0; 2 * elements.len()];
        Self { elements, stiffness, dashpots, pressures, masses: vec![], decay: 0.0, moved }
    }

    /// Below soil of the weight of this ground's.
    pub(super) fn with_masses(self, ground: &TrenchGround) -> Self {
        Self { masses: ground.description().mass_above, ..self }
    }

    fn diagonal(&self, value: f64, matrix: &mut [f64]) {
        matrix.fill(0.0);
        matrix.iter_mut().step_by(self.moved.len() + 1).for_each(|own| *own = value);
    }
}

impl Ground for Bed {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(&mut self, step: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.decay = (-self.stiffness * step / self.dashpots).exp();
        self.moved.fill(0.0);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.diagonal((1.0 - self.decay) / self.stiffness, matrix);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        displacement.iter_mut().zip(&self.moved).for_each(|(own, s)| *own = self.decay * s);
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        let at_once = (1.0 - self.decay) / self.stiffness;
        for (s, traction) in self.moved.iter_mut().zip(traction) {
            *s = self.decay * *s + at_once * traction;
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.diagonal(1.0 / self.stiffness, matrix);
        Ok(())
    }

    fn description(&self) -> GroundDescription {
        GroundDescription {
            pressure_at_rest: self.pressures.clone(),
            mass_above: self.masses.clone(),
            ..Default::default()
        }
    }
}

pub(super) const WIDTH: f64 = 12.0;
pub(super) const HEIGHT: f64 = 20.0;
pub(super) const DEPTH: f64 = 5.0;

pub(super) fn soil() -> Soil {
    Soil::from_shear_wave_speed(200.0, 0.3, DENSITY).unwrap()
}

pub(super) fn block() -> WithWalls {
    WithWalls::new(RigidBlock::new(WIDTH, HEIGHT, 900.0).unwrap(), DEPTH).unwrap()
}

pub(super) fn faces() -> TrenchElements {
    Trench::new(-0.5 * WIDTH..0.5 * WIDTH, DEPTH).unwrap().elements(6, 4).unwrap()
}

pub(super) fn motion(motion: impl Into<VerticalIncidence>) -> TrenchMotion {
    let ground = TrenchGround::new(soil(), faces()).unwrap();
    TrenchMotion::new(&ground, motion, &mut unobserved).unwrap()
}

pub(super) fn laws() -> Vec<Box<dyn InterfaceLaw>> {
    faces().interfaces(Coulomb::new(0.5).unwrap(), Coulomb::new(0.3).unwrap())
}

/// Weight on the base alone, pressure at rest on the walls; nothing moves without motion.
#[test]
fn a_backfilled_block_stays_at_rest() {
    let mut simulation = Simulation::builder(0.01)
        .structure(block())
        .ground(Bed::new(&faces(), 4e7, 4e5))
        .interfaces(laws())
        .build()
        .unwrap();
    let state = simulation.state();
    let base = state.face(Face::Base);
    assert!((base.thrust / (900.0 * WIDTH * HEIGHT * STANDARD_GRAVITY) - 1.0).abs() < 1e-12);
    assert!(base.place.abs() < 1e-9 && base.shear == 0.0);
    for wall in [Face::LeftWall, Face::RightWall] {
        let wall = state.face(wall);
        let thrust = 0.25 * DENSITY * STANDARD_GRAVITY * DEPTH * DEPTH;
        assert!((wall.thrust / thrust - 1.0).abs() < 1e-12);
        assert_eq!((wall.shear, wall.open_fraction), (0.0, 0.0));
    }
    assert!(state.base_moment.abs() < 1e-6 && state.base_shear.abs() < 1e-6);
    let start = state.contact.clone();
    simulation.run(50, |_| {}).unwrap();
    for (own, start) in simulation.state().contact.iter().zip(&start) {
        assert!((own.pressure - start.pressure).abs() < 1e-12 * 2e5 && own.gap.abs() < 1e-15);
    }
}

/// Strong shaking opens walls and base; the energy balance closes.
#[test]
fn walls_open_and_slide_and_the_energy_balance_closes() {
    let record = el_centro_1940().scaled(2.5).unwrap().padded(0.5, 0.5).unwrap();
    let vertical = Some(record.scaled(0.6).unwrap());
    let motion = motion(VerticalIncidence { horizontal: Some(record), vertical });
    let mut simulation = Simulation::builder(0.01)
        .structure(block())
        .ground(Bed::new(&faces(), 4e7, 4e5))
        .interfaces(laws())
        .motion(motion)
        .build()
        .unwrap();
    let [mut open, mut slips, mut lifted] = [0.0_f64; 3];
    let run = simulation
        .run(800, |state| {
            let walls =
                [Face::LeftWall, Face::RightWall].map(|wall| state.face(wall).open_fraction);
            open = open.max(walls[0]).max(walls[1]);
            lifted = lifted.max(state.face(Face::Base).open_fraction);
            slips += state.modes.iter().filter(|mode| mode.is_slip()).count() as f64;
        })
        .unwrap();
    assert!(run.energy_error < 1e-11, "{}", run.energy_error);
    assert!(open > 0.2 && lifted > 0.1 && slips > 10.0, "{open} {lifted} {slips}");
    assert!(simulation.state().energy_balance.soil > 0.0);
    assert!(simulation.state().energy_balance.contact > 0.0);
}

/// Displacement a and velocity of the surface, at any time.
fn pulse(time: f64) -> [f64; 2] {
    let x = 6.0 * (time - 1.2);
    let [square, bell] = [x * x, (-x * x).exp()];
    [0.05 * (1.0 - 2.0 * square) * bell, 0.05 * 6.0 * x * (4.0 * square - 6.0) * bell]
}

/// A block bonded to all faces under shear and pressure waves, beside an integration of its own.
///
/// The waves of the half-plane are standing ones, u = [a(t + z/c) + a(t − z/c)]/2.
#[test]
fn waves_act_on_all_faces_as_in_an_independent_integration() {
    let (stiffness, dashpots) = (4e7, 8e5);
    let elements = faces().elements();
    let [shear, pressure] = [soil().shear_wave_speed(), soil().pressure_wave_speed()];
    // Displacement, velocity, and stress ∫ρ a dz at a depth.
    let wave = |speed: f64, depth: f64, time: f64| {
        let [early, late] = [pulse(time + depth / speed), pulse(time - depth / speed)];
        let moved = [0, 1].map(|k| 0.5 * (early[k] + late[k]));
        (moved, 0.5 * DENSITY * speed * (early[1] - late[1]))
    };
    let (mass, height) = (900.0 * WIDTH * HEIGHT, 0.5 * HEIGHT);
    let inertia = mass * (WIDTH * WIDTH + HEIGHT * HEIGHT) / 12.0;
    // Acceleration of the centre of gravity (right, up) and of the rotation.
    let acceleration = |u: [f64; 3], v: [f64; 3], time: f64| {
        let mut force = [0.0; 3];
        for own in &elements {
            let half = 0.5 * own.length();
            let [x, _, z] = own.center();
            let [n, t] = [own.directions()[0], own.directions()[1]];
            // Means of the free field over the element: displacement and velocity, and tractions on the soil.
            let (mut free, mut of_field) = ([[0.0; 2]; 2], [0.0; 2]);
            for (place, weight) in [(-GAUSS, 5.0 / 18.0), (0.0, 8.0 / 18.0), (GAUSS, 5.0 / 18.0)] {
                let depth = -(z + t[2] * half * place);
                let (along, sigma) = wave(shear, depth, time);
                let (up, sigma_up) = wave(pressure, depth, time);
                let aside = 0.3 / 0.7 * sigma_up;
                let on_soil =
                    if n[2] < -0.5 { [-sigma, -sigma_up] } else { [n[0] * aside, t[2] * sigma] };
                for k in 0..2 {
                    free[0][k] += weight * along[k];
                    free[1][k] += weight * up[k];
                    of_field[k] += weight * on_soil[k];
                }
            }
            // The middle of the element, from the centre of gravity.
            let arm = [x, z + DEPTH - height];
            let point = |q: [f64; 3]| [q[0] - arm[1] * q[2], q[1] + arm[0] * q[2]];
            let [pu, pv] = [point(u), point(v)];
            for k in 0..2 {
                let against = stiffness * (pu[k] - free[k][0]) + dashpots * (pv[k] - free[k][1]);
                let on_block = -own.length() * (of_field[k] + against);
                force[k] += on_block;
                force[2] += [-arm[1], arm[0]][k] * on_block;
            }
        }
        [force[0] / mass, force[1] / mass, force[2] / inertia]
    };
    let step = 0.0025;
    let [mut u, mut v] = [[0.0; 3]; 2];
    let mut reference = vec![];
    let add = |a: [f64; 3], b: [f64; 3], h: f64| [0, 1, 2].map(|k| a[k] + h * b[k]);
    for n in 0..960 {
        let t = f64::from(n) * step;
        let k1 = (v, acceleration(u, v, t));
        let at = |k: ([f64; 3], [f64; 3]), h: f64| (add(u, k.0, h), add(v, k.1, h));
        let next = |k: ([f64; 3], [f64; 3]), h: f64| {
            let (u, v) = at(k, h);
            (v, acceleration(u, v, t + h))
        };
        let k2 = next(k1, 0.5 * step);
        let k3 = next(k2, 0.5 * step);
        let k4 = next(k3, step);
        for (k, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            u = add(u, k.0, step * weight / 6.0);
            v = add(v, k.1, step * weight / 6.0);
        }
        // The middle of the base, up and rotation.
        reference.push([u[0] + height * u[2], u[1], u[2]]);
    }
    let record = || {
        let second = |time: f64| {
            let h = 1e-4;
            (pulse(time + h)[1] - pulse(time - h)[1]) / (2.0 * h)
        };
        Record::from_fn(0.005, 3.0, second).unwrap()
    };
    let motion = motion(VerticalIncidence { horizontal: Some(record()), vertical: Some(record()) });
    let mut simulation = Simulation::builder(step)
        .structure(block())
        .ground(Bed::new(&faces(), stiffness, dashpots))
        .interface(Bonded)
        .motion(motion)
        .build()
        .unwrap();
    let [mut largest, mut apart] = [[0.0_f64; 3]; 2];
    for wanted in &reference {
        let state = simulation.step().unwrap();
        let [along, up] = [0, 1].map(|dof| state.absolute_displacement()[dof]);
        let found = [along, up, state.base_rotation];
        for k in 0..3 {
            largest[k] = largest[k].max(wanted[k].abs());
            apart[k] = apart[k].max((found[k] - wanted[k]).abs());
        }
    }
    for k in 0..3 {
        assert!(apart[k] < 0.003 * largest[k], "{k}: {} of {}", apart[k], largest[k]);
    }
    assert!(largest[2] > 1e-3, "{largest:?}");
}

/// A block welded in a trench under a pulse of shear waves, beside its Fourier synthesis.
#[test]
fn a_welded_block_follows_its_fourier_synthesis() {
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap();
    let elements = Trench::new(-1.0..1.0, 1.0).unwrap().elements(4, 3).unwrap();
    let ground = TrenchGround::new(soil, elements).unwrap();
    let second = |t: f64| {
        let x = 0.6 * (t - 9.0);
        0.36 * (-6.0 + x * x * (24.0 - 8.0 * x * x)) * (-x * x).exp()
    };
    let record = Record::from_fn(0.02, 40.0, second).unwrap();
    let motion = TrenchMotion::new(&ground, record, &mut unobserved).unwrap();
    let mut simulation = Simulation::builder(0.2)
        .structure(WithWalls::new(RigidBlock::new(2.0, 3.0, 1.0).unwrap(), 1.0).unwrap())
        .ground(ground)
        .interface(Bonded)
        .motion(motion)
        .expected_steps(130)
        .build()
        .unwrap();
    let table = include_str!("../data/embedded/td_SV_h1f_dt02.csv");
    let [mut largest, mut apart] = [[0.0_f64; 2]; 2];
    for line in table.lines() {
        let values: Vec<f64> = line.split(',').filter_map(|own| own.parse().ok()).collect();
        if values.len() < 3 {
            continue;
        }
        let state = simulation.step().unwrap();
        assert!((state.time - values[0]).abs() < 1e-9);
        // The table's rotation lowers the right end.
        let found = [state.absolute_displacement()[0], -state.base_rotation];
        for k in 0..2 {
            largest[k] = largest[k].max(values[1 + k].abs());
            apart[k] = apart[k].max((found[k] - values[1 + k]).abs());
        }
    }
    // The table has twice as many elements.
    assert!((0..2).all(|k| apart[k] < 0.025 * largest[k]), "{apart:?} {largest:?}");
    let energy = simulation.state().energy_balance;
    assert!(energy.residual() < 1e-9 && energy.soil > 0.0, "{energy:?}");
}

/// Base and walls that open and slide on the soil around a trench: the balance closes and the soil never gives.
#[test]
fn soil_around_a_trench_never_gives_energy() {
    let elements = Trench::new(-0.5 * WIDTH..0.5 * WIDTH, DEPTH).unwrap().elements(4, 3).unwrap();
    let laws = elements.interfaces(Coulomb::new(0.5).unwrap(), Coulomb::new(0.3).unwrap());
    let ground = TrenchGround::new(soil(), elements).unwrap().with_pressure_at_rest(0.5).unwrap();
    let record = el_centro_1940().scaled(3.0).unwrap().padded(0.2, 0.0).unwrap();
    let motion = TrenchMotion::new(&ground, record, &mut unobserved).unwrap();
    let mut simulation = Simulation::builder(0.02)
        .structure(block())
        .ground(ground)
        .interfaces(laws)
        .motion(motion)
        .expected_steps(256)
        .build()
        .unwrap();
    let [mut least, mut most, mut open] = [0.0_f64; 3];
    let run = simulation
        .run(256, |state| {
            least = least.min(state.energy_balance.soil);
            most = most.max(state.energy_balance.soil);
            open = open.max(state.face(Face::LeftWall).open_fraction);
        })
        .unwrap();
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    assert!(least > -1e-12 * most && open > 0.3, "{least} {most} {open}");
}

/// A tiny load at the start changes tractions by as little: jumps count from the placed state.
#[test]
fn a_tiny_load_at_the_start_hardly_changes_tractions() {
    let elements = Trench::new(-0.5 * WIDTH..0.5 * WIDTH, DEPTH).unwrap().elements(4, 2).unwrap();
    let laws = || elements.interfaces(Coulomb::new(0.5).unwrap(), Coulomb::new(0.3).unwrap());
    let weight = 900.0 * WIDTH * HEIGHT * STANDARD_GRAVITY;
    let at_rest = |load: f64| {
        Simulation::builder(0.02)
            .structure(block())
            .ground(TrenchGround::new(soil(), elements.clone()).unwrap())
            .interfaces(laws())
            .load(Load::constant([(1, 1.0)], -load * weight))
            .build()
            .unwrap()
            .state()
            .contact
            .clone()
    };
    let [without, with] = [0.0, 1e-6].map(at_rest);
    let scale = weight / WIDTH;
    for (one, other) in without.iter().zip(&with) {
        let apart = (one.pressure - other.pressure).abs().max((one.shear - other.shear).abs());
        assert!(apart < 1e-5 * scale, "{one:?} {other:?}");
    }
    assert!(without.iter().zip(&with).any(|(one, other)| one.pressure != other.pressure));
}

/// Uplift and slip are of the base; factors of safety are not known with walls.
#[test]
fn walls_have_results_of_their_own() {
    let mut simulation = Simulation::builder(0.01)
        .structure(block())
        .ground(Bed::new(&faces(), 4e7, 4e5))
        .interfaces(laws())
        .motion(motion(el_centro_1940().scaled(2.0).unwrap()))
        .build()
        .unwrap();
    simulation
        .run(300, |state| {
            let base = state.face(Face::Base);
            assert!((state.uplifted_fraction - base.open_fraction).abs() < 1e-12);
            assert!((state.base_shear - base.shear).abs() > 0.0 || state.time < 0.1);
        })
        .unwrap();
    let state = simulation.state();
    let [left, right] = [Face::LeftWall, Face::RightWall].map(|wall| state.face(wall));
    let shear = right.thrust - left.thrust + state.face(Face::Base).shear;
    assert!((state.base_shear - shear).abs() < 1e-9 * state.normal_force);
    let unloaded = Simulation::builder(0.01)
        .structure(block())
        .ground(Bed::new(&faces(), 4e7, 4e5))
        .interfaces(laws())
        .gravity_stage(GravityStage::Unloaded)
        .build();
    assert!(matches!(unloaded, Err(Error::Scene { quantity: "gravity stage", .. })));
    let on_surface = Simulation::builder(0.01)
        .structure(RigidBlock::new(WIDTH, HEIGHT, 900.0).unwrap())
        .ground(Bed::new(&faces(), 4e7, 4e5))
        .interfaces(laws())
        .build();
    assert!(on_surface.unwrap_err().to_string().contains("WithWalls"));
}

/// A motion known at the surface only is refused.
#[test]
fn a_motion_of_the_surface_alone_is_refused() {
    let built = Simulation::builder(0.01)
        .structure(block())
        .ground(Bed::new(&faces(), 4e7, 4e5))
        .interface(Bonded)
        .motion(el_centro_1940())
        .build();
    assert!(matches!(built, Err(Error::Scene { quantity: "free field", .. })));
}
