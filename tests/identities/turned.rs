//! GOAL: a body turned by any angle about the vertical is the same body, to the error of the cells under its outline.
//! SCENE: cuboids on springs and on a half-space, bonded and with friction.
//! REFERENCE: forces and moments of the body at no angle.

use std::f64::consts::FRAC_PI_2;

use basemat::bem::{ElasticGround, Ground, SpringGround};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::Triaxial;
use basemat::structure::RigidBody;
use basemat::{Result, Simulation};
use basemat_problems::random::Random;
use basemat_problems::scenes::SCENE_GRAVITY;

use super::compare::relative_difference;
use super::grounds::record;
use super::numbers::{Numbers, RUN_STEPS};
use super::structures::cuboid_inertia;
use super::tally::{IdentityTally, scenes};
use super::view::PLAIN_VIEW;

/// A cuboid turned about the vertical.
struct TurnedCuboid {
    numbers: Numbers,
    /// Cells along the shorter side.
    cells: usize,
    on_soil: bool,
    friction: Option<f64>,
}

/// A horizontal vector turned counter-clockwise.
fn turn(angle: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    let sin = angle.sin();
    let cos = angle.cos();
    [cos * x - sin * y, sin * x + cos * y]
}

impl TurnedCuboid {
    fn body(&self, angle: f64) -> Result<RigidBody> {
        let [a, b] = self.numbers.sides;
        let height = self.numbers.height;
        let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
        let outline = corners.map(|[x, y]| turn(angle, [x * a, y * b]));
        let mass = self.numbers.mass(true);
        let about_x = cuboid_inertia(mass, b, height);
        let about_y = cuboid_inertia(mass, a, height);
        // R I Rᵀ.
        let sin = angle.sin();
        let cos = angle.cos();
        let product = (about_x - about_y) * sin * cos;
        let inertia = [
            [cos * cos * about_x + sin * sin * about_y, product, 0.0],
            [product, sin * sin * about_x + cos * cos * about_y, 0.0],
            [0.0, 0.0, cuboid_inertia(mass, a, b)],
        ];
        RigidBody::from_mass(outline.to_vec(), mass, inertia, [0.0, 0.0, 0.5 * height])
    }

    fn ground(&self, body: &RigidBody) -> Result<Box<dyn Ground>> {
        let numbers = &self.numbers;
        if self.on_soil {
            let soil = numbers.soil(&PLAIN_VIEW);
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
        let peaks = turn(angle, [numbers.peaks[0], numbers.peaks[1]]);
        let motion = Triaxial {
            x: Some(record(numbers, peaks[0], &PLAIN_VIEW)?),
            y: Some(record(numbers, peaks[1], &PLAIN_VIEW)?),
            up: Some(record(numbers, numbers.peaks[2], &PLAIN_VIEW)?),
        };
        let builder = Simulation::builder(numbers.time_step)
            .gravity(SCENE_GRAVITY)
            .ground(self.ground(&body)?)
            .structure(body)
            .motion(motion)
            .expected_steps(RUN_STEPS);
        let builder = match self.friction {
            Some(friction) => builder.interface(Coulomb::new(friction)?),
            None => builder.interface(Bonded),
        };
        let mut simulation = builder.build()?;
        let mut forces = Vec::new();
        let mut moments = Vec::new();
        for _ in 0..RUN_STEPS {
            let foundation = &simulation.step()?.foundations[0];
            for (list, [x, y, up]) in [
                (&mut forces, foundation.force_vector()),
                (&mut moments, foundation.moment_vector()),
            ] {
                list.extend(turn(-angle, [x, y]));
                list.push(up);
            }
        }
        Ok([forces, moments])
    }
}

/// GOAL: forces and moments along the sides of the body do not depend on the angle.
#[test]
fn bodies_turned_by_any_angle() {
    let mut tally = IdentityTally::new("bodies turned by any angle");
    let mut random = Random(161);
    for number in 0..scenes(4, 60) {
        let on_soil = number % 4 == 3;
        let numbers = Numbers::draw(random.bits());
        let friction = random.chance(0.5).then_some(numbers.friction);
        let cells = if on_soil { 6 } else { 10 };
        let cuboid = TurnedCuboid { numbers, cells, on_soil, friction };
        let angle = random.within(0.1, FRAC_PI_2 - 0.1);
        let ground = if on_soil { "half-plane" } else { "springs" };
        let law = if friction.is_some() { "Coulomb" } else { "bonded" };
        tally.scene(&["rigid body", ground, law, "three records"]);
        let place = format!("{number}: {ground}, {law}, {angle:.2} rad, {:.2?} m", numbers.sides);
        let results = [cuboid.run(0.0), cuboid.run(angle)];
        tally.compare(&place, results, |tally, expected, computed| {
            for (k, name) in ["forces", "moments"].into_iter().enumerate() {
                let difference = relative_difference(&expected[k], &computed[k]);
                tally.within(&format!("{name}, {place}"), difference, 0.05);
            }
        });
    }
    tally.close(0.75);
}
