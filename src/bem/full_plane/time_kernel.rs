//! Coefficients in time by the formulation of the paper, with exact integrals.

use super::pair_classes::SegmentPairClasses;
use super::segment::check_segments;
use super::smooth_integrals::smooth_integrals;
use super::step_integrals::{SegmentIntegrals, WaveConstants, step_integrals};
use super::{BoundaryKernel, Segment};
use crate::error::{Result, positive, require, same_length};
use crate::fundamental::{FullPlane, FundamentalSolution, LoadHistory};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use crate::linalg::gauss;
use crate::soil::Soil;

/// Boundary coefficients of Patel & Spyrakos (eqs. 2–4) in the time domain.
///
/// Displacements and tractions are constant over element and step; the equation is collocated at midpoints
/// and step ends. Integrals over element and step are exact. They are differences in time of closed forms for
/// a load H(t), or Gauss rules where no wave front is inside, so that late coefficients keep their digits.
///
/// The scheme is not stable for every step: see [the module](super).
///
/// ```
/// use basemat::Soil;
/// use basemat::bem::full_plane::{BoundaryKernel, Segment, TimeKernel};
/// let soil = Soil::new(80.0e6, 0.25, 2000.0)?;
/// let element = Segment { from: [-0.5, 0.0], to: [0.5, 0.0] };
/// let kernel = TimeKernel::new(soil, &[element], 1.0e-4)?;
/// let (mut g, mut h) = ([0.0; 4], [0.0; 4]);
/// kernel.coefficients(0, &mut g, &mut h)?;
/// // Before waves reach its ends, an element moves by t/(2 ρ c) on either side of the plane.
/// let plane_wave = 1.0e-4 / (2.0 * 2000.0 * soil.pressure_wave_speed());
/// assert!((g[3] / plane_wave - 1.0).abs() < 1e-12);
/// assert_eq!(h, [0.5, 0.0, 0.0, 0.5]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct TimeKernel {
    segments: Vec<Segment>,
    pairs: SegmentPairClasses,
    soil: Soil,
    waves: WaveConstants,
    time_step: f64,
    /// Rule in place of exact integrals over the element.
    subelements: Option<SubelementRule>,
}

/// Largest number of Gauss points of a sub-element.
const MAX_SUBELEMENT_POINTS: usize = 8;

/// Gauss rule on each of the equal sub-elements of an element.
#[derive(Debug, Clone, Copy)]
struct SubelementRule {
    /// Number of sub-elements.
    subelement_count: usize,
    /// Number of points of each sub-element.
    point_count: usize,
}

impl TimeKernel {
    /// Kernel for a soil, elements and steps of `time_step` seconds.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for no elements, [`Error::Memory`](crate::Error::Memory) for too many,
    /// [`Error::Input`](crate::Error::Input) for an element without length, an element that passes through the
    /// midpoint of another, or an invalid time step.
    pub fn new(soil: Soil, segments: &[Segment], time_step: f64) -> Result<Self> {
        check_segments(segments)?;
        positive("time step", time_step)?;
        positive("shear wave travel in a step", soil.shear_wave_speed() * time_step)?;
        let poisson = soil.poisson();
        let waves = WaveConstants {
            speeds: [soil.pressure_wave_speed(), soil.shear_wave_speed()],
            lame_ratio: 2.0 * poisson / (1.0 - 2.0 * poisson),
        };
        let pairs = SegmentPairClasses::new(segments);
        Ok(Self { segments: segments.to_vec(), pairs, soil, waves, time_step, subelements: None })
    }

    /// Replaces exact integrals in space by midpoint rules over `count` sub-elements.
    ///
    /// The paper has five sub-elements and does not name the rule. Integrals over sub-elements next to the load remain
    /// exact. Use this rule for comparison only: it is slower and less accurate.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for 0.
    pub fn with_subelements(self, count: usize) -> Result<Self> {
        self.with_gauss_subelements(count, 1)
    }

    /// Replaces exact integrals in space by Gauss rules with `points` points in each of `count` sub-elements.
    ///
    /// `points` is from one (the midpoint) to eight.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for no sub-elements, or a number of points outside 1 to 8.
    pub fn with_gauss_subelements(mut self, count: usize, points: usize) -> Result<Self> {
        let is_in_range = (1..=MAX_SUBELEMENT_POINTS).contains(&points);
        require(
            "number of Gauss points of a sub-element",
            points as f64,
            is_in_range,
            "from 1 to 8",
        )?;
        require("number of sub-elements", count as f64, count > 0, "at least 1")?;
        self.subelements = Some(SubelementRule { subelement_count: count, point_count: points });
        Ok(self)
    }

