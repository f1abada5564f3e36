//! GOAL: profiles, damping laws and layered kernels return typed errors for bad input without delay.
//! SCENE: bad numbers, laws that are not causal or passive, scales and contrasts out of reach.
//! REFERENCE: the fields of the error, and the clock.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use basemat::bem::GroundError;
use basemat::bem::layered::{Stages, StripContact};
use basemat::bem::{ElasticGround, Grading, Ground, Strip};
use basemat::history::{HistoryMethod, HistoryOptions};
use basemat::interface::Bonded;
use basemat::site::{ControlPoint, SoilColumn, VerticalWave};
use basemat::soil::SoilError;
use basemat::soil::{
    Bedrock, Elastic, GeneralizedMaxwell, Hysteretic, KelvinVoigt, Kjartansson, Relaxation,
    SoilLayer, SoilProfile,
};
use basemat::structure::RigidBlock;
use basemat::{Complex, Error, Result, Simulation, Soil, memory_limit, unobserved};

use basemat_problems::faults::is_input_of;
use basemat_problems::profiles::{gmb, p1, two_stages};

fn soil() -> Soil {
    Soil::from_shear_wave_speed(150.0, 0.33, 1800.0).unwrap()
}

fn strip() -> Strip {
    Strip::uniform(-3.0..3.0, 3).unwrap()
}

/// A layer of this thickness on a half-plane of the same soil.
fn layered(thickness: f64) -> SoilProfile {
    SoilProfile::on_half_plane(soil()).with_layer(soil(), thickness).unwrap()
}

#[test]
fn hysteretic_damping_is_an_error_in_time() {
    let profile = layered(3.0).with_bedrock_damping(Hysteretic::new(0.05).unwrap());
    let error = two_stages(profile, &strip()).weights(0.01).err().unwrap();
    assert!(matches!(error, Error::Soil(SoilError::NotCausal { layer: 2, .. })), "{error}");
    for words in ["hysteretic", "constant_q"] {
        assert!(error.to_string().contains(words), "{error}");
    }
}

/// A ground with hysteretic damping has impedances, but no time steps.
#[test]
fn hysteretic_damping_has_impedances() {
    let profile = layered(3.0).with_damping(Hysteretic::new(0.05).unwrap());
    let mut ground = ElasticGround::new(profile, strip()).unwrap();
    let impedances = ground.impedances(&[2.0], StripContact::Bonded, &mut unobserved).unwrap();
    assert!(impedances[0].vertical.re.is_finite() && impedances[0].dashpots()[1] > 0.0);
    let preparation = ground.prepare(0.01, None, &mut unobserved);
    let build_result = Simulation::builder(0.01)
        .structure(RigidBlock::new(6.0, 3.0, 2000.0).unwrap())
        .ground(ground)
        .interface(Bonded)
        .build();
    for result in [preparation, build_result.map(drop)] {
        assert!(
            matches!(result, Err(Error::Soil(SoilError::NotCausal { layer: 1, .. }))),
            "{result:?}"
        );
    }
}

fn elastic_layer(thickness: f64) -> SoilLayer {
    SoilLayer { soil: soil(), thickness, damping: Arc::new(Elastic) }
}

#[test]
fn profiles_are_validated() {
    for thickness in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let one_layer = SoilProfile::on_rigid_bedrock().with_layer(soil(), 1.0).unwrap();
        let layers = vec![elastic_layer(1.0), elastic_layer(thickness)];
        for profile in
            [one_layer.with_layer(soil(), thickness), SoilProfile::new(layers, Bedrock::Rigid)]
        {
            let error = profile.unwrap_err();
            assert!(is_input_of(&error, "layer 2", "thickness (m)", thickness), "{error}");
        }
    }
    assert!(SoilProfile::new(vec![], Bedrock::Rigid).is_err());
    let profile_of_infinite_depth =
        SoilProfile::on_rigid_bedrock().with_layer(soil(), 1e308).unwrap();
    assert!(profile_of_infinite_depth.with_layer(soil(), 1e308).is_err());
    assert!(ElasticGround::new(SoilProfile::on_rigid_bedrock(), strip()).is_err());
    for value in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(KelvinVoigt::new(value).is_err() && KelvinVoigt::with_ratio(value, 1.0).is_err());
        assert!(Kjartansson::new(value, 1.0).is_err() && Kjartansson::new(0.05, value).is_err());
        assert!(Hysteretic::new(value).is_err());
        assert!(GeneralizedMaxwell::constant_q(value, [0.1, 10.0], 1.0).is_err());
    }
}

