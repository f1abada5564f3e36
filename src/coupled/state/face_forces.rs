//! Forces between soil and each face of a structure in the ground.

use crate::coupled::state::{Context, State};
use crate::geometry::{ContactElement, middle};
use crate::interface::{ContactState, Mode};

/// Face of a structure in the ground, in the order of the outline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Face {
    /// Wall on the left.
    LeftWall,
    /// Base between the walls.
    Base,
    /// Wall on the right.
    RightWall,
}

/// Forces on the soil behind one face, per metre.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct FaceForces {
    /// Total pressure, positive in compression, N/m.
    pub thrust: f64,
    /// Force on the soil along the outline, N/m.
    ///
    /// Positive down the left wall, to the right along the base, up the right wall.
    pub shear: f64,
    /// Point where the thrust acts, m: height above the base; for the base, distance to the right of its middle.
    ///
    /// Pressure on each element of a wall is distributed as at rest; NaN without thrust.
    pub place: f64,
    /// Length of open elements over the length of the face.
    pub open_fraction: f64,
}

impl State {
    /// Forces on a face; zero with `place` NaN for a wall of a base without walls.
    ///
    /// ```
    /// # use basemat::prelude::*;
    /// use basemat::bem::embedded::{Trench, TrenchGround};
    /// use basemat::coupled::Face;
    /// use basemat::structure::WithWalls;
    ///
    /// let elements = Trench::new(-6.0..6.0, 5.0)?.elements(2, 4)?;
    /// let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0)?;
    /// let simulation = Simulation::builder(0.01)
    ///     .structure(WithWalls::new(RigidBlock::new(12.0, 20.0, 900.0)?, 5.0)?)
    ///     .ground(TrenchGround::new(soil, elements)?.with_pressure_at_rest(0.5)?)
    ///     .interface(Coulomb::new(0.5)?)
    ///     .build()?;
    /// let wall = simulation.state().face(Face::LeftWall);
    /// // K₀ ρ g d²/2, a third of the depth above the base.
    /// assert!((wall.thrust / (0.5 * 1900.0 * STANDARD_GRAVITY * 12.5) - 1.0).abs() < 1e-12);
    /// assert!((wall.place - 5.0 / 3.0).abs() < 1e-12);
    /// let series = basemat::results::Recorder::new().contact(1).start(&simulation)?;
    /// assert_eq!(series.face(Face::LeftWall).next(), Some(wall));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn face(&self, face: Face) -> FaceForces {
        let Context { elements, pressure_depths, .. } = &*self.context;
        FaceForces::of_face(face, elements, pressure_depths, &self.contact, &self.modes)
    }
}

impl FaceForces {
    /// Forces on a face, from state and mode of each element of a ground.
    ///
    /// `pressure_depths`: distance of the resultant pressure below the middle of each element, m; empty where it is zero.
    pub(crate) fn of_face(
        face: Face,
        elements: &[ContactElement],
        pressure_depths: &[f64],
        contact: &[ContactState],
        modes: &[Mode],
    ) -> Self {
        let faces = ContactElement::faces(elements).in_order();
        let floor = &elements[faces[Face::Base as usize].clone()];
        let bottom = floor.first().map_or(0.0, |element| element.center()[2]);
        let ends =
            [floor.first().map(ContactElement::left), floor.last().map(ContactElement::right)];
        let floor_middle = middle(ends.map(Option::unwrap_or_default));
        let mut thrust = 0.0;
        let mut shear = 0.0;
        let mut moment = 0.0;
        let mut open_length = 0.0;
        let mut total_length = 0.0;
        for e in faces[face as usize].clone() {
            let element = &elements[e];
            let state = &contact[e];
            let area = element.area();
            let center = element.center();
            let pressure_depth = pressure_depths.get(e).copied().unwrap_or(0.0);
            let height = center[2] - pressure_depth - bottom;
            let arm = if face == Face::Base { center[0] - floor_middle } else { height };
            thrust += area * state.pressure;
            shear += area * state.shear;
            moment += area * state.pressure * arm;
            total_length += area;
            if !modes[e].is_closed() {
                open_length += area;
            }
        }
        let open_fraction = if total_length > 0.0 { open_length / total_length } else { 0.0 };
        Self { thrust, shear, place: moment / thrust, open_fraction }
    }
}
