//! GOAL: soils, strips, grounds and their kernels return errors for bad numbers and huge counts.
//! SCENE: zero, negative and non-finite parameters; grounds that were not prepared.
//! REFERENCE: the fields of the error.

use basemat::bem::{
    ContactElement, ElasticGround, Grading, Ground, InfluenceKernel, PatchKernel, SpringGround,
    Strip,
};
use basemat::history::ConvolutionWeights;
use basemat::motion::{Record, el_centro_1940};
use basemat::soil::{GeneralizedMaxwell, Hysteretic, KelvinVoigt, Kjartansson};
use basemat::structure::{ModalDamping, RayleighDamping, RigidBlock, ShearBuilding, Storey};
use basemat::{Error, Soil, unobserved};

use super::{
    NEGATIVE_OR_NOT_FINITE, NOT_FINITE, NOT_POSITIVE_FINITE, assert_errors, error_with, soil,
};
use basemat_problems::block_on_springs::bed;

#[test]
fn soils_return_errors_for_invalid_numbers() {
    assert_errors("shear modulus", &NOT_POSITIVE_FINITE, |x| Soil::new(x, 0.3, 1.0));
    assert_errors("density", &NOT_POSITIVE_FINITE, |x| Soil::new(1.0, 0.3, x));
    let out_of_range = [-1.0, 0.5, 0.7, -3.0, f64::NAN, f64::INFINITY];
    assert_errors("Poisson's ratio", &out_of_range, |x| Soil::new(1.0, x, 1.0));
    assert_errors("shear wave speed", &NOT_POSITIVE_FINITE, |x| {
        Soil::from_wave_speeds(x, 2.0, 1.0)
    });
    assert_errors("pressure wave speed", &NOT_POSITIVE_FINITE, |x| {
        Soil::from_wave_speeds(1.0, x, 1.0)
    });
    assert_errors("density", &NOT_POSITIVE_FINITE, |x| Soil::from_wave_speeds(1.0, 2.0, x));
    error_with("Poisson's ratio", Soil::from_wave_speeds(1.0, 1.1, 1.0));
    error_with("shear wave speed", Soil::new(1e-300, 0.3, 1e300));
}

#[test]
fn strips_and_grounds_return_errors_for_invalid_numbers() {
    assert_errors("left end", &NOT_FINITE, |x| Strip::uniform(x..1.0, 2));
    assert_errors("right end", &NOT_FINITE, |x| Strip::new(0.0..x, 2, Grading::Cosine));
    assert_errors("length of the strip", &[0.0, -1.0], |x| Strip::uniform(0.0..x, 2));
    assert_errors("number of contact elements", &[0.0], |_| Strip::uniform(0.0..1.0, 0));
    assert_errors("strip node", &NOT_FINITE, |x| Strip::from_nodes(vec![0.0, x, 2.0]));
    assert_errors("length of a contact element", &[0.0], |_| Strip::from_nodes(vec![1.0, 1.0]));
    let error = error_with("strip nodes", Strip::from_nodes(vec![1.0]));
    assert!(matches!(error, Error::Size { found: 1, needed: 2, .. }));

    assert_errors("length of the strip", &[-1.0], |x| {
        ElasticGround::new(soil(), Strip::uniform(0.0..x, 2)?)
    });
    assert_errors("number of contact", &[0.0], |_| {
        ElasticGround::new(soil(), Strip::graded(0.0..1.0, 0)?)
    });
    let error = error_with("contact elements", ElasticGround::new(soil(), []));
    assert!(matches!(error, Error::Size { found: 0, needed: 1, .. }));
    assert_errors("left end of a contact element", &[1.0, -2.0], |x| {
        ElasticGround::new(soil(), [Strip::uniform(0.0..2.0, 2)?, Strip::uniform(x..x + 2.0, 2)?])
    });

    assert_errors("normal stiffness", &NOT_POSITIVE_FINITE, |x| {
        SpringGround::new(0.0..1.0, 2, x, 1.0)
    });
    assert_errors("tangential stiffness", &NOT_POSITIVE_FINITE, |x| {
        SpringGround::new(0.0..1.0, 2, 1.0, x)
    });
    assert_errors("normal dashpot", &NEGATIVE_OR_NOT_FINITE, |x| bed(2).with_dashpots(x, 0.0));
    assert_errors("tangential dashpot", &NEGATIVE_OR_NOT_FINITE, |x| bed(2).with_dashpots(0.0, x));
    assert_errors("theta", &[0.49, 1.01, f64::NAN], |x| bed(2).with_theta(x));
    assert_errors("time step", &NOT_POSITIVE_FINITE, |x| bed(2).prepare(x, None, &mut unobserved));
    assert_errors("time step", &NOT_POSITIVE_FINITE, |x| {
        ElasticGround::new(soil(), Strip::uniform(0.0..1.0, 2)?)?.prepare(x, None, &mut unobserved)
    });
}

