//! Errors of the full-plane ground by its truncated free surface.

use basemat::bem::full_plane::{BoundaryKernel, ConvolutionQuadrature, CqMethod, FullPlaneGround};
use basemat::bem::{ElasticGround, Grading, Ground, Strip};
use basemat::coupled::SimulationBuilder;
use basemat::interface::Coulomb;
use basemat::motion::RickerDisplacement;
use basemat::structure::RigidBlock;
use basemat::{Simulation, Soil};

use crate::impedance::{ForceSampling, impedances};
use crate::rigid_strip::DrivenStrip;
use crate::sampled_block::{SampledSeries, distance, sample, under_pulse};
use crate::series::{RelativeError, nearest_integer};
use crate::table;

/// Full-plane elements under a strip of half width 1.
#[derive(Debug, Clone, Copy)]
pub struct FullPlaneMesh {
    pub elements: usize,
    /// Elements of the free surface on either side.
    pub free: usize,
    /// β = c₁Δt/l.
    pub beta: f64,
    /// Convolution quadrature; the time kernel if `None`.
    pub quadrature: Option<CqMethod>,
}

impl FullPlaneMesh {
    pub fn time_step(&self, soil: Soil) -> f64 {
        self.beta * 2.0 / self.elements as f64 / soil.pressure_wave_speed()
    }

    /// The ground, without an assessment of its growth.
    pub fn ground(&self, soil: Soil) -> FullPlaneGround {
        let ground = FullPlaneGround::strip(soil, -1.0..1.0, self.elements, self.free).unwrap();
        let ground = ground.allow_growth();
        let Some(method) = self.quadrature else { return ground };
        ground.with_kernel(move |segments, soil, step| {
            let kernel = ConvolutionQuadrature::new(soil, segments, step, method)?;
            Ok(Box::new(kernel) as Box<dyn BoundaryKernel>)
        })
    }
}

/// `[hh, vv, rr, hr]`, real and imaginary part, per frequency.
pub type Impedances = Vec<[[f64; 2]; 4]>;

/// Frequencies 0.1 ≤ a₀ ≤ 4 and impedances of the bonded strip, from its table.
pub fn tabled(name: &str) -> (Vec<f64>, Impedances) {
    let columns =
        ["a0", "re_khh", "im_khh", "re_kvv", "im_kvv", "re_krr", "im_krr", "re_khr", "im_khr"];
    let rows = table(&format!("strip_bonded_nu{name}_xi00.csv")).rows(columns).into_iter();
    rows.filter(|row| (0.0999..4.0001).contains(&row[0]))
        .map(|row| (row[0], std::array::from_fn(|k| [row[2 * k + 1], row[2 * k + 2]])))
        .unzip()
}

/// Impedances of the bonded strip from a march of 60 shear wave travel times.
pub fn bonded_impedances(poisson: f64, mesh: FullPlaneMesh, frequencies: &[f64]) -> Impedances {
    let soil = Soil::new(1.0, poisson, 1.0).unwrap();
    let time_step = mesh.time_step(soil);
    // Convolution quadrature takes point values.
    let sampling = if mesh.quadrature.is_some() { ForceSampling::End } else { ForceSampling::Mean };
    impedances(
        |tractions| DrivenStrip::on(Box::new(mesh.ground(soil)), time_step, tractions),
        time_step,
        sampling,
        true,
        frequencies,
    )
}

/// Distances of `[hh, vv, rr, hr]`: root mean squares of the error, relative to that of the modulus.
pub fn distances(computed: &Impedances, expected: &Impedances) -> [f64; 4] {
    let mut errors = [RelativeError::default(); 4];
    for (computed, expected) in computed.iter().zip(expected) {
        for k in 0..4 {
            for part in 0..2 {
                errors[k].add(computed[k][part], expected[k][part]);
            }
        }
    }
    errors.map(RelativeError::relative)
}

/// Distances of the bonded strip from its table.
pub fn impedance_errors(name: &str, poisson: f64, mesh: FullPlaneMesh) -> [f64; 4] {
    let (frequencies, expected) = tabled(name);
    distances(&bonded_impedances(poisson, mesh, &frequencies), &expected)
}

/// Base displacement, rotation and base shear of a bonded rigid block under a Ricker pulse.
///
/// Width and height are 2, the density is 1. There is a sample every `interval` steps; the shear is the mean over them.
fn block_series(ground: impl Ground + 'static, time_step: f64, interval: usize) -> SampledSeries {
    let block = RigidBlock::new(2.0, 2.0, 1.0).unwrap();
    let mut simulation = under_pulse(block, ground, time_step);
    sample(&mut simulation, nearest_integer(20.0 / time_step), interval).unwrap().0
}

/// Relative distance of the block's `[u_base, theta, V]` on the full plane from that on a fine
/// half-plane (32 graded elements, an eighth of the step).
pub fn block_errors(mesh: FullPlaneMesh) -> [f64; 3] {
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap();
    let time_step = mesh.time_step(soil);
    let strip = Strip::new(-1.0..1.0, 32, Grading::Cosine).unwrap();
    let half_plane = ElasticGround::new(soil, strip).unwrap();
    let computed = block_series(mesh.ground(soil), time_step, 1);
    distance(&computed, &block_series(half_plane, time_step / 8.0, 8))
}

/// Mean slip and largest uplifted fraction of a block of height 4 under its weight that rocks and
/// slides, on the full plane and on a half-plane with the same elements and step.
pub fn rocking(elements: usize, free: usize, beta: f64) -> [(Vec<f64>, f64); 2] {
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap();
    let time_step = beta * 2.0 / elements as f64 / soil.pressure_wave_speed();
    let full_plane = FullPlaneGround::strip(soil, -1.0..1.0, elements, free).unwrap();
    let strip = Strip::uniform(-1.0..1.0, elements).unwrap();
    let half_plane = ElasticGround::new(soil, strip).unwrap();
    [
        rocking_on(Simulation::builder(time_step).ground(full_plane), time_step),
        rocking_on(Simulation::builder(time_step).ground(half_plane), time_step),
    ]
}

/// Mean slip and largest uplifted fraction of the block on a ground.
fn rocking_on(builder: SimulationBuilder, time_step: f64) -> (Vec<f64>, f64) {
    let mut simulation = builder
        .structure(RigidBlock::new(2.0, 4.0, 0.5).unwrap())
        .interface(Coulomb::new(0.5).unwrap())
        .motion(RickerDisplacement::new(1.0, 1.5, 6.0).unwrap())
        .gravity(0.1)
        .build()
        .unwrap();
    let mut slip = Vec::new();
    let run = simulation
        .run(nearest_integer(14.0 / time_step), |state| {
            slip.push(state.mean_slip);
            for contact in &state.contact {
                assert!(contact.pressure >= -1e-9 && contact.gap >= -1e-9);
                assert!(contact.shear.abs() <= 0.5 * contact.pressure + 1e-9);
            }
        })
        .unwrap();
    assert!(run.energy_error < 1e-9, "energy balance open by {:.1e}", run.energy_error);
    (slip, run.whole.uplifted_fraction.largest().value)
}
