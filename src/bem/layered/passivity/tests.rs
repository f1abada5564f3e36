//! Tests that the mobility of random grounds is accretive, and that the check detects other mobilities.

use basemat_testkit::random::Random;

use super::*;
use crate::Error;
use crate::bem::layered::runge_kutta::Stages;
use crate::bem::layered::test_profiles::{gmb, p1, p3};
use crate::bem::layered::wavenumber::{Compliances, StripWorkspace, Wavenumbers};
use crate::bem::{Grading, Strip};
use crate::soil::SoilError;
use crate::soil::{
    Elastic, GeneralizedMaxwell, KelvinVoigt, Kjartansson, Relaxation, Soil, SoilProfile,
};

fn quadrature(profile: SoilProfile, classes: &PairClasses, time_step: f64) -> Quadrature {
    Quadrature::new(profile, classes, Stages::Two, time_step, 1e-10)
}

/// Damping law of one of four types, with this damping ratio.
fn law(law_type: u8, ratio: f64) -> std::sync::Arc<dyn Relaxation> {
    match law_type {
        0 => std::sync::Arc::new(Elastic),
        1 => std::sync::Arc::new(KelvinVoigt::new(0.1 * ratio).unwrap()),
        2 => std::sync::Arc::new(Kjartansson::new(ratio, 1.0).unwrap()),
        _ => std::sync::Arc::new(GeneralizedMaxwell::constant_q(ratio, [0.03, 3.0], 0.3).unwrap()),
    }
}

/// A layer with each property in a wide range.
fn random_layer(random: &mut Random) -> crate::soil::SoilLayer {
    let speed = random.within(-1.0, 1.5).exp2();
    let poisson = random.within(-0.5, 0.4999);
    let density = random.within(0.5, 2.0);
    crate::soil::SoilLayer {
        soil: Soil::from_shear_wave_speed(speed, poisson, density).unwrap(),
        thickness: 10.0_f64.powf(random.within(-2.0, 1.5)),
        damping: law(random.pick(&[0, 1, 2, 3]), random.within(0.001, 0.2)),
    }
}

/// Smallest eigenvalue of Herm(sF), with every pair relative to the mobilities of its elements.
#[test]
fn mobility_of_random_grounds_is_accretive() {
    for scene in 0..150 {
        let mut random = Random(scene);
        let mut layers: Vec<_> =
            (0..random.pick(&[1, 2, 3, 4])).map(|_| random_layer(&mut random)).collect();
        let last_layer = layers.pop().unwrap();
        let bedrock = if random.chance(0.5) && !layers.is_empty() {
            crate::soil::Bedrock::Rigid
        } else {
            crate::soil::Bedrock::HalfPlane { soil: last_layer.soil, damping: last_layer.damping }
        };
        let profile = SoilProfile::new(layers, bedrock).unwrap();
        let element_count = random.pick(&[1, 2, 3, 4, 5, 6]);
        let strip = Strip::new(-1.0..1.0, element_count, Grading::Cosine).unwrap();
        let classes = PairClasses::new(strip.elements()).unwrap();
        let magnitude = 10.0_f64.powf(random.within(-2.0, 1.5));
        let real_part = magnitude * 10.0_f64.powf(random.within(-3.0, 0.0));
        let s = Complex::new(
            real_part,
            (magnitude * magnitude - real_part * real_part).max(0.0).sqrt(),
        );
        let integrals = Wavenumbers::new(&classes, 1e-10);
        let mut values = vec![[Complex::default(); 3]; classes.count()];
        integrals
            .compliance(&profile, s, &mut StripWorkspace::default(), &mut values)
            .unwrap();
        for value in values.iter_mut().flatten() {
            *value = *value * s;
        }
        let margin = margin(&classes, &values);
        assert!(margin >= -1e-10, "scene {scene}: {margin:e} at {s:?}\n{profile}");
    }
}

#[test]
fn table_profiles_are_passive_for_all_steps() {
    let strip = Strip::new(-1.0..1.0, 6, Grading::Cosine).unwrap();
    let classes = PairClasses::new(strip.elements()).unwrap();
    for profile in [p1(gmb(5), gmb(1)), p1(Elastic, Elastic), p3(gmb(5)), p3(Elastic)] {
        for time_step in [0.02, 0.3, 5.0, 50.0] {
            check(
                &quadrature(profile.clone(), &classes, time_step),
                &classes,
                &[],
                &mut ProgressReporter::unobserved(),
            )
            .unwrap();
        }
    }
}

/// Modulus with negative damping: the stiffness decreases with frequency.
#[derive(Debug)]
struct ActiveLaw;

