//! Meshes of beams, shells and bricks in space.

use std::collections::HashSet;
use std::io::Read;
use std::path::Path;

use super::cell::{self, MeshCell, group_names, sorted_nodes};
use super::kind::{ElementKind, KINDS_IN_SPACE};
use super::merge::NodeMerge;
use super::parse;
use super::raw::duplicate_fault;
use crate::error::{Error, FileFault, Result};
use crate::fem::{BeamSection, Hex8, Material, Mesh, Shell, SpaceBeam};
use crate::text::file::open_file;

/// Kind of the finite elements that a physical group of a [`GmshSpaceMesh`] becomes.
///
/// Materials are linear elastic: laws of solids that yield are for plane strain ([`GmshMesh`](super::GmshMesh)).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum GmshPart {
    /// Lines become [`SpaceBeam`](crate::fem::SpaceBeam)s of this material, section and orientation.
    ///
    /// The orientation is the vector of [`SpaceBeam::new`](crate::fem::SpaceBeam::new), the same for all lines of the
    /// group.
    Beam(Material, BeamSection, [f64; 3]),
    /// Triangles and quadrilaterals become [`Shell`](crate::fem::Shell)s of this material and thickness (m).
    ///
    /// For curved shells let Gmsh recombine triangles to quadrilaterals, because triangles are too stiff there.
    Shell(Material, f64),
    /// Hexahedra become [`Hex8`](crate::fem::Hex8) bricks of this material.
    Solid(Material),
    /// Lines, surfaces and volumes of this name become no elements; you can add other ones.
    LeftOut,
}

impl GmshPart {
    /// Dimension of the elements of this part; `None` for any dimension.
    fn dimension(&self) -> Option<usize> {
        match self {
            Self::Beam(..) => Some(1),
            Self::Shell(..) => Some(2),
            Self::Solid(_) => Some(3),
            Self::LeftOut => None,
        }
    }

    /// Whether an element has this part, which belongs to the group `name`.
    fn is_part_of(&self, cell: &MeshCell, name: &str) -> bool {
        self.fits_dimension(cell.kind.dimension()) && cell.is_in(name)
    }

    /// Whether elements of this dimension may have this part.
    fn fits_dimension(&self, dimension: usize) -> bool {
        self.dimension().map_or(dimension > 0, |part| part == dimension)
    }
}

/// Mesh in space from a file of Gmsh, format 4.1 or 2.2, text or binary (`gmsh -3 -format msh41`).
///
/// The names of physical groups define which elements become beams, shells or bricks ([`GmshPart`]). An element belongs
/// to all of its groups; an element in no group has the name "". Points, lines, triangles, quadrilaterals and
/// hexahedra of the first order are read; other elements are an error. z points up. Nodes of the file without an
/// element are left out, unless they are points of a group.
///
/// Nodes of hexahedra that are inside out are reordered. Beams and shells have the direction of the file.
///
/// ```
/// use basemat::fem::{BeamSection, Material};
/// use basemat::io::{GmshPart, GmshSpaceMesh};
/// use basemat::structure::{FemModel, Structure};
///
/// // A square raft with a column.
/// let text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n\
///     $PhysicalNames\n2\n1 7 \"column\"\n2 9 \"raft\"\n$EndPhysicalNames\n\
///     $Entities\n0 1 1 0\n1 0 0 0 0 0 3 1 7 0\n1 0 0 0 2 2 0 1 9 0\n$EndEntities\n\
///     $Nodes\n1 5 1 5\n2 1 0 5\n1\n2\n3\n4\n5\n\
///     0. 0. 0.\n2. 0. 0.\n2. 2. 0.\n0. 2. 0.\n0. 0. 3.\n$EndNodes\n\
///     $Elements\n2 2 1 2\n1 1 1 1\n1 1 5\n2 1 3 1\n2 1 2 3 4\n$EndElements\n";
/// let gmsh = GmshSpaceMesh::from_reader("raft.msh", text.as_bytes())?;
/// assert_eq!(gmsh.groups(2), ["raft"]);
/// let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
/// let square = BeamSection::new(0.16, [2.13e-3, 2.13e-3], 3.6e-3)?;
/// let mesh = gmsh.mesh(&[
///     ("raft", GmshPart::Shell(concrete, 0.5)),
///     ("column", GmshPart::Beam(concrete, square, [1.0, 0.0, 0.0])),
/// ])?;
/// let model = FemModel::on_faces(mesh, &gmsh.cells(2, "raft")?)?;
/// assert_eq!((model.dofs(), model.base().nodes().count()), (30, 4));
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct GmshSpaceMesh {
    /// Name of the file, for errors.
    file: String,
    /// Coordinates of the nodes, in the order of the file.
    nodes: Vec<[f64; 3]>,
    cells: Vec<MeshCell>,
}

