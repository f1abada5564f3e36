//! Rigid links and ties, by which nodes follow another node.

use crate::error::{Error, Result, in_bounds};
use crate::fem::{Direction, Mesh, Numbering};
use crate::structure::Triplets;

/// Motions in which a follower moves with its leader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RigidLinkKind {
    /// All motions: a rigid body.
    Body,
    /// Motions in a horizontal plane: a rigid diaphragm.
    Diaphragm,
    /// Displacements alone, equal to those of the leader: a tie.
    Tie,
}

impl RigidLinkKind {
    /// Whether a follower follows its leader in this direction.
    fn ties(self, direction: Direction) -> bool {
        match self {
            Self::Body => true,
            Self::Diaphragm => {
                matches!(direction, Direction::X | Direction::Y | Direction::RotationZ)
            }
            Self::Tie => !direction.is_rotation(),
        }
    }

    /// Requirement on the degrees of freedom of a leader, for an error.
    fn leader_requirement(self) -> &'static str {
        match self {
            Self::Body => {
                "its leader must have all degrees of freedom of a node, from a beam for example"
            }
            Self::Diaphragm => {
                "its leader must have displacements along x and y and the rotation about z"
            }
            Self::Tie => "its leader must have displacements in all directions",
        }
    }
}

fn link_error(needed: &'static str) -> Error {
    Error::Scene { quantity: "rigid link", needed }
}

/// A node that follows another one.
pub(super) struct Follower {
    pub(super) node: usize,
    pub(super) leader: usize,
    /// Whether the node follows in all directions, not only in a horizontal plane.
    pub(super) is_body: bool,
}

/// Rigid links of a mesh.
///
/// Every degree of freedom of the mesh is a weighted sum of the remaining ones.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RigidLinks {
    /// Kind of link and leader of each node that is a follower.
    leaders: Vec<Option<(RigidLinkKind, usize)>>,
    /// Whether each node is a leader.
    is_leader: Vec<bool>,
    /// Terms (remaining degree of freedom, weight) of each degree of freedom of the mesh.
    rows: Vec<Vec<(usize, f64)>>,
    /// Number of remaining degrees of freedom.
    dof_count: usize,
}

impl RigidLinks {
    /// Numbering of a mesh without links, to which [`link`](Self::link) adds links.
    pub(super) fn new(mesh: &Mesh, numbering: &Numbering) -> Self {
        let node_count = mesh.nodes().len();
        let dof_count = numbering.dofs();
        let rows = (0..dof_count).map(|dof| vec![(dof, 1.0)]).collect();
        Self {
            leaders: vec![None; node_count],
            is_leader: vec![false; node_count],
            rows,
            dof_count,
        }
    }

    /// Ties `followers` to `leader`.
    pub(super) fn link(
        &mut self,
        mesh: &Mesh,
        numbering: &Numbering,
        kind: RigidLinkKind,
        leader: usize,
        followers: &[usize],
    ) -> Result<()> {
        let node_count = mesh.nodes().len();
        for &node in std::iter::once(&leader).chain(followers) {
            in_bounds("node of a rigid link", node, node_count)?;
        }
        let mut tied_directions =
            mesh.directions().iter().filter(|direction| kind.ties(**direction));
        if tied_directions.any(|&direction| numbering.dof(leader, direction).is_none()) {
            return Err(link_error(kind.leader_requirement()));
        }
        if kind != RigidLinkKind::Body {
            let leader_height = mesh.nodes()[leader][mesh.up_axis()];
            let mut heights = followers.iter().map(|&node| mesh.nodes()[node][mesh.up_axis()]);
            if !heights.all(|height| (height - leader_height).abs() <= mesh.height_tolerance()) {
                return Err(link_error("the nodes of a diaphragm or a tie must lie at one height"));
            }
        }
        if self.leaders[leader].is_some() {
            return Err(link_error("its leader must not follow another node"));
        }
        for (follower_index, &follower) in followers.iter().enumerate() {
            let is_follower =
                self.leaders[follower].is_some() || followers[..follower_index].contains(&follower);
            if follower == leader || is_follower || self.is_leader[follower] {
                return Err(link_error("its followers must follow one node only, and lead none"));
            }
        }
        self.is_leader[leader] = true;
        for &follower in followers {
            self.leaders[follower] = Some((kind, leader));
        }
        self.renumber(mesh, numbering);
        Ok(())
    }

