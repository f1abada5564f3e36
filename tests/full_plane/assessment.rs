//! GOAL: the full-plane ground assesses its march before it is prepared. SCENE: four unit elements
//! with three free ones on either side, steps that grow and steps that do not. REFERENCE: growth of
//! the march itself; the number of coefficients requested.

use basemat::bem::GroundError;
use basemat::bem::full_plane::{
    BoundaryKernel, ConvolutionQuadrature, CqMethod, FullPlaneGround, GroundStability, Segment,
    TimeKernel,
};
use basemat::bem::{ElasticGround, Ground, Strip};
use basemat::interface::Bonded;
use basemat::structure::RigidBlock;
use basemat::{Error, Result, Simulation, unobserved};
use std::any::Any;
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
    let found = allowed.stability().unwrap();
    assert_eq!(found.worst().growth_per_step, growth_per_step);
    assert!(found.require_bounded().is_err());
    // The base is free of traction: the growth of the uplifted state.
    let uplifted = found.uplifted.growth_per_step;
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
        let found = ground.stability().unwrap();
        assert!(found.is_bounded() && found.require_bounded().is_ok());
        assert!(found.bonded.passivity.is_some() && found.uplifted.passivity.is_none());
        assert!(found.to_string().starts_with("uplifted: bounded"), "{found}");
        assert!(found.to_string().contains("\nbonded: bounded"), "{found}");
        let early = marched(ground, 200);
        assert!(marched(ground, 1000) < early);
    }
}

/// The report of a simulation's full-plane ground, boxed or not.
fn stability(mut ground: &dyn Any) -> Option<&GroundStability> {
    if let Some(boxed) = ground.downcast_ref::<Box<dyn Ground>>() {
        ground = boxed.as_ref();
    }
    ground.downcast_ref::<FullPlaneGround>().expect("the ground that was given").stability()
}

/// GOAL: building a simulation is where growth is found, and where the report can be had.
#[test]
fn a_simulation_is_refused_or_reports() {
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
    let allowed = build(ground().allow_growth(), 0.25).unwrap();
    assert!(!stability(allowed.ground()).unwrap().is_bounded());
    let boxed: Box<dyn Ground> = Box::new(ground());
    let bounded = build(boxed, 1.0).unwrap();
    assert!(stability(bounded.ground()).unwrap().is_bounded());
    let skipped = build(ground().skip_assessment(), 0.25).unwrap();
    assert!(stability(skipped.ground()).is_none());
    // A ground that is stable for every step is of another type, and has nothing to report.
    let half = build(
        ElasticGround::new(unit_soil(), Strip::uniform(-2.0..2.0, 4).unwrap()).unwrap(),
        0.25,
    )
    .unwrap();
    assert!(!(half.ground() as &dyn Any).is::<FullPlaneGround>());
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
    let mut ground = counting(&calls).allow_growth();
    let first = taken(&mut ground, 1.0);
    let lags = ground.stability().unwrap().uplifted.summed_lags;
    // Both states from the same lags, and a few more for their tail.
    assert!(first >= lags && first < lags + 32, "{first} for {lags} lags");
    assert_eq!(taken(&mut ground, 1.0), 1);
    assert!(taken(&mut ground, 1.25) > 32);
    // Another growth to look for, and another kernel, need another assessment.
    let mut ground = ground.with_growth_over(500);
    assert!(taken(&mut ground, 1.25) > 32);
    assert_eq!(ground.stability().unwrap().bonded.smallest_growth, 1.0 / 500.0);
    calls.store(0, Relaxed);
    let before = ground.assess(1.5).unwrap().clone();
    assert!(calls.load(Relaxed) > 32);
    assert_eq!(taken(&mut ground, 1.5), 1);
    assert_eq!(ground.stability(), Some(&before));
    let mut ground = ground.skip_assessment();
    assert_eq!(taken(&mut ground, 1.0), 1);
    assert!(ground.stability().is_none());
}

/// GOAL: what grows too slowly for the run is let pass.
#[test]
fn expected_steps_set_what_counts_as_growth() {
    let mut short = ground().with_growth_over(4);
    short.prepare(0.25, None, &mut unobserved).unwrap();
    assert!(short.stability().unwrap().is_bounded());
    for steps in [0, 1, usize::MAX] {
        assert!(ground().with_growth_over(steps).assess(1.0).is_ok(), "{steps}");
    }
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(ground().assess(step), Err(Error::Input { .. })), "{step}");
    }
}
