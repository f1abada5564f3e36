//! Integrals over an element and a step without a wave front inside.
//!
//! Differences in time of the closed forms lose digits at late times, because displacements grow like log t
//! while coefficients fall like 1/t. Without a front inside, the response to an impulse is smooth in space and
//! time. With t in place of the unit steps of [`super::step_integrals`] and after both waves have passed,
//!
//! * D/r² = Σ ± 1/(c R (T+R)²), L = Σ 1/(c R), Q/r² = −1/(c R³)
//! * (8D + 2(Q₁−Q₂))/r⁴ = −2 Σ ± (3R+T)/(c R³ (T+R)³)
//!
//! These terms do not contain r, so that the element under the load needs no special treatment.

use super::step_integrals::{SegmentIntegrals, WaveConstants};
use crate::linalg::gauss;
use crate::linalg::gauss::Rule;

/// Waves that have passed the element.
#[derive(Clone, Copy, PartialEq)]
enum PassedWaves {
    None,
    Pressure,
    Both,
}

/// Gauss rules of one element and step.
struct SmoothRules {
    passed_waves: PassedWaves,
    space_rule: &'static Rule,
    time_rule: &'static Rule,
}

/// Response to an impulse at (`s`, `h`) after the pressure wave, or both waves, have passed.
fn impulse_response(
    waves: &WaveConstants,
    s: f64,
    h: f64,
    time: f64,
    is_past_both: bool,
) -> SegmentIntegrals {
    let c1 = waves.speeds[0];
    let c2 = waves.speeds[1];
    let square = s * s + h * h;
    let t1 = c1 * time;
    let t2 = c2 * time;
    let r1 = (t1 * t1 - square).sqrt();
    let q1 = -1.0 / (c1 * r1 * r1 * r1);
    // D/r², L and Q₂/r² of the formulas above, and (8D + 2(Q₁−Q₂))/r⁴.
    let d;
    let l;
    let q2;
    let w;
    if is_past_both {
        let r2 = (t2 * t2 - square).sqrt();
        let sums = [t1 + r1, t2 + r2];
        q2 = -1.0 / (c2 * r2 * r2 * r2);
        d = 1.0 / (c1 * r1 * sums[0] * sums[0]) - 1.0 / (c2 * r2 * sums[1] * sums[1]);
        l = 1.0 / (c1 * r1) + 1.0 / (c2 * r2);
        w = 2.0 * q1 * (3.0 * r1 + t1) / (sums[0] * sums[0] * sums[0])
            - 2.0 * q2 * (3.0 * r2 + t2) / (sums[1] * sums[1] * sums[1]);
    } else {
        q2 = 0.0;
        d = (t1 * t1 + r1 * r1) / (c1 * square * square * r1);
        l = 1.0 / (c1 * r1);
        w = (8.0 * d + 2.0 * q1) / square;
    }
    let isotropic_part = 0.5 * (l - square * d);
    let lame_ratio = waves.lame_ratio;
    SegmentIntegrals {
        displacement: [isotropic_part + d * s * s, d * s * h, isotropic_part + d * h * h],
        traction: [
            [(2.0 * d - q2) * h - w * s * s * h, (2.0 * d - q2) * s - w * s * h * h],
            [
                (2.0 * d - lame_ratio * q1) * s - w * s * h * h,
                (6.0 * d - 2.0 * q2 - lame_ratio * q1) * h - w * h * h * h,
            ],
        ],
    }
}

/// Rules in space and time; `None` if the rectangle is too near to a front.
fn smooth_rules(
    waves: &WaveConstants,
    ends: [f64; 2],
    h: f64,
    start: f64,
    end: f64,
) -> Option<SmoothRules> {
    let max_distance = ends[0].abs().max(ends[1].abs()).hypot(h);
    let min_distance = if ends[0] <= 0.0 && ends[1] >= 0.0 {
        h.abs()
    } else {
        ends[0].abs().min(ends[1].abs()).hypot(h)
    };
    let mut passed_waves = PassedWaves::None;
    // The singularities nearest to the intervals determine the rules.
    let mut space_ellipse_size = f64::INFINITY;
    let mut time_ellipse_size = f64::INFINITY;
    let waves_by_front = [PassedWaves::Pressure, PassedWaves::Both];
    for (c, waves_after_front) in waves.speeds.into_iter().zip(waves_by_front) {
        if c * end <= min_distance {
            break;
        }
        if c * start <= max_distance {
            return None;
        }
        passed_waves = waves_after_front;
        let front = ((c * start - h.abs()) * (c * start + h.abs())).sqrt();
        for point in [front, -front] {
            let ellipse_size = gauss::ellipse_size([point, 0.0], ends[0], ends[1]);
            space_ellipse_size = space_ellipse_size.min(ellipse_size);
        }
        let ellipse_size = gauss::ellipse_size([max_distance / c, 0.0], start, end);
        time_ellipse_size = time_ellipse_size.min(ellipse_size);
    }
    if passed_waves == PassedWaves::Pressure {
        let ellipse_size = gauss::ellipse_size([0.0, h], ends[0], ends[1]);
        space_ellipse_size = space_ellipse_size.min(ellipse_size);
    }
    if passed_waves == PassedWaves::None {
        // Any rule integrates zero.
        let rule = gauss::largest_rule();
        return Some(SmoothRules { passed_waves, space_rule: rule, time_rule: rule });
    }
    let space_rule = gauss::rule_for(space_ellipse_size)?;
    let time_rule = gauss::rule_for(time_ellipse_size)?;
    Some(SmoothRules { passed_waves, space_rule, time_rule })
}

/// Integrals over the element for an impulse spread between two times.
///
/// `None` if a front is inside or near.
pub(super) fn smooth_integrals(
    waves: &WaveConstants,
    ends: [f64; 2],
    h: f64,
    times: [f64; 2],
) -> Option<SegmentIntegrals> {
    let rules = smooth_rules(waves, ends, h, times[0], times[1])?;
    let mut sum = SegmentIntegrals::default();
    if rules.passed_waves == PassedWaves::None {
        return Some(sum);
    }
    let is_past_both = rules.passed_waves == PassedWaves::Both;
    let half_length = 0.5 * (ends[1] - ends[0]);
    let half_step = 0.5 * (times[1] - times[0]);
    for (x, time_weight) in rules.time_rule.nodes.iter().zip(&rules.time_rule.weights) {
        let time = times[0] + half_step * (1.0 + x);
        for (y, space_weight) in rules.space_rule.nodes.iter().zip(&rules.space_rule.weights) {
            let s = ends[0] + half_length * (1.0 + y);
            let value = impulse_response(waves, s, h, time, is_past_both);
            sum.add_scaled(half_length * half_step * time_weight * space_weight, &value);
        }
    }
    Some(sum)
}
