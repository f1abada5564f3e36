//! Forces at a horizontal section of a finite-element model: three in the plane, six in space.

use super::cut::SectionCut;
use crate::error::Result;
use crate::fem::Direction;
use crate::structure::{FemModel, SectionRows};

/// Forces that the part above a horizontal section exerts on the part below, per metre.
///
/// They consist of elastic forces, of damping forces without mass-proportional damping, and of the inertia of the
/// elements above at the nodes of the section. To include the weight of the elements above, add the acceleration of
/// gravity to the vertical accelerations.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Height of the section, m.
    pub height: f64,
    /// Horizontal force on the part below, N, positive to the right.
    ///
    /// At the base it is the base shear.
    pub shear: SectionRows,
    /// Vertical force on the part below, N, positive downwards (compression).
    pub compression: SectionRows,
    /// Moment on the part below about the reference point, N m, counter-clockwise.
    pub moment: SectionRows,
}

/// Forces and moments that the part above a horizontal section exerts on the part below.
///
/// Forces are in N, moments in N m about a reference point in the section, by the right-hand rule. They refer to the
/// undeformed structure. A `Probe::section` records one of them at every step, as a change from the static state.
#[derive(Debug, Clone, PartialEq)]
pub struct SpaceSection {
    /// Height of the section, m.
    pub height: f64,
    /// Forces along x and along y; at the base, the base shears.
    pub shear: [SectionRows; 2],
    /// Vertical force, positive downwards (compression).
    pub compression: SectionRows,
    /// Moments about the axes along x and along y.
    pub moments: [SectionRows; 2],
    /// Torque about the vertical axis, counter-clockwise from above.
    pub torque: SectionRows,
}

impl FemModel {
    /// Forces that the part above `height` (m) exerts on the part below.
    ///
    /// Moments refer to the point (`reference`, `height`).
    ///
    /// The section consists of the nodes at this height; elements at this height belong to the part below. The rows are
    /// −K, −C and −M of the elements above, summed over the nodes of the section. A rigid body of linked nodes with a
    /// node at or below the section belongs to the part below with all its nodes.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) when a number is not finite, when no node lies at `height`, when no
    /// element lies above it, or when an element crosses it; [`Error::Part`](crate::Error::Part) when an element above
    /// it has internal variables; [`Error::Scene`](crate::Error::Scene) for a mesh in space, which needs
    /// [`section_in_space`](FemModel::section_in_space).
    pub fn section(&self, height: f64, reference: f64) -> Result<Section> {
        self.mesh.require_plane("section of three resultants")?;
        let cut = SectionCut::new(self, height, [reference, 0.0])?;
        Ok(Section {
            height,
            shear: cut.rows(Direction::X, 1.0),
            compression: cut.rows(Direction::Y, -1.0),
            moment: cut.rows(Direction::Rotation, 1.0),
        })
    }

    /// Six resultants that the part above `height` (m) exerts on the part below, in space.
    ///
    /// Moments refer to the point [x, y] = `reference` (m) at this height. The section consists of the nodes at this
    /// height; elements at this height belong to the part below, so that a section at the height of a mat has the
    /// forces at the feet of its walls. The resultants consist of elastic forces, of damping forces without
    /// mass-proportional damping, and of the inertia of the elements above at the nodes of the section. A rigid body of
    /// linked nodes with a node at or below the section belongs to the part below with all its nodes.
    ///
    /// To include the weight of the elements above, add the acceleration of gravity to the vertical accelerations.
    ///
    /// ```
    /// use basemat::coupled::Probe;
    /// use basemat::fem::{Hex8, Material, Mesh};
    /// use basemat::structure::FemModel;
    ///
    /// // A pier of four bricks, 6 m high.
    /// let concrete = Material::new(30.0e9, 0.2, 2400.0)?;
    /// let mut mesh = Mesh::in_space();
    /// let foot = mesh.add_grid(2, 2, |row, column| [2.0 * column as f64, 2.0 * row as f64, 0.0])?;
    /// for brick in foot.extrude(&mut mesh, &[1.5, 3.0, 4.5, 6.0])? {
    ///     mesh.add(Hex8::new(brick, concrete))?;
    /// }
    /// let pier = FemModel::on_base(mesh)?;
    /// let section = pier.section_in_space(3.0, [1.0, 1.0])?;
    /// let probes = [
    ///     Probe::section("shear in the middle", &section.shear[0]),
    ///     Probe::section("moment in the middle", &section.moments[1]),
    /// ];
    /// assert_eq!(probes.map(|probe| probe.unit), ["N", "N·m"]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) when a number is not finite, when no node lies at `height`, when no
    /// element lies above it, or when an element crosses it; [`Error::Part`](crate::Error::Part) when an element above
    /// it has internal variables; [`Error::Scene`](crate::Error::Scene) for a mesh in the plane, which needs
    /// [`section`](FemModel::section).
    pub fn section_in_space(&self, height: f64, reference: [f64; 2]) -> Result<SpaceSection> {
        self.mesh.require_space("section of six resultants")?;
        let cut = SectionCut::new(self, height, reference)?;
        let rows = |direction| cut.rows(direction, 1.0);
        Ok(SpaceSection {
            height,
            shear: [Direction::X, Direction::Y].map(rows),
            compression: cut.rows(Direction::Z, -1.0),
            moments: [Direction::RotationX, Direction::RotationY].map(rows),
            torque: rows(Direction::RotationZ),
        })
    }
}
