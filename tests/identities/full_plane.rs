//! The paper's ground translated, mirrored and in other units is the same ground; its own kernel, given by a user, is its
//! kernel. Runs would grow (tests/full_plane): the rows compare the ground's answers to tractions.

use basemat::bem::full_plane::{Boundary, BoundaryKernel, FullPlaneGround, TimeKernel};
use basemat::bem::{Ground, Strip};
use basemat::{Result, Soil, unobserved};
use basemat_problems::random::Random;
use basemat_problems::scenes::{Frame, SI};

use super::numbers::SOIL_DENSITY;
use super::tally::{Tally, scenes};

/// Steps of a convolution.
const LAGS: usize = 8;
/// Elements of both strips.
const COUNTS: [usize; 2] = [3, 2];
const CONTACT: usize = COUNTS[0] + COUNTS[1];
const SIZE: usize = 2 * CONTACT;
/// Rounding, which a scheme that grows amplifies.
const LIMIT: f64 = 1e-9;

/// Two strips of a surface, in SI units.
struct Scene {
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

impl Scene {
    fn draw(random: &mut Random) -> Self {
        let modulus = SOIL_DENSITY * random.log_within(100.0, 400.0).powi(2);
        let [left, right] = [random.within(1.0, 4.0), random.within(1.0, 4.0)];
        let gap = random.within(0.5, 2.0);
        let speed = (modulus / SOIL_DENSITY).sqrt();
        let mut traction = || -> Vec<f64> { (0..SIZE).map(|_| random.within(-1e4, 1e4)).collect() };
        Self {
            tractions: (0..LAGS).map(|_| traction()).collect(),
            modulus,
            poisson: random.within(0.1, 0.4),
            strips: [[-left, 0.0], [gap, gap + right]],
            free: random.pick(&[2, 4]),
            time_step: random.within(0.2, 1.0) * left / speed,
        }
    }

    /// The ground in these units, translated by `shift` metres.
    fn ground(&self, frame: &Frame, shift: f64) -> Result<FullPlaneGround> {
        let density = SOIL_DENSITY * frame.density();
        let soil = Soil::new(self.modulus * frame.pressure(), self.poisson, density)?;
        let mut strips = Vec::new();
        for (ends, count) in self.strips.iter().zip(COUNTS) {
            let [one, other] = ends.map(|x| (frame.sign() * x + shift) * frame.length);
            strips.push(Strip::uniform(one.min(other)..one.max(other), count)?);
        }
        if frame.mirrored {
            strips.reverse();
        }
        Ok(FullPlaneGround::new(soil, Boundary::flat(&strips, self.free)?).allow_growth())
    }

    /// Step compliance and displacements by past tractions of all steps, in SI units and the order of the scene.
    fn answers(&self, mut ground: FullPlaneGround, frame: &Frame) -> Result<Vec<f64>> {
        ground.prepare(self.time_step * frame.time, Some(LAGS), &mut unobserved)?;
        // Place and sign in the view of each number of a contact vector.
        let places: Vec<(usize, f64)> = (0..SIZE)
            .map(|i| {
                let (component, element) = (i / CONTACT, i % CONTACT);
                let place = if frame.mirrored { CONTACT - 1 - element } else { element };
                let sign = if component == 0 { 1.0 } else { frame.sign() };
                (component * CONTACT + place, sign)
            })
            .collect();
        let mut matrix = vec![0.0; SIZE * SIZE];
        ground.step_compliance(&mut matrix)?;
        let unit = frame.pressure() / frame.length;
        let mut found = Vec::new();
        for (row, row_sign) in &places {
            for (column, column_sign) in &places {
                // Pressures of 10 kPa.
                let value = matrix[row * SIZE + column] * unit * 1e4;
                found.push(row_sign * column_sign * value);
            }
        }
        for traction in &self.tractions {
            let mut seen = vec![0.0; SIZE];
            for ((place, sign), value) in places.iter().zip(traction) {
                seen[*place] = sign * value * frame.pressure();
            }
            ground.commit(&seen);
            let mut history = vec![0.0; SIZE];
            ground.history(&mut history)?;
            found.extend(places.iter().map(|(place, sign)| sign * history[*place] / frame.length));
        }
        Ok(found)
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
fn the_papers_ground_is_the_same_from_everywhere() {
    let mut tally = Tally::new("full plane: views and users' kernels");
    let mut random = Random(151);
    for number in 0..scenes(6, 100) {
        let scene = Scene::draw(&mut random);
        let mut unit = || 10.0_f64.powf(random.within(-3.0, 3.0));
        let units = Frame { length: unit(), time: unit(), mass: unit(), mirrored: false };
        let mirrored = Frame { mirrored: true, ..SI };
        let shift = random.within(-50.0, 50.0);
        tally.scene(&["full plane", "strip"]);
        let usual = scene.ground(&SI, 0.0).and_then(|ground| scene.answers(ground, &SI)).unwrap();
        let views = [("translated", SI, shift), ("mirrored", mirrored, 0.0), ("units", units, 0.0)];
        for (name, frame, shift) in views {
            let ground = scene.ground(&frame, shift).unwrap();
            let found = scene.answers(ground, &frame).unwrap();
            tally.within(&format!("{number}: {name}"), apart(&usual, &found), LIMIT);
        }
        let ground = scene.ground(&SI, 0.0).unwrap().with_kernel(|segments, soil, time_step| {
            let kernel = TimeKernel::new(soil, segments, time_step)?;
            Ok(Box::new(kernel) as Box<dyn BoundaryKernel>)
        });
        let found = scene.answers(ground, &SI).unwrap();
        tally.within(&format!("{number}: kernel of a user"), apart(&usual, &found), 1e-14);
    }
    tally.close(1.0);
}
