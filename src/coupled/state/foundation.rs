//! One foundation after a step: forces, motion and factors of safety.
//!
//! Factors of safety against sliding and overturning are computed from the actual contact tractions. Tractions of
//! a base that may open and slide cannot exceed its strength: such a factor stays at or above one, and reaches it
//! when the base slides or stands on its edge. Only on a bonded base it falls below one, and shows the missing
//! strength of the interface.

use std::ops::Range;

use crate::geometry::{COMPONENTS_IN_SPACE, ContactElement, Footing, Patch, resultant};
use crate::interface::{ContactState, Mode};

/// Forces of one foundation on the soil, and motion of its base.
///
/// Most structures have one. See [`crate::structure::Base`].
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Foundation {
    /// Elements of the foundation, as indices of [`State::contact`](crate::coupled::State::contact).
    pub elements: Range<usize>,
    /// Horizontal force on the soil, positive to the right, N/m.
    pub base_shear: f64,
    /// Moment on the soil about the middle of its elements, counter-clockwise, N·m/m.
    ///
    /// In plan about the axis along y through the middle of its outline, by the right-hand rule, N·m.
    pub base_moment: f64,
    /// Total pressure on the soil, positive in compression, N/m.
    pub normal_force: f64,
    /// Length of its open elements over the length of all its elements; in plan area over area.
    pub uplifted_fraction: f64,
    /// Slip averaged over its elements, m.
    pub mean_slip: f64,
    /// Rotation of its chord, counter-clockwise, rad.
    ///
    /// In plan the rotation about the axis along y, by the right-hand rule, of the plane that fits its base best.
    pub base_rotation: f64,
    /// Settlement of its centre since the static state, positive downwards, m.
    ///
    /// Relative to the free field's translation: the mean over its length, in plan over its area. It includes
    /// elastic settlement, permanent settlement and gaps, so a base that rocks on hard soil rises: the value is then
    /// negative. It does not include the settlement under weight.
    #[cfg_attr(feature = "serde", serde(default))]
    pub settlement: f64,
    /// Work of its moment on the soil since t = 0, ∫M dθ, J/m.
    ///
    /// Of the [`base_moment`](Foundation::base_moment) of each step on the change of its
    /// [`base_rotation`](Foundation::base_rotation) in the step, as in the energy balance.
    #[cfg_attr(feature = "serde", serde(default))]
    pub rocking_work: f64,
    /// In plan: force on the soil along y, N; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub shear_across: f64,
    /// In plan: moment on the soil about the axis along x, N·m.
    ///
    /// The axis passes through the middle of the foundation; by the right-hand rule.
    #[cfg_attr(feature = "serde", serde(default))]
    pub moment_across: f64,
    /// In plan: moment on the soil about the vertical axis, N·m.
    ///
    /// The axis passes through the middle of the foundation; counter-clockwise from above.
    #[cfg_attr(feature = "serde", serde(default))]
    pub torque: f64,
    /// In plan: slip along y averaged over the elements, m.
    #[cfg_attr(feature = "serde", serde(default))]
    pub mean_slip_across: f64,
    /// In plan: rotation of the base about the axis along x, by the right-hand rule, rad.
    #[cfg_attr(feature = "serde", serde(default))]
    pub rotation_across: f64,
    /// In plan: work of `moment_across` on the soil since t = 0, J; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub rocking_work_across: f64,
    /// In plan: rotation of the base about the vertical axis, counter-clockwise from above, rad.
    #[cfg_attr(feature = "serde", serde(default))]
    pub twist: f64,
    /// Whether the ground is one in plan: forces then act on the whole body.
    #[cfg_attr(feature = "serde", serde(default))]
    pub in_plan: bool,
}

/// Factors of safety and largest slip of a foundation.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct FoundationChecks {
    /// Largest |slip| of any element, m.
    pub(crate) largest_slip: f64,
    /// Resistance of the interface over the horizontal force; NaN without friction coefficients and in flight.
    pub(crate) sliding: f64,
    /// Restoring over overturning moment about the edges that face along x, and along y.
    ///
    /// NaN in flight, infinite along y in the plane.
    pub(crate) overturning: [f64; 2],
}

