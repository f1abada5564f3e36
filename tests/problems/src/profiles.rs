//! Profiles of the tables (P1, a layer on rock; P3, the same layer on a rigid base) and of inclined waves.

use basemat::Soil;
use basemat::bem::layered::Stages;
use basemat::bem::{ElasticGround, Strip};
use basemat::soil::{Elastic, GeneralizedMaxwell, Hysteretic, Relaxation, SoilProfile};

pub use basemat_testkit::gmb_numbers;

/// The law of `gmb.json` for a damping ratio of 5 % or 1 %.
pub fn gmb(percent: u32) -> GeneralizedMaxwell {
    let numbers = gmb_numbers(percent);
    GeneralizedMaxwell::new(numbers.0, numbers.1, numbers.2).unwrap()
}

/// A ground with convolution weights of two stages.
pub fn two_stages(profile: SoilProfile, strip: &Strip) -> ElasticGround {
    ElasticGround::new(profile, strip).unwrap().with_stages(Stages::Two)
}

fn layer() -> Soil {
    Soil::new(1.0, 0.333_333_333_3, 1.0).unwrap()
}

/// A layer on rock.
pub fn p1(
    layer_damping: impl Relaxation + 'static,
    rock_damping: impl Relaxation + 'static,
) -> SoilProfile {
    SoilProfile::on_half_plane(Soil::from_shear_wave_speed(3.0, 0.3, 1.2).unwrap())
        .with_bedrock_damping(rock_damping)
        .with_layer(layer(), 2.0)
        .unwrap()
        .with_damping(layer_damping)
}

/// The same layer on a rigid base.
pub fn p3(damping: impl Relaxation + 'static) -> SoilProfile {
    SoilProfile::on_rigid_bedrock()
        .with_layer(layer(), 2.0)
        .unwrap()
        .with_damping(damping)
}

/// Soft soil, shear waves of 150 m/s.
pub fn soft() -> Soil {
    Soil::from_shear_wave_speed(150.0, 0.4, 1800.0).unwrap()
}

/// Rock, shear waves of 600 m/s.
pub fn rock() -> Soil {
    Soil::from_shear_wave_speed(600.0, 0.25, 2200.0).unwrap()
}

/// Damping of this ratio from 0.1 to 30 Hz, modulus of 1 Hz.
pub fn constant_q(ratio: f64) -> GeneralizedMaxwell {
    GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0).unwrap()
}

/// A soft layer of 6 m and a stiffer one of 9 m on rock.
pub fn two_layers(
    upper: impl Relaxation + 'static,
    lower: impl Relaxation + 'static,
) -> SoilProfile {
    SoilProfile::on_half_plane(rock())
        .with_bedrock_damping(lower)
        .with_layer(soft(), 6.0)
        .unwrap()
        .with_damping(upper)
        .with_layer(Soil::from_shear_wave_speed(400.0, 0.3, 2000.0).unwrap(), 9.0)
        .unwrap()
}

/// A layer and the half-plane under it with the laws of both: elastic, damped and hysteretic.
pub fn one_layer(
    above: Soil,
    below: Soil,
    height: f64,
) -> [(SoilProfile, [Box<dyn Relaxation>; 2]); 3] {
    let soils = [above, below];
    [
        damped_layer(soils, height, [Elastic; 2]),
        damped_layer(soils, height, [0.05, 0.01].map(constant_q)),
        damped_layer(soils, height, [0.1, 0.03].map(|ratio| Hysteretic::new(ratio).unwrap())),
    ]
}

/// A layer and the half-plane under it with these laws, and the laws of both.
fn damped_layer<L: Relaxation + Clone + 'static>(
    [above, below]: [Soil; 2],
    height: f64,
    [upper, lower]: [L; 2],
) -> (SoilProfile, [Box<dyn Relaxation>; 2]) {
    let base = SoilProfile::on_half_plane(below).with_bedrock_damping(lower.clone());
    let profile = base.with_layer(above, height).unwrap().with_damping(upper.clone());
    (profile, [Box::new(upper), Box::new(lower)])
}
