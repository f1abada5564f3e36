//! Meshes of beams, shells and bricks in space.

use std::collections::HashSet;
use std::io::Read;
use std::path::Path;

use super::cell::{self, Cell, group_names, sorted};
use super::kind::{IN_SPACE, Kind};
use super::merge::MergedNumbers;
use super::parse;
use super::part::GmshPart;
use super::raw::twice;
use crate::error::{Error, FileFault, Result};
use crate::fem::{Hex8, Mesh, Shell, SpaceBeam};

/// A mesh in space as Gmsh writes it: file formats 4.1 and 2.2, as text or binary (`gmsh -3 -format msh41`).
///
/// The names of physical groups say which elements become beams, shells or bricks ([`GmshPart`]). An element belongs
/// to all of its groups; an element in no group has the name "". Points, lines, triangles, quadrilaterals and
/// hexahedra of the first order are read; other elements are an error. z points up. Nodes of the file without an
/// element are left out, unless they are points of a group.
///
/// Hexahedra that are turned inside out are turned back. Beams run, and shells have their normals, as in the file.
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
    file: String,
    /// Coordinates of the nodes, in the order of the file.
    nodes: Vec<[f64; 3]>,
    cells: Vec<Cell>,
}

impl GmshSpaceMesh {
    /// Reads a `.msh` file.
    ///
    /// # Errors
    /// [`Error::File`] with the line and the reason.
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let (name, file) = parse::open(path.as_ref())?;
        Self::from_reader(&name, file)
    }

    /// Reads the same from any source of bytes; errors use `name` for the source.
    ///
    /// # Errors
    /// [`Error::File`] with the line and the reason. Elements that are not read, such as tetrahedra, are named with
    /// their number.
    pub fn from_reader(name: &str, source: impl Read) -> Result<Self> {
        let refuse = |(line, fault): (usize, FileFault)| fault.of(name, line);
        let raw = parse::read(source, &IN_SPACE).map_err(refuse)?;
        // A point without a group may be the centre of an arc.
        let numbered =
            cell::number(&raw, |cell| cell.kind != Kind::Point || raw.is_in_a_group(cell));
        let numbered = numbered.map_err(refuse)?;
        let nodes: Vec<[f64; 3]> = numbered.points.iter().map(|point| point.values).collect();
        let mut cells = numbered.cells;
        for cell in cells.iter_mut().filter(|cell| cell.kind == Kind::Brick) {
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

    /// Merges nodes that lie at the same place within `tolerance` (m); returns the number of nodes that are gone.
    ///
    /// Files have such nodes where surfaces of the geometry touch without a common curve
    /// (`geo.removeAllDuplicates` or `occ.fragment` in Gmsh avoid them). The first node of a place stays. Nodes are
    /// renumbered in their order, in all elements and groups.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the tolerance is finite and not negative; [`Error::Part`](crate::Error::Part) for nodes in a row that
    /// lie within the tolerance of each other, while its ends do not; [`Error::File`] with the line of an element that
    /// merging makes degenerate or equal to another one. The mesh is then as it was.
    pub fn merge_nodes(&mut self, tolerance: f64) -> Result<usize> {
        let points = self.nodes.clone();
        let numbers = MergedNumbers::new(&points, tolerance)?;
        numbers.check(&self.file, self.cells.iter())?;
        for cell in &mut self.cells {
            numbers.apply(&mut cell.nodes);
        }
        self.nodes = numbers.kept(&self.nodes);
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
        let own = |cell: &&Cell| cell.kind.dimension() == dimension && cell.is_in(name);
        let found: Vec<Vec<usize>> =
            self.cells.iter().filter(own).map(|cell| cell.nodes.clone()).collect();
        if found.is_empty() { Err(self.no_group(Some(dimension), name)) } else { Ok(found) }
    }

    /// Mesh of the elements by the parts of their groups; more elements can be added.
    ///
    /// Nodes keep their indices. Lines and surfaces that are sides of other elements need no part. Triangles are
    /// matched to the quadrilaterals beside them ([`Shell::match_sides`]).
    ///
    /// # Errors
    /// [`Error::File`] with the line of an element: without a part or with two, or not accepted as a beam, a shell or
    /// a brick. [`Error::File`] also for a part without a group or given twice.
    pub fn mesh(&self, parts: &[(&str, GmshPart)]) -> Result<Mesh> {
        self.check(parts)?;
        let placed = self.placed(parts)?;
        let mut shells = Vec::new();
        for (cell, part) in &placed {
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
        for (cell, part) in placed {
            let added = match (part, &cell.nodes[..]) {
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
            added.map_err(|error| cell.unusable(&self.file, error))?;
        }
        Ok(mesh)
    }

    /// Error for a part without a group or given twice.
    fn check(&self, parts: &[(&str, GmshPart)]) -> Result<()> {
        for (k, (name, part)) in parts.iter().enumerate() {
            let own = |cell: &Cell| part.fits(cell.kind.dimension()) && cell.is_in(name);
            if !self.cells.iter().any(own) {
                return Err(self.no_group(part.dimension(), name));
            }
            let again = |(other, before): &(&str, GmshPart)| {
                other == name && before.dimension() == part.dimension()
            };
            if parts[..k].iter().any(again) {
                return Err(twice(format!("part of group '{name}'")).of(&self.file, 0));
            }
        }
        Ok(())
    }

    /// Elements that have a part, with it.
    fn placed(&self, parts: &[(&str, GmshPart)]) -> Result<Vec<(&Cell, GmshPart)>> {
        let mut placed = Vec::with_capacity(self.cells.len());
        let mut bare = Vec::new();
        for cell in self.cells.iter().filter(|cell| cell.kind != Kind::Point) {
            let mut own = parts
                .iter()
                .filter(|(name, part)| part.fits(cell.kind.dimension()) && cell.is_in(name));
            match (own.next(), own.next()) {
                (Some((_, part)), None) => placed.push((cell, *part)),
                (None, _) => bare.push(cell),
                (Some((one, _)), Some((other, _))) => {
                    let what = format!("part of {}, in '{one}' and '{other}',", title(cell));
                    return Err(twice(what).of(&self.file, cell.line));
                }
            }
        }
        let sides = if bare.is_empty() { HashSet::new() } else { self.sides() };
        match bare.into_iter().find(|cell| !sides.contains(&sorted(&cell.nodes))) {
            None => Ok(placed),
            Some(cell) => {
                let groups = cell.groups.join("' or '");
                let what = format!("part for {} of the group '{groups}'", title(cell));
                Err(FileFault::missing(what).of(&self.file, cell.line))
            }
        }
    }

    /// Sides of surfaces, and faces and edges of bricks, each by its sorted nodes.
    fn sides(&self) -> HashSet<Vec<usize>> {
        let mut sides = HashSet::new();
        for cell in &self.cells {
            let own = &cell.nodes[..];
            let faces: Vec<Vec<usize>> = match cell.kind.dimension() {
                2 => vec![own.to_vec()],
                3 => Hex8::FACE_CORNERS
                    .iter()
                    .map(|face| face.map(|corner| own[corner]).to_vec())
                    .collect(),
                _ => continue,
            };
            for face in faces {
                let edges = face.iter().zip(face.iter().cycle().skip(1));
                sides.extend(edges.map(|(&from, &to)| sorted(&[from, to])));
                if cell.kind == Kind::Brick {
                    sides.insert(sorted(&face));
                }
            }
        }
        sides
    }

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
fn title(cell: &Cell) -> String {
    format!("{} {}", cell.kind.name(), cell.tag)
}
