//! Forces and moments of a model's shells, as weighted sums of degrees of freedom.

use std::any::Any;
use std::collections::BTreeMap;

use crate::error::{Error, Result, in_bounds};
use crate::fem::{Element, Mesh, Shell, ShellResultants};
use crate::structure::{FemModel, SectionRows};

/// Forces and moments of shells per metre at a node, as weighted sums of displacements.
///
/// A `Probe::section` records one of them at every step, as a change from the static state. The static part is the
/// value for `Simulation::static_displacement`. The sums contain the elastic forces, without damping.
#[derive(Debug, Clone, PartialEq)]
pub struct ShellRows {
    /// Index of the node.
    pub node: usize,
    /// Axes e1, e2, n of the resultants as rows, the means of the elements' axes.
    pub axes: [[f64; 3]; 3],
    /// Membrane forces n_11, n_22, n_12, N/m; tension is positive.
    pub membrane: [SectionRows; 3],
    /// Moments m_11, m_22, m_12, N m/m; positive with tension on the side of −n.
    pub moments: [SectionRows; 3],
    /// Shear forces q_1, q_2, N/m: on a section whose outward normal is e1 or e2, along n.
    pub shears: [SectionRows; 2],
}

impl ShellRows {
    /// The resultants for these values of all degrees of freedom.
    ///
    /// Degrees of freedom beyond the end of `displacement` count as zero, as for [`SectionRows::value`];
    /// [`FemModel::shell_resultants`] checks the number.
    pub fn value(&self, displacement: &[f64]) -> ShellResultants {
        let value = |rows: &SectionRows| rows.displacement.value(displacement);
        ShellResultants {
            axes: self.axes,
            membrane: self.membrane.each_ref().map(value),
            moments: self.moments.each_ref().map(value),
            shears: self.shears.each_ref().map(value),
        }
    }
}

impl FemModel {
    /// Forces and moments of a shell at its nodes, in its own axes.
    ///
    /// As [`Shell::resultants`]. `element`: index of the shell, from [`Mesh::add`]. `displacement` holds all degrees
    /// of freedom. `State::displacement` gives changes from the static state.
    ///
    /// # Errors
    /// [`Error::Index`] when there is no such element, [`Error::Part`] when it is not a [`Shell`], [`Error::Size`] for
    /// a displacement of another length, [`Error::NotFinite`] for a displacement that is not finite.
    pub fn shell_resultants(
        &self,
        element: usize,
        displacement: &[f64],
    ) -> Result<Vec<ShellResultants>> {
        let shell = shell_at(&self.mesh, element)?;
        let shell_displacement = self.element_displacements(shell, displacement)?;
        shell.resultants(&self.mesh.coordinates(shell.nodes()), &shell_displacement)
    }

    /// Rows of the forces and moments at every node of some shells.
    ///
    /// They are in ascending order of nodes. At each node they are means over these shells. Pass the shells of one mat
    /// or one wall only: the moments of another wall at a common node are different. `elements` are indices from
    /// [`Mesh::add`].
    ///
    /// `axes` returns [tangent, outward direction] at a point [x, y, z] (m): e1 is the part of the tangent in the plane
    /// of a shell, and the normal n is on the side of the outward direction, as for [`ShellResultants::in_axes`].
    ///
    /// ```
    /// use basemat::coupled::Probe;
    /// use basemat::fem::{Direction, Material, Mesh, Shell};
    /// use basemat::structure::FemModel;
    ///
    /// let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
    /// let mut mesh = Mesh::in_space();
    /// let grid = mesh.add_grid(3, 5, |row, column| [column as f64, row as f64, 0.0])?;
    /// let mut mat = Vec::new();
    /// for (_, cell) in grid.cells() {
    ///     mat.push(mesh.add(Shell::new(cell, concrete, 0.8)?)?);
    /// }
    /// let model = FemModel::on_base(mesh)?;
    /// let rows = model.shell_rows(&mat, |_| [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])?;
    /// let middle = model.mesh().node_at_point([2.0, 1.0, 0.0])?;
    /// let node_rows = rows.iter().find(|rows| rows.node == middle).unwrap();
    /// // The moment is positive with tension on the lower side.
    /// let probe = Probe::section("moment along x", &node_rows.moments[0]);
    /// assert_eq!(probe.unit, "N·m/m");
    /// // The largest moment in the mat in any direction: a rigid motion causes none.
    /// let rigid_motion = model.rigid_motion(Direction::Z, [0.0; 3]);
    /// let moments = rows.iter().flat_map(|rows| rows.value(&rigid_motion).principal_moments());
    /// assert!(moments.fold(0.0, |largest: f64, moment| largest.max(moment.abs())) < 1e-3);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Index`] when there is no such element, [`Error::Part`] when it is not a [`Shell`], [`Error::Item`] with
    /// the element and an error of [`ShellResultants::in_axes`].
    pub fn shell_rows(
        &self,
        elements: &[usize],
        axes: impl Fn([f64; 3]) -> [[f64; 3]; 2],
    ) -> Result<Vec<ShellRows>> {
        let mut node_sums: BTreeMap<usize, NodeSum> = BTreeMap::new();
        let mut dofs = Vec::new();
        for &element in elements {
            let shell = shell_at(&self.mesh, element)?;
            let points = self.mesh.coordinates(shell.nodes());
            self.numbering.element_dofs(shell, &mut dofs);
            let mut unit_displacement = vec![0.0; dofs.len()];
            for (k, &dof) in dofs.iter().enumerate() {
                unit_displacement[k] = 1.0;
                let node_resultants = shell.resultants(&points, &unit_displacement)?;
                unit_displacement[k] = 0.0;
                let nodes = shell.nodes().iter().zip(&points);
                for ((&node, &point), resultants) in nodes.zip(&node_resultants) {
                    let [tangent, outward_direction] = axes(point);
                    let common_resultants = resultants
                        .in_axes(tangent, outward_direction)
                        .map_err(|error| error.within(element_name(element)))?;
                    let sum = node_sums.entry(node).or_default();
                    if k == 0 {
                        sum.add_shell(&common_resultants.axes);
                    }
                    sum.add_resultants(dof, &common_resultants);
                }
            }
        }
        Ok(node_sums.into_iter().map(|(node, sum)| self.mean_rows(node, sum)).collect())
    }