    /// Numbers the remaining degrees of freedom, node by node, and expresses all others by them.
    fn renumber(&mut self, mesh: &Mesh, numbering: &Numbering) {
        let nodes = mesh.nodes();
        let mut remaining_count = 0;
        let mut remaining_indices = vec![None; numbering.dofs()];
        for node in 0..nodes.len() {
            for &direction in mesh.directions() {
                if self.is_tied(node, direction) {
                    continue;
                }
                if let Some(dof) = numbering.dof(node, direction) {
                    remaining_indices[dof] = Some(remaining_count);
                    remaining_count += 1;
                }
            }
        }
        self.dof_count = remaining_count;
        for node in 0..nodes.len() {
            for &direction in mesh.directions() {
                let Some(dof) = numbering.dof(node, direction) else { continue };
                let leader_link = self.leaders[node].filter(|(kind, _)| kind.ties(direction));
                let (kind, leader) = leader_link.unwrap_or((RigidLinkKind::Body, node));
                let arm = match kind {
                    RigidLinkKind::Tie => [0.0; 3],
                    _ => [0, 1, 2].map(|axis| nodes[node][axis] - nodes[leader][axis]),
                };
                // A follower has the motion of its leader, and displacements due to the leader's rotations.
                let motions = mesh.directions().iter().filter(|motion| kind.ties(**motion));
                let mut row = Vec::new();
                for &motion in motions {
                    let weight = direction.in_rigid_motion(motion, arm);
                    let remaining_dof =
                        numbering.dof(leader, motion).and_then(|dof| remaining_indices[dof]);
                    if let Some(remaining_dof) = remaining_dof.filter(|_| weight != 0.0) {
                        row.push((remaining_dof, weight));
                    }
                }
                self.rows[dof] = row;
            }
        }
    }

    /// Number of degrees of freedom that remain.
    pub(super) fn dofs(&self) -> usize {
        self.dof_count
    }

    /// Whether a node follows another one in this direction.
    fn is_tied(&self, node: usize, direction: Direction) -> bool {
        let leader_link = self.leaders.get(node).copied().flatten();
        leader_link.is_some_and(|(kind, _)| kind.ties(direction))
    }

    /// Index of a mesh's degree of freedom among the remaining ones.
    ///
    /// `None` for a follower.
    pub(super) fn remaining_dof(
        &self,
        node: usize,
        direction: Direction,
        dof: usize,
    ) -> Option<usize> {
        let is_free = !self.is_tied(node, direction);
        self.rows
            .get(dof)?
            .first()
            .filter(|_| is_free)
            .map(|&(remaining_dof, _)| remaining_dof)
    }

    /// Converts a weighted sum of the mesh's degrees of freedom to the remaining ones.
    pub(super) fn remaining_terms(&self, terms: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let mut remaining_terms: Vec<(usize, f64)> = Vec::new();
        for &(dof, weight) in terms {
            for &(remaining_dof, factor) in self.rows.get(dof).into_iter().flatten() {
                match remaining_terms.iter_mut().find(|term| term.0 == remaining_dof) {
                    Some(term) => term.1 += weight * factor,
                    None => remaining_terms.push((remaining_dof, weight * factor)),
                }
            }
        }
        remaining_terms
    }

    /// All nodes that follow the rotations of another node; those of a tie do not.
    pub(super) fn followers(&self) -> impl Iterator<Item = Follower> + '_ {
        self.leaders.iter().enumerate().filter_map(|(node, leader)| {
            let (kind, leader) = leader.filter(|(kind, _)| *kind != RigidLinkKind::Tie)?;
            Some(Follower { node, leader, is_body: kind == RigidLinkKind::Body })
        })
    }

    /// Marks all nodes of each rigid body that has a marked node.
    pub(super) fn mark_bodies(&self, is_marked: &mut [bool]) {
        // Marks pass from the followers to their leaders, then from the leaders to all followers.
        for node in 0..is_marked.len() {
            if let Some((RigidLinkKind::Body, leader)) = self.leaders[node] {
                is_marked[leader] |= is_marked[node];
            }
        }
        for node in 0..is_marked.len() {
            if let Some((RigidLinkKind::Body, leader)) = self.leaders[node] {
                is_marked[node] |= is_marked[leader];
            }
        }
    }

    /// Adds Lᵀ A L to `matrix`, with the matrix A of the mesh.
    ///
    /// u = L q for the remaining degrees of freedom q.
    pub(super) fn add_condensed(&self, mesh_matrix: &Triplets, matrix: &mut Triplets) {
        for &(row, column, value) in mesh_matrix.entries() {
            // Degrees of freedom of a user's element may be out of range; the matrix later returns an error.
            let (Some(row_terms), Some(column_terms)) = (self.rows.get(row), self.rows.get(column))
            else {
                matrix.add(row, column, value);
                continue;
            };
            for &(i, a) in row_terms {
                for &(j, b) in column_terms {
                    matrix.add(i, j, a * b * value);
                }
            }
        }
    }
}
