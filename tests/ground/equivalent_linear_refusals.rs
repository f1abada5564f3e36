//! GOAL: the equivalent-linear analysis warns where its assumptions do not hold; errors name what is wrong with a site.
//! SCENE: strong shaking of clay; curves, options and motions out of range.
//! REFERENCE: the warning or the typed error, with layer, quantity, value and need.

use basemat::motion::{Record, el_centro_1940};
use basemat::site::{
    ComplexModulus, EquivalentLinear, EquivalentLinearOptions, SiteWarning, SoilColumn,
    VerticalWave,
};
use basemat::soil::{SoilProfile, StrainCurves};
use basemat::{Error, Result, Soil, unobserved};
use basemat_problems::faults::is_input_of;

use super::equivalent_linear::{LayeredSite, darendeli, motion};
use super::equivalent_linear_theory::uniform_profile;

/// Response of the clay at 0.5 g.
fn strongly_shaken_clay(curves: &[StrainCurves], most_iterations: usize) -> EquivalentLinear {
    let options = EquivalentLinearOptions { most_iterations, ..EquivalentLinearOptions::default() };
    let column = LayeredSite::named("clay").column();
    column.equivalent_linear(&motion(0.5), curves, &options, &mut unobserved).unwrap()
}

#[track_caller]
fn assert_warns(computed: &EquivalentLinear, kind: fn(&SiteWarning) -> bool) {
    assert!(computed.warnings.iter().any(kind), "{computed}");
}

/// GOAL: strains beyond the curves, too few iterations, large strains and long ringing cause warnings.
#[test]
fn assumptions_that_do_not_hold_cause_warnings() {
    let curves = LayeredSite::named("clay").curves();
    let narrow_curves = vec![StrainCurves::Table(vec![[1e-6, 1.0, 0.01], [1e-4, 0.8, 0.05]]); 10];
    assert_warns(&strongly_shaken_clay(&narrow_curves, 50), |warning| {
        matches!(warning, SiteWarning::Extrapolated { largest: 1e-4, .. })
    });
    assert_warns(&strongly_shaken_clay(&curves, 2), |warning| {
        matches!(warning, SiteWarning::NotConverged { iterations: 2, .. })
    });
    let strained = strongly_shaken_clay(&curves, 50);
    assert_warns(&strained, |warning| matches!(warning, SiteWarning::LargeStrain { layer: 3, .. }));
    assert!(strained.layers[2].largest_strain > 5e-3);
    assert!(strained.last_change <= 1e-3 && strained.iterations <= 8, "{strained}");
    // Nearly undamped layers on a rigid base ring for long.
    let ringing = SoilColumn::new(uniform_profile(0.0), VerticalWave::Shear).unwrap();
    let linear_curves = vec![StrainCurves::Linear { damping: 0.003 }; 4];
    let record = el_centro_1940().scaled(0.1).unwrap();
    let computed = analysed(&ringing, &record, &linear_curves).unwrap();
    assert!(matches!(computed.warnings[..], [SiteWarning::CutOff { .. }]), "{computed}");
    let zero_motion = Record::new(0.01, vec![0.0; 50]).unwrap();
    let computed = analysed(&ringing, &zero_motion, &linear_curves).unwrap();
    assert_eq!((computed.layers[0].largest_strain, &computed.warnings[..]), (0.0, &[][..]));
}

/// The analysis with default options.
fn analysed(
    column: &SoilColumn,
    motion: &Record,
    curves: &[StrainCurves],
) -> Result<EquivalentLinear> {
    let options = EquivalentLinearOptions::default();
    column.equivalent_linear(motion, curves, &options, &mut unobserved)
}

/// Two layers of 5 m on rigid bedrock.
fn two_layers() -> SoilProfile {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1800.0).unwrap();
    let profile = SoilProfile::on_rigid_bedrock().with_layer(soil, 5.0).unwrap();
    profile.with_layer(soil, 5.0).unwrap()
}

fn two_layer_column() -> SoilColumn {
    SoilColumn::new(two_layers(), VerticalWave::Shear).unwrap()
}

/// A single sample of 1 m/s² between zeros.
fn single_sample() -> Record {
    Record::new(0.01, vec![0.0, 1.0, 0.0]).unwrap()
}

