//! Probable mistakes of which a run warns.

use crate::coupled::run::warning_text::{likely_motion_unit, likely_soil_units, point_count_text};

/// Number, mesh or ground that is probably a mistake.
///
/// Such numbers are in another unit, unless the model is not to scale.
///
/// [`Warning::Mistake`](crate::coupled::Warning::Mistake) contains it.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
#[non_exhaustive]
pub enum Mistake {
    /// Faces of a base in plan meet and move apart.
    ///
    /// Nodes at one point are not tied together, or a node lies on the edge of another face. The base is cut there, as
    /// between two meshes side by side.
    #[error(
        "base torn at {}, first at x = {x:.2} m, y = {y:.2} m: faces meet there and move apart (merge coincident nodes, \
         tie nodes on an edge to its ends)",
        point_count_text(*points)
    )]
    TornBase {
        /// Number of points where faces move apart.
        points: usize,
        /// Coordinate x of the first of these points, m.
        x: f64,
        /// Coordinate y of the first of these points, m.
        y: f64,
    },
    /// Shells or sides of solids at the height of the base do not touch the ground.
    ///
    /// The base does not include them.
    #[error(
        "faces at the height of the base that do not touch the ground: {faces}, first at x = {x:.2} m, y = {y:.2} m; \
         include them in the base if they stand on the ground"
    )]
    FacesOffGround {
        /// Number of these faces.
        faces: usize,
        /// Coordinate x of the middle of the first of these faces, m.
        x: f64,
        /// Coordinate y of the middle of the first of these faces, m.
        y: f64,
    },
    /// An elastic part of a user's ground applies a traction at the end of its step.
    ///
    /// Its displacement is s₁ = C τ. The ground is then of first order in the time step, and adds numerical damping. See
    /// [`Ground`](crate::bem::Ground#elastic-parts-in-the-mid-step-form).
    #[error(
        "ground of first order: an elastic part applies the traction of a step at the end of the step, which adds \
         numerical damping; apply it in the middle of the step"
    )]
    FirstOrderGround,
    /// A water table below the whole base: the water has no effect.
    #[error("water table {depth:.2} m below the surface, below the base: the water has no effect")]
    WaterBelowBase {
        /// Depth of the water table below the surface, m.
        depth: f64,
    },
    /// A soil with impossible numbers: probably in another unit, unless the model is not to scale.
    #[error("soil of {density:.3e} kg/m³, shear waves of {shear_wave_speed:.2e} m/s: {}",
        likely_soil_units(*shear_wave_speed, *density))]
    UnusualSoil {
        /// Speed of its shear waves, m/s.
        shear_wave_speed: f64,
        /// Density, kg/m³.
        density: f64,
    },
    /// A structure with an unusually long period: probably a stiffness in another unit.
    #[error("structure with a period of {period:.3} s on a fixed base: stiffness in kN/m or kPa?")]
    LongPeriod {
        /// Period on a fixed base, s.
        ///
        /// By Rayleigh's quotient of the deflection under a horizontal force equal to the weight.
        period: f64,
    },
    /// Ground acceleration above 2 g, or a record too weak in m/s²: probably in another unit.
    ///
    /// Numbers of a weak record are probably in g, and numbers above 60 in cm/s².
    #[error("ground acceleration of {acceleration:.3} m/s²: motion in {}?", likely_motion_unit(*acceleration))]
    UnusualMotion {
        /// Largest component at any step or sample, m/s².
        acceleration: f64,
    },
    /// A record with a time step outside 10⁻⁴ to 0.2 s: probably in another unit.
    #[error("record in steps of {time_step:.2e} s: interval in another unit?")]
    UnusualInterval {
        /// Time step of the record, s.
        time_step: f64,
    },
    /// The time step exceeds half the mean period of a record, which it does not resolve.
    #[error(
        "steps of {time_step:.2e} s do not resolve a record of period {period:.2e} s; take {needed:.1e} s"
    )]
    LongTimeStep {
        /// The time step, s.
        time_step: f64,
        /// Time step of the record, s.
        interval: f64,
        /// Mean period of the record's acceleration, by the root mean square of its frequency, s.
        period: f64,
        /// Time step that resolves the record, and a structure with a longer period, s.
        needed: f64,
    },
    /// The velocity of a record does not return to zero.
    ///
    /// The recorder has an offset, or the record is cut off. The ground drifts with this velocity.
    /// [`Record::with_baseline`](crate::motion::Record::with_baseline) removes an offset.
    #[error("record ends at {velocity:.3} m/s: baseline not corrected, or cut off?")]
    DriftingRecord {
        /// Velocity at the end of the record, m/s.
        velocity: f64,
    },
    /// A weight beyond the soil's resistance: over 2.5 % of its shear modulus.
    ///
    /// Probably masses, a thickness or the soil's modulus in another unit, or a mass that is not per metre of thickness.
    #[error(
        "weight of {pressure:.2e} Pa on soil of G = {shear_modulus:.2e} Pa: beyond the soil's resistance"
    )]
    HeavyStructure {
        /// Weight over the area of the contact elements, Pa.
        pressure: f64,
        /// Shear modulus of the soil at the surface, Pa.
        ///
        /// For a base with walls it is that of the stiffest soil.
        shear_modulus: f64,
    },
    /// Masses of vertical and of horizontal motion that differ by more than a tenth.
    ///
    /// The weight follows from the vertical mass. If this mass lacks floors, the pressure on the base is too small. Water that
    /// moves sideways with a structure has no weight on the base.
    #[error("mass moving up {vertical:.3e} kg, sideways {horizontal:.3e} kg: floors missing?")]
    UnequalMasses {
        /// Mass of the structure moving up, kg (in the plane kg/m).
        vertical: f64,
        /// Mass of the structure moving sideways, kg (in the plane kg/m).
        ///
        /// Along x; in plan along x or y.
        horizontal: f64,
    },
    /// A material of implausible density: probably in another unit.
    #[error("material of {density:.4} kg/m³: density in t/m³, kN/m³ or N/m³?")]
    UnusualDensity {
        /// Density, kg/m³.
        density: f64,
    },
    /// A bond much weaker than the pressure under the weight: its strength is probably in kPa.
    #[error("bond of {strength:.3} Pa under a weight of {pressure:.2e} Pa: strength in kPa?")]
    WeakBond {
        /// Smallest tensile or shear strength of an element, Pa.
        strength: f64,
        /// Weight over the area of the contact elements, Pa.
        pressure: f64,
    },
    /// A structure lighter than any building: probably masses in another unit.
    #[error("weight of {pressure:.3} Pa over the base: masses in t, or gravity in another unit?")]
    LightStructure {
        /// Weight over the area of the contact elements, Pa.
        pressure: f64,
    },
    /// An implausible friction coefficient: probably an angle in degrees, or a percentage.
    #[error("friction coefficient of {friction}: in degrees, or in per cent?")]
    UnusualFriction {
        /// The coefficient.
        friction: f64,
    },
    /// An implausible acceleration of gravity: probably in another unit.
    #[error("gravity of {gravity} m/s²: in another unit?")]
    UnusualGravity {
        /// Acceleration of gravity, m/s².
        gravity: f64,
    },
}
