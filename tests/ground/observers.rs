//! GOAL: long calls tell how far they have come and can be stopped, and nothing else changes.
//! SCENE: convolution weights, impedances, response spectra, motions through a site; a block on layers, built and run.
//! REFERENCE: the same calls without an observer, to the last bit.

use std::ops::ControlFlow::{Break, Continue};
use std::sync::{Arc, Mutex};

use basemat::bem::layered::{Stages, StripContact};
use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, PatchKernel, Strip};
use basemat::coupled::SimulationBuilder;
use basemat::history::{ConvolutionHistory, ConvolutionWeights, RelaxedFftHistory};
use basemat::interface::Coulomb;
use basemat::motion::{FreeField, TravellingWave, Triaxial, el_centro_1940};
use basemat::site::{
    ControlPoint, EquivalentLinear, EquivalentLinearOptions, InclinedControl, InclinedWave,
    SoilColumn, VerticalWave,
};
use basemat::soil::{Elastic, SoilProfile, StrainCurves};
use basemat::structure::RigidBlock;
use basemat::{Error, Observer, Progress, Result, Simulation, Soil, unobserved};

use basemat_problems::profiles::{gmb, p1, p3, two_stages};

/// Runs `call` to its end, and stopped early and late before: `Stopped` each time, and what is wanted after all.
fn watched<T: PartialEq + std::fmt::Debug>(
    mut call: impl FnMut(&mut Observer<'_>) -> Result<T>,
    wanted: Option<&T>,
) {
    let mut heard: Vec<Progress> = vec![];
    for stop in [0, 1, 7, 41, 133, 400, usize::MAX] {
        heard.clear();
        let found = call(&mut |progress| {
            heard.push(progress);
            if heard.len() > stop { Break(()) } else { Continue(()) }
        });
        let last = *heard.last().unwrap();
        for pair in heard.windows(2) {
            let [one, two] = pair else { unreachable!() };
            assert!(one.done <= two.done && one.total == two.total && one.task == two.task);
        }
        if heard.len() > stop {
            assert_eq!(found.err(), Some(Error::Stopped(last)));
            assert!(Error::Stopped(last).to_string().contains(last.task));
        } else {
            assert_eq!(last.done, last.total, "{last}");
            let found = found.unwrap();
            assert!(wanted.is_none_or(|wanted| *wanted == found));
            return;
        }
    }
}

fn bits(kernel: &dyn ConvolutionWeights, lags: usize) -> Vec<u64> {
    let mut bits = vec![];
    for class in 0..kernel.classes().count() {
        let mut lists = [(); 3].map(|()| vec![0.0; lags]);
        let [zz, xx, zx] = &mut lists;
        kernel.coefficients(class, 1, &mut [zz, xx, zx]).unwrap();
        bits.extend(lists.iter().flatten().map(|value| value.to_bits()));
    }
    bits
}

#[test]
fn step_coefficients_are_watched_and_stopped() {
    let strip = Strip::uniform(-1.0..1.0, 2).unwrap();
    let make = || two_stages(p1(gmb(5), gmb(1)), &strip).weights(0.2).unwrap();
    let wanted = bits(&*make(), 500);
    // A kernel anew each time, and one that is stopped again and again.
    watched(
        |observer| {
            let kernel = make();
            kernel.prepare(500, observer)?;
            Ok(bits(&*kernel, 500))
        },
        Some(&wanted),
    );
    let kernel = make();
    watched(|observer| kernel.prepare(500, observer), None);
    assert_eq!(bits(&*kernel, 500), wanted);
    // Stopped at the beginning, then repeated without an observer.
    let kernel = make();
    for stop in [1, 30, 60, 200] {
        let mut count = 0;
        let found = kernel.prepare(500, &mut |_| {
            count += 1;
            if count == stop { Break(()) } else { Continue(()) }
        });
        assert!(matches!(found, Err(Error::Stopped(_))));
    }
    assert_eq!(bits(&*kernel, 500), wanted);
    // All is there.
    watched(|observer| kernel.prepare(500, observer), None);
}

/// The forms of a mat in three dimensions, its gate and its weights.
#[test]
fn weights_in_plan_are_watched_and_stopped() {
    let plan = Plan::rectangle(-1.0..1.0, -1.0..1.0, 4).unwrap();
    let make = || {
        let ground = ElasticGround::in_plan(p1(gmb(5), gmb(1)), plan.clone()).unwrap();
        ground.with_stages(Stages::Two).weights(0.2).unwrap()
    };
    let bits = |kernel: &dyn ConvolutionWeights| {
        let mut bits = vec![];
        for class in 0..kernel.classes().count() {
            let mut lists = [(); 6].map(|()| vec![0.0; 300]);
            kernel.coefficients(class, 1, &mut lists.each_mut().map(Vec::as_mut_slice)).unwrap();
            bits.extend(lists.iter().flatten().map(|value| value.to_bits()));
        }
        bits
    };
    let wanted = bits(&*make());
    let kernel = make();
    watched(|observer| kernel.prepare(300, observer), None);
    assert_eq!(bits(&*kernel), wanted);
}

#[test]
fn impedances_are_watched_and_stopped() {
    for profile in [p1(gmb(5), gmb(1)), p3(Elastic)] {
        let ground = ElasticGround::new(profile, Strip::graded(-1.0..1.0, 4).unwrap()).unwrap();
        let frequencies = [0.05, 0.11, 0.3];
        let contact = StripContact::Bonded;
        let wanted = ground.impedances(&frequencies, contact, &mut unobserved).unwrap();
        let call = |observer: &mut Observer<'_>| ground.impedances(&frequencies, contact, observer);
        watched(call, Some(&wanted));
    }
}

#[test]
fn response_spectra_are_watched_and_stopped() {
    let record = el_centro_1940();
    let periods: Vec<f64> = (0..20).map(|i| 1e-4 * 1.6_f64.powi(i)).collect();
    let wanted = record.response_spectrum(&periods, 0.05, &mut unobserved).unwrap();
    watched(|observer| record.response_spectrum(&periods, 0.05, observer), Some(&wanted));
}

/// Motions through a site are heard of in as many parts as a Ctrl-C needs, and stopped.
#[test]
fn site_response_is_watched_and_stopped() {
    let soil = |speed| Soil::from_shear_wave_speed(speed, 0.3, 1900.0).unwrap();
    let rock = SoilProfile::on_half_plane(soil(800.0)).with_bedrock_damping(gmb(1));
    let mut profile = rock;
    for k in 0..12 {
        let layer = soil(180.0 + 10.0 * f64::from(k));
        profile = profile.with_layer(layer, 3.0).unwrap().with_damping(gmb(5));
    }
    let (record, control) = (el_centro_1940(), ControlPoint::Outcrop);
    let (step, samples) = (record.time_step(), record.accelerations());
    let column = SoilColumn::new(profile.clone(), VerticalWave::Shear).unwrap();
    let parts = std::cell::Cell::new(0);
    let heard = |call: &dyn Fn(&mut Observer<'_>)| {
        parts.set(0);
        call(&mut |_| {
            parts.set(parts.get() + 1);
            Continue(())
        });
        parts.get()
    };

    let wanted = column.to_surface(control, step, samples, &mut unobserved).unwrap();
    let up = |own: &mut Observer<'_>| column.to_surface(control, step, samples, own);
    watched(up, Some(&wanted));
    assert!(heard(&|own| drop(up(own))) > 50);
    let wanted = column.from_surface(control, step, samples, &mut unobserved).unwrap();
    watched(|own| column.from_surface(control, step, samples, own), Some(&wanted));

    let frequencies: Vec<f64> = (0..2000).map(|k| 0.01 * f64::from(k)).collect();
    let found = column.transfers(control, &frequencies, &mut |_| Continue(())).unwrap();
    for (frequency, found) in frequencies.iter().zip(&found) {
        let wanted = column.transfer(control, *frequency).unwrap();
        assert!((*found + wanted * -1.0).abs() < 1e-13 * wanted.abs(), "{frequency}");
    }
    watched(|own| column.transfers(control, &frequencies, own), Some(&found));

    let wave = InclinedWave::sv(profile.clone(), 0.2).unwrap();
    let control = InclinedControl::OutcropHorizontal;
    let wanted = wave.to_surface(control, step, samples, &mut unobserved).unwrap();
    watched(|own| wave.to_surface(control, step, samples, own), Some(&wanted));
    let wanted = wave.surface_records(control, &record, &mut |_| Continue(())).unwrap();
    watched(|own| wave.surface_records(control, &record, own), Some(&wanted));
    let field = wave.field(control, &record, -3.0).unwrap();
    let travelled = TravellingWave::new(wanted, wave.apparent_velocity(), -3.0).unwrap();
    assert_eq!(field.displacement(2.0, 4.0), travelled.displacement(2.0, 4.0));

    let motion = Triaxial { x: Some(record.clone()), y: None, up: Some(record.clone()) };
    let control = ControlPoint::Outcrop;
    let wanted = SoilColumn::surface_in_plan(&profile, control, &motion, &mut unobserved).unwrap();
    let call =
        |own: &mut Observer<'_>| SoilColumn::surface_in_plan(&profile, control, &motion, own);
    watched(call, Some(&wanted));

    let curves = vec![StrainCurves::VuceticDobry { plasticity_index: 30.0 }; 12];
    let options = EquivalentLinearOptions::default();
    let numbers = |found: EquivalentLinear| (found.surface, found.accelerations, found.layers);
    let wanted =
        column.equivalent_linear(&record, &curves, &options, &mut unobserved).map(numbers).unwrap();
    let call = |own: &mut Observer<'_>| {
        column.equivalent_linear(&record, &curves, &options, own).map(numbers)
    };
    watched(call, Some(&wanted));
    // Every iteration, in its frequencies and in its layers.
    assert!(heard(&|own| drop(call(own))) > 300);
}

