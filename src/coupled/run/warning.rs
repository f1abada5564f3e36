//! Warnings of a run.

use crate::coupled::run::Quantity;

/// Warning that assumptions of a run are strained, or that its time step or elements are too coarse.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
#[non_exhaustive]
pub enum Warning {
    /// Slip beyond the mean length of the elements, in plan of their shorter sides: they no longer face each other.
    LargeSlip {
        /// Largest slip, m.
        slip: f64,
        /// Mean length of the elements, m.
        element_length: f64,
    },
    /// Rotation of the base beyond 0.1 rad, in plan about any axis: cosines are no longer one.
    LargeRotation {
        /// Largest rotation, rad.
        rotation: f64,
    },
    /// A foundation has settled by more than a tenth of its width, at which it counts as failed in bearing: the ground
    /// does not follow the base down, and the surface that it meets is taken as plane.
    LargeSettlement {
        /// Number of the foundation, from the left, from 0.
        foundation: usize,
        /// Largest settlement since the static state, against the free field, m.
        settlement: f64,
        /// Width of the foundation, in plan of its shorter side, m.
        width: f64,
    },
    /// Tension under a base that cannot open, above 1 % of the largest static pressure: it is held down by what the
    /// model does not have.
    Tension {
        /// Largest tension of any element, Pa.
        tension: f64,
        /// Middle of that element, m.
        x: f64,
        /// In plan: middle of that element along y, m.
        #[cfg_attr(feature = "serde", serde(default))]
        y: Option<f64>,
        /// Time of that tension, s.
        time: f64,
    },
    /// The energy balance does not close to 1e-9 at the end.
    EnergyBalance {
        /// Residual of the balance, relative to the largest energy of the run.
        #[cfg_attr(feature = "serde", serde(with = "crate::text::words::number"))]
        residual: f64,
    },
    /// The time scheme has made energy, more than 2 % of the run's largest:
    /// see [`Newmark`](crate::coupled::Newmark).
    AlgorithmicEnergy {
        /// Most that it had made at any time, relative to the largest energy of the run.
        #[cfg_attr(feature = "serde", serde(with = "crate::text::words::number"))]
        made: f64,
    },
    /// The base shear vibrates with a period that the time step does not resolve.
    UnresolvedPeriod {
        /// Root-mean-square period of the base shear, s.
        period: f64,
        /// The time step, s.
        time_step: f64,
        /// Time step that resolves the motion, s.
        needed: f64,
        /// Estimated error of the largest base shear, relative, from frequencies alone: half the true
        /// one or more in nine cases of ten. A run with half the time step shows it.
        error: f64,
    },
    /// The ground moves faster than the time step resolves, and the base shear with it.
    UnresolvedMotion {
        /// Root-mean-square frequency of the ground acceleration, Hz.
        frequency: f64,
        /// The time step, s.
        time_step: f64,
        /// Time step that resolves the motion, s.
        needed: f64,
        /// Estimated error of the largest base shear, relative: see
        /// [`UnresolvedPeriod`](Self::UnresolvedPeriod).
        error: f64,
    },
    /// In plan, a body vibrates at its own period while shear waves cross its base in less than four steps: steps that
    /// long damp its rocking more than radiation does.
    UnresolvedRadiation {
        /// Time in which shear waves cross the shorter side of the base, s.
        crossing: f64,
        /// The time step, s.
        time_step: f64,
        /// Time step that resolves the motion, s.
        needed: f64,
    },
    /// Fewer elements under a foundation than its rocking stiffness takes.
    FewElements {
        /// Number of the foundation, from the left, from 0.
        foundation: usize,
        /// Elements of the foundation; in plan those of a row or of a column.
        elements: usize,
        /// Fewest that it needs.
        needed: usize,
        /// In plan: `x` for elements of a row, `y` for those of a column.
        #[cfg_attr(feature = "serde", serde(default))]
        axis: Option<char>,
    },
    /// A flexible base on too few contact elements: shapes between elements are held by the structure alone, which is
    /// softer there than the soil that they leave out, or not stiff enough beside it.
    CoarseBase {
        /// Number of the foundation, from the left, from 0.
        foundation: usize,
        /// Elements of the foundation; in plan along its shorter side.
        elements: usize,
        /// About as many as it needs.
        needed: usize,
        /// Change of its vertical static shape by twice the elements, relative, where that is known.
        #[cfg_attr(feature = "serde", serde(default))]
        difference: Option<f64>,
        /// In plan: `x` for elements of a row, `y` for elements of a column.
        #[cfg_attr(feature = "serde", serde(default))]
        axis: Option<char>,
    },
    /// The base reaches beyond the ground's elements, by more than one of them or a tenth of its length: nothing carries
    /// it there.
    UncoveredBase {
        /// Number of the foundation, from the left, from 0.
        foundation: usize,
        /// Distance from the outermost element to the end of the foundation, m.
        reach: f64,
        /// In plan: axis along which the base reaches too far, `x` or `y`.
        #[cfg_attr(feature = "serde", serde(default))]
        axis: Option<char>,
    },
    /// More cells in plan than can be checked for passivity at once: only a sample of them was searched for errors of
    /// the quadrature and damping laws that are not passive. Steps are the same as with a full check.
    SampledPassivity {
        /// Cells that were checked together.
        checked: usize,
        /// All cells.
        cells: usize,
    },
    /// In plan, steps were solved with less friction than the law's, which is infinite or above 100, because an element
    /// slid: its shear is that lower coefficient times its pressure. Steps are counted since the simulation was built,
    /// the static state as one.
    LessFriction {
        /// Number of such steps.
        steps: usize,
        /// Least coefficient used.
        friction: f64,
    },
    /// A base in plan may slide with friction of 3 or more, endless friction included: some steps then have several
    /// solutions, and a mere mirror image of the scene may choose others. In one scene of a hundred that changes peaks by
    /// tens of per cent.
    HighFriction {
        /// Greatest friction coefficient.
        #[cfg_attr(feature = "serde", serde(with = "crate::text::words::number"))]
        friction: f64,
    },
    /// The motion has a component along y, which a ground in the plane leaves out.
    MotionAcross,
    /// A soil with numbers that no soil has: one in another unit, unless the model is not to scale.
    UnusualSoil {
        /// Speed of its shear waves, m/s.
        shear_wave_speed: f64,
        /// Density, kg/m³.
        density: f64,
    },
    /// A structure slower than almost any: a stiffness in another unit, unless the model is not to scale.
    LongPeriod {
        /// Period on a fixed base, s (Rayleigh's quotient of the deflection under its weight to the side).
        period: f64,
    },
    /// Ground acceleration above any that was recorded, or of a record so weak that its numbers are likely to be in g: a
    /// motion in another unit, unless the model is not to scale.
    UnusualMotion {
        /// Largest component at any step, of a weak record at any sample, m/s².
        acceleration: f64,
    },
    /// A record with a time step that no recorder has: an interval in another unit, unless the model is not to scale.
    UnusualInterval {
        /// Time step of the record, s.
        time_step: f64,
    },
    /// A structure that presses on the ground less than any building does: masses in another unit.
    LightStructure {
        /// Weight over the area of the contact elements, Pa.
        pressure: f64,
    },
    /// A friction coefficient that no material has: an angle in degrees, or a percentage.
    UnusualFriction {
        /// The coefficient.
        friction: f64,
    },
    /// A storey above 100 m: a height in another unit, or in the place of the mass.
    TallStorey {
        /// Height of the storey, m.
        height: f64,
    },
    /// An acceleration of gravity that no planet has: one in another unit, unless the model is not to scale.
    UnusualGravity {
        /// Acceleration of gravity, m/s².
        gravity: f64,
    },
    /// The run ended before most of its record: more than a third of the Arias intensity was still to come.
    EndsEarly {
        /// Time at the end of the run, s.
        end: f64,
        /// Time of the last sample of the record, s.
        duration: f64,
        /// Fraction of the record's Arias intensity until the end of the run.
        passed: f64,
    },
    /// A response to the ground motion was largest in the last step: it may grow further.
    PeakAtEnd {
        /// The response.
        quantity: Quantity,
        /// Time at the end of the run, s.
        end: f64,
    },
    /// The run ended because a base turned beyond the rotation limit
    /// ([`SimulationBuilder::rotation_limit`](crate::coupled::SimulationBuilder::rotation_limit)): it has overturned, or what
    /// small rotations cannot describe. A further run goes on.
    Overturned {
        /// Rotation limit, rad.
        limit: f64,
        /// Time at which it was passed, s.
        time: f64,
    },
    /// Damping of the structure resists a rigid translation, as mass-proportional damping does, and has braked a base that
    /// slid.
    DampedSliding {
        /// Damping of the translation over the mass that it moves, 1/s.
        rate: f64,
        /// Estimated loss of the longest slip event, relative: of a block that slides to rest.
        loss: f64,
    },
    /// Elements longer than a quarter of the soil's shear waves at the frequency of the base shear, where waves run
    /// along the base; in plan cells longer than a twelfth.
    LongElements {
        /// Longest element, m; in plan the narrowest along x or along y.
        element_length: f64,
        /// Wavelength at the root-mean-square frequency of the base shear, m.
        wavelength: f64,
        /// Length that resolves it, m.
        needed: f64,
    },
}
