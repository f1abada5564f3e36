//! GOAL: the full-plane ground assesses the growth of its march before it is prepared.
//! SCENE: four unit elements with three free elements on either side, time steps with growth and without.
//! REFERENCE: growth of the march itself; the number of coefficients requested.

use basemat::bem::Ground;
use basemat::bem::GroundError;
use basemat::bem::full_plane::{
    BoundaryKernel, ConvolutionQuadrature, CqMethod, FullPlaneGround, Segment, TimeKernel,
};
use basemat::interface::Bonded;
use basemat::structure::RigidBlock;
use basemat::{Error, Result, Simulation, unobserved};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use super::unit_soil;
use basemat_problems::{assert_close, dense::largest};

/// Four unit elements with three free elements on either side.
fn ground() -> FullPlaneGround {
    FullPlaneGround::strip(unit_soil(), -2.0..2.0, 4, 3).unwrap()
}

/// Time kernel that counts the requests for coefficients.
struct CountingKernel {
    inner_kernel: TimeKernel,
    calls: Arc<AtomicUsize>,
}

impl BoundaryKernel for CountingKernel {
    fn segments(&self) -> &[Segment] {
        self.inner_kernel.segments()
    }

    fn coefficients(&self, lag: usize, g: &mut [f64], h: &mut [f64]) -> Result<()> {
        self.calls.fetch_add(1, Relaxed);
        self.inner_kernel.coefficients(lag, g, h)
    }
}

/// The ground with a kernel that counts its requests in `calls`.
fn counting_ground(calls: &Arc<AtomicUsize>) -> FullPlaneGround {
    let calls = Arc::clone(calls);
    ground().with_kernel(move |segments, soil, step| {
        let inner_kernel = TimeKernel::new(soil, segments, step)?;
        Ok(Box::new(CountingKernel { inner_kernel, calls: Arc::clone(&calls) })
            as Box<dyn BoundaryKernel>)
    })
}

/// Number of requests for coefficients while the ground is prepared.
fn requests_of_preparation(
    calls: &AtomicUsize,
    ground: &mut FullPlaneGround,
    time_step: f64,
) -> usize {
    calls.store(0, Relaxed);
    ground.prepare(time_step, None, &mut unobserved).unwrap();
    calls.load(Relaxed)
}

/// Largest displacement of a traction-free march after a push on one element.
fn largest_displacement(ground: &mut FullPlaneGround, steps: usize) -> f64 {
    let size = 2 * ground.elements().len();
    let mut history = vec![0.0; size];
    let mut push = vec![0.0; size];
    push[0] = 1.0;
    for step in 0..steps {
        ground.history(&mut history).unwrap();
        ground.commit(if step == 0 { &push } else { &[] });
    }
    largest(ground.displacement())
}

/// GOAL: β = 1/2, the step of the paper, is an error with the growth of a march of this ground.
#[test]
fn growth_is_an_error_and_is_that_of_the_march() {
    // The time step has β = 1/2.
    let Err(Error::Ground(GroundError::Unstable { growth_per_step, growing_modes })) =
        ground().prepare(0.25, None, &mut unobserved)
    else {
        panic!("prepared")
    };
    assert!(growing_modes > 0);
    let mut ground_with_growth = ground().allow_growth();
    ground_with_growth.prepare(0.25, None, &mut unobserved).unwrap();
    // With the base uplifted, then bonded.
    let assessed =
        ground_with_growth.assess(0.25, 1e-4).unwrap().map(|state| state.growth_per_step);
    assert_eq!(assessed[0].max(assessed[1]), growth_per_step);
    // The base is free of traction, so that the growth is that of the uplifted state.
    let mut ground_of_the_longer_run = ground().allow_growth();
    ground_of_the_longer_run.prepare(0.25, None, &mut unobserved).unwrap();
    let early_displacement = largest_displacement(&mut ground_with_growth, 400);
    let late_displacement = largest_displacement(&mut ground_of_the_longer_run, 800);
    assert_close(
        "growth",
        ((late_displacement / early_displacement).ln() / 400.0).exp_m1(),
        assessed[0],
        0.0,
        0.02,
    );
}

/// GOAL: a bounded time step is accepted, and convolution quadrature is bounded at the time step for
/// which the time kernel is an error on the same mesh.
#[test]
fn bounded_grounds_are_prepared_and_decay() {
    let mut long_step = ground();
    long_step.prepare(1.0, None, &mut unobserved).unwrap();
    let mut quadrature = ground().with_kernel(|segments, soil, step| {
        let kernel = ConvolutionQuadrature::new(soil, segments, step, CqMethod::Bdf2)?;
        Ok(Box::new(kernel) as Box<dyn BoundaryKernel>)
    });
    quadrature.prepare(0.25, None, &mut unobserved).unwrap();
    for ground in [&mut long_step, &mut quadrature] {
        let early_displacement = largest_displacement(ground, 200);
        assert!(largest_displacement(ground, 1000) < early_displacement);
    }
}

/// GOAL: the builder of a simulation returns an error for growth.
#[test]
fn a_simulation_with_growth_is_an_error_unless_allowed() {
    fn build(ground: impl Ground, time_step: f64) -> Result<Simulation> {
        Simulation::builder(time_step)
            .structure(RigidBlock::new(4.0, 2.0, 1.0).unwrap())
            .ground(ground)
            .interface(Bonded)
            .gravity(0.0)
            .build()
    }
    let result = build(ground(), 0.25).err().unwrap();
    assert!(matches!(result, Error::Ground(GroundError::Unstable { .. })));
    assert!(result.to_string().contains("per step"), "{result}");
    assert!(build(ground().allow_growth(), 0.25).is_ok());
    let boxed: Box<dyn Ground> = Box::new(ground());
    assert!(build(boxed, 1.0).is_ok());
}

/// GOAL: an assessment is computed once, and not at all when growth is allowed.
#[test]
fn coefficients_are_requested_once() {
    let calls = Arc::new(AtomicUsize::new(0));
    let mut ground = counting_ground(&calls);
    let first = requests_of_preparation(&calls, &mut ground, 1.0);
    // Both states use the same lags: 64 times a power of two, and a few more for their tail.
    assert!((first / 64).is_power_of_two() && first % 64 < 32, "{first}");
    assert_eq!(requests_of_preparation(&calls, &mut ground, 1.0), 1);
    calls.store(0, Relaxed);
    assert!(ground.prepare(1.25, None, &mut unobserved).is_err());
    assert!(calls.load(Relaxed) > 32);
    // Another kernel needs another assessment.
    let mut ground = ground.with_kernel(|segments, soil, step| {
        Ok(Box::new(TimeKernel::new(soil, segments, step)?) as Box<dyn BoundaryKernel>)
    });
    assert!(ground.prepare(0.25, None, &mut unobserved).is_err());
    let mut ground = counting_ground(&calls).allow_growth();
    assert_eq!(requests_of_preparation(&calls, &mut ground, 0.25), 1);
}

/// GOAL: growth below the smallest growth of interest counts as bounded.
#[test]
fn growth_below_the_smallest_of_interest_is_bounded() {
    let assessed = ground().assess(0.25, 0.25).unwrap();
    assert!(assessed[0].is_bounded() && assessed[1].is_bounded());
    for growth in [0.0, 1.0, f64::NAN] {
        assert!(matches!(ground().assess(1.0, growth), Err(Error::Input { .. })), "{growth}");
    }
    for time_step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let result = ground().assess(time_step, 1e-4);
        assert!(matches!(result, Err(Error::Input { .. })), "{time_step}");
    }
}
