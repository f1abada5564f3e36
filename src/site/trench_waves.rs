//! Waves of one horizontal slowness at the depths of a trench's faces.
//!
//! A motion of the surface is transformed to Laplace's s, multiplied by the fields [below the surface](super::below_surface)
//! and transformed back: accelerations of the soil, and stresses, which are rates of their impulses.

use std::f64::consts::PI;

use super::below_surface::{Field, Medium};
use super::pace::Pace;
use super::transform::{Contour, ContourPoint, Transform};
use crate::bem::embedded::TrenchGround;
use crate::bem::{ContactElement, Ground};
use crate::error::{Result, Watch, memory, require, require_part};
use crate::linalg::{Complex, gauss};
use crate::motion::{FreeField, Record, TravellingWave};
use crate::soil::SoilProfile;

/// Records of mean values: displacement to the right and up, and those whose velocities are the impulses of σ_xz and
/// of the pressure across the face. Without a record, zero.
pub(super) type Level = [Option<Record>; VALUES];

pub(super) const VALUES: usize = 4;
/// Rest before and after a record, in travel times to the base, and in samples.
const REST: [f64; 2] = [2.0, 32.0];
/// Part of a record's length over which motion before and after it fades.
const FADING: f64 = 0.5;
/// Least velocity along the surface over the lowest shear wave speed: surface waves of layers run at 0.87 or more.
const SLOWEST: f64 = 0.8;

/// Waves of one horizontal slowness in a profile, down to the base of a trench.
pub(super) struct Waves<'a> {
    profile: &'a SoilProfile,
    pub(super) slowness: f64,
    pub(super) elements: Vec<ContactElement>,
    /// Numbers that are equal only for equal soils, if they are known.
    pub(super) soils: Option<Vec<f64>>,
    /// Number of elements of a wall: their levels come first, then the level of the base.
    walls: usize,
    /// Depth of the base, m.
    bottom: f64,
    /// Points on the way down.
    points: Vec<Point>,
}

/// Point of a rule for the mean over a level.
struct Point {
    level: usize,
    weight: f64,
    /// Soil above, and height (m) from the last point.
    soil: usize,
    height: f64,
}

impl<'a> Waves<'a> {
    pub(super) fn new(ground: &'a TrenchGround, slowness: f64) -> Result<Self> {
        let needed = "a trench without it: waves beside it are not the profile's";
        require_part("backfill", !ground.has_backfill(), needed)?;
        let (profile, bottom) = (ground.profile(), ground.trench_elements().trench().depth());
        profile.check_causal()?;
        let speeds = profile.soils().map(|(soil, _)| soil.shear_wave_speed());
        let fits = SLOWEST * speeds.fold(f64::INFINITY, f64::min) * slowness.abs() <= 1.0;
        let needed = "at least 0.8 of the lowest shear wave speed";
        require("apparent velocity of a wave", 1.0 / slowness, fits, needed)?;
        let elements = ground.trench_elements().elements();
        let [left, ..] = ContactElement::faces(&elements);
        let (walls, mut points) = (left.len(), vec![]);
        for (level, own) in elements[left].iter().enumerate() {
            let (middle, length) = (-own.center()[2], own.length());
            let (top, bottom) = (middle - 0.5 * length, middle + 0.5 * length);
            let mut start = top;
            for (soil, (_, end)) in profile.soils_to().enumerate() {
                let piece = end.min(bottom) - start;
                if piece <= 0.0 {
                    continue;
                }
                let mut passed = 0.0;
                for (place, weight) in gauss::rule(4).points_on_unit_interval() {
                    let weight = weight * piece / length;
                    let height = (place - passed) * piece;
                    points.push(Point { level, weight, soil, height });
                    passed = place;
                }
                points.push(Point { level, weight: 0.0, soil, height: (1.0 - passed) * piece });
                start += piece;
            }
        }
        points.push(Point { level: walls, weight: 1.0, soil: 0, height: 0.0 });
        let soils = ground.description().identity;
        Ok(Self { profile, slowness, elements, soils, walls, bottom, points })
    }

    /// Time (s) that waves take from the base to the surface.
    fn travel(&self) -> f64 {
        self.profile.above(self.bottom).travel_time()
    }

    /// Time before and after a record in which waves pass, s.
    pub(super) fn rest(&self, step: f64) -> f64 {
        REST[0] * self.travel() + REST[1] * step
    }

