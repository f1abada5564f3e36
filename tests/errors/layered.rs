//! GOAL: profiles, damping laws and layered kernels refuse bad input with typed errors, at once.
//! SCENE: bad numbers, laws that are not causal or passive, scales and contrasts out of reach.
//! REFERENCE: the fields of the error, and the clock.

use std::ops::ControlFlow;
use std::sync::Arc;

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
use basemat::{Complex, Error, Soil, unobserved};
use basemat_problems::faults::is_input_of;

use basemat_problems::profiles::{gmb, p1, two_stages};

fn soil() -> Soil {
    Soil::from_shear_wave_speed(150.0, 0.33, 1800.0).unwrap()
}

fn strip() -> Strip {
    Strip::uniform(-3.0..3.0, 3).unwrap()
}

#[test]
fn hysteretic_damping_is_refused_in_time() {
    let profile = SoilProfile::on_half_plane(soil())
        .with_layer(soil(), 3.0)
        .unwrap()
        .with_bedrock_damping(Hysteretic::new(0.05).unwrap());
    let found = two_stages(profile, &strip()).weights(0.01).err().unwrap();
    assert!(matches!(found, Error::Soil(SoilError::NotCausal { layer: 2, .. })), "{found}");
    assert!(
        found.to_string().contains("hysteretic") && found.to_string().contains("constant_q"),
        "{found}"
    );
    // A ground of this profile has the profile's impedances, but no time steps.
    let profile = SoilProfile::on_half_plane(soil())
        .with_layer(soil(), 3.0)
        .unwrap()
        .with_damping(Hysteretic::new(0.05).unwrap());
    let mut ground =
        ElasticGround::new(profile.clone(), Strip::uniform(-3.0..3.0, 3).unwrap()).unwrap();
    let found = ground.impedances(&[2.0], StripContact::Bonded, &mut unobserved).unwrap();
    assert!(found[0].vertical.re.is_finite() && found[0].dashpots()[1] > 0.0);
    let not_causal = |found: basemat::Result<()>| {
        matches!(found, Err(Error::Soil(SoilError::NotCausal { layer: 1, .. })))
    };
    assert!(not_causal(ground.prepare(0.01, None, &mut unobserved)));
    let built = basemat::Simulation::builder(0.01)
        .structure(RigidBlock::new(6.0, 3.0, 2000.0).unwrap())
        .ground(ground)
        .interface(Bonded)
        .build();
    assert!(not_causal(built.map(drop)));
}

#[test]
fn profiles_are_validated() {
    for thickness in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let good = SoilProfile::on_rigid_bedrock().with_layer(soil(), 1.0).unwrap();
        let layer = |thickness| SoilLayer { soil: soil(), thickness, damping: Arc::new(Elastic) };
        let layers = vec![layer(1.0), layer(thickness)];
        for found in [good.with_layer(soil(), thickness), SoilProfile::new(layers, Bedrock::Rigid)]
        {
            let error = found.unwrap_err();
            assert!(is_input_of(&error, "layer 2", "thickness (m)", thickness), "{error}");
        }
    }
    assert!(SoilProfile::new(vec![], Bedrock::Rigid).is_err());
    let huge = SoilProfile::on_rigid_bedrock().with_layer(soil(), 1e308).unwrap();
    assert!(huge.with_layer(soil(), 1e308).is_err());
    let bare = SoilProfile::on_rigid_bedrock();
    assert!(ElasticGround::new(bare.clone(), strip()).is_err());
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(KelvinVoigt::new(bad).is_err() && KelvinVoigt::with_ratio(bad, 1.0).is_err());
        assert!(Kjartansson::new(bad, 1.0).is_err() && Kjartansson::new(0.05, bad).is_err());
        assert!(Hysteretic::new(bad).is_err());
        assert!(GeneralizedMaxwell::constant_q(bad, [0.1, 10.0], 1.0).is_err());
    }
}

