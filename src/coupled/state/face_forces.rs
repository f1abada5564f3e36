//! Forces between the soil and each face of a structure in the ground.

use crate::coupled::state::{ResultContext, State};
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
    /// Point of action of the thrust, m.
    ///
    /// For a wall it is the height above the base, for the base the distance to the right of its middle. On each element of
    /// a wall the pressure is distributed as at rest. The place is NaN without thrust.
    pub place: f64,
    /// Length of open elements over the length of the face.
    pub open_fraction: f64,
}

impl State {
    /// Forces on a face.
    ///
    /// For a wall of a base without walls all forces are zero, and the place is NaN.
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
        let ResultContext { elements, pressure_depths, .. } = &*self.context;
        FaceForces::on(face, elements, pressure_depths, &self.contact, &self.modes)
    }
}

impl FaceForces {
    /// Forces on a face, from contact and mode of each element of a ground.
    ///
    /// `pressure_depths` are distances of the resultant pressure below the middle of each element, m; empty for none.
    pub(crate) fn on(
        face: Face,
        elements: &[ContactElement],
        pressure_depths: &[f64],
        contact: &[ContactState],
        modes: &[Mode],
    ) -> Self {
        let faces = ContactElement::faces(elements).in_order();
        let floor = &elements[faces[Face::Base as usize].clone()];
        let floor_height = floor.first().map_or(0.0, |element| element.center()[2]);
        let ends =
            [floor.first().map(ContactElement::left), floor.last().map(ContactElement::right)];
        let middle = middle(ends.map(Option::unwrap_or_default));
        let mut thrust = 0.0;
        let mut shear = 0.0;
        let mut moment = 0.0;
        let mut open_length = 0.0;
        let mut face_length = 0.0;
        for e in faces[face as usize].clone() {
            let element = &elements[e];
            let state = &contact[e];
            let area = element.area();
            let center = element.center();
            let pressure_depth = pressure_depths.get(e).copied().unwrap_or(0.0);
            let height = center[2] - pressure_depth - floor_height;
            let arm = if face == Face::Base { center[0] - middle } else { height };
            thrust += area * state.pressure;
            shear += area * state.shear;
            moment += area * state.pressure * arm;
            face_length += area;
            if !modes[e].is_closed() {
                open_length += area;
            }
        }
        let open_fraction = if face_length > 0.0 { open_length / face_length } else { 0.0 };
        Self { thrust, shear, place: moment / thrust, open_fraction }
    }
}