/// Result of a motion with this sample through a site whose second layer has this modulus and thickness.
fn motion_through_site(modulus: f64, thickness: f64, sample: f64) -> Result<()> {
    let profile = layered(2.0).with_layer(Soil::new(modulus, 0.3, 2e3)?, thickness)?;
    let column = SoilColumn::new(profile, VerticalWave::Shear)?;
    let motion = [0.0, sample, 1.0];
    column.to_surface(ControlPoint::Outcrop, 0.01, &motion, &mut unobserved).map(drop)
}

/// Numbers beyond the range of double precision are named, with their layer.
#[test]
fn motions_through_extreme_sites_are_named() {
    assert_eq!(motion_through_site(1e8, 3.0, 1.0), Ok(()));
    let error = motion_through_site(1e306, 1e-200, 1.0).unwrap_err().to_string();
    assert!(error.contains("layer 2"), "{error}");
    let result = motion_through_site(1e8, 3.0, 1e306);
    let expected = "largest sample of a motion through a site";
    assert!(
        matches!(result, Err(Error::Input { quantity, value: 1e306, .. }) if quantity == expected),
        "{result:?}"
    );
}

#[test]
fn kernels_are_validated() {
    let source = two_stages(p1(gmb(5), gmb(1)), &strip());
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(source.weights(step).is_err());
    }
    for tolerance in [0.0, 1.0, 1e-16, f64::NAN] {
        let source = two_stages(p1(gmb(5), gmb(1)), &strip());
        assert!(source.with_tolerance(tolerance).is_err());
    }
    assert!(ElasticGround::new(p1(gmb(5), gmb(1)), []).is_err());
}

/// Requests coefficients of a kernel in lists of these lengths.
fn coefficients(class: usize, first_lag: usize, lengths: [usize; 3]) -> Result<()> {
    let kernel = two_stages(p1(gmb(5), gmb(1)), &strip()).weights(0.5)?;
    let mut lists = lengths.map(|length| vec![0.0; length]);
    kernel.coefficients(class, first_lag, &mut lists.each_mut().map(Vec::as_mut_slice))
}

#[test]
fn requests_of_coefficients_are_validated() {
    assert!(matches!(coefficients(99, 1, [2; 3]), Err(Error::Index { .. })));
    assert!(matches!(coefficients(0, 0, [2; 3]), Err(Error::Input { .. })));
    assert!(matches!(coefficients(0, 1, [2, 2, 3]), Err(Error::Size { .. })));
    assert!(coefficients(0, usize::MAX, [2; 3]).is_err());
    assert!(coefficients(0, usize::MAX, [0; 3]).is_err());
    coefficients(0, 5, [0; 3]).unwrap();
    let kernel = two_stages(p1(gmb(5), gmb(1)), &strip()).weights(0.5).unwrap();
    assert!(kernel.prepare(usize::MAX, &mut unobserved).is_err());
}

/// Scales so far apart that integrals would never end are errors, without delay.
#[test]
fn extreme_scales_are_errors() {
    let start = Instant::now();
    for step in [1e-9, 1e-30, 1e-300] {
        let kernel = two_stages(layered(3.0), &strip()).weights(step).unwrap();
        let error = kernel.prepare(1, &mut unobserved).unwrap_err();
        let is_expected = matches!(
            error,
            Error::Ground(GroundError::TooFine { .. } | GroundError::Unresolved { .. })
        );
        assert!(is_expected, "{step} {error}");
    }
    let error = two_stages(layered(1e-7), &strip()).static_compliance(&mut [0.0; 36]).unwrap_err();
    assert!(matches!(error, Error::Ground(GroundError::TooFine { .. })), "{error}");
    assert!(start.elapsed().as_secs() < 5);
}

