//! Meshes of quadrilaterals in the plane.

use std::collections::BTreeSet;
use std::io::Read;
use std::path::Path;

use super::cell::{self, MeshCell, group_names};
use super::kind::{ElementKind, KINDS_IN_PLANE};
use super::merge::NodeMerge;
use super::parse;
use super::raw::duplicate_fault;
use crate::error::{Error, FileFault, Result};
use crate::fem::{Mesh, Quad4, Quad8, QuadFormulation, SharedMaterial};
use crate::text::file::open_file;

/// Mesh of quadrilaterals from a file of Gmsh, format 4.1 or 2.2, text or binary (`gmsh -2 -format msh41`).
///
/// [`GmshSpaceMesh`](super::GmshSpaceMesh) reads meshes in space.
///
/// The names of physical groups define the material of quadrilaterals and the meaning of lines. An element
/// belongs to all of its groups; an element in no group has the name "". A quadrilateral must have exactly one
/// group with a material. Points, and lines that the caller does not use, are ignored. Triangles and nodes
/// outside the plane z = 0 are an error. Clockwise quadrilaterals are reversed. Elements of the second order
/// have eight nodes (`Mesh.SecondOrderIncomplete = 1`) and become [`Quad8`]s.
///
/// ```
/// use basemat::fem::Material;
/// use basemat::io::GmshMesh;
/// use basemat::structure::{FemModel, Structure};
///
/// // The example of Gmsh's manual: two squares side by side; here with a named line below.
/// let text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n\
///     $PhysicalNames\n2\n1 7 \"base\"\n2 9 \"wall\"\n$EndPhysicalNames\n\
///     $Entities\n0 1 1 0\n1 0 0 0 2 0 0 1 7 0\n1 0 0 0 2 1 0 1 9 0\n$EndEntities\n\
///     $Nodes\n1 6 1 6\n2 1 0 6\n1\n2\n3\n4\n5\n6\n\
///     0. 0. 0.\n1. 0. 0.\n1. 1. 0.\n0. 1. 0.\n2. 0. 0.\n2. 1. 0.\n$EndNodes\n\
///     $Elements\n2 4 1 4\n1 1 1 2\n1 1 2\n2 2 5\n2 1 3 2\n3 1 2 3 4\n4 2 5 6 3\n$EndElements\n";
/// let gmsh = GmshMesh::from_reader("wall.msh", text.as_bytes())?;
/// assert_eq!(gmsh.surfaces(), ["wall"]);
/// let concrete = Material::new(30.0e9, 0.2, 2400.0)?;
/// let mesh = gmsh.mesh(&[("wall", concrete)])?;
/// let model = FemModel::new(mesh, &gmsh.line("base")?)?;
/// assert_eq!((model.dofs(), model.base().nodes().count()), (12, 3));
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct GmshMesh {
    /// Name of the file, for errors.
    file: String,
    /// Coordinates of the nodes that quadrilaterals use, in the order of the file.
    nodes: Vec<[f64; 2]>,
    quads: Vec<MeshCell>,
    lines: Vec<MeshCell>,
}

