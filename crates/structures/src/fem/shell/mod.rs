//! Flat shell elements of four and of three nodes in space.

mod corners;
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

use corners::Corners;
use frame::Frame;
use quad_bending::QuadBending;
use quad_membrane::QuadMembrane;
use section::ShellSection;
use surface::MiddleSurface;
use triangle_bending::TriangleBending;
use triangle_membrane::TriangleMembrane;

use super::condensation::leading;
use super::element::{Element, MassKind};
use super::element_face::ElementFace;
use super::material::Material;
use crate::error::{Error, Result, all_finite, finite, positive, require_part, same_length};
use crate::geometry::{Direction, SPACE_DIRECTIONS};

/// Shell of four or three nodes in space: walls, slabs, mats, vessels, domes.
///
/// The element is flat, of one isotropic material in plane stress, and its nodes lie in its middle surface. It has
/// all six directions at each node: membrane with rotation about the normal, bending, and shear across the
/// thickness, so it serves from thin vessels to thick mats. The matrices do not depend on the node with which the
/// list begins, nor on the sense in which it runs around the element.
///
/// * **Four nodes**: MITC4 in bending (Bathe & Dvorkin 1985); a membrane with bending modes and with sides that bulge
///   with the rotations of their ends (Allman 1984), tied to the rotation of the material (Hughes & Brezzi 1989). Nodes
///   that lie in no plane act through rigid links on their projections: rigid motions of a warped element are exact.
/// * **Three nodes**: MITC3+ in bending (Lee, Lee & Bathe 2014, with bounded shear strains) and Felippa's optimal
///   triangle (2003).
///
/// Take quadrilaterals for curved shells. Triangles are much too stiff on a curved thin shell where their sides
/// exceed √(Rt), with the radius R and the thickness t: a pinched hemisphere moves by 0.49 of its displacement with
/// triangles of 3√(Rt), by 0.92 with quadrilaterals of that size. Triangles are good in plane walls and slabs, on
/// cylinders nearly as good as quadrilaterals, and right where meshes run together, as at the top of a dome.
///
/// Triangles and quadrilaterals in one wall need [`Shell::match_sides`].
///
/// A load q (N/m) across a side of length L in the plane of the element, outwards, gives qL/2 to each of the two
/// nodes and the moments −qL²/12 and +qL²/12 about the normal, in the order counter-clockwise. Without these
/// moments a strip of one row bulges at its loaded end.
///
/// Shells have no geometric stiffness by themselves. In [`FemModel::with_p_delta`](crate::structure::FemModel::with_p_delta)
/// their forces at rest turn with them.
///
/// The mass matrix has rotary inertia, ρt³/12 times the area, about all three axes. The lumped one is diagonal in any
/// axes.
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
/// let found = slab.resultants(&corners, bent.as_flattened())?;
/// assert!((found[0].moments[0] - 70_312.5).abs() < 1e-6); // E t³/12/(1 − ν²) · 0.001
/// assert!((found[0].moments[1] - 14_062.5).abs() < 1e-6); // ν times that
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Shell {
    nodes: Corners<usize>,
    material: Material,
    thickness: f64,
    /// Whether the sides 1–2, 2–3 and 3–1 of a triangle belong to quadrilaterals, too.
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
        let corners = Corners::of(nodes).ok_or(Error::Size {
            quantity: "list of nodes of a shell (three, or four)",
            found: nodes.len(),
            needed: 4,
        })?;
        let all_differ = (1..nodes.len()).all(|k| !nodes[..k].contains(&nodes[k]));
        require_part("nodes of a shell", all_differ, "each only once")?;
        positive("thickness of a shell", thickness)?;
        let shell = Self { nodes: corners, material, thickness, shared_sides: [false; 3] };
        positive("bending stiffness of a shell", shell.section().bending()[0][0])?;
        finite("mass per area of a shell", material.density() * thickness)?;
        Ok(shell)
    }

    /// Matches triangles to the quadrilaterals with which they share sides.
    ///
    /// By themselves the sides of triangles bulge more by the rotations of their ends, which makes walls of triangles
    /// bend well. Beside quadrilaterals it would disturb the membrane forces: by a quarter of a uniform stress where
    /// a line between the two kinds begins, ends or turns, and by 0.4 of it all over a chessboard of both, on any mesh.
    /// Matched sides bulge alike, and a uniform stress is exact. Bending needs no match.
    ///
    /// Pass all shells of a mesh at once, before they are added to it.
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
    /// let alone = wall.clone();
    /// Shell::match_sides(&mut wall);
    /// // Of the triangles, the first shares the side 4–1 with the quadrilateral.
    /// assert!(wall[0] == alone[0] && wall[1] != alone[1] && wall[2] == alone[2]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn match_sides(shells: &mut [Self]) {
        let mut sides = HashSet::new();
        for shell in shells.iter() {
            if let Corners::Four(nodes) = shell.nodes {
                sides.extend((0..4).map(|k| side(nodes[k], nodes[(k + 1) % 4])));
            }
        }
        for shell in shells {
            if let Corners::Three(nodes) = shell.nodes {
                shell.shared_sides =
                    [0, 1, 2].map(|k| sides.contains(&side(nodes[k], nodes[(k + 1) % 3])));
            }
        }
    }

    /// Thickness t, m.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// Area of the middle surface that belongs to each node, ∫ N dA, m².
    ///
    /// The surface is the bilinear one through four nodes that lie in no plane. `coordinates` are the nodes' [x, y, z].
    /// A load per area, such as snow, times these areas gives forces at the nodes.
    ///
    /// # Errors
    /// As for [`Element::check`].
    pub fn areas(&self, coordinates: &[[f64; 3]]) -> Result<Vec<f64>> {
        self.check(coordinates)?;
        Ok(match self.corner_points(coordinates)? {
            Corners::Four(nodes) => MiddleSurface::quadrilateral(&nodes).areas().to_vec(),
            Corners::Three(nodes) => MiddleSurface::triangle(&nodes).areas().to_vec(),
        })
    }

    /// Forces [x, y, z] (N) of a `pressure` (Pa) at each node; a positive pressure pushes along the normal.
    ///
    /// The normal n points to the side from which the nodes run counter-clockwise. The forces over closed surfaces
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
        let vectors = match self.corner_points(coordinates)? {
            Corners::Four(nodes) => MiddleSurface::quadrilateral(&nodes).vectors.to_vec(),
            Corners::Three(nodes) => MiddleSurface::triangle(&nodes).vectors.to_vec(),
        };
        Ok(vectors.into_iter().map(|area| area.map(|part| pressure * part)).collect())
    }

    /// Forces and moments per metre at each node, in the axes of the element.
    ///
    /// `displacement` holds the six displacements (m, rad) of each node, node by node. The axis n is the normal from
    /// which the nodes run counter-clockwise. e1 runs from the middle of the side 4–1 to the middle of the side 2–3,
    /// in a triangle along the side 1–2. [`ShellResultants::in_axes`] takes them to axes that do not depend on the
    /// list of nodes. Values at a node differ between its elements: their mean is far more accurate.
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
            Corners::Four(nodes) => {
                let frame = Frame::quadrilateral(&nodes);
                let points = &frame.points;
                let local = frame.local::<12>(displacement);
                let membrane = QuadMembrane { points, section }.corner_strains(&local.membrane);
                let bending = QuadBending { points, section }.corner_strains(&local.bending);
                section.resultants(frame.axes, &membrane, &bending)
            }
            Corners::Three(nodes) => {
                let frame = Frame::triangle(&nodes);
                let points = &frame.points;
                let local = frame.local::<9>(displacement);
                let membrane =
                    TriangleMembrane { points, section, shared_sides: self.shared_sides }
                        .corner_strains(&local.membrane);
                let bending = TriangleBending { points, section }.corner_strains(&local.bending);
                section.resultants(frame.axes, &membrane, &bending)
            }
        })
    }

    fn section(&self) -> ShellSection {
        ShellSection::new(&self.material, self.thickness)
    }

    /// Coordinates of the corners, one for each node.
    fn corner_points(&self, coordinates: &[[f64; 3]]) -> Result<Corners<[f64; 3]>> {
        let found = coordinates.len();
        let needed = self.nodes().len();
        let points = Corners::of(coordinates).filter(|_| found == needed);
        points.ok_or(Error::Size { quantity: "coordinates of a shell", found, needed })
    }

    /// Adds the mass matrix of the element over its middle surface.
    fn add_mass<const N: usize>(
        &self,
        surface: &MiddleSurface<N>,
        kind: MassKind,
        matrix: &mut [f64],
    ) {
        let translation = self.material.density() * self.thickness;
        let rotation = translation * self.thickness.powi(2) / 12.0;
        for i in 0..N {
            for j in 0..N {
                let column = if kind == MassKind::Lumped { i } else { j };
                for direction in 0..6 {
                    let density = if direction < 3 { translation } else { rotation };
                    matrix[(6 * i + direction) * 6 * N + 6 * column + direction] +=
                        density * surface.products[i][j];
                }
            }
        }
    }
}

