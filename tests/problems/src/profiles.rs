//! Profiles of the tables: P1, a layer on rock; P3, the same layer on a rigid base.

use basemat::Soil;
use basemat::soil::{GeneralizedMaxwell, Relaxation, SoilProfile};

/// Long-term modulus, moduli and frequencies of the law of `gmb.json` for 5 % or 1 %.
pub fn gmb_numbers(percent: u32) -> (f64, Vec<f64>, Vec<f64>) {
    let text = include_str!("../../data/layered/gmb.json");
    let block = text.split(&format!("\"gmb{percent}\"")).nth(1).unwrap();
    let list = |name: &str| -> Vec<f64> {
        let list = block.split(&format!("\"{name}\": [")).nth(1).unwrap();
        list.split(']').next().unwrap().split(',').map(|x| x.trim().parse().unwrap()).collect()
    };
    let long_term = block.split("\"mr\": ").nth(1).unwrap().split('\n').next().unwrap();
    (long_term.trim().parse().unwrap(), list("y"), list("w"))
}

/// The law of `gmb.json` for 5 % or 1 %.
pub fn gmb(percent: u32) -> GeneralizedMaxwell {
    let (long_term, moduli, frequencies) = gmb_numbers(percent);
    GeneralizedMaxwell::new(long_term, moduli, frequencies).unwrap()
}

fn layer() -> Soil {
    Soil::new(1.0, 0.333_333_333_3, 1.0).unwrap()
}

pub fn p1(
    layer_damping: impl Relaxation + 'static,
    rock_damping: impl Relaxation + 'static,
) -> SoilProfile {
    SoilProfile::on_half_plane(Soil::from_shear_wave_speed(3.0, 0.3, 1.2).unwrap())
        .with_base_damping(rock_damping)
        .with_layer(layer(), 2.0)
        .unwrap()
        .with_damping(layer_damping)
}

pub fn p3(damping: impl Relaxation + 'static) -> SoilProfile {
    SoilProfile::on_rigid_base().with_layer(layer(), 2.0).unwrap().with_damping(damping)
}
