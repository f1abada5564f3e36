//! GOAL: while a store makes a kernel, its sources and other threads can use it without deadlock.
//! SCENE: sources that request kernels from the store of their own kernel; up to sixteen threads.
//! REFERENCE: the number of kernels made; an end within ten seconds.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, mpsc};
use std::time::Duration;

use basemat::bem::{
    ContactElement, Ground, PatchKernel, SharedKernels, Strip, WeightsGround, WeightsSource,
};
use basemat::history::ConvolutionWeights;
use basemat::{Error, Result, unobserved};

use super::scene::soil;

/// A source for which the store makes the kernels of `required_sources` first.
#[derive(Clone)]
struct DependentSource {
    number: f64,
    required_sources: Vec<DependentSource>,
    kernels: SharedKernels,
    /// Number of kernels that this source has made.
    kernel_count: Arc<AtomicUsize>,
}

impl DependentSource {
    fn new(kernels: &SharedKernels, number: f64) -> Self {
        let kernel_count = Arc::default();
        Self { number, required_sources: vec![], kernels: kernels.clone(), kernel_count }
    }

    /// A source that depends on another of this number.
    fn depending_on(kernels: &SharedKernels, number: f64, other: f64) -> Self {
        Self { required_sources: vec![Self::new(kernels, other)], ..Self::new(kernels, number) }
    }

    fn prepare(&self) -> Result<()> {
        let elements = Strip::uniform(-1.0..1.0, 2)?.elements();
        let ground = WeightsGround::new(self.clone(), elements)?;
        ground.with_shared_kernels(&self.kernels).prepare(1e-3, None, &mut unobserved)
    }
}

impl WeightsSource for DependentSource {
    fn kernel(
        &self,
        elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<dyn ConvolutionWeights>> {
        self.kernel_count.fetch_add(1, Ordering::Relaxed);
        self.required_sources.iter().try_for_each(DependentSource::prepare)?;
        Ok(Arc::new(PatchKernel::new(soil(), elements.to_vec(), time_step)?))
    }

    fn static_compliance(&self, _: &[ContactElement], matrix: &mut [f64]) -> Result<()> {
        matrix.fill(0.0);
        Ok(())
    }

    fn identity(&self) -> Option<Vec<f64>> {
        Some(vec![self.number])
    }
}

/// Results of `tasks`, each in a new thread, within ten seconds.
fn results_in_time<T: Send + 'static>(tasks: Vec<Box<dyn FnOnce() -> T + Send>>) -> Vec<T> {
    let mut receivers = Vec::new();
    for task in tasks {
        let (sender, receiver) = mpsc::channel();
        std::thread::spawn(move || sender.send(task()));
        receivers.push(receiver);
    }
    let mut results = Vec::new();
    for receiver in receivers {
        results.push(receiver.recv_timeout(Duration::from_secs(10)).expect("a deadlock"));
    }
    results
}

#[track_caller]
fn assert_errors(result: &Result<()>) {
    let Err(Error::Scene { quantity: "kernel source", needed }) = result else {
        panic!("{result:?}")
    };
    assert!(needed.contains("that it is computing"), "{needed}");
}

#[test]
fn a_source_may_request_others_from_its_store() {
    let kernels = SharedKernels::default();
    let mut source = DependentSource::new(&kernels, 1.0);
    source.required_sources =
        vec![DependentSource::new(&kernels, 2.0), DependentSource::new(&kernels, 3.0)];
    let results = results_in_time(vec![Box::new(move || (source.prepare(), source.prepare()))]);
    assert_eq!(results, [(Ok(()), Ok(()))]);
    assert_eq!(kernels.count(), 3);
}

#[test]
fn a_source_that_requests_itself_is_an_error() {
    let kernels = SharedKernels::default();
    let first = DependentSource::new(&kernels, 1.0);
    let first_source = DependentSource::depending_on(&kernels, 1.0, 1.0);
    let second_source = DependentSource::depending_on(&kernels, 2.0, 1.0);
    let indirect = DependentSource { required_sources: vec![second_source], ..first.clone() };
    for source in [first_source, indirect] {
        assert_errors(&results_in_time(vec![Box::new(move || source.prepare())])[0]);
        assert_eq!(kernels.count(), 0);
    }
    // The store still makes the kernel afterwards.
    assert_eq!(results_in_time(vec![Box::new(move || first.prepare())]), [Ok(())]);
}

#[test]
fn a_kernel_that_another_thread_computes_is_shared() {
    let kernels = SharedKernels::default();
    let source = DependentSource::new(&kernels, 1.0);
    let mut tasks: Vec<Box<dyn FnOnce() -> Result<()> + Send>> = Vec::new();
    for _ in 0..16 {
        let source = source.clone();
        tasks.push(Box::new(move || source.prepare()));
    }
    assert!(results_in_time(tasks).iter().all(Result::is_ok));
    assert_eq!(source.kernel_count.load(Ordering::Relaxed), 1);
    assert_eq!(kernels.count(), 1);
}

/// Prepares a ground of this source with the kernels of a store.
fn prepare_ground(source: impl WeightsSource + 'static, kernels: &SharedKernels) -> Result<()> {
    let elements = Strip::uniform(-1.0..1.0, 2)?.elements();
    let ground = WeightsGround::new(source, elements)?;
    ground.with_shared_kernels(kernels).prepare(1e-3, None, &mut unobserved)
}

/// A kernel whose source panics is made by the next source of the same identity.
#[test]
fn a_source_that_panics_leaves_its_kernel_to_the_next() {
    let kernels = SharedKernels::default();
    let source = DependentSource::new(&kernels, 4.0);
    let panicking = PanickingSource(source.clone());
    let store = kernels.clone();
    let thread = std::thread::spawn(move || prepare_ground(panicking, &store));
    assert!(thread.join().is_err());
    let succeeding = PanickingSource(DependentSource { number: -4.0, ..source });
    let store = kernels.clone();
    let results = results_in_time(vec![Box::new(move || prepare_ground(succeeding, &store))]);
    assert_eq!(results, [Ok(())]);
    assert_eq!(kernels.count(), 1);
}

/// Panics while it makes a kernel whose number is positive; its identity has no sign.
struct PanickingSource(DependentSource);

impl WeightsSource for PanickingSource {
    fn kernel(
        &self,
        elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<dyn ConvolutionWeights>> {
        assert!(self.0.number < 0.0, "a panic on purpose");
        self.0.kernel(elements, time_step)
    }

    fn static_compliance(&self, elements: &[ContactElement], matrix: &mut [f64]) -> Result<()> {
        self.0.static_compliance(elements, matrix)
    }

    fn identity(&self) -> Option<Vec<f64>> {
        Some(vec![self.0.number.abs()])
    }
}
