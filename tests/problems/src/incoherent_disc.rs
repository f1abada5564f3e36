//! Rigid disc without mass on a half-space whose ground motion is incoherent (Luco and Mita, "Response of circular
//! foundation to spatially random ground motion", J. Eng. Mech. 113 (1987), 1–15).
//!
//! Lengths are relative to the radius R and speeds to that of shear waves c, so that angular frequencies are a₀ = ωR/c.

use std::f64::consts::TAU;

use basemat::bem::{ContactElement, ElasticGround, Ground};
use basemat::coupled::Load;
use basemat::interface::Bonded;
use basemat::motion::{
    FreeField, Incoherence, IncoherentMotion, LucoWong, Record, Triaxial, mean_coherence,
};
use basemat::structure::RigidBody;
use basemat::{Complex, Result, Simulation, Soil};

/// Parameter of the coherence exp(−(α a₀ d/R)²).
pub const COHERENCE_PARAMETER: f64 = 0.5;
/// Frequencies of the published table.
pub const DISC_FREQUENCIES: [f64; 3] = [1.0, 2.0, 3.0];
/// Mean square of the horizontal and of the vertical motion over that of the ground, for ν = 1/3.
pub const PUBLISHED_MEAN_SQUARES: [[f64; 3]; 2] = [[0.732, 0.402, 0.251], [0.730, 0.416, 0.270]];
/// Component of the motion along x and upwards, for the rows of the table.
pub const DISC_COMPONENTS: [usize; 2] = [0, 2];

/// Time step and duration of the run from which the weights follow, in R/c.
const WEIGHTS_TIME_STEP: f64 = 0.05;
const WEIGHTS_DURATION: f64 = 40.0;
/// Ratio of the disc's mass to that of a cube of soil of its radius.
const DISC_MASS_RATIO: f64 = 3e-4;
/// Interval of a₀ between independent phases.
const PHASE_BANDWIDTH: f64 = 0.25;
/// Time step of the record, and time of its pulse, in R/c.
const RECORD_TIME_STEP: f64 = 0.1;
const PULSE_TIME: f64 = 60.0;
/// Number of samples until the random motion has ended, and the time of the last one, in R/c.
const SAMPLE_COUNT: u32 = 2000;
const MOTION_DURATION: f64 = 200.0;

/// The disc: its body and its ground.
pub struct Disc {
    body: RigidBody,
    cell_count: usize,
    pub elements: Vec<ContactElement>,
}

impl Disc {
    /// Disc with this number of cells along its diameter.
    pub fn new(cell_count: usize) -> Result<Self> {
        let height = 0.1;
        let density = DISC_MASS_RATIO / (0.5 * TAU * height);
        let body = RigidBody::cylinder(1.0, height, density)?;
        let elements = Self::ground(&body, cell_count)?.elements().to_vec();
        Ok(Self { body, cell_count, elements })
    }

    fn ground(body: &RigidBody, cell_count: usize) -> Result<ElasticGround> {
        ElasticGround::under(Soil::new(1.0, 1.0 / 3.0, 1.0)?, body, cell_count)
    }

    /// Weights w with the motion Σ wᵢuᵢ of the disc, for each frequency, from the forces under a unit load on the disc.
    ///
    /// By reciprocity the weights are the forces on the cells divided by the load.
    pub fn weights(&self, component: usize) -> Result<Vec<Vec<Complex>>> {
        let load = |time: f64| (-((time - 3.0) / 0.6).powi(2)).exp();
        let row = self.body.displacement_at([0.0; 3])[component].clone();
        let mut simulation = Simulation::builder(WEIGHTS_TIME_STEP)
            .gravity(0.0)
            .structure(self.body.clone())
            .ground(Self::ground(&self.body, self.cell_count)?)
            .interface(Bonded)
            .load(Load::new(row, load))
            .build()?;
        let steps = simulation.steps_for(WEIGHTS_DURATION);
        let mut load_coefficients = [Complex::real(0.0); 3];
        let mut weights =
            vec![vec![Complex::real(0.0); self.elements.len()]; DISC_FREQUENCIES.len()];
        simulation.run(steps, |state| {
            let middle = state.time - 0.5 * WEIGHTS_TIME_STEP;
            for (k, frequency) in DISC_FREQUENCIES.iter().enumerate() {
                let phasor = Complex::polar(1.0, -frequency * middle);
                load_coefficients[k] += phasor.scale(load(middle));
                for ((weight, element), contact) in
                    weights[k].iter_mut().zip(&self.elements).zip(&state.contact)
                {
                    let traction = if component == 0 { contact.shear } else { -contact.pressure };
                    *weight += phasor.scale(element.area() * traction);
                }
            }
        })?;
        for (weights, load) in weights.iter_mut().zip(load_coefficients) {
            for weight in weights {
                *weight = *weight / load;
            }
        }
        Ok(weights)
    }

