//! Static states of a structure that is pushed to prescribed displacements.

use std::cell::RefCell;

use super::at_rest::{loaded_state, static_compliance};
use super::buoyancy::set_water_force;
use super::flexible_base;
use super::settled::settle;
use crate::coupled::builder::SimulationBuilder;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::parts::Parts;
use crate::coupled::state::foundation::Foundation;
use crate::coupled::statics::equilibrium::StaticProblem;
use crate::coupled::statics::prescribed_displacement::{PrescribedDisplacement, control_stiffness};
use crate::coupled::statics::static_state::StaticState;
use crate::error::{Error, Result, at_least, require_part};
use crate::geometry::Footing;
use crate::interface::{ContactState, PreviousContacts};
use crate::linalg::CompressedMatrix;
use crate::structure::{DofCombination, Structure};

/// A structure on its ground under its weight and a load pattern that a displacement determines.
pub(crate) struct StaticPush {
    parts: Parts,
    assembled: Assembled,
    ground_compliance: CompressedMatrix,
    footings: Vec<Footing>,
    /// Weight and loads at t = 0, N.
    constant_load: Vec<f64>,
    /// Forces of the load pattern, N per unit of its factor.
    pattern: Vec<f64>,
    control: DofCombination,
    spring_stiffness: f64,
    pub(crate) state: StaticState,
    contacts: PreviousContacts,
}

/// Resultants on the soil in a static state.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct BaseResultants {
    /// Horizontal force on the soil along x, N.
    pub(crate) base_shear: f64,
    /// Moment on the soil, as [`State::base_moment`](crate::coupled::State::base_moment).
    pub(crate) base_moment: f64,
    /// Area of open elements over the area of the base.
    pub(crate) uplifted_fraction: f64,
}

impl StaticPush {
    /// The structure under its weight and the loads at t = 0.
    pub(crate) fn new(
        builder: SimulationBuilder,
        pattern: &DofCombination,
        control: &DofCombination,
    ) -> Result<Self> {
        let mut parts = Parts::new(builder)?;
        let needed = "one without walls: push an embedded structure by forces, with `push_over`";
        let has_walls = parts.elements.has_walls() || parts.mass_at_rest.is_some();
        require_part("foundation of a push-over by displacements", !has_walls, needed)?;
        let needed = "one with a static state";
        require_part("gravity stage of the push-over", !parts.builder.starts_unloaded(), needed)?;
        let dofs = parts.structure.dofs();
        for (quantity, row) in [
            ("degree of freedom of the load pattern", pattern),
            ("degree of freedom of the push-over", control),
        ] {
            row.check(quantity, dofs)?;
            at_least(quantity, row.iter().filter(|(_, weight)| *weight != 0.0).count(), 1)?;
        }
        // Contact in plan needs a symmetric compliance.
        let is_symmetric = !parts.elements.is_plan() || pattern == control;
        let needed = "must be the load pattern in plan, so that the load does work on it";
        require_part("controlled degree of freedom of the push-over", is_symmetric, needed)?;
        let structure = parts.structure.as_ref();
        let (assembled, mut fixed_factor) =
            Assembled::new(structure, &parts.elements, &parts.joints)?;
        if assembled.is_linear {
            assembled.structure_at_rest(structure).check(&mut fixed_factor)?;
        }
        parts.spread_over_joints(&assembled.base);
        set_water_force(&mut parts, &assembled)?;
        let ground_compliance = static_compliance(&parts, &assembled.base)?;
        let start = loaded_state(&mut parts, &assembled, &ground_compliance)?;
        if parts.builder.has_static_loads() {
            let shared_compliance = RefCell::default();
            flexible_base::check(&parts, (&assembled, None), &start.state, &shared_compliance)?;
        }
        let mut forces = vec![0.0; dofs];
        pattern.iter().for_each(|&(dof, weight)| forces[dof] += weight);
        let spring_stiffness =
            control_stiffness(control, &assembled.stiffness_at_rest().diagonal());
        let base = &assembled.base;
        let mut footings = Vec::new();
        for ((_, range), outline) in base.foundations().zip(base.outlines()) {
            footings.push(Footing::new(&parts.elements, range, outline, parts.moment_center));
        }
        Ok(Self {
            parts,
            assembled,
            ground_compliance,
            footings,
            constant_load: start.forces,
            pattern: forces,
            control: control.clone(),
            spring_stiffness,
            state: start.state,
            contacts: start.contacts,
        })
    }

    /// Advances to the static state with a displacement of the control, m or rad, and commits it.
    ///
    /// `displacement` is that since the undeformed structure. On an error the state stays the last one.
    pub(crate) fn advance(&mut self, displacement: f64) -> Result<()> {
        let prescribed_displacement = PrescribedDisplacement {
            pattern: &self.pattern,
            control: &self.control,
            displacement,
            spring_stiffness: self.spring_stiffness,
        };
        let gaps = self.assembled.base.initial_gaps();
        let problem = StaticProblem {
            assembled: &self.assembled,
            structure: self.parts.structure.as_ref(),
            ground_compliance: &self.ground_compliance,
            is_frictionless: false,
            jump_offset: &gaps,
            shared_compliance: &RefCell::default(),
            may_shorten_increments: true,
            prescribed_displacement: Some(&prescribed_displacement),
        };
        let laws = &self.parts.builder.laws;
        let contacts = self.contacts.clone();
        (self.state, self.contacts) =
            settle(&problem, laws, contacts, self.state.clone(), &self.constant_load)?;
        if let Some(force) = self.parts.structure.nonlinear_mut() {
            force.commit(&self.state.displacement);
        }
        Ok(())
    }

    pub(crate) fn structure(&self) -> &dyn Structure {
        self.parts.structure.as_ref()
    }

    /// Areas of the contact elements of the ground, m².
    pub(crate) fn areas(&self) -> &[f64] {
        self.parts.elements.areas()
    }

    /// Displacement of the control in the present state, m or rad.
    pub(crate) fn controlled_displacement(&self) -> f64 {
        self.control.value(&self.state.displacement)
    }

    /// Resultants on the soil in the present state.
    pub(crate) fn resultants(&self) -> BaseResultants {
        let layout = self.assembled.base.layout();
        let mut contact = Vec::with_capacity(layout.elements());
        for e in 0..layout.elements() {
            contact.push(ContactState::from_components(
                |component| if component == 0 { self.state.gap[e] } else { -0.0 },
                |component| self.state.traction[layout.index_of(component, e)],
                layout.is_plan(),
            ));
        }
        let mut resultants = BaseResultants::default();
        let mut areas = [0.0; 2];
        for ((_, elements), footing) in self.assembled.base.foundations().zip(&self.footings) {
            let mut foundation = Foundation { elements, ..Foundation::default() };
            let patch = &self.parts.elements;
            let sums = foundation.update(footing, patch, &[], &contact, &self.state.modes).0;
            areas[0] += sums.open_area;
            areas[1] += sums.area;
            let eccentric_moment = foundation.normal_force * footing.center[0];
            resultants.base_shear += foundation.base_shear;
            resultants.base_moment +=
                foundation.base_moment + footing.rotation_sign * eccentric_moment;
        }
        resultants.uplifted_fraction = areas[0] / areas[1];
        resultants
    }
}

/// Whether an error states that no equilibrium was found.
pub(crate) fn has_no_equilibrium(error: &Error) -> bool {
    matches!(error, Error::Preload { .. } | Error::Singular { .. } | Error::IllConditioned { .. })
}
