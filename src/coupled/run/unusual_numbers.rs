//! Warnings of numbers that are probably mistakes, such as values in other units.

use std::f64::consts::TAU;

use crate::coupled::base::influence::UPWARD_DIRECTION;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::run::GroundMotion;
use crate::coupled::run::mistake::Mistake;
use crate::coupled::run::variation::Variation;
use crate::coupled::run::warning::Warning;
use crate::coupled::run::warning_text::is_within;
use crate::coupled::scene::Scene;
use crate::coupled::statics::strength::{bond_at_rest, friction_at_rest};
use crate::interface::LawForm;
use crate::motion::{FreeField, Record, STANDARD_GRAVITY};
use crate::soil::Soil;
use crate::structure::{Structure, StructureDescription};

/// Speeds of shear waves in soils, m/s, from mud to rock.
const SOIL_WAVE_SPEEDS: [f64; 2] = [10.0, 5000.0];
/// Densities of soils, kg/m³.
const SOIL_DENSITIES: [f64; 2] = [500.0, 10_000.0];
/// Densities of materials of solids and shells, kg/m³: above insulation, and up to the heaviest metal.
const MATERIAL_DENSITIES: [f64; 2] = [100.0, 22_600.0];
/// Period above which a structure is unusually slow, s.
///
/// Only the tallest towers and liquid in wide tanks are slower.
pub(super) const MAX_USUAL_PERIOD: f64 = 8.0;
/// Largest usual ground acceleration, m/s². Few records exceed it; the largest has about 4.5 times gravity.
const MAX_GROUND_ACCELERATION: f64 = 2.0 * STANDARD_GRAVITY;
/// Accelerations of a record (m/s²) that are probably in g: weaker than design motions, and not zero.
///
/// Design motions start at 0.5 m/s², where earthquakes are rare.
const WEAK_ACCELERATIONS: [f64; 2] = [0.02, 0.45];
/// Usual time steps of records, s.
const USUAL_RECORD_TIME_STEPS: [f64; 2] = [1e-4, 0.2];
/// Velocity at the end of a record over the largest velocity, above which the record drifts.
///
/// Records with a corrected baseline end with some per cent.
const MAX_END_VELOCITY_RATIO: f64 = 0.3;
/// Smallest usual weight over the area of a base, Pa: that of a timber floor.
///
/// Below it masses are probably in another unit.
const MIN_BASE_PRESSURE: f64 = 2e3;
/// Largest weight over the area of a base that a soil can resist.
///
/// It is relative to the soil's shear modulus.
///
/// Clay fails at 5.14 times its undrained strength (Prandtl 1921), and its shear modulus at small strains is at least
/// a hundred times that strength: failure at 0.05 or less. The limit is half of that.
const MAX_PRESSURE_RATIO: f64 = 0.025;
/// Smallest plausible ratio of vertical and horizontal mass; below it the smaller mass lacks floors.
const MIN_MASS_RATIO: f64 = 0.9;
/// Strengths of a bond (Pa) that are probably in kPa.
const WEAK_BOND_STRENGTHS: [f64; 2] = [0.5, 1e3];
/// Largest strength of a bond that is probably in kPa, relative to the pressure under the weight.
const MAX_WEAK_BOND_RATIO: f64 = 0.01;
/// Friction coefficients that are probably angles in degrees or percentages.
const UNLIKELY_FRICTION_COEFFICIENTS: [f64; 2] = [15.0, 90.0];
/// Plausible accelerations of gravity, m/s²: the moon has 1.6, Jupiter 25.
const GRAVITY_RANGE: [f64; 2] = [1.5, 30.0];
/// Time step over the mean period of a record above which the steps cannot resolve the record.
const MAX_STEP_PER_RECORD_PERIOD: f64 = 0.5;
/// Recommended number of time steps per mean period of a record.
const STEPS_PER_RECORD_PERIOD: f64 = 15.0;
/// Recommended number of time steps per period of a structure.
const STEPS_PER_STRUCTURE_PERIOD: f64 = 30.0;

/// Weight of a structure on its base.
pub(crate) struct Weight {
    /// Acceleration of gravity, m/s².
    gravity: f64,
    /// Weight over the area of the contact elements, Pa.
    pressure: f64,
    /// Masses of motions along x, up and, in plan, along y, kg; in the plane kg/m.
    masses: Vec<f64>,
}

