//! Flat shell elements of four and of three nodes in space.

mod frame;
mod quad_bending;
mod quad_membrane;
mod resultants;
mod section;
mod shape;
mod surface;
mod triangle_bending;
mod triangle_membrane;

pub use resultants::ShellResultants;

use std::collections::HashSet;

use frame::LocalFrame;
use quad_bending::QuadBending;
use quad_membrane::QuadMembrane;
use section::ShellSection;
use shape::Corners;
use surface::MiddleSurface;
use triangle_bending::TriangleBending;
use triangle_membrane::TriangleMembrane;

use super::element::{Element, ElementFace, MassKind};
use super::element_matrix::leading_block;
use super::material::Material;
use crate::error::{Error, Result, all_finite, finite, positive, require_part, same_length};
use crate::geometry::{Direction, SPACE_DIRECTIONS};

/// Shell of four or three nodes in space: walls, slabs, mats, vessels, domes.
///
/// The element is flat, of one isotropic material in plane stress, and its nodes lie in its middle surface. It has
/// all six directions at each node: membrane with rotation about the normal, bending, and shear across the
/// thickness, so it serves from thin vessels to thick mats. The matrices do not depend on the node with which the list
/// begins, nor on the sense of rotation in which nodes are listed.
///
/// * **Four nodes**: MITC4 in bending (Bathe & Dvorkin 1985). The membrane has bending modes, and sides that bulge with
///   the rotations of their ends (Allman 1984); a penalty ties these rotations to the rotation of the material (Hughes
///   & Brezzi 1989). If the nodes lie in no common plane, rigid links connect them to their projections: rigid motions
///   of a warped element are exact.
/// * **Three nodes**: MITC3+ in bending (Lee, Lee & Bathe 2014, with bounded shear strains) and Felippa's optimal
///   triangle (2003).
///
/// Use quadrilaterals for curved shells. Triangles are much too stiff on a curved thin shell where their sides exceed
/// √(Rt), with the radius R and the thickness t: a pinched hemisphere has 0.49 of its displacement with triangles of
/// 3√(Rt), and 0.92 with quadrilaterals of that size. Triangles are accurate in plane walls and slabs, nearly as
/// accurate as quadrilaterals on cylinders, and suitable where meshes converge, as at the top of a dome.
///
/// Triangles and quadrilaterals in one wall need [`Shell::match_sides`].
///
/// An outward load q (N/m) normal to a side of length L in the plane of the element gives the force qL/2 at each of the
/// two nodes, and the moments −qL²/12 and +qL²/12 about the normal, for nodes in counter-clockwise order. Without these
/// moments a strip of one row bulges at its loaded end.
///
/// A shell itself has no geometric stiffness. With
/// [`FemModel::with_p_delta`](crate::structure::FemModel::with_p_delta) its static forces rotate with it.
///
/// The mass matrix has rotary inertia, ρt³/12 times the area, about all three axes. The lumped matrix is diagonal in
/// any axes.
///
/// ```
/// use basemat::fem::{Element, MassKind, Material, Shell};
///
/// let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
/// let slab = Shell::new([0, 1, 2, 3], concrete, 0.3)?;
/// let corners = [[0.0; 3], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let mut mass = vec![0.0; 24 * 24];
/// slab.mass(&corners, MassKind::Lumped, &mut mass);
/// assert!((mass[0] - 375.0).abs() < 1e-9); // a quarter of 2 m · 1 m · 0.3 m · 2500 kg/m³
///
/// // Bent along x with a curvature of 0.001 /m, edges up: tension below.
/// let bent = corners.map(|[x, ..]| [0.0, 0.0, 0.0005 * x * x, 0.0, -0.001 * x, 0.0]);
/// let resultants = slab.resultants(&corners, bent.as_flattened())?;
/// assert!((resultants[0].moments[0] - 70_312.5).abs() < 1e-6); // E t³/12/(1 − ν²) · 0.001
/// assert!((resultants[0].moments[1] - 14_062.5).abs() < 1e-6); // ν times that
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Shell {
    nodes: Corners<usize>,
    material: Material,
    thickness: f64,
    /// Whether the sides 1–2, 2–3 and 3–1 of a triangle are also sides of quadrilaterals.
    shared_sides: [bool; 3],
}

