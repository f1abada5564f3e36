//! GOAL: the full-plane ground assesses its march before it is prepared. SCENE: four unit elements
//! with three free ones on either side, steps that grow and steps that do not. REFERENCE: growth of
//! the march itself; the number of coefficients requested.

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
use basemat_problems::close;

/// Four unit elements with three free ones on either side.
fn ground() -> FullPlaneGround {
    FullPlaneGround::strip(unit_soil(), -2.0..2.0, 4, 3).unwrap()
}

/// The time kernel; counts the calls for coefficients.
struct Counting {
    inner: TimeKernel,
    calls: Arc<AtomicUsize>,
}

impl BoundaryKernel for Counting {
    fn segments(&self) -> &[Segment] {
        self.inner.segments()
    }

    fn coefficients(&self, lag: usize, g: &mut [f64], h: &mut [f64]) -> Result<()> {
        self.calls.fetch_add(1, Relaxed);
        self.inner.coefficients(lag, g, h)
    }
}

fn counting(calls: &Arc<AtomicUsize>) -> FullPlaneGround {
    let calls = Arc::clone(calls);
    ground().with_kernel(move |segments, soil, step| {
        let inner = TimeKernel::new(soil, segments, step)?;
        Ok(Box::new(Counting { inner, calls: Arc::clone(&calls) }) as Box<dyn BoundaryKernel>)
    })
}

/// Largest displacement of a traction-free march after a push on one element.
fn marched(ground: &mut FullPlaneGround, steps: usize) -> f64 {
    let size = 2 * ground.elements().len();
    let mut history = vec![0.0; size];
    let mut push = vec![0.0; size];
    push[0] = 1.0;
    for step in 0..steps {
        ground.history(&mut history).unwrap();
        ground.commit(if step == 0 { &push } else { &[] });
    }
    ground.displacement().iter().fold(0.0_f64, |m, x| m.max(x.abs()))
}

/// GOAL: the step of the paper is refused, with the growth that a march of this ground shows.
#[test]
fn growth_is_refused_and_is_that_of_the_march() {
    // β = 1/2.
    let Err(Error::Ground(GroundError::Unstable { growth_per_step, growing_modes })) =
        ground().prepare(0.25, None, &mut unobserved)
    else {
        panic!("prepared")
    };
    assert!(growing_modes > 0);
    let mut allowed = ground().allow_growth();
    allowed.prepare(0.25, None, &mut unobserved).unwrap();
    let [uplifted, bonded] = allowed.assess(0.25, 1e-4).unwrap().map(|own| own.growth_per_step);
    assert_eq!(uplifted.max(bonded), growth_per_step);
    // The base is free of traction: the growth of the uplifted state.
    let mut again = ground().allow_growth();
    again.prepare(0.25, None, &mut unobserved).unwrap();
    let (early, late) = (marched(&mut allowed, 400), marched(&mut again, 800));
    close("growth", ((late / early).ln() / 400.0).exp_m1(), uplifted, 0.0, 0.02);
}

/// GOAL: a bounded step marches, and the same mesh with another kernel is bounded at the step
/// that the time kernel is refused for.
#[test]
fn bounded_grounds_are_prepared_and_decay() {
    let mut long = ground();
    long.prepare(1.0, None, &mut unobserved).unwrap();
    let mut quadrature = ground().with_kernel(|segments, soil, step| {
        let kernel = ConvolutionQuadrature::new(soil, segments, step, CqMethod::Bdf2)?;
        Ok(Box::new(kernel) as Box<dyn BoundaryKernel>)
    });
    quadrature.prepare(0.25, None, &mut unobserved).unwrap();
    for ground in [&mut long, &mut quadrature] {
        let early = marched(ground, 200);
        assert!(marched(ground, 1000) < early);
    }
}

/// GOAL: building a simulation is where growth is found.
#[test]
fn a_simulation_is_refused_unless_allowed() {
    fn build(ground: impl Ground, step: f64) -> Result<Simulation> {
        Simulation::builder(step)
            .structure(RigidBlock::new(4.0, 2.0, 1.0).unwrap())
            .ground(ground)
            .interface(Bonded)
            .gravity(0.0)
            .build()
    }
    let refused = build(ground(), 0.25).err().unwrap();
    assert!(matches!(refused, Error::Ground(GroundError::Unstable { .. })));
    assert!(refused.to_string().contains("per step"), "{refused}");
    assert!(build(ground().allow_growth(), 0.25).is_ok());
    let boxed: Box<dyn Ground> = Box::new(ground());
    assert!(build(boxed, 1.0).is_ok());
}

/// GOAL: an assessment is paid for once, and not at all when it is skipped.
#[test]
fn coefficients_are_asked_for_once() {
    let calls = Arc::new(AtomicUsize::new(0));
    let taken = |ground: &mut FullPlaneGround, step: f64| {
        calls.store(0, Relaxed);
        ground.prepare(step, None, &mut unobserved).unwrap();
        calls.load(Relaxed)
    };
    let mut ground = counting(&calls);
    let first = taken(&mut ground, 1.0);
    // Both states from the same lags, 64 or twice as many and so on, and a few more for their tail.
    assert!((first / 64).is_power_of_two() && first % 64 < 32, "{first}");
    assert_eq!(taken(&mut ground, 1.0), 1);
    calls.store(0, Relaxed);
    assert!(ground.prepare(1.25, None, &mut unobserved).is_err());
    assert!(calls.load(Relaxed) > 32);
    // Another kernel needs another assessment.
    let mut ground = ground.with_kernel(|segments, soil, step| {
        Ok(Box::new(TimeKernel::new(soil, segments, step)?) as Box<dyn BoundaryKernel>)
    });
    assert!(ground.prepare(0.25, None, &mut unobserved).is_err());
    let mut ground = counting(&calls).allow_growth();
    assert_eq!(taken(&mut ground, 0.25), 1);
}

/// GOAL: what grows too slowly for the run is let pass.
#[test]
fn the_smallest_growth_is_chosen() {
    let [uplifted, bonded] = ground().assess(0.25, 0.25).unwrap();
    assert!(uplifted.is_bounded() && bonded.is_bounded());
    for growth in [0.0, 1.0, f64::NAN] {
        assert!(matches!(ground().assess(1.0, growth), Err(Error::Input { .. })), "{growth}");
    }
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(ground().assess(step, 1e-4), Err(Error::Input { .. })), "{step}");
    }
}