impl GmshSpaceMesh {
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
    /// [`Error::File`] with the line and the reason. Elements that are not read, such as tetrahedra, are named with
    /// their number.
    pub fn from_reader(name: &str, source: impl Read) -> Result<Self> {
        let file_mesh =
            parse::read(source, &KINDS_IN_SPACE).map_err(|(line, fault)| fault.of(name, line))?;
        // A point without a group may be the centre of an arc.
        let numbered_mesh = cell::numbered_mesh(&file_mesh, |cell| {
            cell.kind != ElementKind::Point || file_mesh.is_in_group(cell)
        });
        let numbered_mesh = numbered_mesh.map_err(|(line, fault)| fault.of(name, line))?;
        let nodes: Vec<[f64; 3]> =
            numbered_mesh.nodes.iter().map(|node| node.coordinates).collect();
        let mut cells = numbered_mesh.cells;
        for cell in cells.iter_mut().filter(|cell| cell.kind == ElementKind::Brick) {
            let corners: Vec<[f64; 3]> = cell.nodes.iter().map(|&node| nodes[node]).collect();
            if Hex8::is_inside_out(&corners) {
                cell.nodes.rotate_left(4);
            }
        }
        Ok(Self { file: name.to_owned(), nodes, cells })
    }

    /// Coordinates [x, y, z] of the nodes, m.
    pub fn nodes(&self) -> &[[f64; 3]] {
        &self.nodes
    }

    /// Merges nodes within `tolerance` (m) of each other; returns the number of removed nodes.
    ///
    /// Files have such nodes where surfaces of the geometry touch without a common curve
    /// (`geo.removeAllDuplicates` or `occ.fragment` in Gmsh avoid them). The first node of a point stays. Nodes are
    /// renumbered in their order, in all elements and groups.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the tolerance is finite and not negative; [`Error::Part`](crate::Error::Part) for nodes in a row that
    /// lie within the tolerance of each other, while its ends do not; [`Error::File`] with the line of an element that
    /// merging makes degenerate or equal to another one. The mesh is then unchanged.
    pub fn merge_nodes(&mut self, tolerance: f64) -> Result<usize> {
        let points = self.nodes.clone();
        let merge = NodeMerge::new(&points, tolerance)?;
        merge.check(&self.file, self.cells.iter())?;
        for cell in &mut self.cells {
            merge.renumber(&mut cell.nodes);
        }
        self.nodes = merge.kept_items(&self.nodes);
        Ok(points.len() - self.nodes.len())
    }

    /// Names of the groups of this dimension, sorted: 0 of points, 1 of lines, 2 of surfaces, 3 of volumes.
    pub fn groups(&self, dimension: usize) -> Vec<&str> {
        group_names(self.cells.iter().filter(|cell| cell.kind.dimension() == dimension))
    }

    /// Nodes of each element of a group, as indices into [`nodes`](GmshSpaceMesh::nodes).
    ///
    /// Surfaces are the faces of a base for [`FemModel::on_faces`], points the places of masses, loads and probes.
    ///
    /// [`FemModel::on_faces`]: crate::structure::FemModel::on_faces
    ///
    /// # Errors
    /// [`Error::File`] if there is no such group.
    pub fn cells(&self, dimension: usize, name: &str) -> Result<Vec<Vec<usize>>> {
        let mut node_lists = Vec::new();
        for cell in &self.cells {
            if cell.kind.dimension() == dimension && cell.is_in(name) {
                node_lists.push(cell.nodes.clone());
            }
        }
        if node_lists.is_empty() {
            Err(self.no_group(Some(dimension), name))
        } else {
            Ok(node_lists)
        }
    }

