//! Profiles of the tables for unit tests: P1, a layer on rock; P3, the same layer on rigid bedrock.

use crate::soil::{GeneralizedMaxwell, Relaxation, Soil, SoilProfile};

/// Damping law of `gmb.json` for 5 % or 1 % damping.
pub(in crate::bem) fn gmb(percent: u32) -> GeneralizedMaxwell {
    let (long_term, moduli, frequencies) = basemat_testkit::gmb_numbers(percent);
    GeneralizedMaxwell::new(long_term, moduli, frequencies).unwrap()
}

/// Adds the layer of the tables, 2 m thick.
fn with_layer(profile: SoilProfile, damping: impl Relaxation + 'static) -> SoilProfile {
    let layer = Soil::new(1.0, 0.333_333_333_3, 1.0).unwrap();
    profile.with_layer(layer, 2.0).unwrap().with_damping(damping)
}

/// Profile P1: a layer on rock.
pub(in crate::bem) fn p1(
    layer_damping: impl Relaxation + 'static,
    rock_damping: impl Relaxation + 'static,
) -> SoilProfile {
    let rock = Soil::from_shear_wave_speed(3.0, 0.3, 1.2).unwrap();
    with_layer(SoilProfile::on_half_plane(rock).with_bedrock_damping(rock_damping), layer_damping)
}

/// Profile P3: the same layer on rigid bedrock.
pub(in crate::bem) fn p3(damping: impl Relaxation + 'static) -> SoilProfile {
    with_layer(SoilProfile::on_rigid_bedrock(), damping)
}