impl Shell {
    /// Shell of three or four `nodes`, listed around it, and its thickness t (m).
    ///
    /// # Errors
    /// [`Error::Item`] with the nodes and the fault: [`Error::Size`] unless there are three or four nodes,
    /// [`Error::Scene`] if one occurs twice, [`Error::Input`] unless the thickness is positive and finite, or if its
    /// bending stiffness or mass is not.
    pub fn new(nodes: impl AsRef<[usize]>, material: Material, thickness: f64) -> Result<Self> {
        let nodes = nodes.as_ref();
        Self::without_context(nodes, material, thickness)
            .map_err(|error| within_shell(error, nodes))
    }

    /// [`Shell::new`], but its errors do not name the nodes.
    fn without_context(nodes: &[usize], material: Material, thickness: f64) -> Result<Self> {
        let corners = Corners::new(nodes).ok_or(Error::Size {
            quantity: "list of nodes of a shell (three, or four)",
            found: nodes.len(),
            needed: 4,
        })?;
        let all_differ = (1..nodes.len()).all(|k| !nodes[..k].contains(&nodes[k]));
        require_part("nodes of a shell", all_differ, "each only once")?;
        positive("thickness of a shell", thickness)?;
        let shell = Self { nodes: corners, material, thickness, shared_sides: [false; 3] };
        positive("bending stiffness of a shell", shell.section().bending_stiffness()[0][0])?;
        finite("mass per area of a shell", material.density() * thickness)?;
        Ok(shell)
    }

