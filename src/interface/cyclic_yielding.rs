//! Contact on soil that yields again in every cycle of a rocking base.

use super::{
    Condition, ContactState, Coulomb, InterfaceLaw, Limits, Mode, PreviousContact, Tolerance,
};
use crate::error::{Result, not_negative, positive, require};

/// Smallest difference between bearing pressure and pressure on the backbone, relative to the bearing pressure.
///
/// Below it, rounding errors determine the settlement that the backbone returns for the pressure.
const MIN_RESERVE_FRACTION: f64 = 1e-12;

/// Coulomb friction and uplift on soil that settles in every cycle of load.
///
/// Under virgin load the pressure follows a hyperbola over the settlement h of an element, the backbone. The reference
/// settlement w_r is the one at which half of the bearing pressure q acts. q grows from its initial value q_u with the
/// settlement w of the soil, by q_d per metre:
///
/// ```text
/// F(h) = q h/(h + w_r),        q = q_u + q_d w
/// ```
///
/// After the pressure has fallen by more than the elastic range η q, the soil yields again before the pressure reaches
/// its former value. The state variables of each element are its settlement w (m) and the threshold c (Pa) up to which
/// it bears without yielding. The normal conditions of an element are combined with stick and slip. With pressure p, gap
/// g, the settlement v in the step and F(h₀) = c, they are:
///
/// | | |
/// |---|---|
/// | open | p = 0, g ≥ −w |
/// | closed | g = −w, 0 ≤ p ≤ c |
/// | yielding | g = −w − v, p = F(h₀ + v) |
///
/// At the end of a step w grows by v. Where the soil yielded, c becomes F(h₀ + v). Then c becomes min(c, p + η q). The
/// first load is virgin, with c = 0: the weight settles by F⁻¹ of its pressure. With w_r = 0 and q_d = 0 the law is
/// [`Yielding`](super::Yielding).
///
/// The law stores no elastic energy. The energy balance counts p v ≥ 0 in `contact`, for all parameters, so that the
/// dissipated energy never decreases. Sliding does not lower q. Only friction bounds the shear traction; the law has no bound
/// by the undrained strength of the soil.
///
/// Each element yields independently of its neighbours, in series with the elastic ground. For a footing of
/// 2.8 m × 0.65 m, w_r = 5 mm, η = 0.1 and q_d = 1.4 MPa/m were fitted to one slow centrifuge test of a rocking wall on
/// dense dry sand (Gajan & Kutter 2008, doi:10.1061/(ASCE)1090-0241(2008)134:8(1129)). They belong to q_u = 814 kPa and to
/// a half-space of 30 MPa. In cycles of equal rotation each adds the same settlement if q_d = 0, and less than the cycle
/// before if q_d > 0.
///
/// For another footing, a point of its load test gives w_r: where the pressure p has caused the settlement h in addition to
/// that of the elastic ground, w_r = h (q/p − 1). The settlement in a cycle of load gives η, since the soil settles more
/// with a shorter elastic range; without a test, η from 0.1 to 1 shows its effect.
///
/// ```
/// use basemat::Simulation;
/// use basemat::bem::SpringGround;
/// use basemat::interface::CyclicYielding;
/// use basemat::motion::el_centro_1940;
/// use basemat::structure::RigidBlock;
///
/// // 118 kPa due to weight, on soil with a bearing pressure of 500 kPa.
/// let law = CyclicYielding::new(500.0e3, 5.0e-3, 0.6)?.with_elastic_range(0.1)?;
/// let static_settlement = law.virgin_settlement(117.7e3);
/// assert!((static_settlement - 1.54e-3).abs() < 1e-5);
/// let mut simulation = Simulation::builder(0.002)
///     .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
///     .ground(SpringGround::new(-2.0..2.0, 16, 8e7, 4e7)?.with_dashpots(7e5, 4e5)?)
///     .interface(law)
///     .motion(el_centro_1940())
///     .build()?;
/// let run = simulation.run(2500, |_| {})?;
/// let settlement = simulation.state().state_variables(0)[0];
/// assert!(settlement > 2.0 * static_settlement, "the edge has sunk in: {settlement}");
/// assert!(run.energy_error < 1e-9 && simulation.state().energy_balance.contact > 0.0);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "CyclicYieldingForm"))]
pub struct CyclicYielding {
    bearing_pressure: f64,
    reference_settlement: f64,
    elastic_range: f64,
    depth_gradient: f64,
    #[cfg_attr(
        feature = "serde",
        serde(rename = "friction", serialize_with = "Coulomb::write_friction")
    )]
    contact: Coulomb,
}

