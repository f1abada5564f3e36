//! A body turned by any angle about the vertical is the same body, to the error of the cells under its oblique outline.

use std::f64::consts::FRAC_PI_2;

use basemat::bem::{ElasticGround, Ground, SpringGround};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::Triaxial;
use basemat::structure::RigidBody;
use basemat::{Result, Simulation};
use basemat_problems::random::Random;
use basemat_problems::scenes::GRAVITY;

use super::grounds::record;
use super::numbers::{Numbers, STEPS};
use super::tally::{Tally, scenes};
use super::view::PLAIN;

/// A cuboid turned about the vertical.
struct Turned {
    numbers: Numbers,
    /// Cells along the shorter side.
    cells: usize,
    on_soil: bool,
    friction: Option<f64>,
}

/// A horizontal vector turned counter-clockwise.
fn turn(angle: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos * x - sin * y, sin * x + cos * y]
}

impl Turned {
    fn body(&self, angle: f64) -> Result<RigidBody> {
        let [a, b] = self.numbers.sides;
        let height = self.numbers.height;
        let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
        let outline = corners.map(|[x, y]| turn(angle, [x * a, y * b]));
        let mass = self.numbers.mass(true);
        let about = |one: f64, other: f64| mass * (one * one + other * other) / 12.0;
        let [along, across] = [about(b, height), about(a, height)];
        // R I Rᵀ.
        let (sin, cos) = angle.sin_cos();
        let product = (along - across) * sin * cos;
        let inertia = [
            [cos * cos * along + sin * sin * across, product, 0.0],
            [product, sin * sin * along + cos * cos * across, 0.0],
            [0.0, 0.0, about(a, b)],
        ];
        RigidBody::from_mass(outline.to_vec(), mass, inertia, [0.0, 0.0, 0.5 * height])
    }

    fn ground(&self, body: &RigidBody) -> Result<Box<dyn Ground>> {
        let numbers = &self.numbers;
        if self.on_soil {
            let soil = numbers.soil(&PLAIN);
            return Ok(Box::new(ElasticGround::under(soil, body, self.cells)?));
        }
        let stiffness = numbers.modulus / numbers.sides[0];
        let bed = SpringGround::under(body, self.cells, 2.0 * stiffness, 1.5 * stiffness)?;
        let dashpot = 0.01 * stiffness;
        Ok(Box::new(bed.with_dashpots(dashpot, dashpot)?))
    }

    /// Forces, and moments, of all steps along the sides of the body.
    fn run(&self, angle: f64) -> Result<[Vec<f64>; 2]> {
        let numbers = &self.numbers;
        let body = self.body(angle)?;
        let [along, across, up] = numbers.peaks;
        let [x, y] = turn(angle, [along, across]);
        let motion = Triaxial {
            x: Some(record(numbers, x, &PLAIN)?),
            y: Some(record(numbers, y, &PLAIN)?),
            up: Some(record(numbers, up, &PLAIN)?),
        };
        let builder = Simulation::builder(numbers.time_step)
            .gravity(GRAVITY)
            .ground(self.ground(&body)?)
            .structure(body)
            .motion(motion)
            .expected_steps(STEPS);
        let builder = match self.friction {
            Some(friction) => builder.interface(Coulomb::new(friction)?),
            None => builder.interface(Bonded),
        };
        let mut simulation = builder.build()?;
        let [mut forces, mut moments] = [Vec::new(), Vec::new()];
        for _ in 0..STEPS {
            let foundation = &simulation.step()?.foundations[0];
            for (found, [x, y, up]) in [
                (&mut forces, foundation.force_vector()),
                (&mut moments, foundation.moment_vector()),
            ] {
                let [along, across] = turn(-angle, [x, y]);
                found.extend([along, across, up]);
            }
        }
        Ok([forces, moments])
    }
}

/// Largest difference, relative to the largest number.
fn apart(one: &[f64], other: &[f64]) -> f64 {
    let scale = one.iter().fold(0.0, |scale: f64, value| scale.max(value.abs()));
    let pairs = one.iter().zip(other);
    pairs.fold(0.0, |largest: f64, (a, b)| {
        let difference = (a - b).abs() / scale;
        if difference.is_nan() { f64::NAN } else { largest.max(difference) }
    })
}

#[test]
fn bodies_turned_by_any_angle() {
    let mut tally = Tally::new("bodies turned by any angle");
    let mut random = Random(161);
    for number in 0..scenes(4, 60) {
        let on_soil = number % 4 == 3;
        let numbers = Numbers::draw(random.bits());
        let friction = random.chance(0.5).then_some(numbers.friction);
        let cells = if on_soil { 6 } else { 10 };
        let turned = Turned { numbers, cells, on_soil, friction };
        let angle = random.within(0.1, FRAC_PI_2 - 0.1);
        let ground = if on_soil { "half-plane" } else { "springs" };
        let law = if friction.is_some() { "Coulomb" } else { "bonded" };
        tally.scene(&["rigid body", ground, law, "three records"]);
        let place = format!("{number}: {ground}, {law}, {angle:.2} rad, {:.2?} m", numbers.sides);
        match [turned.run(0.0), turned.run(angle)] {
            [Ok([forces, moments]), Ok([other_forces, other_moments])] => {
                tally.within(&format!("forces, {place}"), apart(&forces, &other_forces), 0.05);
                tally.within(&format!("moments, {place}"), apart(&moments, &other_moments), 0.05);
            }
            [Err(error), Err(_)] => tally.refuse(format!("{place}: {error}")),
            [one, other] => {
                let [one, other] = [one, other].map(|found| found.err().map(|own| own.to_string()));
                tally.fail(format!("{place}: {one:?} but {other:?}"));
            }
        }
    }
    tally.close(0.75);
}
