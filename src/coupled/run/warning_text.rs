//! Texts of the warnings.

use std::fmt;

use crate::coupled::run::warning::Warning;
use crate::error::along;
use crate::motion::STANDARD_GRAVITY;

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LargeSlip { slip, element_length } => write!(
                f,
                "slip of {slip:.3e} m is beyond an element, {element_length:.3e} m on average: \
                 contact is paired for small displacements"
            ),
            Self::LargeRotation { rotation } => {
                write!(
                    f,
                    "base rotation of {rotation:.3e} rad: geometry is that of small rotations"
                )
            }
            Self::LargeSettlement { foundation, settlement, width } => write!(
                f,
                "foundation {foundation} settles by {settlement:.3e} m, width {width:.3} m: beyond a tenth of it \
                 the soil has failed in bearing"
            ),
            Self::Tension { tension, x, y, time } => {
                let across = y.map_or(String::new(), |y| format!(", y = {y:.2} m"));
                write!(
                    f,
                    "base pulled up by {tension:.2e} Pa, x = {x:.2} m{across} at {time:.2} s: its law cannot open"
                )
            }
            Self::EnergyBalance { residual } => write!(f, "energy balance open by {residual:.1e}"),
            Self::AlgorithmicEnergy { made } => write!(
                f,
                "time scheme made {:.1} % of the largest energy: take `Midpoint`, or shorter steps",
                100.0 * made
            ),
            Self::UnresolvedPeriod { period, time_step, needed, error } => write!(
                f,
                "base shear off by about {:.0} %: steps of {time_step:.2e} s, period {period:.2e} s; \
                 take {needed:.1e} s",
                100.0 * error
            ),
            Self::UnresolvedMotion { frequency, time_step, needed, error } => write!(
                f,
                "base shear off by about {:.0} %: steps of {time_step:.2e} s, ground {frequency:.3} Hz; \
                 take {needed:.1e} s",
                100.0 * error
            ),
            Self::UnresolvedRadiation { crossing, time_step, needed } => write!(
                f,
                "steps of {time_step:.2e} s damp rocking: shear waves cross the base in {crossing:.2e} s; \
                 take {needed:.1e} s"
            ),
            Self::FewElements { foundation, elements, needed, axis } => write!(
                f,
                "elements{} under foundation {foundation}: {elements}, its rocking needs {needed}",
                along(*axis)
            ),
            Self::CoarseBase { foundation, elements, needed, difference, axis } => {
                let change = difference.map_or(String::new(), |own| {
                    format!(" (twice as many: {:.1} % of its static shape)", 100.0 * own)
                });
                write!(
                    f,
                    "elements{} under foundation {foundation}: {elements}, its flexible base needs {needed}{change}",
                    along(*axis)
                )
            }
            Self::UncoveredBase { foundation, reach, axis } => write!(
                f,
                "foundation {foundation} reaches {reach:.2} m{} beyond the ground's elements: nothing carries it there",
                along(*axis)
            ),
            Self::SampledPassivity { checked, cells } => {
                write!(f, "passivity of the ground checked on {checked} of {cells} cells")
            }
            Self::LessFriction { steps, friction } => write!(
                f,
                "steps solved with friction {friction:.0} in place of more: {steps}; shear is too small there"
            ),
            Self::HighFriction { friction } => write!(
                f,
                "friction of {friction} in plan: steps may have several solutions; run a mirror image too"
            ),
            Self::MotionAcross => {
                write!(f, "motion along y: a ground in the plane leaves it out")
            }
            Self::LongElements { element_length, wavelength, needed } => write!(
                f,
                "elements of {element_length:.2e} m for shear waves of {wavelength:.2e} m: \
                 take {needed:.1e} m"
            ),
            Self::UnusualSoil { .. }
            | Self::LongPeriod { .. }
            | Self::UnusualMotion { .. }
            | Self::UnusualInterval { .. }
            | Self::LightStructure { .. }
            | Self::UnusualFriction { .. }
            | Self::TallStorey { .. }
            | Self::UnusualGravity { .. }
            | Self::EndsEarly { .. }
            | Self::PeakAtEnd { .. }
            | Self::Overturned { .. }
            | Self::DampedSliding { .. } => self.of_input(f),
        }
    }
}

impl Warning {
    /// Texts of warnings about the user's input: numbers in another unit, the length of a run, damping.
    fn of_input(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnusualSoil { shear_wave_speed, density } => write!(
                f,
                "soil of {density:.3e} kg/m³, shear waves of {shear_wave_speed:.2e} m/s: {}",
                likely_slip(*shear_wave_speed, *density)
            ),
            Self::LongPeriod { period } => write!(
                f,
                "structure with a period of {period:.3} s on a fixed base: stiffness in kN/m or kPa?"
            ),
            Self::UnusualMotion { acceleration } => {
                let unit = if *acceleration > 1.0 { "cm/s²" } else { "g" };
                write!(f, "ground acceleration of {acceleration:.3} m/s²: motion in {unit}?")
            }
            Self::UnusualInterval { time_step } => {
                write!(f, "record in steps of {time_step:.2e} s: interval in another unit?")
            }
            Self::LightStructure { pressure } => write!(
                f,
                "weight of {pressure:.3} Pa over the area of the base: masses in t, or gravity in another unit?"
            ),
            Self::UnusualFriction { friction } => {
                write!(f, "friction coefficient of {friction}: in degrees, or in per cent?")
            }
            Self::TallStorey { height } => {
                write!(f, "storey of {height:.1} m: in another unit, or in place of the mass?")
            }
            Self::UnusualGravity { gravity } => {
                write!(f, "gravity of {gravity} m/s²: in another unit?")
            }
            Self::EndsEarly { end, duration, passed } => write!(
                f,
                "run ends at {end:.2} s, its record at {duration:.2} s: {:.0} % of the record's intensity until then",
                100.0 * passed
            ),
            Self::PeakAtEnd { quantity, end } => {
                write!(f, "{} largest in the last step, at {end:.2} s: run longer", quantity.name())
            }
            Self::Overturned { limit, time } => write!(
                f,
                "run ended at {time:.2} s: base turned by more than {limit} rad (`rotation_limit`)"
            ),
            Self::DampedSliding { rate, loss } => write!(
                f,
                "damping resists translation ({rate:.2}/s): longest slip event short by about {:.0} %",
                100.0 * loss
            ),
            // Texts of the others are above.
            _ => Ok(()),
        }
    }
}

/// Whether `value` lies between two bounds.
pub(crate) fn within([least, most]: [f64; 2], value: f64) -> bool {
    (least..=most).contains(&value)
}

/// Units in which the numbers of a soil would be usual.
fn likely_slip(speed: f64, density: f64) -> String {
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
