//! Forces at the ends of a model's beams, as weighted sums of degrees of freedom.

use std::any::Any;

use crate::error::{Error, Result, in_bounds};
use crate::fem::{Beam, Direction, Element, EndFrame, SpaceBeam};
use crate::structure::{DofCombination, FemModel, SectionRows};

/// Forces and moments of a beam at its two ends, as weighted sums of displacements.
///
/// At both ends they act on a section whose outward normal is x, the axis of the beam from its first to its second
/// node. Axial force, torque and, without loads between the nodes, shear force are therefore equal at both ends. A
/// `Probe::section` records one of them at every step, as a change from the static state. The static part is the value
/// for `Simulation::static_displacement`.
///
/// The sums contain the elastic forces, without damping and without the inertia of the beam's mass, which acts at its
/// nodes. With the P–Δ effect ([`FemModel::with_p_delta`],
/// [`Beam::with_compression`](crate::fem::Beam::with_compression)) they also contain the forces of the geometric
/// stiffness. They then refer to the axes of the undeformed beam: the shear force contains the static axial force times
/// the rotation of the beam, and the moments are in equilibrium with the loads in the deformed state. The static axial
/// force itself ([`Element::compression`]) is not part of a change.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamRows {
    /// Axes x (along the beam), y and z of the section, as rows.
    ///
    /// In the plane y is to the left of x, and z points out of the plane.
    pub axes: [[f64; 3]; 3],
    /// The first and the second end.
    pub ends: [BeamEndRows; 2],
}

/// Forces and moments at one end of a beam.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamEndRows {
    /// Index of the node of this end.
    pub node: usize,
    /// Axial force N, positive in tension.
    pub axial: SectionRows,
    /// Shear forces along y and along z; the second is zero in the plane.
    pub shears: [SectionRows; 2],
    /// Torque about x; zero in the plane.
    pub torque: SectionRows,
    /// Moments about y and about z by the right-hand rule.
    ///
    /// The first is zero in the plane.
    ///
    /// A positive moment about y causes tension at positive z, a positive moment about z tension at negative y.
    pub moments: [SectionRows; 2],
}

impl FemModel {
    /// Forces at the ends of a [`Beam`](crate::fem::Beam) or [`SpaceBeam`](crate::fem::SpaceBeam), as rows.
    ///
    /// `element`: index of the beam, from [`Mesh::add`](crate::fem::Mesh::add). For an end with an offset the
    /// forces are those at the end, not at the node. Degrees of freedom of followers of rigid links or diaphragms are
    /// expressed by the remaining degrees of freedom. Forces are in N and moments in N m; in the plane per metre of
    /// thickness.
    ///
    /// ```
    /// use basemat::coupled::Probe;
    /// use basemat::fem::{Beam, Direction, Mesh};
    /// use basemat::structure::{FemModel, Structure};
    ///
    /// // A column 6 m high on a strip.
    /// let mut mesh = Mesh::new();
    /// let [left, foot, right] =
    ///     [mesh.add_node(-2.0, 0.0)?, mesh.add_node(0.0, 0.0)?, mesh.add_node(2.0, 0.0)?];
    /// let top = mesh.add_node(0.0, 6.0)?;
    /// mesh.add(Beam::new([left, foot], 30.0e9, 0.5, 0.01, 2400.0)?)?;
    /// mesh.add(Beam::new([foot, right], 30.0e9, 0.5, 0.01, 2400.0)?)?;
    /// let column = mesh.add(Beam::new([foot, top], 30.0e9, 0.5, 0.01, 2400.0)?)?;
    /// let model = FemModel::on_base(mesh)?;
    /// let [foot_rows, head_rows] = model.beam_rows(column)?.ends;
    /// let probe = Probe::section("moment at the foot", &foot_rows.moments[1]);
    /// assert_eq!(probe.unit, "N·m/m");
    /// // The top moves by 1 mm and does not rotate: 12 E I u/L³ and ±6 E I u/L².
    /// let mut displacement = vec![0.0; model.dofs()];
    /// displacement[model.dof(top, Direction::X).unwrap()] = 1e-3;
    /// let value = |rows: &basemat::structure::SectionRows| rows.displacement.value(&displacement);
    /// assert!((value(&head_rows.shears[0]) + 12.0 * 3.0e8 * 1e-3 / 216.0).abs() < 1e-6);
    /// assert!((value(&head_rows.moments[1]) - 6.0 * 3.0e8 * 1e-3 / 36.0).abs() < 1e-6);
    /// assert!((value(&foot_rows.moments[1]) + 6.0 * 3.0e8 * 1e-3 / 36.0).abs() < 1e-6);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Index`] when there is no such element, [`Error::Part`] when it is not a linear beam.
    pub fn beam_rows(&self, element: usize) -> Result<BeamRows> {
        in_bounds("element", element, self.mesh.elements().len())?;
        let not_a_beam = |reason| Error::part(format!("element {element}"), reason);
        let beam =
            self.mesh.elements().nth(element).ok_or_else(|| not_a_beam("it is not a beam"))?;
        let points = self.mesh.coordinates(beam.nodes());
        let reason = if beam.inelastic().is_some() {
            "its forces are not proportional to displacements: beam_sections returns those of beams of fibres"
        } else {
            "it is not a beam"
        };
        let frame = end_frame(beam, &points).ok_or_else(|| not_a_beam(reason))?;
        let dof_count = beam.order();
        let mut stiffness = vec![0.0; dof_count * dof_count];
        beam.stiffness(&points, &mut stiffness);
        beam.geometric_stiffness(&points, &mut stiffness);
        let mut dofs = Vec::with_capacity(dof_count);
        self.numbering.element_dofs(beam, &mut dofs);
        let ends = [0, 1].map(|end| {
            let row = |is_moment: bool, axis: [f64; 3]| {
                let weights =
                    end_force_row(beam.directions(), &frame, end, is_moment, axis, &stiffness);
                let weighted_dofs = dofs.iter().copied().zip(weights);
                self.remaining_row(weighted_dofs.filter(|(_, weight)| *weight != 0.0).collect())
            };
            BeamEndRows {
                node: beam.nodes()[end],
                axial: self.force_rows(row(false, frame.axes[0])),
                shears: [1, 2].map(|k| self.force_rows(row(false, frame.axes[k]))),
                torque: self.moment_rows(row(true, frame.axes[0])),
                moments: [1, 2].map(|k| self.moment_rows(row(true, frame.axes[k]))),
            }
        });
        Ok(BeamRows { axes: frame.axes, ends })
    }