    /// Mesh of the elements, as the parts of their groups define them; you can add elements.
    ///
    /// Nodes keep their indices. Lines and surfaces that are sides of other elements need no part. Triangles are
    /// matched to the quadrilaterals beside them ([`Shell::match_sides`]).
    ///
    /// # Errors
    /// [`Error::File`] with the line of an element: without a part or with two, or not accepted as a beam, a shell or
    /// a brick. [`Error::File`] also for a part without a group or given twice.
    pub fn mesh(&self, parts: &[(&str, GmshPart)]) -> Result<Mesh> {
        self.check_parts(parts)?;
        let elements = self.elements_with_parts(parts)?;
        let mut shells = Vec::new();
        for (cell, part) in &elements {
            if let GmshPart::Shell(material, thickness) = part {
                let shell = Shell::new(&cell.nodes, *material, *thickness);
                shells.push(shell.map_err(|error| cell.unusable(&self.file, error))?);
            }
        }
        Shell::match_sides(&mut shells);
        let mut shells = shells.into_iter();
        let mut mesh = Mesh::in_space();
        for &node in &self.nodes {
            mesh.add_node_at(node)?;
        }
        for (cell, part) in elements {
            let result = match (part, &cell.nodes[..]) {
                (GmshPart::Beam(material, section, orientation), &[a, b]) => {
                    SpaceBeam::new([a, b], material, section, orientation)
                        .and_then(|beam| mesh.add(beam))
                }
                (GmshPart::Solid(material), &[a, b, c, d, e, f, g, h]) => {
                    mesh.add(Hex8::new([a, b, c, d, e, f, g, h], material))
                }
                (GmshPart::Shell(..), _) => shells.next().map_or(Ok(0), |shell| mesh.add(shell)),
                _ => continue,
            };
            result.map_err(|error| cell.unusable(&self.file, error))?;
        }
        Ok(mesh)
    }

    /// Error for a part without a group or given twice.
    fn check_parts(&self, parts: &[(&str, GmshPart)]) -> Result<()> {
        for (index, (name, part)) in parts.iter().enumerate() {
            if !self.cells.iter().any(|cell| part.is_part_of(cell, name)) {
                return Err(self.no_group(part.dimension(), name));
            }
            let is_repeated = parts[..index].iter().any(|(other_name, other_part)| {
                other_name == name && other_part.dimension() == part.dimension()
            });
            if is_repeated {
                return Err(duplicate_fault(format!("part of group '{name}'")).of(&self.file, 0));
            }
        }
        Ok(())
    }

    /// Elements that have a part, each with its part.
    fn elements_with_parts(
        &self,
        parts: &[(&str, GmshPart)],
    ) -> Result<Vec<(&MeshCell, GmshPart)>> {
        let mut elements = Vec::with_capacity(self.cells.len());
        let mut cells_without_part = Vec::new();
        for cell in self.cells.iter().filter(|cell| cell.kind != ElementKind::Point) {
            let mut parts_of_cell = parts.iter().filter(|(name, part)| part.is_part_of(cell, name));
            match (parts_of_cell.next(), parts_of_cell.next()) {
                (Some((_, part)), None) => elements.push((cell, *part)),
                (None, _) => cells_without_part.push(cell),
                (Some((name, _)), Some((other_name, _))) => {
                    let item =
                        format!("part of {}, in '{name}' and '{other_name}',", element_name(cell));
                    return Err(duplicate_fault(item).of(&self.file, cell.line));
                }
            }
        }
        let sides = if cells_without_part.is_empty() { HashSet::new() } else { self.sides() };
        match cells_without_part
            .into_iter()
            .find(|cell| !sides.contains(&sorted_nodes(&cell.nodes)))
        {
            None => Ok(elements),
            Some(cell) => {
                let groups = cell.groups.join("' or '");
                let item = format!("part for {} of the group '{groups}'", element_name(cell));
                Err(FileFault::missing(item).of(&self.file, cell.line))
            }
        }
    }

    /// Sides of surfaces, and faces and edges of bricks, each as its sorted nodes.
    fn sides(&self) -> HashSet<Vec<usize>> {
        let mut sides = HashSet::new();
        for cell in &self.cells {
            let nodes = &cell.nodes[..];
            let faces: Vec<Vec<usize>> = match cell.kind.dimension() {
                2 => vec![nodes.to_vec()],
                3 => Hex8::FACE_CORNERS
                    .iter()
                    .map(|face| face.map(|corner| nodes[corner]).to_vec())
                    .collect(),
                _ => continue,
            };
            for face in faces {
                let edges = face.iter().zip(face.iter().cycle().skip(1));
                sides.extend(edges.map(|(&start, &end)| sorted_nodes(&[start, end])));
                if cell.kind == ElementKind::Brick {
                    sides.insert(sorted_nodes(&face));
                }
            }
        }
        sides
    }

    /// Error for a group that the file does not have.
    fn no_group(&self, dimension: Option<usize>, name: &str) -> Error {
        let item = match dimension {
            Some(0) => "point",
            Some(1) => "line",
            Some(2) => "surface",
            Some(3) => "volume",
            _ => "group",
        };
        FileFault::missing(format!("{item} '{name}'")).of(&self.file, 0)
    }
}

/// Kind and tag of an element.
fn element_name(cell: &MeshCell) -> String {
    format!("{} {}", cell.kind.name(), cell.tag)
}
