//! The interface of a reading.

use basemat::Soil;
use basemat::interface::{
    Condition, ContactState, Coulomb, FrictionLimit, InPlane, InterfaceLaw, Mode, PlaneLaw,
    PreviousContact, SlipSense, ThinLayer, Tolerance,
};

use super::options::{Law, Limit, Reading, Sense};
use basemat_problems::containment::Glue;

impl Reading {
    /// The law of an element under a base with that mean pressure.
    pub(crate) fn law(
        &self,
        friction: f64,
        soil: &Soil,
        mean_pressure: f64,
    ) -> basemat::Result<Box<dyn InterfaceLaw>> {
        if self.law == Law::Hard {
            let still = Coulomb::new(friction)?;
            if self.kinetic != 1.0 && friction.is_finite() {
                return Ok(Box::new(InPlane(Kinetic {
                    still,
                    moving: Coulomb::new(self.kinetic * friction)?,
                })));
            }
            return Ok(Box::new(still));
        }
        let limit = match self.limit {
            Limit::Total => FrictionLimit::Total,
            Limit::Lagged | Limit::Compression => FrictionLimit::Lagged,
            Limit::Static | Limit::Weight => FrictionLimit::Static,
            Limit::Dynamic => FrictionLimit::Dynamic,
        };
        let sense = match self.sense {
            Sense::Inelastic => SlipSense::Inelastic,
            Sense::Velocity => SlipSense::Velocity,
            Sense::LastVelocity => SlipSense::LastVelocity,
        };
        let layer = ThinLayer::new(*soil, self.neighbour_height(), friction)?
            .with_thickness_ratio(self.ratio)?
            .with_debonded_ratio(self.debonded)?
            .with_friction_limit(limit)
            .with_slip_sense(sense)
            .with_slip_stiffness_ratio(self.slip_shear)?;
        Ok(Box::new(InPlane(Read {
            layer,
            limit: self.limit,
            slip_normal: self.slip_normal,
            mean_pressure,
            static_share: self.static_share,
            lag_modes: self.lag_modes,
        })))
    }

    /// A layer that never lets go.
    pub(crate) fn glue(&self, soil: &Soil) -> basemat::Result<Box<dyn InterfaceLaw>> {
        let layer = ThinLayer::new(*soil, self.neighbour_height(), f64::INFINITY)?;
        Ok(Box::new(InPlane(Glue(layer.with_thickness_ratio(self.ratio)?))))
    }
}

/// Hard contact with another friction in slip than that which slip must overcome.
struct Kinetic {
    still: Coulomb,
    moving: Coulomb,
}

impl PlaneLaw for Kinetic {
    fn modes(&self) -> &[Mode] {
        self.still.modes()
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        if mode.is_slip() {
            return self.moving.conditions(mode, start);
        }
        self.still.conditions(mode, start)
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        // Once an element slides, the friction of slip acts.
        let law = if start.mode.is_slip() && !mode.is_slip() { &self.moving } else { &self.still };
        law.next_mode(mode, start, trial, tolerance)
    }
}

/// A thin layer with what the library's does not offer.
struct Read {
    layer: ThinLayer,
    limit: Limit,
    slip_normal: f64,
    mean_pressure: f64,
    static_share: f64,
    lag_modes: bool,
}

impl Read {
    fn seen<'a>(&self, start: &PreviousContact<'a>) -> PreviousContact<'a> {
        let mut start = *start;
        match self.limit {
            Limit::Compression => start.state.pressure -= start.static_pressure,
            Limit::Lagged => {
                start.state.pressure -= (1.0 - self.static_share) * start.static_pressure;
            }
            Limit::Weight => start.static_pressure = self.mean_pressure,
            _ => {}
        }
        start
    }

    /// The mode that follows from the end of the step before.
    fn lagged_mode(&self, start: &PreviousContact) -> Mode {
        let mut before = self.seen(start);
        before.state.slip -= start.slip_rate * start.time_step;
        let tolerance = Tolerance::new(1e-12, 1e-6);
        self.layer.next_mode(start.mode, &before, &start.state, tolerance)
    }
}

impl PlaneLaw for Read {
    fn modes(&self) -> &[Mode] {
        self.layer.modes()
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        let mode = if self.lag_modes { self.lagged_mode(start) } else { mode };
        let mut conditions = self.layer.conditions(mode, &self.seen(start));
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
        self.layer.next_mode(mode, &self.seen(start), trial, tolerance)
    }

    fn compliance(&self, mode: Mode, start: &PreviousContact) -> [f64; 2] {
        let [normal, shear] = self.layer.compliance(mode, start);
        [if mode.is_slip() { normal / self.slip_normal } else { normal }, shear]
    }

    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        self.layer.frictionless()
    }
}