    /// Mean square of the disc's motion over that of the ground, w* Γ w.
    pub fn mean_square(&self, weights: &[Complex], frequency: f64) -> Result<f64> {
        let coherence = LucoWong::new(COHERENCE_PARAMETER, 1.0)?;
        let matrix = mean_coherence(&coherence, frequency / TAU, &self.elements)?;
        let mut sum = 0.0;
        for (row, weight) in matrix.chunks_exact(weights.len()).zip(weights) {
            for (value, other) in row.iter().zip(weights) {
                sum += value * (weight.re * other.re + weight.im * other.im);
            }
        }
        Ok(sum)
    }

    /// Incoherent motion of a seed, whose reference point is the centre of the disc.
    pub fn motion(&self, component: usize, seed: u64) -> Result<IncoherentMotion> {
        let record = pulse()?;
        let mut records = Triaxial::default();
        match component {
            0 => records.x = Some(record),
            _ => records.up = Some(record),
        }
        let incoherence = Incoherence::new(LucoWong::new(COHERENCE_PARAMETER, 1.0)?);
        let incoherence = incoherence.with_bandwidth(PHASE_BANDWIDTH / TAU)?.with_seed(seed);
        incoherence.motion(&records, &self.elements)
    }

    /// Motion of the disc over that of the record at each frequency, Σ wᵢuᵢ.
    pub fn response(
        &self,
        component: usize,
        weights: &[Vec<Complex>],
        seed: u64,
    ) -> Result<Vec<Complex>> {
        let motion = self.motion(component, seed)?;
        let record = motion.records()[0].clone();
        let mut responses = vec![Complex::real(0.0); DISC_FREQUENCIES.len()];
        let mut record_coefficients = responses.clone();
        for sample in 0..SAMPLE_COUNT {
            let time = RECORD_TIME_STEP * f64::from(sample);
            let displacements: Vec<f64> = self
                .elements
                .iter()
                .map(|element| {
                    let place = [element.center()[0], element.center()[1]];
                    motion.displacement_at(place, time)[component]
                })
                .collect();
            for (k, frequency) in DISC_FREQUENCIES.iter().enumerate() {
                let phasor = Complex::polar(1.0, -frequency * time);
                let record_motion = phasor.scale(record.at(time).displacement);
                record_coefficients[k] += record_motion;
                for (weight, displacement) in weights[k].iter().zip(&displacements) {
                    responses[k] += *weight * phasor.scale(*displacement);
                }
            }
        }
        Ok(responses.iter().zip(record_coefficients).map(|(u, record)| *u / record).collect())
    }

    /// Motion of the disc over that of the record at each frequency, from a run with the motion of a seed.
    pub fn run(&self, component: usize, seed: u64) -> Result<Vec<Complex>> {
        let motion = self.motion(component, seed)?;
        let record = motion.records()[0].clone();
        let mut simulation = Simulation::builder(WEIGHTS_TIME_STEP)
            .gravity(0.0)
            .structure(self.body.clone())
            .ground(Self::ground(&self.body, self.cell_count)?)
            .interface(Bonded)
            .motion(motion)
            .build()?;
        let steps = simulation.steps_for(MOTION_DURATION);
        let mut responses = vec![Complex::real(0.0); DISC_FREQUENCIES.len()];
        let mut record_coefficients = responses.clone();
        simulation.run(steps, |state| {
            for (k, frequency) in DISC_FREQUENCIES.iter().enumerate() {
                let phasor = Complex::polar(1.0, -frequency * state.time);
                let displacement = state.absolute_displacement()[component];
                responses[k] += phasor.scale(displacement);
                let record_motion = phasor.scale(record.at(state.time).displacement);
                record_coefficients[k] += record_motion;
            }
        })?;
        Ok(responses.iter().zip(record_coefficients).map(|(u, record)| *u / record).collect())
    }
}

/// Mean over seeds.
pub struct SampledMean {
    pub mean: f64,
    pub standard_error: f64,
}

/// Mean square of the disc's motion over seeds, for each frequency.
pub fn sampled_mean_squares(
    disc: &Disc,
    component: usize,
    weights: &[Vec<Complex>],
    seed_count: u64,
) -> Result<Vec<SampledMean>> {
    let mut squares = vec![vec![]; DISC_FREQUENCIES.len()];
    for seed in 0..seed_count {
        let responses = disc.response(component, weights, seed)?;
        for (squares, response) in squares.iter_mut().zip(responses) {
            squares.push(response.squared_modulus());
        }
    }
    let count = seed_count as f64;
    Ok(squares
        .iter()
        .map(|squares| {
            let mean = squares.iter().sum::<f64>() / count;
            let deviation: f64 = squares.iter().map(|square| (square - mean).powi(2)).sum();
            SampledMean { mean, standard_error: (deviation / ((count - 1.0) * count)).sqrt() }
        })
        .collect())
}

/// Ricker pulse of displacement with the peak of its spectrum at a₀ = 2, at rest before and after.
fn pulse() -> Result<Record> {
    Record::from_fn(RECORD_TIME_STEP, 2.0 * PULSE_TIME, |time| {
        let x = time - PULSE_TIME;
        (4.0 * x.powi(4) - 12.0 * x * x + 3.0) * (-x * x).exp()
    })
}
