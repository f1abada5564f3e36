//! Waves of one horizontal slowness at the depths of a trench's faces.
//!
//! A motion of the surface is transformed to Laplace's s, multiplied by the fields [below the surface](super::below_surface)
//! and transformed back: accelerations of the soil, and stresses, which are rates of their impulses.

use std::f64::consts::PI;

use super::below_surface::{FieldMedium, WaveField};
use super::transform::PartProgress;
use super::transform::{Contour, Transform};
use crate::bem::embedded::TrenchGround;
use crate::bem::{ContactElement, Ground};
use crate::error::{ProgressReporter, Result, memory, require, require_part};
use crate::linalg::{Complex, gauss};
use crate::motion::{FreeField, Record, TravellingWave};
use crate::soil::SoilProfile;

/// Records of mean values at one level; `None` for zero.
///
/// The displacements of the first two are to the right and up. The velocities of the others are the impulses of σ_xz and
/// of the pressure across the face.
pub(super) type LevelRecords = [Option<Record>; VALUE_COUNT];

/// Number of records of a level.
pub(super) const VALUE_COUNT: usize = 4;
/// Rest before and after a record, in travel times to the base, and in samples.
const REST_DURATION: [f64; 2] = [2.0, 32.0];
/// Fraction of a record's length over which motion before and after it fades.
const FADING_FRACTION: f64 = 0.5;
/// Smallest velocity along the surface, relative to the lowest shear wave speed.
///
/// Surface waves of layers run at 0.87 or more.
const MIN_VELOCITY_RATIO: f64 = 0.8;

/// Waves of one horizontal slowness in a profile, down to the base of a trench.
pub(super) struct TrenchWaves<'a> {
    profile: &'a SoilProfile,
    pub(super) slowness: f64,
    pub(super) elements: Vec<ContactElement>,
    /// Numbers that are equal only for equal soils, if they are known.
    pub(super) soils: Option<Vec<f64>>,
    /// Number of elements of a wall; their levels come first, then the level of the base.
    walls: usize,
    /// Depth of the base, m.
    bottom: f64,
    /// Points of integration, from the surface down.
    points: Vec<DepthPoint>,
}

/// Point of a quadrature rule for the mean over a level.
struct DepthPoint {
    level: usize,
    weight: f64,
    /// Number of the soil above the point.
    soil: usize,
    /// Height from the previous point, m.
    height: f64,
}

/// Records of the surface at the origin.
pub(super) struct SurfaceRecords {
    /// Time by which the records begin earlier than the wave's, s.
    pub(super) lead: f64,
    /// Accelerations to the right and up.
    pub(super) records: [Record; 2],
}

impl<'a> TrenchWaves<'a> {
    pub(super) fn new(ground: &'a TrenchGround, slowness: f64) -> Result<Self> {
        let needed = "a trench without it: waves beside it are not the profile's";
        require_part("backfill", !ground.has_backfill(), needed)?;
        let profile = ground.profile();
        let bottom = ground.trench_elements().trench().depth();
        profile.check_causal()?;
        let speeds = profile.soils().map(|(soil, _)| soil.shear_wave_speed());
        let is_fast =
            MIN_VELOCITY_RATIO * speeds.fold(f64::INFINITY, f64::min) * slowness.abs() <= 1.0;
        let needed = "at least 0.8 of the lowest shear wave speed";
        require("apparent velocity of a wave", 1.0 / slowness, is_fast, needed)?;
        let elements = ground.trench_elements().elements();
        let left_wall = ContactElement::faces(&elements).left_wall;
        let walls = left_wall.len();
        let mut points = vec![];
        for (level, element) in elements[left_wall].iter().enumerate() {
            let middle = -element.center()[2];
            let length = element.length();
            let lower_end = middle + 0.5 * length;
            let mut start = middle - 0.5 * length;
            for (soil, (_, end)) in profile.soils_to().enumerate() {
                let piece = end.min(lower_end) - start;
                if piece <= 0.0 {
                    continue;
                }
                let mut previous = 0.0;
                for (place, weight) in gauss::rule(4).points_on_unit_interval() {
                    let weight = weight * piece / length;
                    let height = (place - previous) * piece;
                    points.push(DepthPoint { level, weight, soil, height });
                    previous = place;
                }
                let height = (1.0 - previous) * piece;
                points.push(DepthPoint { level, weight: 0.0, soil, height });
                start += piece;
            }
        }
        points.push(DepthPoint { level: walls, weight: 1.0, soil: 0, height: 0.0 });
        let soils = ground.description().identity;
        Ok(Self { profile, slowness, elements, soils, walls, bottom, points })
    }

    /// Time (s) that waves take from the base to the surface.
    fn travel(&self) -> f64 {
        self.profile.above(self.bottom).travel_time()
    }

    /// Time before and after a record in which waves pass, s.
    pub(super) fn rest(&self, step: f64) -> f64 {
        REST_DURATION[0] * self.travel() + REST_DURATION[1] * step
    }