#[test]
fn errors_of_an_unprepared_half_plane_name_prepare() {
    let mut ground = ElasticGround::new(soil(), Strip::uniform(0.0..1.0, 1).unwrap()).unwrap();
    error_with("prepare", ground.step_compliance(&mut [0.0; 4]));
    error_with("prepare", ground.history(&mut [0.0; 2]));
}

#[test]
fn errors_of_an_unprepared_spring_bed_name_prepare() {
    let mut bed = SpringGround::new(0.0..1.0, 1, 1e6, 1e6).unwrap();
    error_with("prepare", bed.step_compliance(&mut [0.0; 4]));
    error_with("prepare", bed.history(&mut [0.0; 2]));
}

/// Huge counts are errors or are reduced, and are not allocated.
#[test]
fn huge_counts_do_not_panic() {
    for count in [0, 1_000_000_000_000, usize::MAX] {
        error_with("contact elements", Strip::uniform(0.0..1.0, count));
        error_with("contact elements", SpringGround::new(0.0..1.0, count, 1.0, 1.0));
    }
    let mut ground = ElasticGround::new(soil(), Strip::uniform(0.0..1.0, 1).unwrap()).unwrap();
    ground.prepare(0.01, Some(usize::MAX), &mut unobserved).unwrap();

    // Steps far longer than the passage of the fronts must not be subdivided forever.
    for step in [1e200, 1e300] {
        ground.prepare(step, None, &mut unobserved).unwrap();
        assert!(ground.step_compliance(&mut [0.0; 4]).is_ok());
    }

    let left = ContactElement::new(0.0, 1.0);
    let right = ContactElement::new(1.0, 2.0);
    let patch = PatchKernel::new(soil(), vec![left, right], 1e-30).unwrap();
    let always_coupled = (0..patch.classes().count())
        .find(|&class| patch.last_coupling_lag(class).unwrap() == Some(usize::MAX - 1));
    let mut slices = [&mut [0.0; 2][..], &mut [0.0; 2], &mut [0.0; 2]];
    patch.coefficients(always_coupled.unwrap(), usize::MAX, &mut slices).unwrap();
}

#[test]
fn kernels_return_errors_for_invalid_numbers() {
    assert_errors("time step", &NOT_POSITIVE_FINITE, |x| InfluenceKernel::new(soil(), x));
    let kernel = InfluenceKernel::new(soil(), 1e-3).unwrap();
    let unit = ContactElement::new(0.0, 1.0);
    for (left, right) in [(f64::NAN, 1.0), (0.0, f64::INFINITY), (1.0, 0.0)] {
        let invalid_element = ContactElement::new(left, right);
        assert!(matches!(kernel.coefficients(invalid_element, unit, 1), Err(Error::Input { .. })));
        assert!(matches!(kernel.coefficients(unit, invalid_element, 1), Err(Error::Input { .. })));
        assert!(PatchKernel::new(soil(), vec![invalid_element], 1e-3).is_err());
    }
    assert_errors("lag", &[0.0], |_| kernel.coefficients(unit, unit, 0));
    let patch = PatchKernel::new(soil(), vec![unit], 1e-3).unwrap();
    let result_of_unequal_lists =
        patch.coefficients(0, 1, &mut [&mut [0.0; 3], &mut [0.0; 2], &mut [0.0; 3]]);
    assert!(matches!(
        error_with("xx", result_of_unequal_lists),
        Error::Size { found: 2, needed: 3, .. }
    ));
    error_with("first lag", patch.coefficients(0, 0, &mut [&mut [0.0], &mut [0.0], &mut [0.0]]));

    assert_errors("time step", &NOT_POSITIVE_FINITE, |x| PatchKernel::new(soil(), vec![unit], x));
    error_with("contact elements", PatchKernel::new(soil(), vec![], 1e-3));
    let overlapping = vec![unit, ContactElement::new(0.5, 1.5)];
    error_with("left end", PatchKernel::new(soil(), overlapping, 1e-3));
}