/// Integrals over the elements of a foundation, which are added over the whole base.
#[derive(Default)]
pub(crate) struct ContactSums {
    pub(crate) area: f64,
    /// Area of open elements.
    pub(crate) open_area: f64,
    /// Integral of the slip along x.
    pub(crate) slip: f64,
    /// Integral of the slip along y.
    slip_across: f64,
}

impl ContactSums {
    /// Adds the integrals over one element.
    fn add(&mut self, element: &ContactElement, area: f64, state: &ContactState, mode: Mode) {
        let slip = element.vector([0.0, state.slip, state.slip_across]);
        self.area += area;
        self.slip += area * slip[0];
        self.slip_across += area * slip[1];
        if !mode.is_closed() {
            self.open_area += area;
        }
    }
}

impl Foundation {
    /// Force on the soil as a vector, N/m; in plan along x, y and up, N.
    ///
    /// In the plane axes point to the right, up and towards the reader.
    pub fn force_vector(&self) -> [f64; COMPONENTS_IN_SPACE] {
        in_axes(self.in_plan, [self.base_shear, self.shear_across, -self.normal_force])
    }

    /// Moment on the soil about the middle of the foundation as a vector, N·m/m.
    ///
    /// By the right-hand rule, with axes as in [`force_vector`](Foundation::force_vector).
    pub fn moment_vector(&self) -> [f64; COMPONENTS_IN_SPACE] {
        in_axes(self.in_plan, [self.moment_across, self.base_moment, self.torque])
    }

    /// Rotation of the base as a vector by the right-hand rule, rad.
    ///
    /// Axes as in [`force_vector`](Foundation::force_vector).
    pub fn rotation_vector(&self) -> [f64; COMPONENTS_IN_SPACE] {
        in_axes(self.in_plan, [self.rotation_across, self.base_rotation, self.twist])
    }

    /// Adds the work of the present moments on these increments of the rotations.
    ///
    /// `increments`: in the step to the present state, in the order of [`PlacedBase::rotations`].
    ///
    /// [`PlacedBase::rotations`]: crate::coupled::base::PlacedBase::rotations
    pub(crate) fn add_rocking_work(&mut self, increments: impl Iterator<Item = f64>) {
        let works = [
            (&mut self.rocking_work, self.base_moment),
            (&mut self.rocking_work_across, self.moment_across),
        ];
        for ((work, moment), increment) in works.into_iter().zip(increments) {
            *work += moment * increment;
        }
    }