    /// Adds the unit of a force to its weights.
    fn force_rows(&self, displacement: DofCombination) -> SectionRows {
        let unit = if self.mesh.has_depth() { "N" } else { "N/m" };
        SectionRows { unit, displacement, ..SectionRows::default() }
    }

    /// Adds the unit of a moment to its weights.
    fn moment_rows(&self, displacement: DofCombination) -> SectionRows {
        let unit = if self.mesh.has_depth() { "N·m" } else { "N·m/m" };
        SectionRows { unit, displacement, ..SectionRows::default() }
    }
}

/// Axes and offsets of a beam; `None` for other elements.
///
/// A boxed element is unboxed first.
fn end_frame(element: &dyn Element, coordinates: &[[f64; 3]]) -> Option<EndFrame> {
    let any_element: &dyn Any = element;
    if let Some(inner) = any_element.downcast_ref::<Box<dyn Element>>() {
        return end_frame(inner.as_ref(), coordinates);
    }
    if let Some(beam) = any_element.downcast_ref::<SpaceBeam>() {
        return beam.end_frame(coordinates);
    }
    any_element.downcast_ref::<Beam>()?.end_frame(coordinates)
}

/// Weights of the nodal displacements in one end force or moment.
///
/// `stiffness`: matrix of the element; its product with the displacements is the force of the nodes on the beam. The
/// component along `axis` is the work of the nodal forces in a unit rigid motion about the end.
fn end_force_row(
    directions: &[Direction],
    frame: &EndFrame,
    end: usize,
    is_moment: bool,
    axis: [f64; 3],
    stiffness: &[f64],
) -> Vec<f64> {
    let dof_count = 2 * directions.len();
    // The outward normal is x: the section force equals the nodal force at the second end, and its negative at the
    // first end.
    let sign = if end == 0 { -1.0 } else { 1.0 };
    let arm_to_node = frame.offsets[end].map(|offset| -offset);
    let rigid_motions = if is_moment { ROTATION_DIRECTIONS } else { TRANSLATION_DIRECTIONS };
    let mut row = vec![0.0; dof_count];
    for (k, direction) in directions.iter().enumerate() {
        // The rotation of a mesh in the plane is about z.
        let space_direction =
            if *direction == Direction::Rotation { Direction::RotationZ } else { *direction };
        let weight: f64 = rigid_motions
            .iter()
            .zip(axis)
            .map(|(&motion, axis_component)| {
                axis_component * space_direction.in_rigid_motion(motion, arm_to_node)
            })
            .sum();
        let row_start = (end * directions.len() + k) * dof_count;
        for (weight_sum, entry) in row.iter_mut().zip(&stiffness[row_start..row_start + dof_count])
        {
            *weight_sum += sign * weight * entry;
        }
    }
    row
}

/// Translations of a rigid motion in space.
const TRANSLATION_DIRECTIONS: [Direction; 3] = [Direction::X, Direction::Y, Direction::Z];
/// Rotations of a rigid motion in space.
const ROTATION_DIRECTIONS: [Direction; 3] =
    [Direction::RotationX, Direction::RotationY, Direction::RotationZ];