fn scene() -> SimulationBuilder {
    scene_on(Strip::graded(-3.0..3.0, 4).unwrap())
}

fn scene_on(strip: Strip) -> SimulationBuilder {
    let soil = |speed| Soil::from_shear_wave_speed(speed, 0.33, 1900.0).unwrap();
    let profile = SoilProfile::on_half_plane(soil(500.0)).with_layer(soil(150.0), 6.0).unwrap();
    let block = RigidBlock::new(6.0, 9.0, 2000.0).unwrap();
    Simulation::builder(0.01)
        .ground(ElasticGround::new(profile, strip).unwrap())
        .structure(block)
        .interface(Coulomb::new(0.3).unwrap())
        .motion(el_centro_1940())
}

fn states(mut simulation: Simulation) -> Vec<u64> {
    let mut bits = vec![];
    simulation.run(200, |state| bits.push(state.base_shear.to_bits())).unwrap();
    bits
}

/// All of a run's coefficients at build time, or before the run; then the run hears of none.
#[test]
fn builds_and_runs_hand_their_observer_on() {
    let wanted = states(scene().build().unwrap());
    let told = states(scene().expected_steps(200).build().unwrap());
    for stop in [0, 1, 7, 41, usize::MAX] {
        let heard = Arc::new(Mutex::new(vec![]));
        let own = Arc::clone(&heard);
        let builder = scene().expected_steps(200).observer(move |progress| {
            let mut heard = own.lock().unwrap();
            heard.push(progress);
            if heard.len() > stop { Break(()) } else { Continue(()) }
        });
        let built = builder.build();
        let last = *heard.lock().unwrap().last().unwrap();
        match built {
            Ok(simulation) => {
                assert!(stop == usize::MAX && last.done == last.total, "{last}");
                assert_eq!(states(simulation), told);
            }
            Err(error) => assert_eq!(error, Error::Stopped(last)),
        }
    }
    let mut simulation = scene().build().unwrap();
    let before = simulation.state().clone();
    watched(|observer| simulation.prepare(200, observer), None);
    assert_eq!(*simulation.state(), before);
    let choice = simulation.ground().description().history.unwrap();
    assert_eq!(choice.steps, Some(200));
    assert_eq!(states(simulation), wanted);
}

