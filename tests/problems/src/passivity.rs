//! Passivity of grounds: work of random tractions, and growth of the tractions of random displacements.

use basemat::bem::{ElasticGround, Ground, Strip};
use basemat::history::{HistoryMethod, HistoryOptions};
use basemat::{Soil, unobserved};

use super::dense::inverse;
use super::random::Random;

/// A strip, its time step and its random excitation.
#[derive(Debug, Clone, Copy)]
pub struct PassivityScene {
    pub poisson: f64,
    /// c₁ Δt over the mean element length.
    pub beta: f64,
    pub graded: bool,
    pub elements: usize,
    pub steps: usize,
    pub seed: u64,
    pub history: HistoryMethod,
    /// Allowed tolerance of the history; 0 for none.
    pub tolerance: f64,
}

impl PassivityScene {
    fn ground(&self) -> ElasticGround {
        let soil = Soil::new(1.0, self.poisson, 1.0).unwrap();
        let strip = if self.graded { Strip::graded } else { Strip::uniform };
        let strip = strip(-1.0..1.0, self.elements).unwrap();
        let tolerance = (self.tolerance > 0.0).then_some(self.tolerance);
        let options = HistoryOptions { tolerance, ..self.history.into() };
        let mut ground = ElasticGround::new(soil, strip).unwrap().with_history(options).unwrap();
        let length = 2.0 / self.elements as f64;
        ground
            .prepare(
                self.beta * length / soil.pressure_wave_speed(),
                Some(self.steps),
                &mut unobserved,
            )
            .unwrap();
        ground
    }

    /// [`min_work_ratio`] of the ground.
    pub fn min_work_ratio(&self) -> f64 {
        min_work_ratio(&mut self.ground(), self.steps, self.seed)
    }

    /// Growth of the tractions of random displacements, whose increments are white noise.
    ///
    /// It is the largest traction in the last tenth of the run over the largest in the first tenth.
    pub fn growth_of_tractions(&self) -> f64 {
        let mut ground = self.ground();
        let size = 2 * self.elements;
        let mut operator = vec![0.0; size * size];
        ground.step_compliance(&mut operator).unwrap();
        let inverse = inverse(&operator, size);
        let mut random = Random(self.seed);
        let mut history = vec![0.0; size];
        let mut increment = vec![0.0; size];
        let tenth_of_steps = self.steps / 10;
        let mut early_max = 0.0_f64;
        let mut late_max = 0.0_f64;
        for step in 0..self.steps {
            ground.history(&mut history).unwrap();
            for (du, h) in increment.iter_mut().zip(&history) {
                *du = random.within(-1.0, 1.0) - h;
            }
            let traction = multiply(&inverse, &increment);
            let max_traction = traction.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
            if !max_traction.is_finite() {
                return f64::INFINITY;
            }
            if step < tenth_of_steps {
                early_max = early_max.max(max_traction);
            } else if step >= self.steps - tenth_of_steps {
                late_max = late_max.max(max_traction);
            }
            ground.commit(&traction);
        }
        late_max / early_max
    }
}

/// Smallest work of tractions on a prepared ground, relative to the work of the first ten steps.
///
/// The work until step N is W_N = Σ A τ·Δs; a passive ground keeps it positive. Tractions are white noise for ten steps.
/// Until half of the run they then extract as much energy in each step as possible: τ = −½ G⁻¹(h − s₀) minimises
/// τ·A(h + Gτ − s₀). Slow noise follows.
pub fn min_work_ratio(ground: &mut dyn Ground, steps: usize, seed: u64) -> f64 {
    let count = ground.elements().len();
    let directions = ground.elements()[0].directions().len();
    let size = directions * count;
    let mut operator = vec![0.0; size * size];
    ground.step_compliance(&mut operator).unwrap();
    let inverse = inverse(&operator, size);
    let sides = ground.elements().iter().map(basemat::bem::ContactElement::sides);
    let areas: Vec<f64> = sides.map(|[along, across]| along * across).collect();
    let mut random = Random(seed);
    let mut traction = vec![0.0; size];
    let mut history = vec![0.0; size];
    let mut start = vec![0.0; size];
    let mut work = 0.0;
    let mut min_work = f64::INFINITY;
    let mut noise_work = 0.0;
    for step in 0..steps {
        ground.history(&mut history).unwrap();
        let is_noise = step < 10;
        if !is_noise && step < steps / 2 {
            let change: Vec<f64> =
                history.iter().zip(&start).map(|(h, s)| -0.5 * (h - s)).collect();
            traction = multiply(&inverse, &change);
        } else {
            for t in &mut traction {
                let noise = random.within(-1.0, 1.0);
                *t = if is_noise { noise } else { 0.95 * *t + 0.3 * noise };
            }
        }
        let mut end = multiply(&operator, &traction);
        for (s, h) in end.iter_mut().zip(&history) {
            *s += h;
        }
        for i in 0..size {
            work += areas[i % count] * traction[i] * (end[i] - start[i]);
        }
        if is_noise {
            noise_work = work;
        }
        if !is_noise || work < 0.0 {
            min_work = min_work.min(work);
        }
        ground.commit(&traction);
        start.copy_from_slice(&end);
    }
    min_work / noise_work
}

fn multiply(matrix: &[f64], x: &[f64]) -> Vec<f64> {
    matrix
        .chunks_exact(x.len())
        .map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum())
        .collect()
}
