//! Cells under the base of a structure.

use super::cells::{Plan, check_faces};
use super::faces::Face;
use super::outline::OVERHANG;
use super::overhang::{NAME, mean_side, overhang};
use crate::error::Result;
use crate::linalg::SparseMatrix;
use crate::soil::Soil;
use crate::structure::{Base, BaseNode, Structure, Triplets};

/// Largest number of cells to which the number under flexible faces is raised.
const MOST_RAISED: f64 = 1000.0;

impl Plan {
    /// Cells under the faces of a structure, with `cells` along the shorter side of all: [`Plan::on_faces`].
    ///
    /// Cells under flexible faces end at the outline ([`Plan::without_overhang`]), because a right overhang depends on
    /// the soil ([`Plan::on_soil`]). The plan has at least one cell for each
    /// flexible face (two triangles count as one): between cells only the structure holds its nodes. This raises the
    /// number to 1000 cells at most: a base that needs more causes an error or a warning of the build
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
        let Base::Faces(bodies) = &base else { return Ok(None) };
        let corners = |face: &Vec<BaseNode>| face.iter().map(BaseNode::place).collect();
        let corners: Vec<Vec<_>> = bodies.iter().map(corners).collect();
        let faces = corners.iter().enumerate().map(|(number, own)| Face::new(number, own));
        let faces = faces.collect::<Result<Vec<_>>>()?;
        check_faces(faces.len())?;
        let mats = Face::mats(&faces);
        let mats = (0..=mats.iter().copied().max().unwrap_or(0)).map(|mat| {
            let own = (0..faces.len()).filter(|face| mats[*face] == mat);
            own.map(|face| (&bodies[face][..], faces[face].area())).collect::<Vec<_>>()
        });
        let is_flexible = |own: &Vec<(&[BaseNode], f64)>| {
            let nodes: Vec<_> = own.iter().flat_map(|(corners, _)| corners.to_vec()).collect();
            !BaseNode::are_flat(&nodes)
        };
        let flexible: Vec<_> = mats.filter(|own| cells > 1 && is_flexible(own)).collect();
        let sides = Face::bounds(&faces).map(|[least, greatest]| greatest - least);
        let shorter = sides[0].min(sides[1]);
        let longer = sides[0].max(sides[1]);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "> 0")]
        let limit = (MOST_RAISED / (longer / shorter)).sqrt() as usize;
        let mut most = cells;
        for own in &flexible {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "> 0")]
            let along = (shorter / mean_side(own) * (1.0 - 1e-9)).ceil() as usize;
            most = most.max(along.min(limit));
        }
        if flexible.is_empty() {
            return Self::on(faces, most, OVERHANG, f64::INFINITY).map(Some);
        }
        let mut least = if soil.is_some() { [OVERHANG, f64::MAX] } else { [0.0; 2] };
        if let Some(soil) = soil {
            let mut stiffness = Triplets::new(structure.dofs());
            base.check(structure.dofs())?;
            structure.stiffness(&mut stiffness)?;
            let stiffness = SparseMatrix::new(NAME, &stiffness)?;
            for own in &flexible {
                let own = overhang(&stiffness, own, soil, shorter / most as f64);
                least = [0, 1].map(|k| least[k].min(own[k]));
            }
        }
        let [overhang, rigidity] = least;
        Self::on(faces, most, overhang, rigidity).map(Some)
    }
}