/// Spectra alone, of pairs and of wavenumbers: heard of in parts, stopped between any two.
#[test]
fn spectra_are_heard_of_in_parts() {
    let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0).unwrap();
    for strip in [Strip::graded(-3.0..3.0, 8), Strip::uniform(-3.0..3.0, 16)] {
        let elements = strip.unwrap().elements();
        let size = 2 * elements.len();
        let displacements = |observer: &mut Observer<'_>| {
            let kernel = Arc::new(PatchKernel::new(soil, elements.clone(), 0.01)?);
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
        };
        let mut parts = 0;
        let wanted = displacements(&mut |_| {
            parts += 1;
            Continue(())
        });
        let wanted = wanted.unwrap();
        assert!(parts > 20, "{parts}");
        watched(displacements, Some(&wanted));
    }
}

/// Spectra are made after the weights: heard of, stopped without a trace, and the end is heard at the end alone.
#[test]
fn spectra_are_watched_and_stopped() {
    for strip in [Strip::graded(-3.0..3.0, 4), Strip::uniform(-3.0..3.0, 8)] {
        let strip = strip.unwrap();
        let wanted = states(scene_on(strip.clone()).build().unwrap());
        let mut heard = vec![];
        let mut twin = scene_on(strip.clone()).build().unwrap();
        let all = twin.prepare(2000, &mut |progress| {
            heard.push(progress);
            Continue(())
        });
        assert_eq!(all, Ok(()));
        let before_end = |progress: &&Progress| progress.done < progress.total;
        assert!(heard.iter().skip_while(before_end).count() <= 2);

        let mut simulation = scene_on(strip).build().unwrap();
        let before = simulation.state().clone();
        for _ in 0..2 {
            let found = simulation.prepare(2000, &mut |progress| {
                let is_last = progress.done + 1 >= progress.total;
                if is_last { Break(()) } else { Continue(()) }
            });
            assert!(matches!(found, Err(Error::Stopped(_))), "{found:?}");
            assert_eq!(simulation.ground().description().history.unwrap().steps, None);
            assert_eq!(*simulation.state(), before);
        }
        assert_eq!(states(simulation), wanted);
    }
}