    /// Matches triangles to the quadrilaterals with which they share sides.
    ///
    /// By default the sides of triangles bulge more with the rotations of their ends than the sides of quadrilaterals,
    /// which makes walls of triangles bend accurately. At quadrilaterals the difference would disturb the membrane
    /// forces: by a quarter of a uniform stress where a line between triangles and quadrilaterals begins, ends or
    /// turns, and by 0.4 of it everywhere on a chessboard of both. Refinement does not reduce the error. Matched sides
    /// bulge equally, and a uniform stress is exact. Bending needs no matching.
    ///
    /// Pass all shells of a mesh in one call, before they are added to the mesh.
    ///
    /// ```
    /// use basemat::fem::{Material, Shell};
    ///
    /// let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
    /// let mut wall = [
    ///     Shell::new([0, 1, 4, 3], concrete, 0.3)?,
    ///     Shell::new([1, 2, 4], concrete, 0.3)?,
    ///     Shell::new([2, 5, 4], concrete, 0.3)?,
    /// ];
    /// let unmatched = wall.clone();
    /// Shell::match_sides(&mut wall);
    /// // The first triangle shares a side with the quadrilateral, the second triangle does not.
    /// assert!(wall[0] == unmatched[0] && wall[1] != unmatched[1] && wall[2] == unmatched[2]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn match_sides(shells: &mut [Self]) {
        let mut quad_sides = HashSet::new();
        for shell in shells.iter() {
            if let Corners::Four(nodes) = shell.nodes {
                quad_sides.extend((0..4).map(|k| side_nodes(nodes[k], nodes[(k + 1) % 4])));
            }
        }
        for shell in shells {
            if let Corners::Three(nodes) = shell.nodes {
                shell.shared_sides = [0, 1, 2]
                    .map(|k| quad_sides.contains(&side_nodes(nodes[k], nodes[(k + 1) % 3])));
            }
        }
    }

    /// Thickness t, m.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// Area of the middle surface that belongs to each node, ∫ N dA, m².
    ///
    /// The middle surface of four nodes is bilinear. `coordinates`: [x, y, z] of the nodes, m. A load per area, such as
    /// snow, times these areas gives forces at the nodes.
    ///
    /// # Errors
    /// As for [`Element::check`].
    pub fn areas(&self, coordinates: &[[f64; 3]]) -> Result<Vec<f64>> {
        self.check(coordinates)?;
        Ok(match self.corner_points(coordinates)? {
            Corners::Four(corners) => MiddleSurface::quadrilateral(&corners).areas().to_vec(),
            Corners::Three(corners) => MiddleSurface::triangle(&corners).areas().to_vec(),
        })
    }

    /// Forces [x, y, z] (N) of a `pressure` (Pa) at each node.
    ///
    /// A positive pressure acts along the normal.
    ///
    /// The normal n points to the side from which the nodes are seen counter-clockwise. The forces on a closed surface
    /// are in equilibrium.
    ///
    /// # Errors
    /// As for [`Element::check`].
    pub fn pressure_forces(
        &self,
        coordinates: &[[f64; 3]],
        pressure: f64,
    ) -> Result<Vec<[f64; 3]>> {
        self.check(coordinates)?;
        let area_normals = match self.corner_points(coordinates)? {
            Corners::Four(corners) => MiddleSurface::quadrilateral(&corners).area_normals.to_vec(),
            Corners::Three(corners) => MiddleSurface::triangle(&corners).area_normals.to_vec(),
        };
        Ok(area_normals
            .into_iter()
            .map(|area_normal| area_normal.map(|component| pressure * component))
            .collect())
    }

    /// Forces and moments per metre at each node, in the axes of the element.
    ///
    /// `displacement` holds the six displacements (m, rad) of each node, node by node. The normal n points to the side
    /// from which the nodes are seen counter-clockwise. e1 runs from the middle of the side 4–1 to the middle of the
    /// side 2–3, in a triangle along the side 1–2. [`ShellResultants::in_axes`] transforms resultants to axes that do
    /// not depend on the list of nodes. Values at a node differ between its elements: their mean is far more accurate.
    ///
    /// # Errors
    /// As for [`Element::check`]; [`Error::Size`] unless there are six displacements a node, and
    /// [`Error::NotFinite`] unless they are finite.
    pub fn resultants(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
    ) -> Result<Vec<ShellResultants>> {
        self.check(coordinates)?;
        same_length("displacement of a shell", displacement.len(), self.order())?;
        all_finite("displacement of a shell", displacement)?;
        let section = &self.section();
        Ok(match self.corner_points(coordinates)? {
            Corners::Four(corners) => {
                let frame = LocalFrame::quadrilateral(&corners);
                let points = &frame.points;
                let local_displacements = frame.local_displacements::<12>(displacement);
                let membrane =
                    QuadMembrane { points, section }.corner_strains(&local_displacements.membrane);
                let bending =
                    QuadBending { points, section }.corner_strains(&local_displacements.bending);
                section.resultants(frame.axes, &membrane, &bending)
            }
            Corners::Three(corners) => {
                let frame = LocalFrame::triangle(&corners);
                let points = &frame.points;
                let local_displacements = frame.local_displacements::<9>(displacement);
                let membrane =
                    TriangleMembrane { points, section, shared_sides: self.shared_sides }
                        .corner_strains(&local_displacements.membrane);
                let bending = TriangleBending { points, section }
                    .corner_strains(&local_displacements.bending);
                section.resultants(frame.axes, &membrane, &bending)
            }
        })
    }

    /// Stiffness of the section.
    fn section(&self) -> ShellSection {
        ShellSection::new(&self.material, self.thickness)
    }

    /// Coordinates of the corners, one for each node.
    fn corner_points(&self, coordinates: &[[f64; 3]]) -> Result<Corners<[f64; 3]>> {
        let point_count = coordinates.len();
        let node_count = self.nodes().len();
        let points = Corners::new(coordinates).filter(|_| point_count == node_count);
        points.ok_or(Error::Size {
            quantity: "coordinates of a shell",
            found: point_count,
            needed: node_count,
        })
    }

    /// Adds the mass matrix, from integrals over the middle surface, to `matrix`.
    fn add_mass<const N: usize>(
        &self,
        surface: &MiddleSurface<N>,
        kind: MassKind,
        matrix: &mut [f64],
    ) {
        let mass_per_area = self.material.density() * self.thickness;
        let inertia_per_area = mass_per_area * self.thickness.powi(2) / 12.0;
        for i in 0..N {
            for j in 0..N {
                let column = if kind == MassKind::Lumped { i } else { j };
                for direction in 0..6 {
                    let inertia = if direction < 3 { mass_per_area } else { inertia_per_area };
                    matrix[(6 * i + direction) * 6 * N + 6 * column + direction] +=
                        inertia * surface.shape_products[i][j];
                }
            }
        }
    }
}

