//! Warnings of a run.

use std::fmt;

use super::energy_balance::EnergyBalance;
use super::scene::Scene;
use crate::bem::Ground;
use crate::error::along;
use crate::motion::{FreeField, STANDARD_GRAVITY};
use crate::soil::Soil;

/// Warning that assumptions of a run are strained, or that its time step or elements are too coarse.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
#[non_exhaustive]
pub enum Warning {
    /// Slip beyond the mean length of the elements, in plan of their shorter sides: they no longer face each other.
    LargeSlip {
        /// Largest slip, m.
        slip: f64,
        /// Mean length of the elements, m.
        element_length: f64,
    },
    /// Rotation of the base beyond 0.1 rad, in plan about any axis: cosines are no longer one.
    LargeRotation {
        /// Largest rotation, rad.
        rotation: f64,
    },
    /// Tension under a base that cannot open, above 1 % of the largest static pressure: it is held down by what the
    /// model does not have.
    Tension {
        /// Largest tension of any element, Pa.
        tension: f64,
        /// Middle of that element, m.
        x: f64,
        /// In plan: middle of that element along y, m.
        #[cfg_attr(feature = "serde", serde(default))]
        y: Option<f64>,
        /// Time of that tension, s.
        time: f64,
    },
    /// The energy balance does not close to 1e-9 at the end.
    EnergyBalance {
        /// Residual of the balance, relative to the largest energy of the run.
        #[cfg_attr(feature = "serde", serde(with = "crate::text::words::number"))]
        residual: f64,
    },
    /// The time scheme has made energy, more than 2 % of the run's largest:
    /// see [`Newmark`](super::Newmark).
    AlgorithmicEnergy {
        /// Most that it had made at any time, relative to the largest energy of the run.
        #[cfg_attr(feature = "serde", serde(with = "crate::text::words::number"))]
        made: f64,
    },
    /// The base shear vibrates with a period that the time step does not resolve.
    UnresolvedPeriod {
        /// Root-mean-square period of the base shear, s.
        period: f64,
        /// The time step, s.
        time_step: f64,
        /// Time step that resolves the motion, s.
        needed: f64,
        /// Estimated error of the largest base shear, relative, from frequencies alone: half the true
        /// one or more in nine cases of ten. A run with half the time step shows it.
        error: f64,
    },
    /// The ground moves faster than the time step resolves, and the base shear with it.
    UnresolvedMotion {
        /// Root-mean-square frequency of the ground acceleration, Hz.
        frequency: f64,
        /// The time step, s.
        time_step: f64,
        /// Time step that resolves the motion, s.
        needed: f64,
        /// Estimated error of the largest base shear, relative: see
        /// [`UnresolvedPeriod`](Self::UnresolvedPeriod).
        error: f64,
    },
    /// In plan, a body vibrates at its own period while shear waves cross its base in less than four steps: steps that
    /// long damp its rocking more than radiation does.
    UnresolvedRadiation {
        /// Time in which shear waves cross the shorter side of the base, s.
        crossing: f64,
        /// The time step, s.
        time_step: f64,
        /// Time step that resolves the motion, s.
        needed: f64,
    },
    /// Fewer elements under a foundation than its rocking stiffness takes.
    FewElements {
        /// Number of the foundation, from the left, from 0.
        foundation: usize,
        /// Elements of the foundation; in plan those of a row or of a column.
        elements: usize,
        /// Fewest that it needs.
        needed: usize,
        /// In plan: `x` for elements of a row, `y` for those of a column.
        #[cfg_attr(feature = "serde", serde(default))]
        axis: Option<char>,
    },
    /// The base reaches beyond the ground's elements, by more than one of them: nothing carries it there.
    UncoveredBase {
        /// Number of the foundation, from the left, from 0.
        foundation: usize,
        /// Distance from the outermost element to the end of the foundation, m.
        reach: f64,
        /// In plan: axis along which the base reaches too far, `x` or `y`.
        #[cfg_attr(feature = "serde", serde(default))]
        axis: Option<char>,
    },
    /// More cells in plan than can be checked for passivity at once: only a sample of them was searched for errors of
    /// the quadrature and damping laws that are not passive. Steps are the same as with a full check.
    SampledPassivity {
        /// Cells that were checked together.
        checked: usize,
        /// All cells.
        cells: usize,
    },
    /// In plan, steps were solved with less friction than the law's, which is infinite or above 100, because an element
    /// slid: its shear is that lower coefficient times its pressure. Steps are counted since the simulation was built,
    /// the static state as one.
    LessFriction {
        /// Number of such steps.
        steps: usize,
        /// Least coefficient used.
        friction: f64,
    },
    /// The motion has a component along y, which a ground in the plane leaves out.
    MotionAcross,
    /// A soil with numbers that no soil has: one in another unit, unless the model is not to scale.
    UnusualSoil {
        /// Speed of its shear waves, m/s.
        shear_wave_speed: f64,
        /// Density, kg/m³.
        density: f64,
    },
    /// A structure slower than almost any: a stiffness in another unit, unless the model is not to scale.
    LongPeriod {
        /// Period on a fixed base, s (Rayleigh's quotient of the deflection under its weight to the side).
        period: f64,
    },
    /// Ground acceleration above any that was recorded: a motion in another unit, unless the model is not to scale.
    UnusualMotion {
        /// Largest component at any step, m/s².
        acceleration: f64,
    },
    /// Elements longer than a quarter of the soil's shear waves at the frequency of the base shear, where waves run
    /// along the base; in plan cells longer than a twelfth.
    LongElements {
        /// Longest element, m; in plan the narrowest along x or along y.
        element_length: f64,
        /// Wavelength at the root-mean-square frequency of the base shear, m.
        wavelength: f64,
        /// Length that resolves it, m.
        needed: f64,
    },
}

