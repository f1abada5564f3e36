//! Rigid links, by which nodes follow another node like a rigid body.

use crate::error::{Error, Result, in_bounds};
use crate::fem::{Direction, Mesh, Numbering};
use crate::structure::Triplets;

/// Motions in which a follower moves with its leader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RigidLinkKind {
    /// All: a rigid body.
    Body,
    /// Motions in a horizontal plane: a rigid diaphragm.
    Floor,
}

impl RigidLinkKind {
    fn ties(self, direction: Direction) -> bool {
        let horizontal = matches!(direction, Direction::X | Direction::Y | Direction::RotationZ);
        self == Self::Body || horizontal
    }

    /// Need for the degrees of freedom of a leader.
    fn needed(self) -> &'static str {
        match self {
            Self::Body => {
                "its leader must have all degrees of freedom of a node, from a beam for example"
            }
            Self::Floor => {
                "its leader must have displacements along x and y and the rotation about z"
            }
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
    /// Whether it follows in all directions, and not in a horizontal plane only.
    pub(super) is_body: bool,
}

/// Rigid links: every degree of freedom of the mesh as a weighted sum of the remaining ones.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RigidLinks {
    /// Leader of each follower.
    leader: Vec<Option<(RigidLinkKind, usize)>>,
    is_leader: Vec<bool>,
    /// Pairs (remaining degree of freedom, weight) for each degree of freedom of the mesh.
    rows: Vec<Vec<(usize, f64)>>,
    dofs: usize,
}

impl RigidLinks {
    /// No links yet.
    pub(super) fn new(mesh: &Mesh, numbering: &Numbering) -> Self {
        let nodes = mesh.nodes().len();
        let dofs = numbering.dofs();
        let rows = (0..dofs).map(|dof| vec![(dof, 1.0)]).collect();
        Self { leader: vec![None; nodes], is_leader: vec![false; nodes], rows, dofs }
    }

    /// Ties `followers` to `leader`.
    pub(super) fn link(
        &mut self,
        mesh: &Mesh,
        numbering: &Numbering,
        link: RigidLinkKind,
        leader: usize,
        followers: &[usize],
    ) -> Result<()> {
        let bound = mesh.nodes().len();
        for &index in std::iter::once(&leader).chain(followers) {
            in_bounds("node of a rigid link", index, bound)?;
        }
        let mut tied = mesh.directions().iter().filter(|direction| link.ties(**direction));
        if tied.any(|&direction| numbering.dof(leader, direction).is_none()) {
            return Err(link_error(link.needed()));
        }
        if link == RigidLinkKind::Floor {
            let floor = mesh.nodes()[leader][mesh.up()];
            let mut heights = followers.iter().map(|&node| mesh.nodes()[node][mesh.up()]);
            if !heights.all(|height| (height - floor).abs() <= mesh.tolerance()) {
                return Err(link_error("the nodes of a diaphragm must lie at one height"));
            }
        }
        if self.leader[leader].is_some() {
            return Err(link_error("its leader must not follow another node"));
        }
        for (place, &follower) in followers.iter().enumerate() {
            let twice = self.leader[follower].is_some() || followers[..place].contains(&follower);
            if follower == leader || twice || self.is_leader[follower] {
                return Err(link_error("its followers must follow one node only, and lead none"));
            }
        }
        self.is_leader[leader] = true;
        for &follower in followers {
            self.leader[follower] = Some((link, leader));
        }
        self.renumber(mesh, numbering);
        Ok(())
    }

    /// Numbers the remaining degrees of freedom, node by node, and expresses the followers by them.
    fn renumber(&mut self, mesh: &Mesh, numbering: &Numbering) {
        let nodes = mesh.nodes();
        let mut next = 0;
        let mut remaining = vec![None; numbering.dofs()];
        for node in 0..nodes.len() {
            for &direction in mesh.directions() {
                if self.is_tied(node, direction) {
                    continue;
                }
                if let Some(dof) = numbering.dof(node, direction) {
                    remaining[dof] = Some(next);
                    next += 1;
                }
            }
        }
        self.dofs = next;
        for node in 0..nodes.len() {
            for &direction in mesh.directions() {
                let Some(dof) = numbering.dof(node, direction) else { continue };
                let tied = self.leader[node].filter(|(link, _)| link.ties(direction));
                let (link, leader) = tied.unwrap_or((RigidLinkKind::Body, node));
                let arm = [0, 1, 2].map(|axis| nodes[node][axis] - nodes[leader][axis]);
                // A follower moves like its leader, and its displacement also with the leader's rotations.
                let motions = mesh.directions().iter().filter(|motion| link.ties(**motion));
                let mut row = Vec::new();
                for &motion in motions {
                    let weight = direction.in_rigid_motion(motion, arm);
                    let index = numbering.dof(leader, motion).and_then(|dof| remaining[dof]);
                    if let Some(index) = index.filter(|_| weight != 0.0) {
                        row.push((index, weight));
                    }
                }
                self.rows[dof] = row;
            }
        }
    }

    /// Number of degrees of freedom that remain.
    pub(super) fn dofs(&self) -> usize {
        self.dofs
    }

    /// Whether a node follows another one in this direction.
    fn is_tied(&self, node: usize, direction: Direction) -> bool {
        let link = self.leader.get(node).copied().flatten();
        link.is_some_and(|(link, _)| link.ties(direction))
    }

    /// The new number of a mesh's degree of freedom; `None` for a follower's.
    pub(super) fn remaining(&self, node: usize, direction: Direction, dof: usize) -> Option<usize> {
        let free = !self.is_tied(node, direction);
        self.rows.get(dof)?.first().filter(|_| free).map(|&(index, _)| index)
    }

    /// A weighted sum of the mesh's degrees of freedom by the remaining ones.
    pub(super) fn row(&self, terms: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let mut sums: Vec<(usize, f64)> = Vec::new();
        for &(dof, weight) in terms {
            for &(index, share) in self.rows.get(dof).into_iter().flatten() {
                match sums.iter_mut().find(|sum| sum.0 == index) {
                    Some(sum) => sum.1 += weight * share,
                    None => sums.push((index, weight * share)),
                }
            }
        }
        sums
    }

    /// All nodes that follow another one.
    pub(super) fn followers(&self) -> impl Iterator<Item = Follower> + '_ {
        self.leader.iter().enumerate().filter_map(|(node, leader)| {
            (*leader).map(|(link, leader)| Follower {
                node,
                leader,
                is_body: link == RigidLinkKind::Body,
            })
        })
    }

    /// Marks all nodes of each rigid body of which one node is marked.
    pub(super) fn mark_bodies(&self, marks: &mut [bool]) {
        // From the followers to their leaders, then back.
        for node in 0..marks.len() {
            if let Some((RigidLinkKind::Body, leader)) = self.leader[node] {
                marks[leader] |= marks[node];
            }
        }
        for node in 0..marks.len() {
            if let Some((RigidLinkKind::Body, leader)) = self.leader[node] {
                marks[node] |= marks[leader];
            }
        }
    }

    /// Adds Lᵀ A L, where u = L q and q are the remaining degrees of freedom.
    pub(super) fn add_condensed(&self, mesh_matrix: &Triplets, matrix: &mut Triplets) {
        for &(row, column, value) in mesh_matrix.entries() {
            // A user's element may have indices out of range: the matrix reports them.
            let (Some(rows), Some(columns)) = (self.rows.get(row), self.rows.get(column)) else {
                matrix.add(row, column, value);
                continue;
            };
            for &(i, a) in rows {
                for &(j, b) in columns {
                    matrix.add(i, j, a * b * value);
                }
            }
        }
    }
}
