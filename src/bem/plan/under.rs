//! Cells under the base of a structure.

use super::cells::{Plan, check_faces};
use super::faces::MatFace;
use super::outline::RIGID_MAT_OVERHANG;
use super::overhang::{EdgeStiffness, STIFFNESS_MATRIX_NAME, edge_stiffness, mean_side};
use crate::error::Result;
use crate::linalg::SparseMatrix;
use crate::soil::Soil;
use crate::structure::{Base, BaseNode, Structure, Triplets};

/// Largest number of cells to which the plan under flexible faces is refined, because more would slow down every step.
const MAX_REFINED_CELLS: f64 = 1000.0;
/// Relative rounding error of the number of faces along a side.
const FACE_COUNT_ROUNDING: f64 = 1e-9;

impl Plan {
    /// Plan under the faces of a structure, with `cells` along the shorter side of all faces: [`Plan::on_faces`].
    ///
    /// Cells under flexible faces end at the outline ([`Plan::without_overhang`]), because the best overhang depends on
    /// the soil ([`Plan::on_soil`]). The plan has at least one cell for each flexible face (two triangles count as one),
    /// because nodes between cells are supported by the structure alone. This rule increases the number to 1000 cells at
    /// most: a base that needs more cells causes an error or a warning of the build
    /// ([`Warning::CoarseBase`](crate::coupled::Warning::CoarseBase)).
    ///
    /// # Errors
    /// As for [`Plan::on_faces`].
    pub fn under(structure: &dyn Structure, cells: usize) -> Result<Self> {
        Self::of_base(structure, cells, None)?.map_or_else(|| Self::on_faces(&[], cells), Ok)
    }

    /// Plan under the faces of a structure on `soil`, as [`ElasticGround::under`](crate::bem::ElasticGround::under) uses it.
    ///
    /// Cells under flexible faces extend beyond the outline by the best fraction for this soil.
    ///
    /// # Errors
    /// As for [`Plan::on_faces`]; errors of the structure's stiffness matrix.
    pub fn on_soil(structure: &dyn Structure, cells: usize, soil: &Soil) -> Result<Self> {
        let plan = Self::of_base(structure, cells, Some(soil))?;
        plan.map_or_else(|| Self::on_faces(&[], cells), Ok)
    }

    /// Plan under the faces of a structure; `None` for a structure in the plane.
    ///
    /// Without a soil, cells under flexible faces end at the outline.
    pub(in crate::bem) fn of_base(
        structure: &dyn Structure,
        cells: usize,
        soil: Option<&Soil>,
    ) -> Result<Option<Self>> {
        let base = structure.base();
        let Base::Faces(base_faces) = &base else { return Ok(None) };
        let mut faces = Vec::with_capacity(base_faces.len());
        for (face, nodes) in base_faces.iter().enumerate() {
            let corners: Vec<_> = nodes.iter().map(BaseNode::place).collect();
            faces.push(MatFace::new(face, &corners)?);
        }
        check_faces(faces.len())?;
        let flexible_mats = if cells > 1 { flexible_mats(base_faces, &faces) } else { vec![] };
        if flexible_mats.is_empty() {
            return Self::on_outlines(faces, cells, RIGID_MAT_OVERHANG, f64::INFINITY).map(Some);
        }
        let sides = MatFace::bounds(&faces).map(|[min, max]| max - min);
        let shorter_side = sides[0].min(sides[1]);
        let longer_side = sides[0].max(sides[1]);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "> 0")]
        let max_cells = (MAX_REFINED_CELLS / (longer_side / shorter_side)).sqrt() as usize;
        let mut shorter_side_cells = cells;
        for mat in &flexible_mats {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "> 0")]
            let shorter_side_faces =
                (shorter_side / mean_side(mat) * (1.0 - FACE_COUNT_ROUNDING)).ceil() as usize;
            shorter_side_cells = shorter_side_cells.max(shorter_side_faces.min(max_cells));
        }
        let Some(soil) = soil else {
            return Self::on_outlines(faces, shorter_side_cells, 0.0, 0.0).map(Some);
        };
        let mut triplets = Triplets::new(structure.dofs());
        base.check(structure.dofs())?;
        structure.stiffness(&mut triplets)?;
        let stiffness = SparseMatrix::new(STIFFNESS_MATRIX_NAME, &triplets)?;
        let mut min_stiffness = EdgeStiffness { overhang: RIGID_MAT_OVERHANG, rigidity: f64::MAX };
        let cell_side = shorter_side / shorter_side_cells as f64;
        for mat in &flexible_mats {
            let mat_stiffness = edge_stiffness(&stiffness, mat, soil, cell_side);
            min_stiffness.overhang = min_stiffness.overhang.min(mat_stiffness.overhang);
            min_stiffness.rigidity = min_stiffness.rigidity.min(mat_stiffness.rigidity);
        }
        Self::on_outlines(faces, shorter_side_cells, min_stiffness.overhang, min_stiffness.rigidity)
            .map(Some)
    }
}

/// Faces of each flexible mat; a face is its corners and its area (m²).
fn flexible_mats<'a>(
    base_faces: &'a [Vec<BaseNode>],
    faces: &[MatFace],
) -> Vec<Vec<(&'a [BaseNode], f64)>> {
    let face_mats = MatFace::mats(faces);
    let mut flexible_mats = vec![];
    for mat in 0..=face_mats.iter().copied().max().unwrap_or(0) {
        let mut mat_faces = vec![];
        let mut nodes = vec![];
        for face in (0..faces.len()).filter(|face| face_mats[*face] == mat) {
            mat_faces.push((&base_faces[face][..], faces[face].area()));
            nodes.extend_from_slice(&base_faces[face]);
        }
        if !BaseNode::are_flat(&nodes) {
            flexible_mats.push(mat_faces);
        }
    }
    flexible_mats
}
