//! Cells under the base of a structure.

use super::cells::{Plan, check_faces};
use super::faces::MatFace;
use super::outline::RIGID_MAT_OVERHANG;
use super::overhang::{EdgeStiffness, STIFFNESS_MATRIX_NAME, edge_stiffness, mean_side};
use crate::error::Result;
use crate::linalg::SparseMatrix;
use crate::soil::Soil;
use crate::structure::{Base, BaseNode, Structure, Triplets};

/// Largest number of cells to which the plan under flexible faces is refined.
const MAX_RAISED_CELLS: f64 = 1000.0;

impl Plan {
    /// Cells under the faces of a structure, with `cells` along the shorter side of all: [`Plan::on_faces`].
    ///
    /// Cells under flexible faces end at the outline ([`Plan::without_overhang`]), because the best overhang depends on
    /// the soil ([`Plan::on_soil`]). The plan has at least one cell for each flexible face (two triangles count as one),
    /// because nodes between cells are supported by the structure alone. This raises the number to 1000 cells at most: a
    /// base that needs more causes an error or a warning of the build
    /// ([`Warning::CoarseBase`](crate::coupled::Warning::CoarseBase)).
    ///
    /// # Errors
    /// As for [`Plan::on_faces`].
    pub fn under(structure: &dyn Structure, cells: usize) -> Result<Self> {
        Self::of_base(structure, cells, None)?.map_or_else(|| Self::on_faces(&[], cells), Ok)
    }

    /// Cells under the faces of a structure on `soil`, as of [`ElasticGround::under`](crate::bem::ElasticGround::under).
    ///
    /// Cells under flexible faces extend beyond the outline by the part that is right for this soil.
    ///
    /// # Errors
    /// As for [`Plan::on_faces`]; errors of the structure's stiffness matrix.
    pub fn on_soil(structure: &dyn Structure, cells: usize, soil: &Soil) -> Result<Self> {
        let plan = Self::of_base(structure, cells, Some(soil))?;
        plan.map_or_else(|| Self::on_faces(&[], cells), Ok)
    }

    /// Cells under the faces of a structure; `None` for a structure in the plane.
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
        for (number, nodes) in base_faces.iter().enumerate() {
            let corners: Vec<_> = nodes.iter().map(BaseNode::place).collect();
            faces.push(MatFace::new(number, &corners)?);
        }
        check_faces(faces.len())?;
        let flexible = if cells > 1 { flexible_mats(base_faces, &faces) } else { vec![] };
        if flexible.is_empty() {
            return Self::on_outlines(faces, cells, RIGID_MAT_OVERHANG, f64::INFINITY).map(Some);
        }
        let sides = MatFace::bounds(&faces).map(|[low, high]| high - low);
        let shorter = sides[0].min(sides[1]);
        let longer = sides[0].max(sides[1]);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "> 0")]
        let max_cells_along = (MAX_RAISED_CELLS / (longer / shorter)).sqrt() as usize;
        let mut cells_along = cells;
        for mat in &flexible {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "> 0")]
            let one_per_face = (shorter / mean_side(mat) * (1.0 - 1e-9)).ceil() as usize;
            cells_along = cells_along.max(one_per_face.min(max_cells_along));
        }
        let Some(soil) = soil else {
            return Self::on_outlines(faces, cells_along, 0.0, 0.0).map(Some);
        };
        let mut triplets = Triplets::new(structure.dofs());
        base.check(structure.dofs())?;
        structure.stiffness(&mut triplets)?;
        let stiffness = SparseMatrix::new(STIFFNESS_MATRIX_NAME, &triplets)?;
        let mut smallest = EdgeStiffness { overhang: RIGID_MAT_OVERHANG, rigidity: f64::MAX };
        for mat in &flexible {
            let of_mat = edge_stiffness(&stiffness, mat, soil, shorter / cells_along as f64);
            smallest.overhang = smallest.overhang.min(of_mat.overhang);
            smallest.rigidity = smallest.rigidity.min(of_mat.rigidity);
        }
        Self::on_outlines(faces, cells_along, smallest.overhang, smallest.rigidity).map(Some)
    }
}

/// Faces of each flexible mat: corners and area of each.
fn flexible_mats<'a>(
    base_faces: &'a [Vec<BaseNode>],
    faces: &[MatFace],
) -> Vec<Vec<(&'a [BaseNode], f64)>> {
    let mats = MatFace::mats(faces);
    let mut flexible = vec![];
    for mat in 0..=mats.iter().copied().max().unwrap_or(0) {
        let mut mat_faces = vec![];
        let mut nodes = vec![];
        for face in (0..faces.len()).filter(|face| mats[*face] == mat) {
            mat_faces.push((&base_faces[face][..], faces[face].area()));
            nodes.extend_from_slice(&base_faces[face]);
        }
        if !BaseNode::are_flat(&nodes) {
            flexible.push(mat_faces);
        }
    }
    flexible
}