impl Warning {
    /// Rotation above which a run warns, rad: the cosine is off by half a percent.
    const ROTATION_LIMIT: f64 = 0.1;
    /// Energy error at the end of a run above which it warns. Earlier, while energies are still
    /// small, it may be larger.
    const ENERGY_ERROR_LIMIT: f64 = 1e-9;
    /// Energy that the time scheme may make before a run warns, relative to the largest energy.
    const ALGORITHMIC_LIMIT: f64 = 0.02;

    /// Tension above which a run under weight warns, relative to the largest static pressure.
    pub(crate) const TENSION_LIMIT: f64 = 0.01;

    /// Speeds of shear waves in soils, m/s, from mud to rock.
    const SOIL_SPEEDS: [f64; 2] = [10.0, 5000.0];
    /// Densities of soils, kg/m³.
    const SOIL_DENSITIES: [f64; 2] = [500.0, 10_000.0];

    /// Period above which a structure is unusually slow, s: only the tallest towers and liquid in wide tanks are
    /// slower.
    const LONGEST_PERIOD: f64 = 8.0;
    /// Acceleration above any that was recorded, m/s²: about 4.5 times gravity was.
    const LARGEST_ACCELERATION: f64 = 60.0;

    /// Warnings of a scene before its first step, of a structure with this `period` on a fixed base (s).
    pub(crate) fn of_scene(
        scene: &Scene,
        ground: &dyn Ground,
        motion: &dyn FreeField,
        period: f64,
    ) -> Vec<Self> {
        let mut warnings: Vec<_> = Self::of_soils(&ground.soils()).collect();
        // A model not to scale has its own warning.
        if warnings.is_empty() && period > Self::LONGEST_PERIOD {
            warnings.push(Self::LongPeriod { period });
        }
        let uncovered = scene.base.uncovered().into_iter();
        warnings.extend(uncovered.map(|(foundation, axis, reach)| Self::UncoveredBase {
            foundation,
            reach,
            axis,
        }));
        if motion.moves_across() && !scene.layout().is_plan() {
            warnings.push(Self::MotionAcross);
        }
        if let Some(taken) = scene.static_state.stand_in {
            Self::count_friction(&mut warnings, taken);
        }
        let sample = ground.sampled_cells();
        warnings.extend(sample.map(|[checked, cells]| Self::SampledPassivity { checked, cells }));
        warnings
    }

    /// Warning of a largest ground acceleration (m/s²) above any recorded.
    pub(crate) fn of_motion(acceleration: f64) -> Option<Self> {
        (acceleration > Self::LARGEST_ACCELERATION).then_some(Self::UnusualMotion { acceleration })
    }

    /// Warnings of `soils` with unusual numbers.
    fn of_soils(soils: &[Soil]) -> impl Iterator<Item = Self> {
        let numbers = soils.iter().map(|soil| [soil.shear_wave_speed(), soil.density()]);
        let unusual = numbers.filter(|[speed, density]| {
            !(within(Self::SOIL_SPEEDS, *speed) && within(Self::SOIL_DENSITIES, *density))
        });
        unusual.map(|[shear_wave_speed, density]| Self::UnusualSoil { shear_wave_speed, density })
    }

    /// Counts a step that was solved with the friction `taken` in place of a greater one.
    pub(crate) fn count_friction(warnings: &mut Vec<Self>, taken: f64) {
        for warning in &mut *warnings {
            if let Self::LessFriction { steps, friction } = warning {
                (*steps, *friction) = (*steps + 1, friction.min(taken));
                return;
            }
        }
        warnings.push(Self::LessFriction { steps: 1, friction: taken });
    }

    /// Warnings of the largest slip, mean element length, largest rotation, last energy balance and least algorithmic
    /// energy of a run.
    pub(crate) fn all(
        slip: f64,
        element_length: f64,
        rotation: f64,
        energy_balance: &EnergyBalance,
        least_algorithmic: f64,
    ) -> Vec<Self> {
        let (slip, rotation) = (slip.abs(), rotation.abs());
        let mut warnings = Vec::new();
        if slip > element_length {
            warnings.push(Self::LargeSlip { slip, element_length });
        }
        if rotation > Self::ROTATION_LIMIT {
            warnings.push(Self::LargeRotation { rotation });
        }
        let residual = energy_balance.residual();
        if residual > Self::ENERGY_ERROR_LIMIT
            || (residual.is_nan() && !energy_balance.is_left_out())
        {
            warnings.push(Self::EnergyBalance { residual });
        }
        let made = -least_algorithmic / energy_balance.scale();
        if made > Self::ALGORITHMIC_LIMIT {
            warnings.push(Self::AlgorithmicEnergy { made });
        }
        warnings
    }
}

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
            Self::MotionAcross => {
                write!(f, "motion along y: a ground in the plane leaves it out")
            }
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
                write!(f, "ground acceleration of {acceleration:.3} m/s²: motion in cm/s²?")
            }
            Self::LongElements { element_length, wavelength, needed } => write!(
                f,
                "elements of {element_length:.2e} m for shear waves of {wavelength:.2e} m: \
                 take {needed:.1e} m"
            ),
        }
    }
}

fn within([least, most]: [f64; 2], value: f64) -> bool {
    (least..=most).contains(&value)
}

/// Units in which the numbers of a soil would be usual ones.
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
