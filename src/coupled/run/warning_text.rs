//! Parts of the texts of warnings: units, places, changes.

use crate::motion::STANDARD_GRAVITY;

/// Place along y of an element in plan, after its x.
pub(crate) fn across(y: Option<f64>) -> String {
    y.map_or(String::new(), |y| format!(", y = {y:.2} m"))
}

/// Height of a place, where there are walls.
pub(crate) fn height(z: Option<f64>) -> String {
    z.map_or(String::new(), |z| format!(", z = {z:.2} m"))
}

/// A number of points.
pub(crate) fn places(count: usize) -> String {
    if count == 1 { "1 point".into() } else { format!("{count} points") }
}

/// Change of the static shape with twice the elements, where it is known.
pub(crate) fn with_twice_as_many(difference: Option<f64>) -> String {
    match difference {
        Some(change) => format!(" (twice as many: {:.1} % of its static shape)", 100.0 * change),
        None => String::new(),
    }
}

/// Unit in which a ground acceleration would be usual.
pub(crate) fn unit_of_motion(acceleration: f64) -> &'static str {
    match acceleration {
        strong if strong > 60.0 => "cm/s²",
        weak if weak < 1.0 => "g",
        _ => "another unit, or scaled twice",
    }
}

/// Whether `value` lies between two bounds.
pub(crate) fn within([low, high]: [f64; 2], value: f64) -> bool {
    (low..=high).contains(&value)
}

/// Units in which the numbers of a soil would be usual.
pub(crate) fn likely_slip(speed: f64, density: f64) -> String {
    let densities = [
        (1.0, ""),
        (1000.0 / STANDARD_GRAVITY, "density in kN/m³"),
        (1000.0, "density in t/m³"),
        (1.0 / STANDARD_GRAVITY, "density in N/m³"),
    ];
    let moduli =
        [(1.0, ""), (1e3, "modulus in kPa"), (1e6, "modulus in MPa"), (1e9, "modulus in GPa")];
    for (by_density, first) in densities {
        for (by_modulus, second) in moduli {
            let speed = speed * (by_modulus / by_density).sqrt();
            if within([1200.0, 3500.0], density * by_density) && within([50.0, 3000.0], speed) {
                let words = [first, second].into_iter().filter(|word| !word.is_empty());
                return format!("{}?", words.collect::<Vec<_>>().join(", "));
            }
        }
    }
    "a model not to scale?".into()
}