validated! {
    CyclicYielding as CyclicYieldingForm {
        bearing_pressure: f64,
        reference_settlement: f64,
        elastic_range: f64,
        #[serde(default)]
        depth_gradient: f64,
        #[serde(with = "crate::text::forms::number")]
        friction: f64,
    }
    => CyclicYielding::new(bearing_pressure, reference_settlement, friction)?
        .with_elastic_range(elastic_range)?
        .with_depth_gradient(depth_gradient)
}

impl CyclicYielding {
    /// Creates the law from its bearing pressure (Pa), reference settlement (m) and friction coefficient.
    ///
    /// [`ShallowFooting`](crate::soil::ShallowFooting) computes the bearing pressure of a footing.
    /// The elastic range is one: the soil yields again only above its largest past pressure. The bearing pressure does
    /// not grow. The friction coefficient is zero or more; if it is infinite, nothing ever slides.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a pressure that is not finite and above zero, a settlement that is not
    /// finite or below zero, and a coefficient that is NaN or negative.
    pub fn new(bearing_pressure: f64, reference_settlement: f64, friction: f64) -> Result<Self> {
        Ok(Self {
            bearing_pressure: positive("bearing pressure", bearing_pressure)?,
            reference_settlement: not_negative("reference settlement", reference_settlement)?,
            elastic_range: 1.0,
            depth_gradient: 0.0,
            contact: Coulomb::new(friction)?,
        })
    }

    /// Sets the elastic range η: the rise of pressure without yielding, relative to the bearing pressure.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is above 0 and at most 1.
    pub fn with_elastic_range(mut self, range: f64) -> Result<Self> {
        let is_fraction = range > 0.0 && range <= 1.0;
        self.elastic_range = require("elastic range", range, is_fraction, "above 0, at most 1")?;
        Ok(self)
    }

    /// Sets the growth q_d of the bearing pressure with the settlement, Pa/m.
    ///
    /// For a base on sand it is about γ N_q, since the soil beside a base that has settled is a surcharge.
    /// [`ShallowFooting::pressure_growth`](crate::soil::ShallowFooting::pressure_growth) includes the factor of shape: for
    /// the footing above and sand of 42° it is 1.60 MPa/m, while γ N_q is 1.39 MPa/m.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is finite and not below zero.
    pub fn with_depth_gradient(mut self, gradient: f64) -> Result<Self> {
        self.depth_gradient = not_negative("growth of the bearing pressure", gradient)?;
        Ok(self)
    }

    /// Settlement (m) of soil that is loaded for the first time, under a pressure (Pa).
    ///
    /// The settlement of the elastic ground below is not included. The bearing pressure has its initial value.
    pub fn virgin_settlement(&self, pressure: f64) -> f64 {
        self.backbone(0.0).settlement_at(pressure)
    }

    /// The friction coefficient.
    pub(crate) fn friction(&self) -> f64 {
        self.contact.friction()
    }

    /// Backbone of soil after a settlement (m).
    fn backbone(&self, settlement: f64) -> Backbone {
        Backbone {
            bearing_pressure: self.bearing_pressure + self.depth_gradient * settlement.max(0.0),
            reference_settlement: self.reference_settlement,
        }
    }
}

/// Pressure over settlement under virgin load: F(h) = q h/(h + w_r).
#[derive(Clone, Copy)]
struct Backbone {
    bearing_pressure: f64,
    reference_settlement: f64,
}

/// Pressure (Pa) and slope (Pa/m) of the backbone at a settlement.
struct BackbonePoint {
    pressure: f64,
    slope: f64,
}

impl Backbone {
    /// Pressure relative to the bearing pressure, below one.
    fn load_ratio(&self, pressure: f64) -> f64 {
        (pressure / self.bearing_pressure).clamp(0.0, 1.0 - MIN_RESERVE_FRACTION)
    }

    /// F⁻¹ of a pressure, m.
    fn settlement_at(&self, pressure: f64) -> f64 {
        let ratio = self.load_ratio(pressure);
        self.reference_settlement * ratio / (1.0 - ratio)
    }

    /// Pressure above which soil with this `threshold` yields: the pressure of [`Backbone::point_after`] at v = 0.
    fn yield_pressure(&self, threshold: f64) -> f64 {
        if self.reference_settlement == 0.0 {
            self.bearing_pressure
        } else {
            threshold.clamp(0.0, (1.0 - MIN_RESERVE_FRACTION) * self.bearing_pressure)
        }
    }