/// Numbers beyond the range of the computer are named, with their layer.
#[test]
fn motions_through_extreme_sites_are_named() {
    let column = |modulus: f64, thickness: f64| {
        let profile = SoilProfile::on_half_plane(soil()).with_layer(soil(), 2.0).unwrap();
        let profile = profile.with_layer(Soil::new(modulus, 0.3, 2e3).unwrap(), thickness).unwrap();
        SoilColumn::new(profile, VerticalWave::Shear).unwrap()
    };
    let surface = |column: SoilColumn, sample: f64| {
        column
            .to_surface(ControlPoint::Outcrop, 0.01, &[0.0, sample, 1.0], &mut unobserved)
            .map(drop)
    };
    assert_eq!(surface(column(1e8, 3.0), 1.0), Ok(()));
    let stiff = surface(column(1e306, 1e-200), 1.0).unwrap_err().to_string();
    assert!(stiff.contains("layer 2"), "{stiff}");
    let found = surface(column(1e8, 3.0), 1e306);
    let named = "largest sample of a motion through a site";
    assert!(
        matches!(found, Err(Error::Input { quantity, value: 1e306, .. }) if quantity == named),
        "{found:?}"
    );
}

#[test]
fn kernels_are_validated() {
    let make = || two_stages(p1(gmb(5), gmb(1)), &strip());
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(make().weights(step).is_err());
    }
    for tolerance in [0.0, 1.0, 1e-16, f64::NAN] {
        assert!(make().with_tolerance(tolerance).is_err());
    }
    assert!(ElasticGround::new(p1(gmb(5), gmb(1)), []).is_err());
    let kernel = make().weights(0.5).unwrap();
    let mut list = [0.0; 2];
    let (mut one, mut two) = ([0.0; 2], [0.0; 3]);
    assert!(matches!(
        kernel.coefficients(99, 1, &mut [&mut list, &mut one, &mut [0.0; 2]]),
        Err(Error::Index { .. })
    ));
    assert!(matches!(
        kernel.coefficients(0, 0, &mut [&mut list, &mut one, &mut [0.0; 2]]),
        Err(Error::Input { .. })
    ));
    assert!(matches!(
        kernel.coefficients(0, 1, &mut [&mut list, &mut one, &mut two]),
        Err(Error::Size { .. })
    ));
    assert!(kernel.coefficients(0, usize::MAX, &mut [&mut list, &mut one, &mut [0.0; 2]]).is_err());
    assert!(kernel.prepare(usize::MAX, &mut unobserved).is_err());
    assert!(kernel.coefficients(0, usize::MAX, &mut [&mut [], &mut [], &mut []]).is_err());
    kernel.coefficients(0, 5, &mut [&mut [], &mut [], &mut []]).unwrap();
}

/// Scales so far apart that integrals would take for ever are refused at once.
#[test]
fn hopeless_scales_are_refused() {
    let begin = std::time::Instant::now();
    for step in [1e-9, 1e-30, 1e-300] {
        let profile = SoilProfile::on_half_plane(soil()).with_layer(soil(), 3.0).unwrap();
        let kernel = two_stages(profile, &strip()).weights(step).unwrap();
        let found = kernel.prepare(1, &mut unobserved).unwrap_err();
        let expected = matches!(
            found,
            Error::Ground(GroundError::TooFine { .. } | GroundError::Unresolved { .. })
        );
        assert!(expected, "{step} {found}");
    }
    let thin = SoilProfile::on_half_plane(soil()).with_layer(soil(), 1e-7).unwrap();
    let found = two_stages(thin, &strip()).static_compliance(&mut [0.0; 36]).unwrap_err();
    assert!(matches!(found, Error::Ground(GroundError::TooFine { .. })), "{found}");
    assert!(begin.elapsed().as_secs() < 5);
}