    /// Soil of the kernel.
    pub fn soil(&self) -> Soil {
        self.soil
    }

    /// Time step, s.
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// Integrals of one element over the step at `lag`, in its axes.
    fn lag_integrals(&self, ends: [f64; 2], h: f64, lag: usize) -> SegmentIntegrals {
        let start = lag as f64 * self.time_step;
        let end = (lag as f64 + 1.0) * self.time_step;
        if let Some(rule) = self.subelements {
            return self.subelement_integrals(ends, h, [start, end], rule);
        }
        self.exact_integrals(ends, h, [start, end])
    }

    /// Integrals between two times after the load began.
    fn exact_integrals(&self, ends: [f64; 2], h: f64, times: [f64; 2]) -> SegmentIntegrals {
        if let Some(integrals) = smooth_integrals(&self.waves, ends, h, times) {
            return integrals;
        }
        let mut integrals = step_integrals(&self.waves, ends, h, times[1]);
        if times[0] > 0.0 {
            integrals.add_scaled(-1.0, &step_integrals(&self.waves, ends, h, times[0]));
        }
        integrals
    }

    /// Integrals between two times by Gauss rules, exact on sub-elements next to the load.
    fn subelement_integrals(
        &self,
        ends: [f64; 2],
        h: f64,
        times: [f64; 2],
        rule: SubelementRule,
    ) -> SegmentIntegrals {
        let length = (ends[1] - ends[0]) / rule.subelement_count as f64;
        // Positions and weights on a sub-element from −½ to ½.
        let points: Vec<[f64; 2]> = if rule.point_count == 1 {
            vec![[0.0, 1.0]]
        } else {
            let gauss_rule = gauss::rule(rule.point_count);
            let points = gauss_rule.nodes.iter().zip(&gauss_rule.weights);
            points.map(|(x, w)| [0.5 * x, 0.5 * w]).collect()
        };
        let mut sum = SegmentIntegrals::default();
        for k in 0..rule.subelement_count {
            let start = ends[0] + k as f64 * length;
            let middle = start + 0.5 * length;
            if middle.hypot(h) < length {
                sum.add_scaled(1.0, &self.exact_integrals([start, start + length], h, times));
                continue;
            }
            for [position, weight] in &points {
                let offset = [middle + position * length, h];
                self.add_point(&mut sum, weight * length, offset, times);
            }
        }
        sum
    }

    /// Adds `length` times the integrands at a point.
    fn add_point(
        &self,
        sum: &mut SegmentIntegrals,
        length: f64,
        offset: [f64; 2],
        times: [f64; 2],
    ) {
        let plane = FullPlane::new(self.soil);
        let unit = 2.0 * std::f64::consts::PI * self.soil.density() * length;
        for (sign, time) in [(1.0, times[1]), (-1.0, times[0])] {
            let load = LoadHistory::Step;
            let (Ok(u), Ok(t)) = (
                plane.displacement(offset, time, load),
                plane.traction(offset, [0.0, 1.0], time, load),
            ) else {
                continue;
            };
            let t = t.map(|row| row.map(|t| t / self.soil.shear_modulus()));
            let value = SegmentIntegrals { displacement: [u[0][0], u[0][1], u[1][1]], traction: t };
            sum.add_scaled(sign * unit, &value);
        }
    }
}

impl BoundaryKernel for TimeKernel {
    fn segments(&self) -> &[Segment] {
        &self.segments
    }

    fn coefficients(&self, lag: usize, g: &mut [f64], h: &mut [f64]) -> Result<()> {
        let layout = ContactLayout::new(COMPONENTS_IN_PLANE, self.segments.len());
        same_length("displacement coefficients", g.len(), layout.matrix_len())?;
        same_length("traction coefficients", h.len(), layout.matrix_len())?;
        let unit = 1.0 / (2.0 * std::f64::consts::PI * self.soil.density());
        let traction_unit = unit * self.soil.shear_modulus();
        let free_term = if lag == 0 { 0.5 } else { 0.0 };
        self.pairs.fill(&self.segments, g, h, free_term, |view| {
            let integrals = self.lag_integrals(view.ends, view.height, lag);
            let u = integrals.displacement.map(|u| u * unit);
            let t = integrals.traction.map(|row| row.map(|t| t * traction_unit));
            // In the boundary equation the row is the component of the load.
            [[[u[0], u[1]], [u[1], u[2]]], [[t[0][0], t[1][0]], [t[0][1], t[1][1]]]]
        });
        Ok(())
    }
}
