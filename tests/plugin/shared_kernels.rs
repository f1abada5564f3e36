//! GOAL: a store of kernels may be asked while one of them is made, by its source and by other
//! threads, and never stands still.
//! SCENE: sources that take kernels from the store that keeps their own; two threads.
//! REFERENCE: the number of kernels made; an end within ten seconds.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Barrier, mpsc};
use std::time::Duration;

use basemat::bem::{
    ContactElement, Ground, PatchKernel, SharedKernels, Strip, WeightsGround, WeightsSource,
};
use basemat::history::ConvolutionWeights;
use basemat::{Error, Result, unobserved};

use super::scene::soil;

/// A source that first has the store make the kernels of `others`, and `meets` another thread.
#[derive(Clone)]
struct Asking {
    number: f64,
    others: Vec<Asking>,
    kernels: SharedKernels,
    made: Arc<AtomicUsize>,
    meets: Option<Arc<Barrier>>,
}

impl Asking {
    fn new(kernels: &SharedKernels, number: f64) -> Self {
        let made = Arc::default();
        Self { number, others: vec![], kernels: kernels.clone(), made, meets: None }
    }

    fn prepare(&self) -> Result<()> {
        let elements = Strip::uniform(-1.0..1.0, 2)?.elements();
        let ground = WeightsGround::new(self.clone(), elements)?;
        ground.with_shared_kernels(&self.kernels).prepare(1e-3, None, &mut unobserved)
    }
}

impl WeightsSource for Asking {
    fn kernel(
        &self,
        elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<dyn ConvolutionWeights>> {
        self.made.fetch_add(1, Ordering::Relaxed);
        if let Some(barrier) = &self.meets {
            barrier.wait();
        }
        self.others.iter().try_for_each(Asking::prepare)?;
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

/// Results of `works`, each run on a thread of its own.
fn in_time<T: Send + 'static>(works: Vec<Box<dyn FnOnce() -> T + Send>>) -> Vec<T> {
    let receivers: Vec<_> = works
        .into_iter()
        .map(|work| {
            let (sender, receiver) = mpsc::channel();
            std::thread::spawn(move || sender.send(work()));
            receiver
        })
        .collect();
    let wait = |receiver: mpsc::Receiver<T>| receiver.recv_timeout(Duration::from_secs(10));
    receivers.into_iter().map(|receiver| wait(receiver).expect("stands still")).collect()
}

#[track_caller]
fn refused(result: &Result<()>) {
    let Err(Error::Scene { quantity: "kernel source", needed }) = result else {
        panic!("{result:?}")
    };
    assert!(needed.contains("that it is making"), "{needed}");
}

#[test]
fn a_source_may_ask_its_own_store_for_others() {
    let kernels = SharedKernels::default();
    let mut source = Asking::new(&kernels, 1.0);
    source.others = vec![Asking::new(&kernels, 2.0), Asking::new(&kernels, 3.0)];
    let made = in_time(vec![Box::new(move || (source.prepare(), source.prepare()))]);
    assert_eq!(made, [(Ok(()), Ok(()))]);
    assert_eq!(kernels.count(), 3);
}

#[test]
fn a_source_that_asks_for_itself_is_refused() {
    let kernels = SharedKernels::default();
    let (one, two) = (Asking::new(&kernels, 1.0), Asking::new(&kernels, 2.0));
    let direct = Asking { others: vec![one.clone()], ..one.clone() };
    let between = Asking { others: vec![one.clone()], ..two };
    let indirect = Asking { others: vec![between], ..one.clone() };
    for source in [direct, indirect] {
        refused(&in_time(vec![Box::new(move || source.prepare())])[0]);
        assert_eq!(kernels.count(), 0);
    }
    // Nothing of it is left behind.
    assert_eq!(in_time(vec![Box::new(move || one.prepare())]), [Ok(())]);
}

#[test]
fn what_another_thread_makes_is_waited_for() {
    let kernels = SharedKernels::default();
    let source = Asking::new(&kernels, 1.0);
    let work = || -> Box<dyn FnOnce() -> Result<()> + Send> {
        let source = source.clone();
        Box::new(move || source.prepare())
    };
    assert!(in_time((0..16).map(|_| work()).collect()).iter().all(Result::is_ok));
    assert_eq!((source.made.load(Ordering::Relaxed), kernels.count()), (1, 1));

    // One that panics leaves the work to the next.
    let broken = Asking { meets: Some(Arc::new(Barrier::new(1))), ..Asking::new(&kernels, 4.0) };
    let panics = Panicking(broken.clone());
    let elements = Strip::uniform(-1.0..1.0, 2).unwrap().elements();
    let store = kernels.clone();
    let caught = std::thread::spawn(move || {
        let ground = WeightsGround::new(panics, elements).unwrap();
        ground.with_shared_kernels(&store).prepare(1e-3, None, &mut unobserved)
    });
    assert!(caught.join().is_err());
    let again = Panicking(Asking { number: -4.0, ..broken });
    let store = kernels.clone();
    let made = in_time(vec![Box::new(move || {
        let elements = Strip::uniform(-1.0..1.0, 2)?.elements();
        WeightsGround::new(again, elements)?.with_shared_kernels(&store).prepare(
            1e-3,
            None,
            &mut unobserved,
        )
    })]);
    assert_eq!((made, kernels.count()), (vec![Ok(())], 2));
}

/// Panics while it makes a kernel whose number is positive; its identity has no sign.
struct Panicking(Asking);

impl WeightsSource for Panicking {
    fn kernel(
        &self,
        elements: &[ContactElement],
        time_step: f64,
    ) -> Result<Arc<dyn ConvolutionWeights>> {
        assert!(self.0.number < 0.0, "as it should");
        self.0.kernel(elements, time_step)
    }

    fn static_compliance(&self, elements: &[ContactElement], matrix: &mut [f64]) -> Result<()> {
        self.0.static_compliance(elements, matrix)
    }

    fn identity(&self) -> Option<Vec<f64>> {
        Some(vec![self.0.number.abs()])
    }
}
