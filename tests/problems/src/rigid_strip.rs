//! Rigid massless strip on the half-plane, stepped by the methods of the `Ground` trait alone.

use basemat::bem::{ContactElement, ElasticGround, Grading, Ground, Strip};
use basemat::{Soil, unobserved};

use super::dense::inverse;

/// Tractions between the strip and the soil.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StripTractions {
    /// Pressure and shear traction.
    Bonded,
    /// Pressure only.
    Normal,
    /// Shear traction only.
    Tangential,
}

/// Strip of half width 1 on a soil of unit shear modulus and density.
///
/// Motions are `[right, down, rotation]`, forces on the soil are `[right, down, moment]`; a
/// positive rotation or moment lowers the right side.
pub struct DrivenStrip {
    ground: Box<dyn Ground>,
    /// Inverse of the step compliance.
    inverse: Vec<f64>,
    /// Element means of the three rigid motions.
    motions: [Vec<f64>; 3],
    /// These means times the element lengths.
    forces: [Vec<f64>; 3],
    /// Motion of the strip in a step per force on it.
    compliance: Vec<f64>,
    history: Vec<f64>,
}

impl DrivenStrip {
    pub fn new(
        poisson: f64,
        grading: Grading,
        elements: usize,
        time_step: f64,
        tractions: StripTractions,
    ) -> Self {
        let soil = Soil::new(1.0, poisson, 1.0).unwrap();
        let strip = Strip::new(-1.0..1.0, elements, grading).unwrap();
        let ground = ElasticGround::new(soil, strip).unwrap();
        Self::on(Box::new(ground), time_step, tractions)
    }

    /// The strip on any ground with the strip's elements.
    pub fn on(mut ground: Box<dyn Ground>, time_step: f64, tractions: StripTractions) -> Self {
        ground.prepare(time_step, None, &mut unobserved).unwrap();
        let elements = ground.elements().len();
        let size = 2 * elements;
        let mut matrix = vec![0.0; size * size];
        ground.step_compliance(&mut matrix).unwrap();
        let active: Vec<bool> = (0..size)
            .map(|i| match tractions {
                StripTractions::Bonded => true,
                StripTractions::Normal => i < elements,
                StripTractions::Tangential => i >= elements,
            })
            .collect();
        let mut motions = [vec![0.0; size], vec![0.0; size], vec![0.0; size]];
        for (q, element) in ground.elements().iter().enumerate() {
            if active[q] {
                motions[1][q] = 1.0;
                motions[2][q] = element.center()[0];
            }
            if active[elements + q] {
                motions[0][elements + q] = 1.0;
            }
        }
        for i in 0..size {
            for j in 0..size {
                if !(active[i] && active[j]) {
                    matrix[i * size + j] = f64::from(u8::from(i == j));
                }
            }
        }
        let lengths: Vec<f64> = ground.elements().iter().map(ContactElement::length).collect();
        let forces = std::array::from_fn(|k: usize| {
            motions[k].iter().enumerate().map(|(i, m)| m * lengths[i % elements]).collect()
        });

        let mut strip = Self {
            ground,
            inverse: inverse(&matrix, size),
            motions,
            forces,
            compliance: Vec::new(),
            history: vec![0.0; size],
        };
        let mut stiffness = vec![0.0; 9];
        for k in 0..3 {
            let traction = strip.traction(&strip.motions[k]);
            let force = strip.resultant(&traction);
            for (row, f) in force.iter().enumerate() {
                stiffness[row * 3 + k] = *f;
            }
        }
        for k in 0..3 {
            if stiffness[k * 4] == 0.0 {
                stiffness[k * 4] = 1.0;
            }
        }
        strip.compliance = inverse(&stiffness, 3);
        strip
    }

    /// Moves the strip to `motion` in one step; returns the mean forces over the step.
    pub fn drive(&mut self, motion: [f64; 3]) -> [f64; 3] {
        self.ground.history(&mut self.history).unwrap();
        self.advance(motion)
    }

    /// Pushes the strip for one step with the mean forces `force`; returns the motion at the end of the step.
    pub fn push(&mut self, force: [f64; 3]) -> [f64; 3] {
        self.ground.history(&mut self.history).unwrap();
        let history_force = self.resultant(&self.traction(&self.history));
        let total: [f64; 3] = std::array::from_fn(|k| force[k] + history_force[k]);
        let motion = std::array::from_fn(|k| {
            (0..3).map(|j| self.compliance[3 * k + j] * total[j]).sum::<f64>()
        });
        self.advance(motion);
        motion
    }

    fn advance(&mut self, motion: [f64; 3]) -> [f64; 3] {
        let increment: Vec<f64> = (0..self.history.len())
            .map(|i| (0..3).map(|k| motion[k] * self.motions[k][i]).sum::<f64>() - self.history[i])
            .collect();
        let mut traction = self.traction(&increment);
        // Components that are not in contact have no traction.
        for (i, t) in traction.iter_mut().enumerate() {
            if self.motions.iter().all(|m| m[i] == 0.0) && !self.is_in_contact(i) {
                *t = 0.0;
            }
        }
        self.ground.commit(&traction);
        self.resultant(&traction)
    }

    fn is_in_contact(&self, i: usize) -> bool {
        let count = self.history.len() / 2;
        if i < count { self.motions[1][i] != 0.0 } else { self.motions[0][i] != 0.0 }
    }

    fn traction(&self, displacement: &[f64]) -> Vec<f64> {
        let size = displacement.len();
        self.inverse
            .chunks_exact(size)
            .map(|row| row.iter().zip(displacement).map(|(a, b)| a * b).sum())
            .collect()
    }

    fn resultant(&self, traction: &[f64]) -> [f64; 3] {
        std::array::from_fn(|k| self.forces[k].iter().zip(traction).map(|(a, b)| a * b).sum())
    }
}
