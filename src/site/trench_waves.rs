//! Waves of one horizontal slowness at the depths of a trench's faces.
//!
//! A motion of the surface is transformed to Laplace's s, multiplied by the fields [below the surface](super::below_surface)
//! and transformed back. The results are accelerations of the soil, and stresses, which are the rates of their impulses.

use std::f64::consts::PI;

use super::below_surface::{FieldMedium, WaveField};
use super::part_progress::PartProgress;
use super::transform::{Contour, Transform};
use crate::bem::embedded::TrenchGround;
use crate::bem::{ContactElement, Ground};
use crate::error::{ProgressReporter, Result, memory, require, require_part};
use crate::linalg::{Complex, gauss};
use crate::motion::{FreeField, Record, TravellingWave};
use crate::soil::SoilProfile;

/// Records of mean values at one level; `None` for zero.
///
/// The first two have the displacements to the right and up. The velocities of the other two are the impulses of σ_xz and
/// of the pressure on the face.
pub(super) type LevelRecords = [Option<Record>; VALUES_PER_LEVEL];

/// Number of mean values of a level, with a record each.
pub(super) const VALUES_PER_LEVEL: usize = 4;
/// Rest before and after a record, in travel times of waves between base and surface: one time up and one down.
const REST_TRAVEL_TIMES: f64 = 2.0;
/// Further rest before and after a record, in samples, for the response of the filters.
const REST_SAMPLE_COUNT: f64 = 32.0;
/// Number of Gauss points in each soil of a level; over its depth fields vary as exponentials.
const POINTS_PER_PIECE: usize = 4;
/// Bytes of a sample of a record with its integrals, and of temporary copies.
const BYTES_PER_SAMPLE: f64 = 40.0;
/// Duration in which motion before and after a record fades, relative to the record's duration.
const FADING_FRACTION: f64 = 0.5;
/// Smallest velocity along the surface, relative to the lowest shear wave speed.
///
/// Surface waves of layers have 0.87 of that speed, or more.
const MIN_VELOCITY_RATIO: f64 = 0.8;

/// Waves of one horizontal slowness in a profile, down to the base of a trench.
pub(super) struct TrenchWaves<'a> {
    /// Profile without the trench.
    profile: &'a SoilProfile,
    /// Horizontal slowness, s/m.
    pub(super) slowness: f64,
    /// Contact elements of the trench.
    pub(super) elements: Vec<ContactElement>,
    /// Numbers that are equal only for equal soils; `None` for soils without an identity.
    pub(super) soil_identity: Option<Vec<f64>>,
    /// Number of elements of a wall. Each has a level; the level of the base follows.
    wall_element_count: usize,
    /// Depth of the base, m.
    base_depth: f64,
    /// Integration points, from the surface down.
    depth_points: Vec<DepthPoint>,
}

/// Integration point for the mean over a level.
struct DepthPoint {
    /// Index of the level.
    level: usize,
    /// Weight in the mean over the level.
    weight: f64,
    /// Index of the soil above the point.
    soil_index: usize,
    /// Depth below the previous point, m.
    depth_step: f64,
}

/// Records of the surface at the origin of a wave.
pub(super) struct SurfaceRecords {
    /// Time by which these records begin before those of the wave, s.
    pub(super) lead_time: f64,
    /// Accelerations to the right and up.
    pub(super) records: [Record; 2],
}