    /// Records of a wave's motion of the surface at the origin, with rest before and after.
    pub(super) fn surface(&self, wave: &TravellingWave, origin: f64) -> Result<SurfaceRecords> {
        let records = wave.records();
        let step = records.iter().map(|record| record.time_step()).fold(f64::INFINITY, f64::min);
        require_part("record of a wave", step.is_finite(), "one: a wave made of records")?;
        let end = records.iter().map(|record| record.duration()).fold(0.0, f64::max);
        let is_quiet = |time: f64| wave.velocity(origin, time) == [0.0; 2];
        let is_quiet_outside = is_quiet(-step) && is_quiet(end + step);
        let fading = if is_quiet_outside { 0.0 } else { FADING_FRACTION * end };
        let lead = ((self.rest(step) + fading) / step).ceil();
        let count = 2.0 * lead + (end / step).ceil();
        memory::check("samples of the record", count, 40.0 * count)?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "fits into memory"
        )]
        let count = count as usize;
        let mut velocities = [Vec::with_capacity(count + 1), Vec::with_capacity(count + 1)];
        for i in 0..=count {
            let time = (i as f64 - lead) * step;
            let outside = (-time).max(time - end).max(0.0);
            let fraction = if fading > 0.0 { (outside / fading).min(1.0) } else { 0.0 };
            for (samples, velocity) in velocities.iter_mut().zip(wave.velocity(origin, time)) {
                samples.push(velocity * 0.5 * (1.0 + (PI * fraction).cos()));
            }
        }
        let horizontal = differentiated(&velocities[0], step)?;
        let vertical = differentiated(&velocities[1], step)?;
        Ok(SurfaceRecords { lead: lead * step, records: [horizontal, vertical] })
    }

    /// Motion at all levels due to one component of the surface's motion.
    ///
    /// `kind`: 0 for the motion to the right, 1 for the motion up.
    pub(super) fn levels(
        &self,
        kind: usize,
        surface: &Record,
        progress: &mut PartProgress<'_, '_>,
    ) -> Result<Vec<LevelRecords>> {
        let step = surface.time_step();
        let samples = surface.accelerations();
        // Vertical waves have one direction.
        let nonzero: Vec<usize> =
            (0..VALUE_COUNT).filter(|k| self.slowness != 0.0 || k % 2 == kind).collect();
        let contour = Contour::new(step, samples.len(), self.travel())?;
        let mut transform = Transform::new(contour, samples)?;
        let mut moduli = vec![];
        let mut values = vec![];
        transform.filter(nonzero.len() * (self.walls + 1), true, progress, |places, filters| {
            for (i, place) in places.iter().enumerate() {
                self.profile.moduli(place.s, &mut moduli)?;
                self.values(kind, place.s, &moduli, &mut values);
                let level_values =
                    values.iter().flat_map(|values| nonzero.iter().map(|k| values[*k]));
                let filters = filters[i..].iter_mut().step_by(places.len());
                for (filter, value) in filters.zip(level_values) {
                    *filter = value.scale(1.0 - place.nearness);
                }
            }
            Ok(())
        })?;
        let mut levels = vec![];
        for level in 0..=self.walls {
            let mut records = LevelRecords::default();
            for (slot, &k) in nonzero.iter().enumerate() {
                let mut motion = transform.motion(level * nonzero.len() + slot)?;
                if let (Some(frequency), true) = (motion.amplified_from, k < 2) {
                    let needed = "none: the soil above the base amplifies this motion on the way down more than a hundredfold";
                    require("frequency of the record (Hz)", frequency, false, needed)?;
                }
                motion.cut(samples.len());
                records[k] = Some(Record::new(step, motion.samples)?);
            }
            levels.push(records);
        }
        progress.reach(1.0)?;
        Ok(levels)
    }

    /// Overwrites `values` with the means of each level.
    ///
    /// They are per unit acceleration of a component of the surface.
    fn values(
        &self,
        kind: usize,
        s: Complex,
        moduli: &[Complex],
        values: &mut Vec<[Complex; VALUE_COUNT]>,
    ) {
        let soils = self.profile.soils().zip(moduli);
        let media: Vec<FieldMedium> = soils
            .map(|((soil, _), modulus)| FieldMedium::new(soil, *modulus, self.slowness))
            .collect();
        let zero = Complex::default();
        let mut field = if kind == 0 {
            WaveField { right: Complex::real(1.0), ..WaveField::default() }
        } else {
            WaveField { down: Complex::real(-1.0), ..WaveField::default() }
        };
        values.clear();
        values.resize(self.walls + 1, [zero; VALUE_COUNT]);
        for point in &self.points {
            let medium = &media[point.soil];
            field = medium.below(s, point.height, field);
            // Normal to the face: the walls are vertical, the base is horizontal.
            let is_wall = point.level < self.walls;
            let normal = if is_wall { medium.horizontal_stress(field) } else { field.normal };
            let point_values = [field.right, -field.down, field.shear / s, -(normal / s)];
            for (sum, value) in values[point.level].iter_mut().zip(point_values) {
                *sum += value.scale(point.weight);
            }
        }
    }
}

/// Record of the acceleration whose sum by the trapezoidal rule is the velocity.
fn differentiated(velocity: &[f64], step: f64) -> Result<Record> {
    let contour = Contour::new(step, velocity.len(), 0.0)?;
    let mut watch = ProgressReporter::unobserved();
    let mut progress = PartProgress::whole(&mut watch);
    let [mut acceleration] = contour.filtered(velocity, &mut progress, |places, filters| {
        for (filter, place) in filters.iter_mut().zip(places) {
            let one = Complex::real(1.0);
            let delay = (-place.s.scale(step)).exp();
            *filter = ((one - delay) / (one + delay)).scale(2.0 / step * (1.0 - place.nearness));
        }
        Ok(())
    })?;
    acceleration.cut(velocity.len());
    Record::new(step, acceleration.samples)
}
