//! GOAL: long calls report their progress and can be stopped; their results do not change.
//! SCENE: convolution weights, impedances, response spectra; a block on layers, built and run.
//! REFERENCE: the same calls without an observer, to the last bit.

use std::ops::ControlFlow::{Break, Continue};
use std::sync::{Arc, Mutex};

use basemat::bem::layered::{Stages, StripContact};
use basemat::bem::plan::Plan;
use basemat::bem::{ContactElement, ElasticGround, PatchKernel, Strip};
use basemat::coupled::SimulationBuilder;
use basemat::history::{ConvolutionHistory, ConvolutionWeights, RelaxedFftHistory};
use basemat::interface::Coulomb;
use basemat::motion::el_centro_1940;
use basemat::soil::{Elastic, SoilProfile};
use basemat::structure::RigidBlock;
use basemat::{Error, Observer, Progress, Result, Simulation, Soil, unobserved};

use basemat_problems::profiles::{gmb, p1, p3, two_stages};

/// Stops `call` early and late, then runs it to its end: `Stopped` each time, then the expected result.
pub(super) fn check_observed<T: PartialEq + std::fmt::Debug>(
    mut call: impl FnMut(&mut Observer<'_>) -> Result<T>,
    expected: Option<&T>,
) {
    let mut reports: Vec<Progress> = vec![];
    for stop in [0, 1, 7, 41, 133, 400, usize::MAX] {
        reports.clear();
        let outcome = call(&mut |progress| {
            reports.push(progress);
            if reports.len() > stop { Break(()) } else { Continue(()) }
        });
        let last_report = *reports.last().unwrap();
        for pair in reports.windows(2) {
            assert!(pair[0].done <= pair[1].done && pair[0].total == pair[1].total);
            assert!(pair[0].task == pair[1].task);
        }
        if reports.len() > stop {
            assert_eq!(outcome.err(), Some(Error::Stopped(last_report)));
            assert!(Error::Stopped(last_report).to_string().contains(last_report.task));
        } else {
            assert_eq!(last_report.done, last_report.total, "{last_report}");
            let computed = outcome.unwrap();
            assert!(expected.is_none_or(|expected| *expected == computed));
            return;
        }
    }
}

/// Number of reports of a call to its observer.
pub(super) fn count_reports(call: impl FnOnce(&mut Observer<'_>)) -> usize {
    let mut count = 0;
    call(&mut |_| {
        count += 1;
        Continue(())
    });
    count
}

/// Bits of all weights of a strip.
fn weight_bits(kernel: &dyn ConvolutionWeights, lags: usize) -> Vec<u64> {
    let mut bits = vec![];
    for class in 0..kernel.classes().count() {
        let mut weights = [(); 3].map(|()| vec![0.0; lags]);
        kernel
            .coefficients(class, 1, &mut weights.each_mut().map(Vec::as_mut_slice))
            .unwrap();
        bits.extend(weights.iter().flatten().map(|value| value.to_bits()));
    }
    bits
}

/// Weights of two elements on a damped layer, none of them computed.
fn unprepared_weights() -> Arc<dyn ConvolutionWeights> {
    let strip = Strip::uniform(-1.0..1.0, 2).unwrap();
    two_stages(p1(gmb(5), gmb(1)), &strip).weights(0.2).unwrap()
}

/// GOAL: the preparation of weights reports, stops, and continues after a stop.
#[test]
fn convolution_weights_report_and_stop() {
    let expected = weight_bits(&*unprepared_weights(), 500);
    // A new kernel each time, then one that is stopped again and again.
    check_observed(
        |observer| {
            let kernel = unprepared_weights();
            kernel.prepare(500, observer)?;
            Ok(weight_bits(&*kernel, 500))
        },
        Some(&expected),
    );
    let kernel = unprepared_weights();
    check_observed(|observer| kernel.prepare(500, observer), None);
    assert_eq!(weight_bits(&*kernel, 500), expected);
    // Stopped at the beginning, then repeated without an observer.
    let kernel = unprepared_weights();
    for stop in [1, 30, 60, 200] {
        let mut count = 0;
        let outcome = kernel.prepare(500, &mut |_| {
            count += 1;
            if count == stop { Break(()) } else { Continue(()) }
        });
        assert!(matches!(outcome, Err(Error::Stopped(_))));
    }
    assert_eq!(weight_bits(&*kernel, 500), expected);
    // All weights are computed: the preparation still reports.
    check_observed(|observer| kernel.prepare(500, observer), None);
}

/// Weights of a mat on a damped layer, none of them computed.
fn unprepared_weights_in_plan() -> Arc<dyn ConvolutionWeights> {
    let plan = Plan::rectangle(-1.0..1.0, -1.0..1.0, 4).unwrap();
    let ground = ElasticGround::in_plan(p1(gmb(5), gmb(1)), plan).unwrap();
    ground.with_stages(Stages::Two).weights(0.2).unwrap()
}

/// Bits of all weights of a mat at 300 lags.
fn weight_bits_in_plan(kernel: &dyn ConvolutionWeights) -> Vec<u64> {
    let mut bits = vec![];
    for class in 0..kernel.classes().count() {
        let mut weights = [(); 6].map(|()| vec![0.0; 300]);
        kernel
            .coefficients(class, 1, &mut weights.each_mut().map(Vec::as_mut_slice))
            .unwrap();
        bits.extend(weights.iter().flatten().map(|value| value.to_bits()));
    }
    bits
}

/// GOAL: the integrals and weights of a mat in three dimensions report and stop.
#[test]
fn weights_in_plan_report_and_stop() {
    let expected = weight_bits_in_plan(&*unprepared_weights_in_plan());
    let kernel = unprepared_weights_in_plan();
    check_observed(|observer| kernel.prepare(300, observer), None);
    assert_eq!(weight_bits_in_plan(&*kernel), expected);
}

/// GOAL: impedances of strips report and stop.
#[test]
fn impedances_report_and_stop() {
    for profile in [p1(gmb(5), gmb(1)), p3(Elastic)] {
        let ground = ElasticGround::new(profile, Strip::graded(-1.0..1.0, 4).unwrap()).unwrap();
        let frequencies = [0.05, 0.11, 0.3];
        let contact = StripContact::Bonded;
        let expected = ground.impedances(&frequencies, contact, &mut unobserved).unwrap();
        check_observed(
            |observer| ground.impedances(&frequencies, contact, observer),
            Some(&expected),
        );
    }
}

/// GOAL: response spectra of records report and stop.
#[test]
fn response_spectra_report_and_stop() {
    let record = el_centro_1940();
    let periods: Vec<f64> = (0..20).map(|i| 1e-4 * 1.6_f64.powi(i)).collect();
    let expected = record.response_spectrum(&periods, 0.05, &mut unobserved).unwrap();
    check_observed(|observer| record.response_spectrum(&periods, 0.05, observer), Some(&expected));
}

fn soil_of_speed(speed: f64) -> Soil {
    Soil::from_shear_wave_speed(speed, 0.33, 1900.0).unwrap()
}

/// A block that slides and uplifts on a layer under El Centro.
fn block_on_layer(strip: Strip) -> SimulationBuilder {
    let profile = SoilProfile::on_half_plane(soil_of_speed(500.0));
    let profile = profile.with_layer(soil_of_speed(150.0), 6.0).unwrap();
    let block = RigidBlock::new(6.0, 9.0, 2000.0).unwrap();
    Simulation::builder(0.01)
        .ground(ElasticGround::new(profile, strip).unwrap())
        .structure(block)
        .interface(Coulomb::new(0.3).unwrap())
        .motion(el_centro_1940())
}

/// The block on four elements.
fn block_on_four_elements() -> SimulationBuilder {
    block_on_layer(Strip::graded(-3.0..3.0, 4).unwrap())
}

/// Bits of the base shear over 200 steps.
fn base_shear_bits(mut simulation: Simulation) -> Vec<u64> {
    let mut bits = vec![];
    simulation.run(200, |state| bits.push(state.base_shear.to_bits())).unwrap();
    bits
}

/// GOAL: weights of a run are computed when it is built, or by `prepare`; the run then reports none of them.
#[test]
fn builds_and_preparations_pass_their_observer_on() {
    let expected = base_shear_bits(block_on_four_elements().build().unwrap());
    let expected_when_prepared =
        base_shear_bits(block_on_four_elements().expected_steps(200).build().unwrap());
    for stop in [0, 1, 7, 41, usize::MAX] {
        let reports = Arc::new(Mutex::new(vec![]));
        let observed = Arc::clone(&reports);
        let builder = block_on_four_elements().expected_steps(200).observer(move |progress| {
            let mut reports = observed.lock().unwrap();
            reports.push(progress);
            if reports.len() > stop { Break(()) } else { Continue(()) }
        });
        let result = builder.build();
        let last_report = *reports.lock().unwrap().last().unwrap();
        match result {
            Ok(simulation) => {
                assert!(
                    stop == usize::MAX && last_report.done == last_report.total,
                    "{last_report}"
                );
                assert_eq!(base_shear_bits(simulation), expected_when_prepared);
            }
            Err(error) => assert_eq!(error, Error::Stopped(last_report)),
        }
    }
    let mut simulation = block_on_four_elements().build().unwrap();
    let initial_state = simulation.state().clone();
    check_observed(|observer| simulation.prepare(200, observer), None);
    assert_eq!(*simulation.state(), initial_state);
    let choice = simulation.ground().description().history.unwrap();
    assert_eq!(choice.steps, Some(200));
    assert_eq!(base_shear_bits(simulation), expected);
}

/// Bits of displacements over 100 steps by a history with transforms along the surface.
fn displacement_bits(elements: &[ContactElement], observer: &mut Observer<'_>) -> Result<Vec<u64>> {
    let size = 2 * elements.len();
    let kernel = Arc::new(PatchKernel::new(soil_of_speed(200.0), elements.to_vec(), 0.01)?);
    let mut history = RelaxedFftHistory::new(kernel).with_surface_transform(true);
    history.prepare(2000, observer)?;
    let mut displacement = vec![0.0; size];
    let mut bits: Vec<u64> = vec![];
    for step in 0..100_u32 {
        history.evaluate(&mut displacement)?;
        bits.extend(displacement.iter().copied().map(f64::to_bits));
        history.push(&vec![f64::from(step % 7) - 3.0; size]);
    }
    Ok(bits)
}

/// GOAL: transforms of the weights alone, by pairs and by wavenumbers, report in parts and stop between any two.
#[test]
fn transforms_report_in_parts() {
    for strip in [Strip::graded(-3.0..3.0, 8), Strip::uniform(-3.0..3.0, 16)] {
        let elements = strip.unwrap().elements();
        let reports = count_reports(|observer| {
            displacement_bits(&elements, observer).unwrap();
        });
        assert!(reports > 20, "{reports}");
        let expected = displacement_bits(&elements, &mut unobserved).unwrap();
        check_observed(|observer| displacement_bits(&elements, observer), Some(&expected));
    }
}

/// GOAL: a preparation reports transforms after the weights, can be stopped without any change, and reports its end only at
/// its end.
#[test]
fn transforms_report_and_stop() {
    for strip in [Strip::graded(-3.0..3.0, 4), Strip::uniform(-3.0..3.0, 8)] {
        let strip = strip.unwrap();
        let expected = base_shear_bits(block_on_layer(strip.clone()).build().unwrap());
        let mut reports = vec![];
        let mut reporting = block_on_layer(strip.clone()).build().unwrap();
        let outcome = reporting.prepare(2000, &mut |progress| {
            reports.push(progress);
            Continue(())
        });
        assert_eq!(outcome, Ok(()));
        let at_end = reports.iter().skip_while(|progress| progress.done < progress.total);
        assert!(at_end.count() <= 2);

        let mut simulation = block_on_layer(strip).build().unwrap();
        let initial_state = simulation.state().clone();
        for _ in 0..2 {
            let outcome = simulation.prepare(2000, &mut |progress| {
                let is_last = progress.done + 1 >= progress.total;
                if is_last { Break(()) } else { Continue(()) }
            });
            assert!(matches!(outcome, Err(Error::Stopped(_))), "{outcome:?}");
            assert_eq!(simulation.ground().description().history.unwrap().steps, None);
            assert_eq!(*simulation.state(), initial_state);
        }
        assert_eq!(base_shear_bits(simulation), expected);
    }
}