impl<'a> TrenchWaves<'a> {
    /// Waves in the profile of `ground`.
    ///
    /// `slowness`: horizontal slowness, s/m.
    pub(super) fn new(ground: &'a TrenchGround, slowness: f64) -> Result<Self> {
        let needed = "a trench without backfill: waves in backfill are not those of the profile";
        require_part("backfill", !ground.has_backfill(), needed)?;
        let profile = ground.profile();
        let base_depth = ground.trench_elements().trench().depth();
        profile.check_causal()?;
        let shear_wave_speeds = profile.soils().map(|(soil, _)| soil.shear_wave_speed());
        let is_fast_enough =
            MIN_VELOCITY_RATIO * shear_wave_speeds.fold(f64::INFINITY, f64::min) * slowness.abs()
                <= 1.0;
        let needed = "at least 0.8 of the lowest shear wave speed";
        require("apparent velocity of a wave", 1.0 / slowness, is_fast_enough, needed)?;
        let elements = ground.trench_elements().elements();
        let left_wall = ContactElement::faces(&elements).left_wall;
        let wall_element_count = left_wall.len();
        let mut depth_points = vec![];
        for (level, element) in elements[left_wall].iter().enumerate() {
            let middle_depth = -element.center()[2];
            let element_length = element.length();
            let lower_end_depth = middle_depth + 0.5 * element_length;
            let mut start_depth = middle_depth - 0.5 * element_length;
            for (soil_index, (_, end_depth)) in profile.soils_to().enumerate() {
                let piece_length = end_depth.min(lower_end_depth) - start_depth;
                if piece_length <= 0.0 {
                    continue;
                }
                let mut previous_node = 0.0;
                for (node, weight) in gauss::rule(POINTS_PER_PIECE).points_on_unit_interval() {
                    let mean_weight = weight * piece_length / element_length;
                    let depth_step = (node - previous_node) * piece_length;
                    depth_points.push(DepthPoint {
                        level,
                        weight: mean_weight,
                        soil_index,
                        depth_step,
                    });
                    previous_node = node;
                }
                let depth_step = (1.0 - previous_node) * piece_length;
                depth_points.push(DepthPoint { level, weight: 0.0, soil_index, depth_step });
                start_depth += piece_length;
            }
        }
        depth_points.push(DepthPoint {
            level: wall_element_count,
            weight: 1.0,
            soil_index: 0,
            depth_step: 0.0,
        });
        let soil_identity = ground.description().identity;
        Ok(Self {
            profile,
            slowness,
            elements,
            soil_identity,
            wall_element_count,
            base_depth,
            depth_points,
        })
    }

    /// Time (s) that waves take from the base to the surface.
    fn travel_time(&self) -> f64 {
        self.profile.above(self.base_depth).travel_time()
    }

    /// Duration (s) of the rest before and after a record, in which waves pass the trench.
    pub(super) fn rest_duration(&self, time_step: f64) -> f64 {
        REST_TRAVEL_TIMES * self.travel_time() + REST_SAMPLE_COUNT * time_step
    }

