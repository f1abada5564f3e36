//! The interface of a reading.

use basemat::Soil;
use basemat::interface::{
    Condition, ContactState, Coulomb, FrictionLimit, InPlane, InterfaceLaw, Mode, PlaneLaw,
    PreviousContact, SlipSense, ThinLayer, Tolerance,
};

use super::options::{InterfaceReading, LimitReading, PaperReading, SlipSenseReading};
use basemat_problems::containment::PermanentLayer;

impl PaperReading {
    /// The law of an element under a base with that mean pressure.
    pub(crate) fn law(
        &self,
        friction: f64,
        soil: &Soil,
        mean_pressure: f64,
    ) -> basemat::Result<Box<dyn InterfaceLaw>> {
        if self.law == InterfaceReading::Hard {
            let static_friction = Coulomb::new(friction)?;
            if self.kinetic != 1.0 && friction.is_finite() {
                return Ok(Box::new(InPlane(KineticFriction {
                    static_friction,
                    kinetic_friction: Coulomb::new(self.kinetic * friction)?,
                })));
            }
            return Ok(Box::new(static_friction));
        }
        let limit = match self.limit {
            LimitReading::Total => FrictionLimit::Total,
            LimitReading::Lagged | LimitReading::Compression => FrictionLimit::Lagged,
            LimitReading::Static | LimitReading::Weight => FrictionLimit::Static,
            LimitReading::Dynamic => FrictionLimit::Dynamic,
        };
        let sense = match self.sense {
            SlipSenseReading::Inelastic => SlipSense::Inelastic,
            SlipSenseReading::Velocity => SlipSense::Velocity,
            SlipSenseReading::LastVelocity => SlipSense::LastVelocity,
        };
        let layer = ThinLayer::new(*soil, self.neighbour_height(), friction)?
            .with_thickness_ratio(self.ratio)?
            .with_debonded_ratio(self.debonded)?
            .with_friction_limit(limit)
            .with_slip_sense(sense)
            .with_slip_stiffness_ratio(self.slip_shear)?;
        Ok(Box::new(InPlane(ReadLayer {
            layer,
            limit: self.limit,
            slip_normal: self.slip_normal,
            mean_pressure,
            static_share: self.static_share,
            lag_modes: self.lag_modes,
        })))
    }

    /// A layer that stays bonded.
    pub(crate) fn glue(&self, soil: &Soil) -> basemat::Result<Box<dyn InterfaceLaw>> {
        let layer = ThinLayer::new(*soil, self.neighbour_height(), f64::INFINITY)?;
        Ok(Box::new(InPlane(PermanentLayer(layer.with_thickness_ratio(self.ratio)?))))
    }
}

/// Hard contact with different coefficients of static and of kinetic friction.
struct KineticFriction {
    static_friction: Coulomb,
    kinetic_friction: Coulomb,
}

impl PlaneLaw for KineticFriction {
    fn modes(&self) -> &[Mode] {
        self.static_friction.modes()
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        if mode.is_slip() {
            return self.kinetic_friction.conditions(mode, start);
        }
        self.static_friction.conditions(mode, start)
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        // While an element slides, kinetic friction acts.
        let slides = start.mode.is_slip() && !mode.is_slip();
        let law = if slides { &self.kinetic_friction } else { &self.static_friction };
        law.next_mode(mode, start, trial, tolerance)
    }
}

/// A thin layer with options that the library's layer does not have.
struct ReadLayer {
    layer: ThinLayer,
    limit: LimitReading,
    slip_normal: f64,
    mean_pressure: f64,
    static_share: f64,
    lag_modes: bool,
}

impl ReadLayer {
    /// The start of the step with the pressure that limits friction.
    fn limiting_start<'a>(&self, start: &PreviousContact<'a>) -> PreviousContact<'a> {
        let mut start = *start;
        match self.limit {
            LimitReading::Compression => start.state.pressure -= start.static_pressure,
            LimitReading::Lagged => {
                start.state.pressure -= (1.0 - self.static_share) * start.static_pressure;
            }
            LimitReading::Weight => start.static_pressure = self.mean_pressure,
            _ => {}
        }
        start
    }

    /// The mode that follows from the end of the step before.
    fn lagged_mode(&self, start: &PreviousContact) -> Mode {
        let mut before = self.limiting_start(start);
        before.state.slip -= start.slip_rate * start.time_step;
        let tolerance = Tolerance::new(1e-12, 1e-6);
        self.layer.next_mode(start.mode, &before, &start.state, tolerance)
    }
}

impl PlaneLaw for ReadLayer {
    fn modes(&self) -> &[Mode] {
        self.layer.modes()
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        let mode = if self.lag_modes { self.lagged_mode(start) } else { mode };
        let mut conditions = self.layer.conditions(mode, &self.limiting_start(start));
        if mode.is_slip() {
            conditions[0].gap *= self.slip_normal;
        }
        conditions
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        if self.lag_modes {
            return self.lagged_mode(start);
        }
        self.layer.next_mode(mode, &self.limiting_start(start), trial, tolerance)
    }

    fn compliance(&self, mode: Mode, start: &PreviousContact) -> [f64; 2] {
        let mut compliance = self.layer.compliance(mode, start);
        if mode.is_slip() {
            compliance[0] /= self.slip_normal;
        }
        compliance
    }

    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        self.layer.frictionless()
    }
}