/// Every damping ratio must be below one: 5 % is 0.05, not 5.
#[test]
fn damping_ratios_in_per_cent_are_errors() {
    type RatioSetter<'a> = &'a dyn Fn(f64) -> basemat::Result<()>;
    let storeys = [Storey::new(3.0, 30e3, 60e6)];
    let building = ShearBuilding::new(8.0, 60e3, 4e5, &storeys).unwrap();
    let wrong_ratios = [5.0, 1.0, -0.1, f64::NAN, f64::INFINITY];
    let kinds: [(&str, RatioSetter); 8] = [
        ("building", &|x| building.clone().with_stiffness_damping(x).map(drop)),
        ("modal", &|x| ModalDamping::new(&[0.05, x]).map(drop)),
        ("Rayleigh", &|x| RayleighDamping::from_ratios([1.0, 5.0], [0.9, x]).map(drop)),
        ("Maxwell", &|x| GeneralizedMaxwell::constant_q(x, [0.1, 10.0], 1.0).map(drop)),
        ("Kelvin–Voigt", &|x| KelvinVoigt::with_ratio(x, 1.0).map(drop)),
        ("Kjartansson", &|x| Kjartansson::new(x, 1.0).map(drop)),
        ("hysteretic", &|x| Hysteretic::new(x).map(drop)),
        ("spectrum", &|x| el_centro_1940().response_spectrum(&[0.5], x, &mut unobserved).map(drop)),
    ];
    for (kind, set_ratio) in kinds {
        println!("{kind}");
        assert_errors("damping ratio", &wrong_ratios, set_ratio);
        error_with("0.05 is 5 %", set_ratio(5.0));
        if !["Rayleigh", "Maxwell"].contains(&kind) {
            set_ratio(0.05).unwrap();
            set_ratio(0.99).unwrap();
        }
    }
}

/// Three equal storeys.
fn building_of(storey: Storey) -> basemat::Result<ShearBuilding> {
    ShearBuilding::new(8.0, 60e3, 4e5, &[storey; 3])
}

/// A product that overflows is named with its factors.
#[test]
fn products_that_overflow_are_errors() {
    error_with("by its size and density", RigidBlock::new(1e200, 1e200, 1.0));
    error_with("by its size and density", RigidBlock::new(1e200, 1.0, 1.0));
    error_with("by its density and speed", Soil::from_shear_wave_speed(1e200, 0.3, 1.0));
    error_with("by its density and speed", Soil::from_wave_speeds(1e200, 2e200, 1.0));
    let storey = Storey::new(3.0, 30e3, 60e6);
    error_with("by masses and heights", building_of(Storey { height: 1e160, ..storey }));
    error_with("by masses and heights", building_of(Storey { height: 1e300, ..storey }));
    let heavy_building = building_of(Storey { mass: 1e300, ..storey }).unwrap();
    error_with("by masses and stiffnesses", heavy_building.with_stiffness_damping(0.05));
    // Both samples are finite, and so are their integrals.
    let steep_record = Record::new(1e-3, vec![0.0, 1e308, -1e308, 0.0]);
    error_with("rate of change of the record's acceleration", steep_record);
    let high = Record::new(1.0, vec![0.0, 4e307, -4e307, 0.0]).unwrap();
    for k in 0..=300 {
        let time = 0.01 * f64::from(k);
        let motion_components =
            [high.at(time).acceleration, high.at(time).velocity, high.at(time).displacement];
        assert!(motion_components.iter().all(|x| x.is_finite()), "{time}: {motion_components:?}");
    }
}