/// Materials of groups, each in memory once.
fn shared_materials<'a, M: Clone + Into<SharedMaterial>>(
    materials: &[(&'a str, M)],
) -> Vec<(&'a str, SharedMaterial)> {
    materials.iter().map(|(name, material)| (*name, material.clone().into())).collect()
}

/// Largest distance from the plane z = 0 that counts as rounding, relative to the largest coordinate.
const PLANE_TOLERANCE: f64 = 1e-9;

impl GmshMesh {
    /// Reads a `.msh` file.
    ///
    /// # Errors
    /// [`Error::File`] with the line and the reason.
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        Self::from_reader(&path.display().to_string(), open_file(path)?)
    }

    /// Reads the same from any source of bytes; errors use `name` for the source.
    ///
    /// # Errors
    /// [`Error::File`] with the line and the reason.
    pub fn from_reader(name: &str, source: impl Read) -> Result<Self> {
        let file_mesh =
            parse::read(source, &KINDS_IN_PLANE).map_err(|(line, fault)| fault.of(name, line))?;
        // Lines of the geometry that touch no quadrilateral are ignored.
        let numbered_mesh = cell::numbered_mesh(&file_mesh, |cell| cell.kind.dimension() == 2)
            .map_err(|(line, fault)| fault.of(name, line))?;
        let max_coordinate = numbered_mesh.nodes.iter().fold(0.0_f64, |max_so_far, node| {
            max_so_far.max(node.coordinates[0].abs()).max(node.coordinates[1].abs())
        });
        for node in &numbered_mesh.nodes {
            let z = node.coordinates[2];
            if z.abs() > PLANE_TOLERANCE * max_coordinate {
                let fault = FileFault::value("z of a node", z.to_string(), "0");
                return Err(fault.of(name, node.line));
            }
        }
        let nodes = numbered_mesh
            .nodes
            .iter()
            .map(|node| [node.coordinates[0], node.coordinates[1]])
            .collect();
        let mut mesh = Self { file: name.to_owned(), nodes, quads: Vec::new(), lines: Vec::new() };
        for mut cell in numbered_mesh.cells {
            if cell.kind.dimension() == 2 {
                mesh.orient_counter_clockwise(&mut cell.nodes);
                mesh.quads.push(cell);
            } else if cell.kind != ElementKind::Point {
                mesh.lines.push(cell);
            }
        }
        Ok(mesh)
    }

    /// Coordinates of the nodes of quadrilaterals, m.
    pub fn nodes(&self) -> &[[f64; 2]] {
        &self.nodes
    }

    /// Merges nodes within `tolerance` (m) of each other; returns the number of removed nodes.
    ///
    /// Files have such nodes where surfaces of the geometry touch without a common curve
    /// (`geo.removeAllDuplicates` or `occ.fragment` in Gmsh avoid them). The first node of a point stays. Nodes are
    /// renumbered in their order, in all elements and groups.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the tolerance is finite and not negative;
    /// [`Error::Part`](crate::Error::Part) for nodes in a row that lie within the tolerance of each other, while its
    /// ends do not; [`Error::File`] with the line of an element that merging makes degenerate or equal to another
    /// one. The mesh is then unchanged.
    pub fn merge_nodes(&mut self, tolerance: f64) -> Result<usize> {
        let points = self.nodes.iter().map(|&[x, y]| [x, y, 0.0]).collect::<Vec<_>>();
        let merge = NodeMerge::new(&points, tolerance)?;
        merge.check(&self.file, self.quads.iter().chain(&self.lines))?;
        for cell in self.quads.iter_mut().chain(&mut self.lines) {
            merge.renumber(&mut cell.nodes);
        }
        self.nodes = merge.kept_items(&self.nodes);
        Ok(points.len() - self.nodes.len())
    }

    /// Names of the groups of quadrilaterals, sorted.
    pub fn surfaces(&self) -> Vec<&str> {
        group_names(self.quads.iter())
    }

    /// Names of the groups of lines, sorted.
    pub fn lines(&self) -> Vec<&str> {
        group_names(self.lines.iter())
    }

    /// Mesh of the quadrilaterals, each with the material of its group; you can add elements.
    ///
    /// Nodes keep their indices. A material is a [`Material`](crate::fem::Material), or a law of a solid that yields, such
    /// as [`Iwan`](crate::fem::Iwan). Groups of different types of materials take [`SharedMaterial`]s. Quadrilaterals of
    /// four nodes have incompatible modes, or the mean dilatation if they yield.
    ///
    /// # Errors
    /// [`Error::File`] for a quadrilateral without a material or with two materials, a material without a
    /// group, and quadrilaterals without area or with a reflex corner, with their line.
    pub fn mesh<M: Clone + Into<SharedMaterial>>(&self, materials: &[(&str, M)]) -> Result<Mesh> {
        self.mesh_with(&shared_materials(materials), QuadFormulation::for_material)
    }

    /// [`GmshMesh::mesh`] with one formulation of all quadrilaterals of four nodes.
    ///
    /// # Errors
    /// As for [`GmshMesh::mesh`]; also [`Error::File`] for a material that yields with a formulation other than
    /// [`QuadFormulation::MeanDilatation`].
    pub fn mesh_of<M: Clone + Into<SharedMaterial>>(
        &self,
        materials: &[(&str, M)],
        formulation: QuadFormulation,
    ) -> Result<Mesh> {
        self.mesh_with(&shared_materials(materials), |_| formulation)
    }

    /// Mesh of the quadrilaterals; `formulation` returns that of four nodes for a material.
    fn mesh_with(
        &self,
        materials: &[(&str, SharedMaterial)],
        formulation: impl Fn(&SharedMaterial) -> QuadFormulation,
    ) -> Result<Mesh> {
        let surfaces = self.surfaces();
        if let Some((name, _)) = materials.iter().find(|(name, _)| !surfaces.contains(name)) {
            return Err(self.missing_item(format!("surface '{name}'")));
        }
        for (index, (name, _)) in materials.iter().enumerate() {
            if materials[..index].iter().any(|(other_name, _)| other_name == name) {
                return Err(
                    self.file_error(duplicate_fault(format!("material of surface '{name}'")))
                );
            }
        }
        let mut mesh = Mesh::new();
        for &[x, y] in &self.nodes {
            mesh.add_node(x, y)?;
        }
        for quad in &self.quads {
            let material = self.material(quad, materials)?;
            let result = match *quad.nodes {
                [a, b, c, d] => {
                    mesh.add(Quad4::new([a, b, c, d], material.clone(), formulation(material)))
                }
                [a, b, c, d, ab, bc, cd, da] => {
                    mesh.add(Quad8::new([a, b, c, d, ab, bc, cd, da], material.clone()))
                }
                _ => continue,
            };
            result.map_err(|error| quad.unusable(&self.file, error))?;
        }
        Ok(mesh)
    }

    /// The material of a quadrilateral; an error for none or two.
    fn material<'a>(
        &self,
        quad: &MeshCell,
        materials: &'a [(&str, SharedMaterial)],
    ) -> Result<&'a SharedMaterial> {
        let mut matches = materials.iter().filter(|(name, _)| quad.is_in(name));
        match (matches.next(), matches.next()) {
            (Some((_, material)), None) => Ok(material),
            (Some((name, _)), Some((other_name, _))) => {
                let item = format!(
                    "material of element {}, which is in the surfaces '{name}' and '{other_name}',",
                    quad.tag
                );
                Err(duplicate_fault(item).of(&self.file, quad.line))
            }
            (None, _) => {
                let surfaces = quad.groups.join("' or '");
                Err(self.missing_item(format!("material for its surface '{surfaces}'")))
            }
        }
    }

    /// Nodes of the lines of group `name`, from left to right: the contact nodes of a base.
    ///
    /// # Errors
    /// [`Error::File`] if there is no such group, or its lines have a gap; [`GmshMesh::foundations`]
    /// returns the pieces between gaps.
    pub fn line(&self, name: &str) -> Result<Vec<usize>> {
        let mut pieces = self.foundations(name)?;
        match (pieces.pop(), pieces.len()) {
            (Some(line), 0) => Ok(line),
            (_, other_count) => {
                let needed = "1 (`GmshMesh::foundations` returns the pieces)";
                let items = format!("pieces of line '{name}'");
                Err(self.file_error(FileFault::count(&items, other_count + 1, needed)))
            }
        }
    }

    /// Nodes of the lines of group `name`, for each connected piece, from left to right.
    ///
    /// These are the contact nodes of separate footings, for [`FemModel::on_foundations`]. If footings have
    /// their own names, read each by [`line`](GmshMesh::line).
    ///
    /// [`FemModel::on_foundations`]: crate::structure::FemModel::on_foundations
    ///
    /// # Errors
    /// [`Error::File`] if there is no such group.
    pub fn foundations(&self, name: &str) -> Result<Vec<Vec<usize>>> {
        let mut pieces: Vec<BTreeSet<usize>> = Vec::new();
        for line in self.lines.iter().filter(|line| line.is_in(name)) {
            let mut connected_nodes: BTreeSet<usize> = line.nodes.iter().copied().collect();
            pieces.retain_mut(|piece| {
                let is_separate = line.nodes.iter().all(|node| !piece.contains(node));
                if !is_separate {
                    connected_nodes.append(piece);
                }
                is_separate
            });
            pieces.push(connected_nodes);
        }
        if pieces.is_empty() {
            return Err(self.missing_item(format!("line '{name}'")));
        }
        let mut sorted_pieces = Vec::with_capacity(pieces.len());
        for piece in pieces {
            let mut nodes: Vec<usize> = piece.into_iter().collect();
            nodes.sort_by(|&node, &other_node| {
                self.x(node).total_cmp(&self.x(other_node)).then(node.cmp(&other_node))
            });
            sorted_pieces.push(nodes);
        }
        sorted_pieces
            .sort_by(|piece, other_piece| self.x(piece[0]).total_cmp(&self.x(other_piece[0])));
        Ok(sorted_pieces)
    }

    /// The x of a node, m.
    fn x(&self, node: usize) -> f64 {
        self.nodes[node][0]
    }

    /// Error for an item that the file does not have.
    fn missing_item(&self, item: String) -> Error {
        self.file_error(FileFault::missing(item))
    }

    /// Error of the whole file.
    fn file_error(&self, fault: FileFault) -> Error {
        fault.of(&self.file, 0)
    }

    /// Reverses clockwise nodes. Corners come first, then the nodes between them, in Gmsh as in [`Quad8`].
    fn orient_counter_clockwise(&self, nodes: &mut [usize]) {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| self.nodes[nodes[k]]);
        let twice_area = (c[0] - a[0]) * (d[1] - b[1]) - (c[1] - a[1]) * (d[0] - b[0]);
        if twice_area < 0.0 {
            nodes[1..4].reverse();
            nodes[4..].reverse();
        }
    }
}