/// A skin of a quarter of a millimetre under a base of six metres, for the 54 000 steps of an earthquake: minutes of
/// work, of which an observer hears at once, and which it can stop.
#[test]
fn long_work_is_heard_of_and_can_be_stopped() {
    let begin = std::time::Instant::now();
    let profile = SoilProfile::on_half_plane(soil()).with_layer(soil(), 2.5e-4).unwrap();
    let kernel = two_stages(profile, &strip()).weights(0.005).unwrap();
    let mut heard = vec![];
    let found = kernel.prepare(54_000, &mut |progress| {
        heard.push(progress);
        if heard.len() < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    let last = heard[2];
    assert_eq!(found, Err(Error::Stopped(last)));
    assert!(last.done < last.total && last.task.contains("convolution weights"), "{last}");
    assert!(begin.elapsed().as_secs() < 10, "{:?}", begin.elapsed());
}

/// Two thousand million lags, by themselves and for a ground whose history may have all of them. Exponentials need no
/// such memory, and a run without a known end needs only the memory of its history.
#[test]
fn what_takes_too_much_memory_is_refused_beforehand() {
    let begin = std::time::Instant::now();
    let profile = || SoilProfile::on_half_plane(soil()).with_layer(soil(), 3.0).unwrap();
    let refused = |found: basemat::Result<()>, lags: f64| match found.unwrap_err() {
        Error::Memory(error) => {
            assert_eq!((error.asked, error.limit), (lags, basemat::memory_limit() as f64));
            // Three numbers for each of three distances, and the transform's beside them.
            let numbers = error.needed / (9.0 * lags);
            assert!(error.needed > error.limit && (20.0..30.0).contains(&numbers), "{error}");
        }
        other => panic!("{other}"),
    };
    let whole = two_stages(profile(), &strip());
    let kernel = whole.weights(0.005).unwrap();
    let most = 2.0_f64.powi(31);
    // Stopped at once if it begins.
    refused(kernel.prepare(1 << 31, &mut |_| ControlFlow::Break(())), most);
    refused(kernel.prepare(1 << 31, &mut unobserved), most);
    let mut list = [0.0; 1];
    refused(kernel.coefficients(0, (1 << 31) - 1, &mut [&mut list, &mut [0.0], &mut [0.0]]), most);

    let strip = Strip::uniform(-3.0..3.0, 3).unwrap();
    let ground = |profile: SoilProfile, bytes: usize| {
        let ground = ElasticGround::new(profile, &strip).unwrap().with_stages(Stages::Two);
        let options = HistoryOptions { memory: bytes, ..HistoryOptions::default() };
        ground.with_history(options).unwrap()
    };
    for bytes in [1_usize << 20, usize::MAX] {
        let found = ground(profile(), bytes).prepare(0.005, Some(1 << 31), &mut unobserved);
        let Err(Error::Memory(error)) = found else { panic!("{found:?}") };
        let limit = (bytes as f64).min(basemat::memory_limit() as f64);
        assert_eq!((error.asked, error.limit), (most, limit));
    }
    // Steps that fit are begun.
    let mut watched = |_: basemat::Progress| ControlFlow::Break(());
    let begun = ground(profile(), 1 << 20).prepare(0.005, Some(1000), &mut watched);
    assert!(matches!(begun, Err(Error::Stopped(_))), "{begun:?}");
    let mut plain = ElasticGround::new(soil(), &strip).unwrap();
    plain.prepare(0.005, Some(20_000_000), &mut unobserved).unwrap();
    assert_eq!(plain.description().history.unwrap().kind, HistoryMethod::Exponentials);
    assert!(begin.elapsed().as_secs() < 10, "{:?}", begin.elapsed());
}

/// A slab on clay and clay on rock, thin and thick: contrasts of 1e4 are ordinary, contrasts of 2.5e7 possible.
#[test]
fn strong_contrasts_are_resolved() {
    let stiff = Soil::new(1e10, 0.2, 2400.0).unwrap();
    let soft = Soil::new(1e6, 0.4999, 1500.0).unwrap();
    // Shear waves five thousand times as fast as below, too.
    let rigid = Soil::new(2.5e13, 0.2, 2400.0).unwrap();
    for (top, base) in [(stiff, soft), (soft, stiff), (rigid, soft), (soft, rigid)] {
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

/// Contrasts of 1e12 in stiffness, 1e5 in thickness, steps of an hour: an answer, or an error soon.
#[test]
fn extreme_contrasts_end() {
    let stiff = Soil::new(1e12, 0.1, 3000.0).unwrap();
    let soft = Soil::new(1.0, 0.4999, 1000.0).unwrap();
    let begin = std::time::Instant::now();
    for (top, base) in [(stiff, soft), (soft, stiff)] {
        for thickness in [1e-2, 1.0, 1e3] {
            for step in [1.0, 3600.0] {
                let profile = SoilProfile::on_half_plane(base).with_layer(top, thickness).unwrap();
                let kernel = two_stages(profile.clone(), &strip()).weights(step).unwrap();
                let [mut zz, mut xx, mut zx] = [[f64::NAN; 4]; 3];
                let outcome = kernel.coefficients(0, 1, &mut [&mut zz, &mut xx, &mut zx]);
                let statics = two_stages(profile, &strip()).static_compliance(&mut [0.0; 36]);
                println!(
                    "{:.0e} on {:.0e}, {thickness}, {step}: {outcome:?} {zz:?} {statics:?} {:?}",
                    top.shear_modulus(),
                    base.shear_modulus(),
                    begin.elapsed()
                );
                assert!(outcome.is_err() || zz.iter().all(|g| g.is_finite()));
            }
        }
    }
    assert!(begin.elapsed().as_secs() < 120, "{:?}", begin.elapsed());
}

/// A law that is not finite somewhere.
#[derive(Debug)]
struct Broken(f64);

impl Relaxation for Broken {
    fn modulus(&self, _s: Complex) -> Complex {
        Complex::real(self.0)
    }
}

#[test]
fn laws_that_are_not_finite_are_refused() {
    for value in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        let profile = p1(Broken(value), Elastic);
        let kernel = two_stages(profile.clone(), &strip()).weights(0.5).unwrap();
        let found = kernel.prepare(1, &mut unobserved).unwrap_err();
        let expected = matches!(found, Error::Soil(SoilError::Modulus { layer: 1, .. }));
        assert!(expected, "{found}");
        let contact = StripContact::Bonded;
        assert!(
            two_stages(profile, &strip()).impedances(&[1.0], contact, &mut unobserved).is_err()
        );
    }
}

/// The same bits on one thread and on several.
#[cfg(feature = "rayon")]
#[test]
fn threads_do_not_change_bits() {
    let values = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let kernel = two_stages(p1(gmb(5), gmb(1)), &strip()).weights(0.5).unwrap();
            let [mut zz, mut xx, mut zx] = [[0.0; 300]; 3];
            kernel.coefficients(1, 1, &mut [&mut zz, &mut xx, &mut zx]).unwrap();
            [zz, xx, zx].map(|list| list.map(f64::to_bits))
        })
    };
    assert_eq!(values(1), values(3));
}