/// Ends of a side in ascending order.
fn side(from: usize, to: usize) -> [usize; 2] {
    [from.min(to), from.max(to)]
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
        Some(Box::new(Self { nodes: Corners::of(nodes)?, ..self.clone() }))
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
            Ok(Corners::Four(nodes)) => {
                let frame = Frame::quadrilateral(&nodes);
                let points = &frame.points;
                let membrane = QuadMembrane { points, section }.stiffness();
                let bending = QuadBending { points, section }.stiffness();
                frame.add_stiffness::<12>(&leading(&membrane), &bending, matrix);
            }
            Ok(Corners::Three(nodes)) => {
                let frame = Frame::triangle(&nodes);
                let points = &frame.points;
                let membrane =
                    TriangleMembrane { points, section, shared_sides: self.shared_sides }
                        .stiffness();
                let bending = TriangleBending { points, section }.stiffness();
                frame.add_stiffness::<9>(&membrane, &leading(&bending), matrix);
            }
            Err(_) => (),
        }
    }

    fn density(&self) -> Option<f64> {
        Some(self.material.density())
    }

    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]) {
        match self.corner_points(coordinates) {
            Ok(Corners::Four(nodes)) => {
                self.add_mass(&MiddleSurface::quadrilateral(&nodes), kind, matrix);
            }
            Ok(Corners::Three(nodes)) => {
                self.add_mass(&MiddleSurface::triangle(&nodes), kind, matrix);
            }
            Err(_) => (),
        }
    }

    /// [`Error::Item`] with the nodes, unless the shape is good: sides of positive length and no two parallel at a
    /// corner, four nodes listed around a convex quadrilateral, its normals at most 45° apart from that in the middle.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        let checked = self.corner_points(coordinates).and_then(|points| match points {
            Corners::Four(nodes) => shape::check_quadrilateral(&nodes),
            Corners::Three(nodes) => shape::check_triangle(&nodes),
        });
        checked.map_err(|error| within_shell(error, self.nodes()))
    }
}