impl Weight {
    pub(crate) fn new(gravity: f64, assembled: &Assembled) -> Self {
        let translations = assembled.influence.whole_vectors(assembled.dofs());
        let masses: Vec<f64> =
            translations.iter().map(|motion| assembled.mass.form(motion, motion)).collect();
        let pressure =
            gravity * masses[UPWARD_DIRECTION] / assembled.base.areas().iter().sum::<f64>();
        Self { gravity, pressure, masses }
    }
}

/// Mean period of a record's acceleration (root mean square of its frequency), s.
fn mean_period(record: &Record) -> f64 {
    let mut variation = Variation::default();
    for pair in record.accelerations().windows(2) {
        variation.update(pair[0], pair[1]);
    }
    TAU * record.time_step() / (2.0 * variation.ratio().atan())
}

/// Velocity at the end of a record, m/s; `None` unless the record drifts.
fn drift_velocity(record: &Record) -> Option<f64> {
    let velocities = record.velocities();
    let max_velocity = velocities.iter().fold(0.0, |max: f64, velocity| max.max(velocity.abs()));
    let end_velocity = velocities.last().copied()?;
    (end_velocity.abs() > MAX_END_VELOCITY_RATIO * max_velocity).then_some(end_velocity)
}

impl Warning {
    /// Adds warnings of probable mistakes to the `warnings` of a scene.
    ///
    /// `soils`: of the ground, from the surface down.
    pub(crate) fn add_mistakes(
        warnings: &mut Vec<Self>,
        scene: &Scene,
        soils: &[Soil],
        structure: &dyn Structure,
        weight: &Weight,
    ) {
        let description = structure.description();
        let is_unusual_soil =
            |warning: &Self| matches!(warning, Self::Mistake(Mistake::UnusualSoil { .. }));
        let is_to_scale = !warnings.iter().any(is_unusual_soil);
        warnings.extend(Self::of_units(is_to_scale, scene, weight, &description));
        if is_to_scale {
            warnings.extend(Self::of_weight(weight, soils, scene.base.elements().has_walls()));
        }
        warnings.extend(Self::of_faces_off_ground(description.faces_off_ground));
    }

    /// Warnings of numbers of a scene that are probably in another unit.
    ///
    /// For a scene that is not to scale only friction is checked.
    fn of_units(
        is_to_scale: bool,
        scene: &Scene,
        weight: &Weight,
        description: &StructureDescription,
    ) -> Vec<Self> {
        let mut warnings = Vec::new();
        let form = LawForm::of(scene.layout());
        let frictions = scene.laws.iter().map(|law| friction_at_rest(law.as_ref(), form));
        let unlikely_frictions =
            frictions.filter(|friction| is_within(UNLIKELY_FRICTION_COEFFICIENTS, *friction));
        warnings.extend(
            unlikely_frictions
                .reduce(f64::max)
                .map(|friction| Self::Mistake(Mistake::UnusualFriction { friction })),
        );
        if !is_to_scale {
            return warnings;
        }
        let &Weight { gravity, pressure, .. } = weight;
        if gravity > 0.0 && !is_within(GRAVITY_RANGE, gravity) {
            warnings.push(Self::Mistake(Mistake::UnusualGravity { gravity }));
        }
        if gravity > 0.0 && pressure < MIN_BASE_PRESSURE {
            warnings.push(Self::Mistake(Mistake::LightStructure { pressure }));
        }
        let bonds = scene.laws.iter().filter_map(|law| bond_at_rest(law.as_ref(), pressure));
        let weak_bonds = bonds.filter(|strength| {
            is_within(WEAK_BOND_STRENGTHS, *strength) && *strength < MAX_WEAK_BOND_RATIO * pressure
        });
        warnings.extend(
            weak_bonds
                .reduce(f64::min)
                .map(|strength| Self::Mistake(Mistake::WeakBond { strength, pressure })),
        );
        let densities = description.densities.into_iter().flatten();
        let unusual_densities =
            densities.filter(|density| !is_within(MATERIAL_DENSITIES, *density));
        warnings.extend(
            unusual_densities
                .map(|density| Self::Mistake(Mistake::UnusualDensity { density }))
                .take(1),
        );
        warnings
    }