/// A preparation of minutes reports its progress from the start, and an observer can stop it.
///
/// The layer is a quarter of a millimetre thick under a base of six metres, for the 54 000 steps of an earthquake.
#[test]
fn long_work_reports_its_progress_and_can_be_stopped() {
    let start = Instant::now();
    let kernel = two_stages(layered(2.5e-4), &strip()).weights(0.005).unwrap();
    let mut reports = vec![];
    let result = kernel.prepare(54_000, &mut |progress| {
        reports.push(progress);
        if reports.len() < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    let last_report = reports[2];
    assert_eq!(result, Err(Error::Stopped(last_report)));
    assert!(
        last_report.done < last_report.total && last_report.task.contains("convolution weights"),
        "{last_report}"
    );
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
}

/// A number of lags whose weights exceed the memory of any machine.
const HUGE_LAG_COUNT: usize = 1 << 31;

/// Checks that [`HUGE_LAG_COUNT`] lags are an error of too much memory.
#[track_caller]
fn assert_too_many_lags(result: Result<()>) {
    let Err(Error::Memory(error)) = result else { panic!("{result:?}") };
    let lags = HUGE_LAG_COUNT as f64;
    assert_eq!((error.asked, error.limit), (lags, memory_limit() as f64));
    // Three numbers for each of three distances, beside the numbers of the transform.
    let numbers = error.needed / (9.0 * lags);
    assert!(error.needed > error.limit && (20.0..30.0).contains(&numbers), "{error}");
}

#[test]
fn weights_that_need_too_much_memory_are_errors_beforehand() {
    let start = Instant::now();
    let kernel = two_stages(layered(3.0), &strip()).weights(0.005).unwrap();
    // The observer stops the work if it begins.
    assert_too_many_lags(kernel.prepare(HUGE_LAG_COUNT, &mut |_| ControlFlow::Break(())));
    assert_too_many_lags(kernel.prepare(HUGE_LAG_COUNT, &mut unobserved));
    let mut lists = [&mut [0.0][..], &mut [0.0], &mut [0.0]];
    assert_too_many_lags(kernel.coefficients(0, HUGE_LAG_COUNT - 1, &mut lists));
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
}

/// Layered ground whose history may use at most `memory` bytes.
fn ground_with_memory(memory: usize) -> ElasticGround {
    let ground = ElasticGround::new(layered(3.0), strip()).unwrap().with_stages(Stages::Two);
    ground.with_history(HistoryOptions { memory, ..HistoryOptions::default() }).unwrap()
}

/// A history that may contain all lags is an error; exponentials need no such memory.
#[test]
fn histories_that_need_too_much_memory_are_errors_beforehand() {
    let start = Instant::now();
    for bytes in [1_usize << 20, usize::MAX] {
        let mut ground = ground_with_memory(bytes);
        let result = ground.prepare(0.005, Some(HUGE_LAG_COUNT), &mut unobserved);
        let Err(Error::Memory(error)) = result else { panic!("{result:?}") };
        let limit = (bytes as f64).min(memory_limit() as f64);
        assert_eq!((error.asked, error.limit), (HUGE_LAG_COUNT as f64, limit));
    }
    // The work begins for steps that fit.
    let mut ground = ground_with_memory(1 << 20);
    let result = ground.prepare(0.005, Some(1000), &mut |_| ControlFlow::Break(()));
    assert!(matches!(result, Err(Error::Stopped(_))), "{result:?}");
    let mut half_plane = ElasticGround::new(soil(), strip()).unwrap();
    half_plane.prepare(0.005, Some(20_000_000), &mut unobserved).unwrap();
    let choice = half_plane.description().history.unwrap();
    assert_eq!(choice.kind, HistoryMethod::Exponentials);
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
}

/// Slabs on clay and clay on rock, thin and thick, are resolved up to contrasts of 2.5e7.
#[test]
fn strong_contrasts_are_resolved() {
    let stiff_soil = Soil::new(1e10, 0.2, 2400.0).unwrap();
    let soft_soil = Soil::new(1e6, 0.4999, 1500.0).unwrap();
    // Shear waves are four thousand times as fast as in the soft soil.
    let rigid_soil = Soil::new(2.5e13, 0.2, 2400.0).unwrap();
    for (top, base) in [
        (stiff_soil, soft_soil),
        (soft_soil, stiff_soil),
        (rigid_soil, soft_soil),
        (soft_soil, rigid_soil),
    ] {
        for thickness in [0.1, 1.0, 1e3] {
            for step in [1e-2, 1.0] {
                let profile = SoilProfile::on_half_plane(base).with_layer(top, thickness).unwrap();
                let kernel = two_stages(profile.clone(), &strip()).weights(step).unwrap();
                kernel.prepare(1, &mut unobserved).unwrap();
                two_stages(profile, &strip()).static_compliance(&mut [0.0; 36]).unwrap();
            }
        }
    }
}

/// Contrasts of 1e12 in stiffness and 1e5 in thickness, and steps of an hour, end in a result or an error.
#[test]
fn extreme_contrasts_end() {
    let stiff_soil = Soil::new(1e12, 0.1, 3000.0).unwrap();
    let soft_soil = Soil::new(1.0, 0.4999, 1000.0).unwrap();
    let start = Instant::now();
    for (top, base) in [(stiff_soil, soft_soil), (soft_soil, stiff_soil)] {
        for thickness in [1e-2, 1.0, 1e3] {
            for step in [1.0, 3600.0] {
                let profile = SoilProfile::on_half_plane(base).with_layer(top, thickness).unwrap();
                let kernel = two_stages(profile.clone(), &strip()).weights(step).unwrap();
                let mut lists = [[f64::NAN; 4]; 3];
                let mut values = lists.each_mut().map(|list| &mut list[..]);
                let result = kernel.coefficients(0, 1, &mut values);
                let zz = lists[0];
                let statics = two_stages(profile, &strip()).static_compliance(&mut [0.0; 36]);
                println!(
                    "{:.0e} on {:.0e}, {thickness}, {step}: {result:?} {zz:?} {statics:?} {:?}",
                    top.shear_modulus(),
                    base.shear_modulus(),
                    start.elapsed()
                );
                assert!(result.is_err() || zz.iter().all(|value| value.is_finite()));
            }
        }
    }
    assert!(start.elapsed().as_secs() < 120, "{:?}", start.elapsed());
}

/// A law with the same modulus at every frequency.
#[derive(Debug)]
struct ConstantModulus(f64);

impl Relaxation for ConstantModulus {
    fn modulus(&self, _s: Complex) -> Complex {
        Complex::real(self.0)
    }
}

#[test]
fn laws_without_positive_modulus_are_errors() {
    for value in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        let profile = p1(ConstantModulus(value), Elastic);
        let source = two_stages(profile, &strip());
        let kernel = source.weights(0.5).unwrap();
        let error = kernel.prepare(1, &mut unobserved).unwrap_err();
        assert!(matches!(error, Error::Soil(SoilError::Modulus { layer: 1, .. })), "{error}");
        assert!(source.impedances(&[1.0], StripContact::Bonded, &mut unobserved).is_err());
    }
}

#[cfg(feature = "rayon")]
fn weights_in_threads(threads: usize) -> [Vec<u64>; 3] {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let kernel = two_stages(p1(gmb(5), gmb(1)), &strip()).weights(0.5).unwrap();
        let mut lists = [vec![0.0; 300], vec![0.0; 300], vec![0.0; 300]];
        kernel.coefficients(1, 1, &mut lists.each_mut().map(Vec::as_mut_slice)).unwrap();
        lists.map(|list| list.into_iter().map(f64::to_bits).collect())
    })
}