impl Relaxation for ActiveLaw {
    fn modulus(&self, s: Complex) -> Complex {
        Complex::real(1.0) - s.scale(0.3) / (s + Complex::real(2.0))
    }
}

#[test]
fn active_damping_is_an_error() {
    let strip = Strip::uniform(-1.0..1.0, 2).unwrap();
    let classes = PairClasses::new(strip.elements()).unwrap();
    let outcome = check(
        &quadrature(p1(ActiveLaw, Elastic), &classes, 0.1),
        &classes,
        &[],
        &mut ProgressReporter::unobserved(),
    );
    assert!(
        matches!(outcome, Err(Error::Soil(SoilError::Modulus { layer: 1, quantity: "Re(mu/s)/|mu/s|", value, .. })) if value < 0.0),
        "{outcome:?}"
    );
}

/// Matrices of all pairs are symmetric, also with unequal elements, so that Hermitian parts are real parts.
#[test]
fn mobilities_are_reciprocal() {
    let strip = Strip::new(-1.0..1.0, 5, Grading::Cosine).unwrap();
    let classes = PairClasses::new(strip.elements()).unwrap();
    let quadrature = quadrature(p3(gmb(5)), &classes, 0.1);
    let mut values = vec![[Complex::default(); 3]; classes.count()];
    let mut compliances = values.clone();
    let log_z = [CHECK_RADIUS.ln(), 0.4];
    quadrature
        .mobility(log_z, &mut StripWorkspace::default(), &mut compliances, &mut values)
        .unwrap();
    let matrix = assembled(&classes, &values);
    let order = classes.layout().len();
    let mut max_imaginary_part = 0.0_f64;
    for (index, value) in matrix.iter().enumerate() {
        let transposed = matrix[index % order * order + index / order];
        assert_eq!(*value, transposed);
        max_imaginary_part = max_imaginary_part.max(value.im.abs());
    }
    let scales: Vec<_> =
        (0..order).map(|index| 1.0 / matrix[index * (order + 1)].norm().sqrt()).collect();
    let scaled_matrix: Vec<_> = (0..order * order)
        .map(|index| matrix[index] * scales[index / order] * scales[index % order])
        .collect();
    let min_eigenvalue = crate::linalg::hermitian_range(&scaled_matrix, order).unwrap()[0];
    let computed_margin = margin(&classes, &values);
    assert!(
        max_imaginary_part > 0.0 && (min_eigenvalue - computed_margin).abs() < 1e-13,
        "{min_eigenvalue} {computed_margin}"
    );
    for (limit, expected) in [(min_eigenvalue - 1e-10, true), (min_eigenvalue + 1e-10, false)] {
        let exceeds = classes
            .exceeds(limit, self_mobility(&values), |_, pair| real_parts(&values[pair.class]));
        assert_eq!(exceeds, expected);
    }
}

/// The check reports the smallest eigenvalue, also for a limit that no ground satisfies.
#[test]
fn the_check_reports_the_smallest_eigenvalue() {
    let strip = Strip::uniform(-1.0..1.0, 2).unwrap();
    let classes = PairClasses::new(strip.elements()).unwrap();
    let quadrature = quadrature(p1(gmb(5), gmb(1)), &classes, 0.1);
    let mut values = vec![[Complex::default(); 3]; classes.count()];
    let mut compliances = values.clone();
    let log_z = [CHECK_RADIUS.ln(), 1.0];
    quadrature
        .mobility(log_z, &mut StripWorkspace::default(), &mut compliances, &mut values)
        .unwrap();
    assert!(margin(&classes, &values) > 0.0);
    // With the mobilities of the elements scaled to one, the sign of the coupling between elements decides.
    for class in 0..classes.count() {
        let pair = classes.representative(class).unwrap();
        if pair[0] == pair[1] {
            values[class] = values[class].map(|value| -value);
        }
    }
    let negative_margin = margin(&classes, &values);
    assert!(negative_margin < -0.5, "{negative_margin}");
    values[0][0] = Complex::real(f64::NAN);
    assert!(margin(&classes, &values).is_nan());
    let strict_quadrature = Quadrature { tolerance: -0.25, ..quadrature };
    let outcome = check(&strict_quadrature, &classes, &[], &mut ProgressReporter::unobserved());
    let Err(Error::NotPassive { margin, allowed, radius, .. }) = outcome else {
        panic!("{outcome:?}");
    };
    assert!(margin > 0.0 && margin < allowed && allowed == 1.0 && radius == 0.99, "{margin}");
}