    /// Records of a wave's motion of the surface at the origin, with rest before and after.
    pub(super) fn surface_records(
        &self,
        wave: &TravellingWave,
        origin: f64,
    ) -> Result<SurfaceRecords> {
        let records = wave.records();
        let time_step =
            records.iter().map(|record| record.time_step()).fold(f64::INFINITY, f64::min);
        require_part(
            "record of a wave",
            time_step.is_finite(),
            "at least one: the wave must consist of records",
        )?;
        let duration = records.iter().map(|record| record.duration()).fold(0.0, f64::max);
        let is_quiet = |time: f64| wave.velocity(origin, time) == [0.0; 2];
        let is_quiet_outside = is_quiet(-time_step) && is_quiet(duration + time_step);
        let fading_duration = if is_quiet_outside { 0.0 } else { FADING_FRACTION * duration };
        let lead_count = ((self.rest_duration(time_step) + fading_duration) / time_step).ceil();
        let sample_ratio = 2.0 * lead_count + (duration / time_step).ceil();
        memory::check("samples of the record", sample_ratio, BYTES_PER_SAMPLE * sample_ratio)?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "fits into memory"
        )]
        let interval_count = sample_ratio as usize;
        let mut velocities =
            [Vec::with_capacity(interval_count + 1), Vec::with_capacity(interval_count + 1)];
        for i in 0..=interval_count {
            let time = (i as f64 - lead_count) * time_step;
            let time_outside = (-time).max(time - duration).max(0.0);
            let fading_progress =
                if fading_duration > 0.0 { (time_outside / fading_duration).min(1.0) } else { 0.0 };
            for (samples, velocity) in velocities.iter_mut().zip(wave.velocity(origin, time)) {
                samples.push(velocity * 0.5 * (1.0 + (PI * fading_progress).cos()));
            }
        }
        let horizontal = record_of_velocities(&velocities[0], time_step)?;
        let vertical = record_of_velocities(&velocities[1], time_step)?;
        Ok(SurfaceRecords { lead_time: lead_count * time_step, records: [horizontal, vertical] })
    }

    /// Records at all levels due to one component of the surface's motion.
    ///
    /// `surface_component`: 0 for the motion to the right, 1 for the motion up.
    pub(super) fn level_records(
        &self,
        surface_component: usize,
        surface: &Record,
        progress: &mut PartProgress<'_, '_>,
    ) -> Result<Vec<LevelRecords>> {
        let time_step = surface.time_step();
        let samples = surface.accelerations();
        // Vertical waves do not couple horizontal and vertical motion.
        let nonzero_indices: Vec<usize> = (0..VALUES_PER_LEVEL)
            .filter(|k| self.slowness != 0.0 || k % 2 == surface_component)
            .collect();
        let contour = Contour::new(time_step, samples.len(), self.travel_time())?;
        let mut transform = Transform::new(contour, samples)?;
        let mut moduli = vec![];
        let mut level_means = vec![];
        transform.filter(
            nonzero_indices.len() * (self.wall_element_count + 1),
            true,
            progress,
            |points, filters| {
                for (index, point) in points.iter().enumerate() {
                    self.profile.moduli(point.s, &mut moduli)?;
                    self.mean_values(surface_component, point.s, &moduli, &mut level_means);
                    let nonzero_means = level_means
                        .iter()
                        .flat_map(|means| nonzero_indices.iter().map(|k| means[*k]));
                    let point_filters = filters[index..].iter_mut().step_by(points.len());
                    for (filter, value) in point_filters.zip(nonzero_means) {
                        *filter = value.scale(1.0 - point.modified_weight);
                    }
                }
                Ok(())
            },
        )?;
        let mut records_by_level = vec![];
        for level in 0..=self.wall_element_count {
            let mut records = LevelRecords::default();
            for (order, &k) in nonzero_indices.iter().enumerate() {
                let mut motion = transform.motion(level * nonzero_indices.len() + order)?;
                if let (Some(frequency), true) = (motion.amplified_from, k < 2) {
                    let needed = "none: the soil above the base amplifies this motion on the way down more than a hundredfold";
                    require("frequency of the record (Hz)", frequency, false, needed)?;
                }
                motion.truncate(samples.len());
                records[k] = Some(Record::new(time_step, motion.samples)?);
            }
            records_by_level.push(records);
        }
        progress.report(1.0)?;
        Ok(records_by_level)
    }

    /// Overwrites `level_means` with the mean values of each level.
    ///
    /// The values are per unit acceleration of a component of the surface's motion.
    fn mean_values(
        &self,
        surface_component: usize,
        s: Complex,
        moduli: &[Complex],
        level_means: &mut Vec<[Complex; VALUES_PER_LEVEL]>,
    ) {
        let soils = self.profile.soils().zip(moduli);
        let media: Vec<FieldMedium> = soils
            .map(|((soil, _), modulus)| FieldMedium::new(soil, *modulus, self.slowness))
            .collect();
        let zero = Complex::default();
        let mut field = if surface_component == 0 {
            WaveField { right_displacement: Complex::real(1.0), ..WaveField::default() }
        } else {
            WaveField { down_displacement: Complex::real(-1.0), ..WaveField::default() }
        };
        level_means.clear();
        level_means.resize(self.wall_element_count + 1, [zero; VALUES_PER_LEVEL]);
        for point in &self.depth_points {
            let medium = &media[point.soil_index];
            field = medium.field_below(s, point.depth_step, field);
            // The walls are vertical, the base is horizontal.
            let is_wall = point.level < self.wall_element_count;
            let normal_stress =
                if is_wall { medium.horizontal_stress(field) } else { field.normal };
            let point_values = [
                field.right_displacement,
                -field.down_displacement,
                field.shear / s,
                -(normal_stress / s),
            ];
            for (sum, value) in level_means[point.level].iter_mut().zip(point_values) {
                *sum += value.scale(point.weight);
            }
        }
    }
}

/// Record whose accelerations have these velocities as integral by the trapezoidal rule.
fn record_of_velocities(velocities: &[f64], time_step: f64) -> Result<Record> {
    let contour = Contour::new(time_step, velocities.len(), 0.0)?;
    let mut reporter = ProgressReporter::unobserved();
    let mut progress = PartProgress::of_whole_call(&mut reporter);
    let [mut acceleration] = contour.filtered(velocities, &mut progress, |points, filters| {
        for (filter, point) in filters.iter_mut().zip(points) {
            let one = Complex::real(1.0);
            let delay = (-point.s.scale(time_step)).exp();
            *filter = ((one - delay) / (one + delay))
                .scale(2.0 / time_step * (1.0 - point.modified_weight));
        }
        Ok(())
    })?;
    acceleration.truncate(velocities.len());
    Record::new(time_step, acceleration.samples)
}