    /// Computes forces, uplift, slip and factors of safety from the contact of all elements of `patch`.
    ///
    /// `footing` is the shape of this foundation. `friction` has one coefficient for all elements of the patch, one for
    /// each, or none.
    pub(crate) fn update(
        &mut self,
        footing: &Footing,
        patch: &Patch,
        friction: &[f64],
        contact: &[ContactState],
        modes: &[Mode],
    ) -> (ContactSums, FoundationChecks) {
        let elements = self.elements.clone();
        let friction = if friction.len() > 1 { &friction[elements.clone()] } else { friction };
        let mut sums = ContactSums::default();
        let mut resistance = 0.0;
        let mut largest_slip = 0.0_f64;
        let mut moment = [0.0; 2];
        self.in_plan = patch.is_plan();
        self.base_shear = 0.0;
        self.shear_across = 0.0;
        self.normal_force = 0.0;
        self.torque = 0.0;
        for (k, (e, &[x, y, z])) in elements.zip(&footing.arms).enumerate() {
            let element = &patch[e];
            let area = patch.areas()[e];
            let state = &contact[e];
            let element_force = area * state.pressure;
            let coefficient = friction.get(k).or(friction.first()).copied().unwrap_or(f64::NAN);
            // An element without pressure has no resistance, also under infinite friction.
            if element_force != 0.0 && !(coefficient == f64::INFINITY && element_force < 0.0) {
                resistance += coefficient * element_force;
            }
            let [traction_x, traction_y, traction_z] = element.vector(state.traction());
            let vertical_force = area * -traction_z;
            self.normal_force += vertical_force;
            self.base_shear += area * traction_x;
            self.shear_across += area * traction_y;
            self.torque += area * (x * traction_y - y * traction_x);
            moment[0] += vertical_force * x + area * traction_x * z;
            moment[1] += vertical_force * y + area * traction_y * z;
            largest_slip = resultant(state.slip, state.slip_across).abs().max(largest_slip);
            if element.faces_down() {
                sums.add(element, area, state, modes[e]);
            }
        }
        // Subtraction from zero avoids negative zero in the plane.
        self.moment_across = 0.0 - moment[1];
        self.base_moment = footing.rotation_sign * moment[0];
        let area = sums.area.max(f64::MIN_POSITIVE);
        self.uplifted_fraction = sums.open_area / area;
        self.mean_slip = sums.slip / area;
        self.mean_slip_across = sums.slip_across / area;
        let demand = resultant(self.base_shear, self.shear_across).abs();
        let mut sliding = f64::NAN;
        let mut overturning = [f64::NAN; 2];
        // Pressure on walls resists sliding and overturning, which these factors do not include.
        if !patch.has_walls() {
            if !friction.is_empty() {
                sliding = factor_of_safety(self.normal_force, resistance, demand);
            }
            overturning =
                [0, 1].map(|axis| overturning_safety(footing, self.normal_force, moment, axis));
        }
        (sums, FoundationChecks { largest_slip, sliding, overturning })
    }
}

/// A vector in the axes of the scene from its components along x, y and up.
///
/// In the plane axes point to the right, up and towards the reader. The component along y comes last there.
pub(crate) fn in_axes(
    in_plan: bool,
    [x, y, up]: [f64; COMPONENTS_IN_SPACE],
) -> [f64; COMPONENTS_IN_SPACE] {
    if in_plan { [x, y, up] } else { [x, up, y] }
}

/// Factor of safety against overturning.
///
/// It is N b over the moment of the pressure about the middle of the base, with b the half width.
///
/// In plan the smallest over the edges that face along `axis` (x 0, y 1), at their distances b from the middle of
/// the outline; infinite along y in the plane.
fn overturning_safety(footing: &Footing, normal_force: f64, moment: [f64; 2], axis: usize) -> f64 {
    let factors = footing.edges[axis].iter().map(|(edge, edge_distance)| {
        let overturning_moment = edge.outward(moment).max(0.0);
        factor_of_safety(normal_force, normal_force * edge_distance, overturning_moment)
    });
    factors.reduce(f64::min).unwrap_or(f64::INFINITY)
}

