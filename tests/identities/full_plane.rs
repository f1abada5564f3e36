//! GOAL: the paper's ground translated, mirrored and in other units is the same ground; its kernel, given by a user, is
//! its kernel.
//! SCENE: two strips under random tractions; runs would grow (`tests/full_plane`).
//! REFERENCE: step compliance and displacements by past tractions in SI units.

use basemat::bem::full_plane::{Boundary, BoundaryKernel, FullPlaneGround, TimeKernel};
use basemat::bem::{Ground, Strip};
use basemat::{Result, Soil, unobserved};
use basemat_problems::random::Random;
use basemat_problems::scenes::{SI_UNITS, UnitFrame};

use super::compare::relative_difference;
use super::numbers::SOIL_DENSITY;
use super::tally::{IdentityTally, scenes};
use super::view::random_units;

const CONVOLUTION_STEPS: usize = 8;
/// Elements of each strip.
const STRIP_ELEMENTS: [usize; 2] = [3, 2];
const CONTACT_ELEMENTS: usize = STRIP_ELEMENTS[0] + STRIP_ELEMENTS[1];
/// Components of a vector of tractions.
const VECTOR_LENGTH: usize = 2 * CONTACT_ELEMENTS;
/// Rounding, which a scheme that grows amplifies.
const DIFFERENCE_LIMIT: f64 = 1e-9;

/// Two strips of a surface, in SI units.
struct TwoStrips {
    modulus: f64,
    poisson: f64,
    /// Ends of both strips, m.
    strips: [[f64; 2]; 2],
    /// Free elements on either side.
    free: usize,
    time_step: f64,
    /// Tractions of each step, Pa.
    tractions: Vec<Vec<f64>>,
}

impl TwoStrips {
    fn draw(random: &mut Random) -> Self {
        let modulus = SOIL_DENSITY * random.log_within(100.0, 400.0).powi(2);
        let left = random.within(1.0, 4.0);
        let right = random.within(1.0, 4.0);
        let gap = random.within(0.5, 2.0);
        let speed = (modulus / SOIL_DENSITY).sqrt();
        let mut tractions = vec![];
        for _ in 0..CONVOLUTION_STEPS {
            tractions.push((0..VECTOR_LENGTH).map(|_| random.within(-1e4, 1e4)).collect());
        }
        Self {
            tractions,
            modulus,
            poisson: random.within(0.1, 0.4),
            strips: [[-left, 0.0], [gap, gap + right]],
            free: random.pick(&[2, 4]),
            time_step: random.within(0.2, 1.0) * left / speed,
        }
    }

    /// The ground in these units, translated by `shift` metres.
    fn ground(&self, frame: &UnitFrame, shift: f64) -> Result<FullPlaneGround> {
        let density = SOIL_DENSITY * frame.density();
        let soil = Soil::new(self.modulus * frame.pressure(), self.poisson, density)?;
        let mut strips = Vec::new();
        for (ends, count) in self.strips.iter().zip(STRIP_ELEMENTS) {
            let ends = ends.map(|x| (frame.sign() * x + shift) * frame.length);
            strips.push(Strip::uniform(ends[0].min(ends[1])..ends[0].max(ends[1]), count)?);
        }
        if frame.mirrored {
            strips.reverse();
        }
        Ok(FullPlaneGround::new(soil, Boundary::flat(&strips, self.free)?).allow_growth())
    }

    /// Step compliance and displacements by past tractions of all steps, in SI units and the order of the scene.
    fn response(&self, mut ground: FullPlaneGround, frame: &UnitFrame) -> Result<Vec<f64>> {
        ground.prepare(self.time_step * frame.time, Some(CONVOLUTION_STEPS), &mut unobserved)?;
        // Index and sign in the view of each component of a contact vector.
        let components: Vec<(usize, f64)> = (0..VECTOR_LENGTH)
            .map(|i| {
                let direction = i / CONTACT_ELEMENTS;
                let element = i % CONTACT_ELEMENTS;
                let in_view = if frame.mirrored { CONTACT_ELEMENTS - 1 - element } else { element };
                let sign = if direction == 0 { 1.0 } else { frame.sign() };
                (direction * CONTACT_ELEMENTS + in_view, sign)
            })
            .collect();
        let mut matrix = vec![0.0; VECTOR_LENGTH * VECTOR_LENGTH];
        ground.step_compliance(&mut matrix)?;
        let unit = frame.pressure() / frame.length;
        let mut response = Vec::new();
        for (row, row_sign) in &components {
            for (column, column_sign) in &components {
                // Pressures of 10 kPa.
                let value = matrix[row * VECTOR_LENGTH + column] * unit * 1e4;
                response.push(row_sign * column_sign * value);
            }
        }
        for traction in &self.tractions {
            let mut in_view = vec![0.0; VECTOR_LENGTH];
            for ((index, sign), value) in components.iter().zip(traction) {
                in_view[*index] = sign * value * frame.pressure();
            }
            ground.commit(&in_view);
            let mut history = vec![0.0; VECTOR_LENGTH];
            ground.history(&mut history)?;
            let in_scene =
                components.iter().map(|(index, sign)| sign * history[*index] / frame.length);
            response.extend(in_scene);
        }
        Ok(response)
    }
}

/// GOAL: views and a user's kernel do not change the response.
#[test]
fn the_papers_ground_is_the_same_from_everywhere() {
    let mut tally = IdentityTally::new("full plane: views and users' kernels");
    let mut random = Random(151);
    for number in 0..scenes(6, 100) {
        let scene = TwoStrips::draw(&mut random);
        let units = random_units(&mut random);
        let mirrored = UnitFrame { mirrored: true, ..SI_UNITS };
        let shift = random.within(-50.0, 50.0);
        tally.scene(&["full plane", "strip"]);
        let expected = scene.response(scene.ground(&SI_UNITS, 0.0).unwrap(), &SI_UNITS).unwrap();
        let views =
            [("translated", SI_UNITS, shift), ("mirrored", mirrored, 0.0), ("units", units, 0.0)];
        for (name, frame, shift) in views {
            let ground = scene.ground(&frame, shift).unwrap();
            let computed = scene.response(ground, &frame).unwrap();
            let difference = relative_difference(&expected, &computed);
            tally.within(&format!("{number}: {name}"), difference, DIFFERENCE_LIMIT);
        }
        let ground =
            scene.ground(&SI_UNITS, 0.0).unwrap().with_kernel(|segments, soil, time_step| {
                let kernel = TimeKernel::new(soil, segments, time_step)?;
                Ok(Box::new(kernel) as Box<dyn BoundaryKernel>)
            });
        let computed = scene.response(ground, &SI_UNITS).unwrap();
        let difference = relative_difference(&expected, &computed);
        tally.within(&format!("{number}: kernel of a user"), difference, 1e-14);
    }
    tally.close(1.0);
}
