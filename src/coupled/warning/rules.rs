//! When a run warns: limits, and the warnings of a scene, a motion and a run.

use super::Warning;
use super::text::within;
use crate::bem::Ground;
use crate::coupled::energy_balance::EnergyBalance;
use crate::coupled::scene::Scene;
use crate::motion::FreeField;
use crate::soil::Soil;

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