/// Factor of safety: resistance over demand.
///
/// NaN without any pressure, infinite without demand, zero if the base as a whole is in tension.
fn factor_of_safety(normal_force: f64, resistance: f64, demand: f64) -> f64 {
    if normal_force == 0.0 {
        f64::NAN
    } else if normal_force < 0.0 || resistance <= 0.0 {
        0.0
    } else if demand == 0.0 || resistance == f64::INFINITY {
        f64::INFINITY
    } else {
        resistance / demand
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn patch() -> Patch {
        Patch::new(vec![ContactElement::new(-1.0, 1.0), ContactElement::new(1.0, 2.0)]).unwrap()
    }

    /// Factors of safety on `patch`, whose outline is empty in the plane.
    fn safety(
        patch: &Patch,
        outline: &[[f64; 2]],
        friction: &[f64],
        contact: &[ContactState; 2],
    ) -> FoundationChecks {
        let footing = Footing::new(patch, 0..2, outline, [0.0; 2]);
        let mut foundation = Foundation { elements: 0..2, ..Default::default() };
        foundation.update(&footing, patch, friction, contact, &[Mode::Stick; 2]).1
    }

    fn contact(pressure: [f64; 2], shear: [f64; 2]) -> [ContactState; 2] {
        [0, 1].map(|e| ContactState {
            pressure: pressure[e],
            shear: shear[e],
            ..Default::default()
        })
    }

    /// Half width 1.5, N = 2·30 + 10 = 70, H = −14, moment 60·(−0.5) + 10·1 = −20.
    #[test]
    fn factors_of_safety_by_hand() {
        let state = contact([30.0, 10.0], [-10.0, 6.0]);
        let checks = |friction: &[f64]| safety(&patch(), &[], friction, &state);
        assert!((checks(&[0.4]).sliding - 0.4 * 70.0 / 14.0).abs() < 1e-14);
        assert!((checks(&[0.5, 0.1]).sliding - 31.0 / 14.0).abs() < 1e-14);
        assert!(checks(&[]).sliding.is_nan());
        assert!((checks(&[]).overturning[0] - 70.0 * 1.5 / 20.0).abs() < 1e-14);
        assert_eq!(checks(&[]).overturning[1], f64::INFINITY);
    }

    /// Elements in plan, 3 m and 1 m deep.
    ///
    /// N = 180 + 10 = 190, H = −54 and 40, moments about the middle (0.5, 1.5) along x 180·(−0.5) + 10·1, along y
    /// 180·0 + 10·(−1).
    #[test]
    fn factors_of_safety_by_hand_in_plan() {
        let mut state = contact([30.0, 10.0], [-10.0, 6.0]);
        [state[0].shear_across, state[1].shear_across] = [5.0, 10.0];
        let cells = [([-1.0, 1.0], [0.0, 3.0]), ([1.0, 2.0], [0.0, 1.0])];
        let cells = cells.map(|(x_ends, y_ends)| ContactElement::in_plan(x_ends, y_ends));
        let patch = Patch::new(cells.to_vec()).unwrap();
        let square = [[-1.0, 0.0], [2.0, 0.0], [2.0, 3.0], [-1.0, 3.0]];
        let checks = safety(&patch, &square, &[0.4], &state);
        assert!((checks.sliding - 0.4 * 190.0 / 54.0_f64.hypot(40.0)).abs() < 1e-14);
        assert!((checks.overturning[0] - 190.0 * 1.5 / 80.0).abs() < 1e-13);
        assert!((checks.overturning[1] - 190.0 * 1.5 / 10.0).abs() < 1e-13);
        // Pressure under the second element, at (1, −1) from the middle; a diamond about the same middle has edges
        // that face both ways: (e · n)/h = 2/1.5.
        let diamond = [[-1.0, 1.5], [0.5, 0.0], [2.0, 1.5], [0.5, 3.0]];
        for (outline, factor) in [(square, 1.5), (diamond, 0.75)] {
            let checks = safety(&patch, &outline, &[], &contact([0.0, 10.0], [0.0; 2]));
            assert!(checks.overturning.iter().all(|safety| (safety - factor).abs() < 1e-14));
        }
    }

    #[test]
    fn factors_of_safety_in_limiting_cases() {
        let patch = patch();
        let checks_of =
            |friction: f64, state: &[ContactState; 2]| safety(&patch, &[], &[friction], state);
        let flight = contact([0.0; 2], [0.0; 2]);
        let pressed_state = contact([1.0; 2], [0.0; 2]);
        for friction in [0.0, 0.4, f64::INFINITY] {
            let checks = checks_of(friction, &flight);
            assert!(checks.sliding.is_nan() && checks.overturning[0].is_nan());
        }
        // Resultant at the middle: 2 p₀ (−½) + p₁ (1) = 0.
        let checks = checks_of(0.4, &pressed_state);
        assert_eq!([checks.sliding, checks.overturning[0]], [f64::INFINITY; 2]);
        assert_eq!(checks_of(0.0, &pressed_state).sliding, 0.0);
        let sheared_state = contact([1.0, 0.0], [0.3, 0.0]);
        assert_eq!(checks_of(f64::INFINITY, &sheared_state).sliding, f64::INFINITY);
        // The base as a whole is in tension: nothing resists.
        assert_eq!(checks_of(0.4, &contact([-1.0; 2], [0.0; 2])).overturning[0], 0.0);
    }
}