/// Nodes of a side in ascending order.
fn side_nodes(start_node: usize, end_node: usize) -> [usize; 2] {
    [start_node.min(end_node), start_node.max(end_node)]
}

/// Adds the nodes of a shell to its error.
fn within_shell(error: Error, nodes: &[usize]) -> Error {
    error.within(format!("shell on nodes {nodes:?}"))
}

impl Element for Shell {
    fn nodes(&self) -> &[usize] {
        self.nodes.as_slice()
    }

    fn with_nodes(&self, nodes: &[usize]) -> Option<Box<dyn Element>> {
        (nodes.len() == self.nodes.as_slice().len()).then_some(())?;
        Some(Box::new(Self { nodes: Corners::new(nodes)?, ..self.clone() }))
    }

    fn directions(&self) -> &[Direction] {
        SPACE_DIRECTIONS
    }

    fn faces(&self) -> Vec<ElementFace> {
        vec![ElementFace::shell(self.nodes(), self.thickness)]
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let section = &self.section();
        match self.corner_points(coordinates) {
            Ok(Corners::Four(corners)) => {
                let frame = LocalFrame::quadrilateral(&corners);
                let points = &frame.points;
                let membrane = QuadMembrane { points, section }.stiffness();
                let bending = QuadBending { points, section }.stiffness();
                frame.add_stiffness::<12>(&leading_block(&membrane), &bending, matrix);
            }
            Ok(Corners::Three(corners)) => {
                let frame = LocalFrame::triangle(&corners);
                let points = &frame.points;
                let membrane =
                    TriangleMembrane { points, section, shared_sides: self.shared_sides }
                        .stiffness();
                let bending = TriangleBending { points, section }.stiffness();
                frame.add_stiffness::<9>(&membrane, &leading_block(&bending), matrix);
            }
            Err(_) => (),
        }
    }

    fn density(&self) -> Option<f64> {
        Some(self.material.density())
    }

    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]) {
        match self.corner_points(coordinates) {
            Ok(Corners::Four(corners)) => {
                self.add_mass(&MiddleSurface::quadrilateral(&corners), kind, matrix);
            }
            Ok(Corners::Three(corners)) => {
                self.add_mass(&MiddleSurface::triangle(&corners), kind, matrix);
            }
            Err(_) => (),
        }
    }

    /// [`Error::Item`] with the nodes for a shape that the element does not accept.
    ///
    /// Sides must have positive lengths, and the two sides at a corner must not be parallel. Four nodes must be listed
    /// around a convex quadrilateral, whose normals at the corners are within 45° of the normal in the middle.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        let result = self.corner_points(coordinates).and_then(|points| match points {
            Corners::Four(corners) => shape::check_quadrilateral(&corners),
            Corners::Three(corners) => shape::check_triangle(&corners),
        });
        result.map_err(|error| within_shell(error, self.nodes()))
    }
}