    /// Means of the resultants at a node.
    ///
    /// They are sums of the degrees of freedom that the model's links do not eliminate.
    fn mean_rows(&self, node: usize, sum: NodeSum) -> ShellRows {
        let shell_count = sum.shell_count;
        let mut means = sum.rows.into_iter().map(|row| {
            self.remaining_row(
                row.into_iter().map(|(dof, weight)| (dof, weight / shell_count)).collect(),
            )
        });
        // The means are in the order of `ShellResultants::values`: membrane forces, moments, shear forces.
        let mut next_rows = |unit| SectionRows {
            unit,
            displacement: means.next().unwrap_or_default(),
            ..SectionRows::default()
        };
        ShellRows {
            node,
            axes: ShellResultants::mean_axes(sum.axes),
            membrane: ["N/m"; 3].map(&mut next_rows),
            moments: ["N·m/m"; 3].map(&mut next_rows),
            shears: ["N/m"; 2].map(&mut next_rows),
        }
    }
}

/// Sums over the shells at a node.
#[derive(Default)]
struct NodeSum {
    /// Number of shells.
    shell_count: f64,
    /// Sums of the unit vectors e1, e2, n.
    axes: [[f64; 3]; 3],
    /// Sums of each resultant, in the order of [`ShellResultants::values`].
    ///
    /// They are due to a unit value of each degree of freedom of the mesh.
    rows: [BTreeMap<usize, f64>; 8],
}

impl NodeSum {
    /// Counts a shell and adds its axes.
    fn add_shell(&mut self, axes: &[[f64; 3]; 3]) {
        self.shell_count += 1.0;
        for (sum, component) in self.axes.iter_mut().flatten().zip(axes.iter().flatten()) {
            *sum += component;
        }
    }

    /// Adds the resultants of a shell due to a unit value of the degree of freedom `dof`.
    fn add_resultants(&mut self, dof: usize, resultants: &ShellResultants) {
        for (row, value) in self.rows.iter_mut().zip(resultants.values()) {
            if value != 0.0 {
                *row.entry(dof).or_insert(0.0) += value;
            }
        }
    }
}

/// Shell of the element with this index.
fn shell_at(mesh: &Mesh, element: usize) -> Result<&Shell> {
    in_bounds("element", element, mesh.elements().len())?;
    let shell = mesh.elements().nth(element).and_then(as_shell);
    shell.ok_or_else(|| Error::part(element_name(element), "it is not a shell"))
}

/// The element as a shell, also if it is in a box.
///
/// `None` for other elements.
fn as_shell(element: &dyn Element) -> Option<&Shell> {
    let any_element: &dyn Any = element;
    match any_element.downcast_ref::<Box<dyn Element>>() {
        Some(inner) => as_shell(inner.as_ref()),
        None => any_element.downcast_ref(),
    }
}

/// Name of an element in errors.
fn element_name(element: usize) -> String {
    format!("element {element}")
}