    /// Pressure F(h₀ + v) and its slope after a further settlement v (m).
    ///
    /// `threshold` is F(h₀).
    ///
    /// With x = F(h₀)/q, F(h₀ + v) = q (x w_r + (1 − x) v)/(w_r + (1 − x) v). The slope is
    /// q w_r (1 − x)²/(w_r + (1 − x) v)².
    fn point_after(&self, threshold: f64, settlement_in_step: f64) -> BackbonePoint {
        let Self { bearing_pressure, reference_settlement } = *self;
        if reference_settlement == 0.0 {
            return BackbonePoint { pressure: bearing_pressure, slope: 0.0 };
        }
        let ratio = self.load_ratio(threshold);
        let reserve_ratio = 1.0 - ratio;
        // The term (1 − x) v.
        let scaled_settlement = reserve_ratio * settlement_in_step;
        let denominator = reference_settlement + scaled_settlement;
        let slope_root = reserve_ratio / denominator;
        let ratio_after = (ratio * reference_settlement + scaled_settlement) / denominator;
        BackbonePoint {
            pressure: bearing_pressure * ratio_after,
            slope: bearing_pressure * reference_settlement * slope_root * slope_root,
        }
    }
}

/// State variables of an element.
struct SettledSoil {
    /// Settlement w, m.
    settlement: f64,
    /// Pressure c up to which the soil does not yield, Pa.
    threshold: f64,
}

impl SettledSoil {
    /// State variables at the start of a step; zero before the laws have set them.
    fn of(start: &PreviousContact) -> Self {
        match *start.state_variables {
            [settlement, threshold, ..] => Self { settlement, threshold },
            _ => Self { settlement: 0.0, threshold: 0.0 },
        }
    }
}

impl CyclicYielding {
    /// Limits of soil that does not yield in the step.
    fn limits_without_yield(&self, start: &PreviousContact) -> Result<Limits> {
        let SettledSoil { settlement, threshold } = SettledSoil::of(start);
        Ok(Limits {
            pressure_cap: self.backbone(settlement).yield_pressure(threshold),
            gap_offset: -settlement,
            ..self.contact.limits(start)?
        })
    }
}

impl InterfaceLaw for CyclicYielding {
    fn modes(&self) -> &[Mode] {
        Mode::with_yield(self.friction())
    }

    fn state_variables(&self) -> usize {
        2
    }

    /// Sets the threshold to the present pressure: a higher pressure is virgin load.
    fn initial_state_variables(&self, start: &PreviousContact, state_variables: &mut [f64]) {
        let ContactState { gap, pressure, .. } = start.state;
        let is_closed = start.mode.is_closed();
        state_variables[0] = if is_closed { (-gap).max(0.0) } else { 0.0 };
        state_variables[1] = if is_closed { pressure.max(0.0) } else { 0.0 };
    }

    fn commit(
        &self,
        _start: &PreviousContact,
        end: &ContactState,
        mode: Mode,
        state_variables: &mut [f64],
    ) {
        let pressure = if mode.is_closed() { end.pressure.max(0.0) } else { 0.0 };
        if mode.is_yield() {
            let settlement = state_variables[0];
            state_variables[0] = settlement.max(-end.gap);
            // The threshold is computed from the backbone, so that errors of the pressure do not add up over the steps.
            let settlement_in_step = state_variables[0] - settlement;
            let backbone = self.backbone(settlement);
            let point = backbone.point_after(state_variables[1], settlement_in_step);
            state_variables[1] = point.pressure;
        }
        let bearing_pressure = self.backbone(state_variables[0]).bearing_pressure;
        let max_threshold = pressure + self.elastic_range * bearing_pressure;
        state_variables[1] = state_variables[1].min(max_threshold);
    }

    fn friction_coefficient(&self) -> Option<f64> {
        Some(self.friction())
    }

    /// The default conditions; the backbone is evaluated only where the soil yields.
    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        let limits =
            if mode.is_yield() { self.limits(start) } else { self.limits_without_yield(start) };
        limits.map_or_else(
            |_| [Condition::gap_is(f64::NAN), Condition::slip_is(f64::NAN)],
            |limits| limits.conditions(mode, start, [0.0; 2]),
        )
    }

    /// The default next mode; the backbone is evaluated only for soil that does not yield.
    ///
    /// Whether yielding soil continues to yield depends on its settlement alone, not on its pressure.
    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        let needs_backbone = !mode.is_yield() && start.trial_settlement != 0.0;
        let limits =
            if needs_backbone { self.limits(start) } else { self.limits_without_yield(start) };
        let closing_mode = self.modes().first().copied().unwrap_or(Mode::Stick);
        limits.map_or(mode, |limits| {
            limits.next_mode(mode, closing_mode, start, trial, tolerance, [0.0; 2])
        })
    }

    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        let SettledSoil { settlement, threshold } = SettledSoil::of(start);
        let backbone = self.backbone(settlement);
        let BackbonePoint { pressure, slope } =
            backbone.point_after(threshold, start.trial_settlement);
        Ok(Limits {
            pressure_cap: (pressure - slope * start.trial_settlement).max(0.0),
            hardening: slope,
            gap_offset: -settlement,
            ..self.contact.limits(start)?
        })
    }

    /// The same law without friction, on the same soil.
    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        Box::new(Self { contact: Coulomb::frictionless(), ..*self })
    }
}