/// The number of threads changes no bit.
#[cfg(feature = "rayon")]
#[test]
fn threads_do_not_change_bits() {
    assert_eq!(weights_in_threads(1), weights_in_threads(3));
}

/// Weights of a hundred late lags.
fn late_weights(grading: Grading, stages: Stages) -> [Vec<f64>; 3] {
    let strip = Strip::new(-1.0..1.0, 4, grading).unwrap();
    let source = two_stages(p1(gmb(5), gmb(1)), &strip).with_stages(stages);
    let kernel = source.weights(0.5).unwrap();
    let mut lists = [vec![0.0; 100], vec![0.0; 100], vec![0.0; 100]];
    kernel.coefficients(2, 100, &mut lists.each_mut().map(Vec::as_mut_slice)).unwrap();
    lists
}

/// Repeated computations have the same bits, on equal and graded meshes and by both methods.
#[test]
fn two_kernels_have_the_same_bits() {
    for (grading, stages) in [(Grading::Uniform, Stages::Two), (Grading::Cosine, Stages::Three)] {
        assert_eq!(late_weights(grading, stages), late_weights(grading, stages));
    }
}

/// Damping before the first layer, which would apply to the bedrock and not to the layer, is an error.
#[test]
fn damping_comes_after_its_layer() {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap();
    let damping = Hysteretic::new(0.05).unwrap();
    for profile in [SoilProfile::on_half_plane(soil), SoilProfile::on_rigid_bedrock()] {
        let result = profile.clone().with_damping(damping).with_layer(soil, 6.0);
        assert!(matches!(result, Err(Error::Scene { .. })), "{result:?}");
        assert!(result.err().unwrap().to_string().contains("with_bedrock_damping"));
        let layered = profile.with_bedrock_damping(damping).with_layer(soil, 6.0).unwrap();
        assert!(layered.with_damping(damping).with_layer(soil, 6.0).is_ok());
    }
    let without_layers = SoilProfile::on_half_plane(soil).with_damping(damping);
    assert!(without_layers.to_string().contains("hysteretic, 5 %"));
}

/// 100 · 0.07, which is 7.000000000000001, is printed as 7.
#[test]
fn profiles_print_rounded_numbers() {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap();
    let damping = GeneralizedMaxwell::constant_q(0.07, [0.1, 30.0], 1.0).unwrap();
    let voigt = KelvinVoigt::with_ratio(0.05, 3.0).unwrap();
    let profile = SoilProfile::on_half_plane(soil)
        .with_layer(soil, 6.0)
        .unwrap()
        .with_damping(damping)
        .with_layer(soil, 6.0)
        .unwrap()
        .with_damping(voigt);
    let text = profile.to_string();
    assert!(text.contains(" 7 % from 0.1 to 30 Hz"), "{text}");
    assert!(text.contains("Kelvin–Voigt, 0.005305 s"), "{text}");
}
