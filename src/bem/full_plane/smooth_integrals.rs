//! Integrals over an element and a step without a wave front inside.
//!
//! Differences in time of the closed forms lose digits at late times, because displacements grow like log t
//! while coefficients fall like 1/t. Without a front inside, the response to an impulse is smooth in space and
//! time. With t in place of the unit steps of [`super::step_integrals`] and after both waves have passed,
//!
//! * D/r² = Σ ± 1/(c R (T+R)²), L = Σ 1/(c R), Q/r² = −1/(c R³)
//! * (8D + 2(Q₁−Q₂))/r⁴ = −2 Σ ± (3R+T)/(c R³ (T+R)³)
//!
//! These do not contain r, so the element under the load needs no special treatment.

use super::step_integrals::{Integrals, Medium};
use crate::linalg::gauss;
use crate::linalg::gauss::Rule;

/// Waves that have passed the element.
#[derive(Clone, Copy, PartialEq)]
enum Passed {
    None,
    Pressure,
    Both,
}

/// Response to an impulse at (`s`, `h`).
fn impulse(medium: &Medium, s: f64, h: f64, time: f64, both: bool) -> Integrals {
    let [c1, c2] = medium.speeds;
    let square = s * s + h * h;
    let t1 = c1 * time;
    let t2 = c2 * time;
    let r1 = (t1 * t1 - square).sqrt();
    let q1 = -1.0 / (c1 * r1 * r1 * r1);
    let (d, l, q2, w);
    if both {
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
    let middle = 0.5 * (l - square * d);
    let lame = medium.lame;
    Integrals {
        displacement: [middle + d * s * s, d * s * h, middle + d * h * h],
        traction: [
            [(2.0 * d - q2) * h - w * s * s * h, (2.0 * d - q2) * s - w * s * h * h],
            [
                (2.0 * d - lame * q1) * s - w * s * h * h,
                (6.0 * d - 2.0 * q2 - lame * q1) * h - w * h * h * h,
            ],
        ],
    }
}

/// Rules in space and time; `None` if the rectangle is too near to a front.
fn rules(
    medium: &Medium,
    ends: [f64; 2],
    h: f64,
    begin: f64,
    end: f64,
) -> Option<(Passed, [&'static Rule; 2])> {
    let far = ends[0].abs().max(ends[1].abs()).hypot(h);
    let near = if ends[0] <= 0.0 && ends[1] >= 0.0 {
        h.abs()
    } else {
        ends[0].abs().min(ends[1].abs()).hypot(h)
    };
    let mut passed = Passed::None;
    let mut space = f64::INFINITY;
    let mut time = f64::INFINITY;
    for (c, which) in medium.speeds.into_iter().zip([Passed::Pressure, Passed::Both]) {
        if c * end <= near {
            break;
        }
        if c * begin <= far {
            return None;
        }
        passed = which;
        let front = ((c * begin - h.abs()) * (c * begin + h.abs())).sqrt();
        for point in [front, -front] {
            space = space.min(gauss::reach([point, 0.0], ends[0], ends[1]));
        }
        time = time.min(gauss::reach([far / c, 0.0], begin, end));
    }
    if passed == Passed::Pressure {
        space = space.min(gauss::reach([0.0, h], ends[0], ends[1]));
    }
    if passed == Passed::None {
        // Any rule integrates zero.
        return Some((passed, [gauss::largest(); 2]));
    }
    Some((passed, [gauss::rule_for(space)?, gauss::rule_for(time)?]))
}

/// Integrals over the element for an impulse spread over the times from `begin` to `end`.
///
/// `None` if a front is inside or near.
pub(super) fn smooth_integrals(
    medium: &Medium,
    ends: [f64; 2],
    h: f64,
    [begin, end]: [f64; 2],
) -> Option<Integrals> {
    let (passed, [space, time]) = rules(medium, ends, h, begin, end)?;
    let mut sum = Integrals::default();
    if passed == Passed::None {
        return Some(sum);
    }
    let half = 0.5 * (ends[1] - ends[0]);
    let width = 0.5 * (end - begin);
    for (x, weight) in time.nodes.iter().zip(&time.weights) {
        let t = begin + width * (1.0 + x);
        for (y, other) in space.nodes.iter().zip(&space.weights) {
            let s = ends[0] + half * (1.0 + y);
            let value = impulse(medium, s, h, t, passed == Passed::Both);
            sum.add(half * width * weight * other, &value);
        }
    }
    Some(sum)
}
