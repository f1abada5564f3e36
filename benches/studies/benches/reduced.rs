//! A structure of 51 102 degrees of freedom, in full and reduced to its contact nodes and a few modes.
//!
//! Elements per second are steps per second: with steps of 0.01 s, 100 are real time. All models
//! compute the same strong half second of El Centro repeatedly.

use std::hint::black_box;
use std::time::{Duration, Instant};

use basemat::coupled::{Checkpoint, Coordinates};
use basemat::structure::{CraigBampton, DofCombination, MatrixModel};
use basemat::{Result, Simulation};
use basemat_problems::tower::{TowerMatrices, damped, scene};
use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// Steps before the timed steps; the base slides and uplifts by then.
const UNTIMED_STEPS: usize = 200;
const TIMED_STEPS: usize = 50;

/// The full model, and the sway of its top.
fn full_model() -> Result<(MatrixModel, DofCombination)> {
    let TowerMatrices { mass, stiffness, base, top } = TowerMatrices::new()?;
    Ok((damped(mass, stiffness, base)?, top))
}

/// A simulation that computes the same steps repeatedly.
struct RepeatedSteps {
    simulation: Simulation,
    start: Checkpoint,
}

impl RepeatedSteps {
    fn new(mut simulation: Simulation) -> Result<Self> {
        simulation.run(UNTIMED_STEPS, |_| {})?;
        let start = simulation.checkpoint()?;
        Ok(Self { simulation, start })
    }

    /// Time of the steps without the return to their start.
    fn march(&mut self, repetitions: u64) -> Result<Duration> {
        let mut total = Duration::ZERO;
        for _ in 0..repetitions {
            self.simulation.resume(&self.start)?;
            let start_time = Instant::now();
            for _ in 0..TIMED_STEPS {
                black_box(self.simulation.step()?);
            }
            total += start_time.elapsed();
        }
        Ok(total)
    }
}

fn steps(criterion: &mut Criterion) {
    let (model, top) = full_model().expect("a valid tower");
    let mut group = criterion.benchmark_group("steps of 0.01 s, tower of 51102 degrees of freedom");
    group.throughput(Throughput::Elements(TIMED_STEPS as u64)).sample_size(10);
    group.warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(2));
    let mut cases = Vec::new();
    for modes in [10, 20, 40, 80] {
        let reduced_structure =
            CraigBampton::new(modes).reduce(model.clone()).expect("a valid model");
        let reduced_top =
            reduced_structure.recovery().row(&top).expect("the top is a degree of freedom");
        let simulation = scene(reduced_structure, reduced_top, Coordinates::Auto);
        cases.push((BenchmarkId::new("modes", modes), simulation));
    }
    cases.push((BenchmarkId::new("modes", "all"), scene(model, top, Coordinates::Physical)));
    for (name, simulation) in cases {
        let mut repeated_steps = simulation.and_then(RepeatedSteps::new).expect("a valid scene");
        group.bench_function(name, |bencher| {
            bencher.iter_custom(|times| repeated_steps.march(times).expect("every step is solved"));
        });
    }
    group.finish();
}

/// Time of a reduction, once for every model.
fn reduction(criterion: &mut Criterion) {
    let model = full_model().expect("a valid tower").0;
    let mut group = criterion.benchmark_group("reduction, tower of 51102 degrees of freedom");
    group.sample_size(10).warm_up_time(Duration::from_secs(1));
    group.bench_function(BenchmarkId::new("modes", 20), |bencher| {
        bencher.iter_batched(
            || model.clone(),
            |model| black_box(CraigBampton::new(20).reduce(model).expect("a valid model")),
            BatchSize::PerIteration,
        );
    });
    group.finish();
}

criterion_group!(benches, steps, reduction);
criterion_main!(benches);
