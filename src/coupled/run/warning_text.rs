//! Parts of the texts of warnings: coordinates, numbers of points, likely units.

use crate::motion::STANDARD_GRAVITY;

/// Number (m/s²) above which a ground acceleration is probably meant in cm/s²: six times gravity.
const MAX_NUMBER_IN_M_PER_S2: f64 = 60.0;
/// Number below which an unusual ground acceleration is probably meant in g.
const MAX_NUMBER_IN_G: f64 = 1.0;
/// Densities of usual soils, kg/m³.
const USUAL_SOIL_DENSITIES: [f64; 2] = [1200.0, 3500.0];
/// Speeds of shear waves in usual soils, m/s.
const USUAL_SOIL_SPEEDS: [f64; 2] = [50.0, 3000.0];

/// Text of the coordinate y after x; empty in the plane.
pub(crate) fn y_text(y: Option<f64>) -> String {
    y.map_or(String::new(), |y| format!(", y = {y:.2} m"))
}

/// Text of the height z after x; empty without walls.
pub(crate) fn z_text(z: Option<f64>) -> String {
    z.map_or(String::new(), |z| format!(", z = {z:.2} m"))
}

/// Text of a number of points.
pub(crate) fn point_count_text(count: usize) -> String {
    if count == 1 { "1 point".into() } else { format!("{count} points") }
}

/// Text of the change of a base's static shape if its elements are halved.
///
/// `relative_change`: `None` gives an empty text.
pub(crate) fn refinement_text(relative_change: Option<f64>) -> String {
    match relative_change {
        Some(change) => format!(" (twice as many: {:.1} % of its static shape)", 100.0 * change),
        None => String::new(),
    }
}

/// Unit in which the value of a ground acceleration would be usual.
pub(crate) fn likely_motion_unit(acceleration: f64) -> &'static str {
    match acceleration {
        strong if strong > MAX_NUMBER_IN_M_PER_S2 => "cm/s²",
        weak if weak < MAX_NUMBER_IN_G => "g",
        _ => "another unit, or scaled twice",
    }
}

/// Whether `value` lies between two bounds.
pub(crate) fn is_within([low, high]: [f64; 2], value: f64) -> bool {
    (low..=high).contains(&value)
}

/// Units in which the numbers of a soil would be usual.
pub(crate) fn likely_soil_units(speed: f64, density: f64) -> String {
    let densities = [
        (1.0, ""),
        (1000.0 / STANDARD_GRAVITY, "density in kN/m³"),
        (1000.0, "density in t/m³"),
        (1.0 / STANDARD_GRAVITY, "density in N/m³"),
    ];
    let moduli =
        [(1.0, ""), (1e3, "modulus in kPa"), (1e6, "modulus in MPa"), (1e9, "modulus in GPa")];
    for (density_factor, density_unit) in densities {
        for (modulus_factor, modulus_unit) in moduli {
            let converted_speed = speed * (modulus_factor / density_factor).sqrt();
            if is_within(USUAL_SOIL_DENSITIES, density * density_factor)
                && is_within(USUAL_SOIL_SPEEDS, converted_speed)
            {
                let units =
                    [density_unit, modulus_unit].into_iter().filter(|unit| !unit.is_empty());
                return format!("{}?", units.collect::<Vec<_>>().join(", "));
            }
        }
    }
    "a model not to scale?".into()
}