/// Equal and graded meshes, both methods, the same bits twice.
#[test]
fn two_kernels_have_the_same_bits() {
    for (grading, stages) in [(Grading::Uniform, Stages::Two), (Grading::Cosine, Stages::Three)] {
        let strip = Strip::new(-1.0..1.0, 4, grading).unwrap();
        let values = || {
            let ground = two_stages(p1(gmb(5), gmb(1)), &strip).with_stages(stages);
            let [mut zz, mut xx, mut zx] = [[0.0; 100]; 3];
            let kernel = ground.weights(0.5).unwrap();
            kernel.coefficients(2, 100, &mut [&mut zz, &mut xx, &mut zx]).unwrap();
            [zz, xx, zx]
        };
        assert_eq!(values(), values());
    }
}

/// 100 · 0.07 is 7.000000000000001. Damping before the first layer would apply to the base, and leave the layer
/// elastic.
#[test]
fn damping_comes_after_its_layer() {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap();
    let damping = || Hysteretic::new(0.05).unwrap();
    for profile in [SoilProfile::on_half_plane(soil), SoilProfile::on_rigid_bedrock()] {
        let found = profile.clone().with_damping(damping()).with_layer(soil, 6.0);
        assert!(matches!(found, Err(Error::Scene { .. })), "{found:?}");
        assert!(found.err().unwrap().to_string().contains("with_bedrock_damping"));
        let layered = profile.with_bedrock_damping(damping()).with_layer(soil, 6.0).unwrap();
        assert!(layered.with_damping(damping()).with_layer(soil, 6.0).is_ok());
    }
    let bare = SoilProfile::on_half_plane(soil).with_damping(damping());
    assert!(bare.to_string().contains("hysteretic, 5 %"));
}

#[test]
fn profiles_print_numbers_for_people() {
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
