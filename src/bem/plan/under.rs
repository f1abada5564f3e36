//! Cells under the base of a structure.

use super::cells::{OVERHANG, Plan, check_faces};
use super::faces::Face;
use crate::error::Result;
use crate::structure::{Base, BaseNode, Structure};

/// Largest number of cells to which the number under flexible faces is raised.
const MOST_RAISED: f64 = 1000.0;

impl Plan {
    /// Cells under the faces of a structure, with `cells` along the shorter side of all: [`Plan::on_faces`].
    ///
    /// Cells under flexible faces end at the outline ([`Plan::without_overhang`]): a soft plate would sink with soil
    /// beyond its edge. The plan has at least one cell for each flexible face (two triangles count as one): between
    /// cells only the structure holds its nodes. This raises the number to 1000 cells at most: a base that needs more
    /// causes an error or a warning of the build ([`Warning::CoarseBase`](crate::coupled::Warning::CoarseBase)).
    ///
    /// # Errors
    /// As for [`Plan::on_faces`].
    pub fn under(structure: &dyn Structure, cells: usize) -> Result<Self> {
        Self::of_base(structure, cells)?.map_or_else(|| Self::on_faces(&[], cells), Ok)
    }

    /// Cells under the faces of a structure; `None` for a structure in the plane.
    pub(in crate::bem) fn of_base(structure: &dyn Structure, cells: usize) -> Result<Option<Self>> {
        let Base::Faces(bodies) = structure.base() else { return Ok(None) };
        let corners = |face: &Vec<BaseNode>| face.iter().map(BaseNode::place).collect();
        let corners: Vec<Vec<_>> = bodies.iter().map(corners).collect();
        let faces = corners.iter().enumerate().map(|(number, own)| Face::new(number, own));
        let faces = faces.collect::<Result<Vec<_>>>()?;
        check_faces(faces.len())?;
        let mats = Face::mats(&faces);
        let (mut most, mut overhang) = (cells, OVERHANG);
        for mat in 0..=mats.iter().copied().max().unwrap_or(0) {
            let own = || (0..mats.len()).filter(|face| mats[*face] == mat);
            let nodes: Vec<_> = own().flat_map(|face| bodies[face].iter().cloned()).collect();
            if cells > 1 && !BaseNode::are_flat(&nodes) {
                overhang = 0.0;
                let pieces: f64 = own().map(|face| 0.5 * (corners[face].len() as f64 - 2.0)).sum();
                let area = own().map(|face| faces[face].area()).sum::<f64>();
                let sides = Face::bounds(&faces).map(|[least, greatest]| greatest - least);
                let along = sides[0].min(sides[1]) * f64::sqrt(pieces / area);
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "> 0")]
                let along = (along * (1.0 - 1e-9)).ceil() as usize;
                let ratio = sides[0].max(sides[1]) / sides[0].min(sides[1]);
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "> 0")]
                let limit = (MOST_RAISED / ratio).sqrt() as usize;
                most = most.max(along.min(limit));
            }
        }
        Self::covering(faces, most, overhang).map(Some)
    }
}