    /// Records of the surface at the origin, to the right and up, and the time by which they begin earlier.
    pub(super) fn surface(&self, wave: &TravellingWave, origin: f64) -> Result<(f64, [Record; 2])> {
        let records = wave.records();
        let step = records.iter().map(|own| own.time_step()).fold(f64::INFINITY, f64::min);
        require_part("record of a wave", step.is_finite(), "one: a wave made of records")?;
        let end = records.iter().map(|own| own.duration()).fold(0.0, f64::max);
        let is_quiet = |time: f64| wave.velocity(origin, time) == [0.0; 2];
        let fading = if is_quiet(-step) && is_quiet(end + step) { 0.0 } else { FADING * end };
        let lead = ((self.rest(step) + fading) / step).ceil();
        let count = 2.0 * lead + (end / step).ceil();
        memory::check("samples of the record", count, 40.0 * count)?;
        let record = |k: usize| -> Result<Record> {
            let at = |i: usize| {
                let time = (i as f64 - lead) * step;
                let outside = (-time).max(time - end).max(0.0);
                let share = if fading > 0.0 { (outside / fading).min(1.0) } else { 0.0 };
                wave.velocity(origin, time)[k] * 0.5 * (1.0 + (PI * share).cos())
            };
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "fits into memory"
            )]
            let velocity: Vec<f64> = (0..=count as usize).map(at).collect();
            let contour = Contour::new(step, velocity.len(), 0.0)?;
            let mut pace = Watch::nobody();
            let [mut found] =
                contour.filtered(&velocity, &mut Pace::whole(&mut pace), |places, found| {
                    // The velocity is the sum of the acceleration by the trapezoidal rule.
                    let own = |place: &ContourPoint| {
                        let (back, one) = ((-place.s.scale(step)).exp(), Complex::real(1.0));
                        ((one - back) / (one + back)).scale(2.0 / step * (1.0 - place.nearness))
                    };
                    found.iter_mut().zip(places).for_each(|(found, place)| *found = own(place));
                    Ok(())
                })?;
            found.cut(velocity.len());
            Record::new(step, found.samples)
        };
        Ok((lead * step, [record(0)?, record(1)?]))
    }

    /// Motion at all levels by a component of the surface's motion, to the right (0) or up (1).
    pub(super) fn levels(
        &self,
        kind: usize,
        surface: &Record,
        pace: &mut Pace<'_, '_>,
    ) -> Result<Vec<Level>> {
        let (step, samples) = (surface.time_step(), surface.accelerations());
        // Vertical waves have one direction.
        let sought: Vec<usize> =
            (0..VALUES).filter(|k| self.slowness != 0.0 || k % 2 == kind).collect();
        let contour = Contour::new(step, samples.len(), self.travel())?;
        let mut transform = Transform::new(contour, samples)?;
        let (mut moduli, mut values) = (vec![], vec![]);
        transform.filter(sought.len() * (self.walls + 1), true, pace, |places, found| {
            for (i, place) in places.iter().enumerate() {
                self.profile.moduli(place.s, &mut moduli)?;
                self.values(kind, place.s, &moduli, &mut values);
                let own = values.iter().flat_map(|own| sought.iter().map(|k| own[*k]));
                let found = found[i..].iter_mut().step_by(places.len());
                found.zip(own).for_each(|(found, own)| *found = own.scale(1.0 - place.nearness));
            }
            Ok(())
        })?;
        let mut levels = vec![];
        for level in 0..=self.walls {
            let mut own = Level::default();
            for (slot, &k) in sought.iter().enumerate() {
                let mut found = transform.motion(level * sought.len() + slot)?;
                if let (Some(frequency), true) = (found.amplified_from, k < 2) {
                    let needed = "none: the soil above the base amplifies this motion on the way down more than a hundredfold";
                    require("frequency of the record (Hz)", frequency, false, needed)?;
                }
                found.cut(samples.len());
                own[k] = Some(Record::new(step, found.samples)?);
            }
            levels.push(own);
        }
        pace.reach(1.0)?;
        Ok(levels)
    }

    /// Overwrites `values` with the mean values of each level, per unit acceleration of a component of the surface.
    fn values(
        &self,
        kind: usize,
        s: Complex,
        moduli: &[Complex],
        values: &mut Vec<[Complex; VALUES]>,
    ) {
        let soils = self.profile.soils().zip(moduli);
        let media: Vec<Medium> =
            soils.map(|((soil, _), modulus)| Medium::new(soil, *modulus, self.slowness)).collect();
        let zero = Complex::default();
        let mut field: Field = [zero; 4];
        field[kind] = Complex::real(if kind == 0 { 1.0 } else { -1.0 });
        values.clear();
        values.resize(self.walls + 1, [zero; VALUES]);
        for point in &self.points {
            let medium = &media[point.soil];
            field = medium.below(s, point.height, field);
            let [right, down, shear, normal] = field;
            let across = if point.level < self.walls { medium.sideways(field) } else { normal };
            let own = [right, -down, shear / s, -(across / s)];
            let sums = values[point.level].iter_mut().zip(own);
            sums.for_each(|(sum, own)| *sum += own.scale(point.weight));
        }
    }
}