    /// Warnings of a weight beyond the soil's resistance, and of masses that differ between directions.
    fn of_weight(weight: &Weight, soils: &[Soil], has_walls: bool) -> Vec<Self> {
        let &Weight { gravity, pressure, ref masses } = weight;
        let mut warnings = Vec::new();
        if gravity <= 0.0 {
            return warnings;
        }
        let moduli = soils.iter().map(Soil::shear_modulus);
        // A base below the surface may stand on any of the soils.
        let modulus = if has_walls { moduli.reduce(f64::max) } else { moduli.take(1).next() };
        let soft_modulus = modulus.filter(|modulus| pressure > MAX_PRESSURE_RATIO * modulus);
        warnings.extend(soft_modulus.map(|shear_modulus| {
            Self::Mistake(Mistake::HeavyStructure { pressure, shear_modulus })
        }));
        let vertical = masses[UPWARD_DIRECTION];
        let horizontal_masses =
            masses.iter().enumerate().filter(|(direction, _)| *direction != UPWARD_DIRECTION);
        let unequal_mass = horizontal_masses.map(|(_, mass)| *mass).find(|horizontal| {
            *horizontal > 0.0
                && vertical > 0.0
                && (vertical / horizontal).min(horizontal / vertical) < MIN_MASS_RATIO
        });
        warnings.extend(
            unequal_mass
                .map(|horizontal| Self::Mistake(Mistake::UnequalMasses { vertical, horizontal })),
        );
        warnings
    }

    /// Warning of a time step that does not resolve the record with the shortest mean period.
    ///
    /// `time_step`: of the simulation, s; `structure_period`: of the structure on a fixed base, s.
    pub(crate) fn of_time_step(
        time_step: f64,
        motion: &dyn FreeField,
        structure_period: f64,
    ) -> Option<Self> {
        let records = motion.records();
        let periods = records.iter().map(|record| (mean_period(record), record.time_step()));
        let finite_periods = periods.filter(|(period, _)| period.is_finite());
        let (period, interval) = finite_periods.min_by(|a, b| a.0.total_cmp(&b.0))?;
        if time_step <= MAX_STEP_PER_RECORD_PERIOD * period {
            return None;
        }
        let mut needed = period / STEPS_PER_RECORD_PERIOD;
        // A structure with a shorter period than the record follows the record.
        if structure_period > period {
            needed = (structure_period / STEPS_PER_STRUCTURE_PERIOD).min(needed);
        }
        Some(Self::Mistake(Mistake::LongTimeStep { time_step, interval, period, needed }))
    }

    /// Removes the warning of a long time step beside one of unresolved motion.
    pub(super) fn drop_superseded(warnings: &mut Vec<Self>) {
        let has_unresolved_motion = warnings.iter().any(|warning| {
            matches!(warning, Self::UnresolvedMotion { .. } | Self::UnresolvedPeriod { .. })
        });
        if has_unresolved_motion {
            warnings
                .retain(|warning| !matches!(warning, Self::Mistake(Mistake::LongTimeStep { .. })));
        }
    }

    /// Warnings of a run's largest ground acceleration (m/s²), and of the records of its motion.
    pub(crate) fn of_motion(
        acceleration: f64,
        ground_motion: &GroundMotion,
        motion: &dyn FreeField,
    ) -> Vec<Self> {
        let mut warnings = Vec::new();
        let acceleration = acceleration.max(ground_motion.peak);
        if acceleration > MAX_GROUND_ACCELERATION {
            warnings.push(Self::Mistake(Mistake::UnusualMotion { acceleration }));
        }
        let Some(time_step) = ground_motion.time_step else { return warnings };
        if is_within(WEAK_ACCELERATIONS, ground_motion.peak) {
            warnings
                .push(Self::Mistake(Mistake::UnusualMotion { acceleration: ground_motion.peak }));
        }
        if !is_within(USUAL_RECORD_TIME_STEPS, time_step) {
            warnings.push(Self::Mistake(Mistake::UnusualInterval { time_step }));
        }
        let drifts = motion.records().into_iter().filter_map(drift_velocity);
        let largest_drift = drifts.max_by(|a, b| a.abs().total_cmp(&b.abs()));
        warnings.extend(
            largest_drift.map(|velocity| Self::Mistake(Mistake::DriftingRecord { velocity })),
        );
        warnings
    }

    /// Warnings of `soils` with unusual numbers.
    pub(super) fn of_soils(soils: &[Soil]) -> impl Iterator<Item = Self> {
        let speeds_and_densities =
            soils.iter().map(|soil| (soil.shear_wave_speed(), soil.density()));
        let unusual_soils = speeds_and_densities.filter(|(speed, density)| {
            !(is_within(SOIL_WAVE_SPEEDS, *speed) && is_within(SOIL_DENSITIES, *density))
        });
        unusual_soils.map(|(shear_wave_speed, density)| {
            Self::Mistake(Mistake::UnusualSoil { shear_wave_speed, density })
        })
    }
}