/// GOAL: curves out of range are errors of their layer.
#[test]
fn invalid_curves_are_errors_by_layer() {
    let nan = f64::NAN;
    for bad_curves in [
        StrainCurves::Linear { damping: 1.0 },
        StrainCurves::VuceticDobry { plasticity_index: 200.1 },
        StrainCurves::VuceticDobry { plasticity_index: nan },
        StrainCurves::Epri { depth: 305.0 },
        StrainCurves::Epri { depth: -1.0 },
        darendeli(-1.0, 1.0, 1e5, 1.0, 10.0),
        darendeli(0.0, 0.0, 1e5, 1.0, 10.0),
        darendeli(0.0, 1.0, nan, 1.0, 10.0),
        darendeli(0.0, 1.0, 1e5, 0.03, 10.0),
        darendeli(0.0, 1.0, 1e5, 1.0, 0.5),
        darendeli(0.0, 1.0, 1e-5, 1.0, 10.0),
        StrainCurves::Table(vec![]),
        StrainCurves::Table(vec![[0.0, 1.0, 0.01]]),
        StrainCurves::Table(vec![[1e-4, 1.0, 0.01], [1e-4, 0.9, 0.02]]),
        StrainCurves::Table(vec![[1e-4, 1.1, 0.01]]),
        StrainCurves::Table(vec![[1e-4, 0.8, 0.01], [1e-3, 0.9, 0.02]]),
        StrainCurves::Table(vec![[1e-4, 0.0, 0.01]]),
        StrainCurves::Table(vec![[1e-4, 1.0, -0.01]]),
        StrainCurves::Table(vec![[f64::INFINITY, 1.0, 0.01]]),
    ] {
        assert!(bad_curves.at(1e-4).is_err(), "{bad_curves:?}");
        let curves = [StrainCurves::SeedIdrissMean, bad_curves.clone()];
        let outcome = analysed(&two_layer_column(), &single_sample(), &curves);
        let Err(Error::Item { item, .. }) = outcome else {
            panic!("{bad_curves:?}: {outcome:?}")
        };
        assert_eq!(item, "layer 2", "{bad_curves:?}");
    }
    let good_curves = StrainCurves::SeedIdrissMean;
    assert!(good_curves.at(-1e-9).is_err() && good_curves.at(nan).is_err());
}

/// GOAL: options out of range are named.
#[test]
fn invalid_options_are_named_in_their_error() {
    let default = EquivalentLinearOptions::default();
    let curves = [StrainCurves::SeedIdrissMean, StrainCurves::SeedIdrissMean];
    for (options, name) in [
        (EquivalentLinearOptions::of_magnitude(1.0), "strain ratio"),
        (EquivalentLinearOptions::of_magnitude(f64::NAN), "strain ratio"),
        (EquivalentLinearOptions { tolerance: 0.0, ..default }, "tolerance"),
        (EquivalentLinearOptions { most_iterations: 0, ..default }, "iterations"),
        (EquivalentLinearOptions { band: [1.0, 1.0], ..default }, "band"),
        (EquivalentLinearOptions { band: [f64::NAN, 1.0], ..default }, "band"),
    ] {
        let error = two_layer_column()
            .equivalent_linear(&single_sample(), &curves, &options, &mut unobserved)
            .unwrap_err();
        assert!(error.to_string().contains(name), "{error}");
    }
}

/// GOAL: sites without a solution are errors with layer, quantity, value and need.
#[test]
fn invalid_sites_are_errors_by_layer_quantity_value_and_need() {
    let column = two_layer_column();
    let pulse = single_sample();
    let valid_curves = StrainCurves::SeedIdrissMean;
    let curves = [valid_curves.clone(), valid_curves.clone()];
    let error = analysed(&column, &pulse, &curves[..1]).unwrap_err();
    let quantity = "list of strain curves, one for each layer,";
    assert_eq!(error, Error::Size { quantity, found: 1, needed: 2 });
    let pressure = SoilColumn::new(two_layers(), VerticalWave::Pressure).unwrap();
    let error = analysed(&pressure, &pulse, &curves).unwrap_err();
    assert!(matches!(error, Error::Scene { quantity: "soil column", .. }), "{error}");
    // An undamped layer keeps the waves that a rigid base reflects.
    let undamped_curves = [valid_curves.clone(), StrainCurves::Linear { damping: 0.0 }];
    let error = analysed(&column, &pulse, &undamped_curves).unwrap_err();
    assert!(is_input_of(&error, "layer 2", "damping ratio at small strain", 0.0), "{error}");
    // With this damping a modulus of given magnitude has no positive real part.
    let options = EquivalentLinearOptions {
        complex_modulus: ComplexModulus::Magnitude,
        ..Default::default()
    };
    let compatible = "strain-compatible damping ratio";
    let strongly_damped = [valid_curves.clone(), StrainCurves::Linear { damping: 0.6 }];
    let error = column
        .equivalent_linear(&pulse, &strongly_damped, &options, &mut unobserved)
        .unwrap_err();
    assert!(is_input_of(&error, "layer 2", compatible, 0.6), "{error}");
    // No material has this damping.
    let overdamped = [StrainCurves::Linear { damping: 0.99 }, valid_curves];
    let error = analysed(&column, &pulse, &overdamped).unwrap_err();
    assert!(is_input_of(&error, "layer 1", compatible, 0.99), "{error}");
    // Strains of these motions leave the curves, or the range of numbers.
    let large_response = analysed(&column, &alternating_motion(1e100), &curves);
    assert!(large_response.is_ok_and(|computed| !computed.warnings.is_empty()));
    let too_large = analysed(&column, &alternating_motion(1e300), &curves);
    assert!(matches!(too_large, Err(Error::Input { value: 1e300, .. })));
}

/// Three samples of alternating sign.
fn alternating_motion(amplitude: f64) -> Record {
    Record::new(1.0, vec![amplitude, -amplitude, amplitude]).unwrap()
}
