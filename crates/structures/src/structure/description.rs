//! Properties of a structure by which a run warns of probable mistakes.

use crate::fem::Mesh;

/// Properties of a structure by which a run warns of probable mistakes.
///
/// These properties change no result. Default: all `None`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StructureDescription {
    /// Smallest and largest density of the materials, kg/m³, without massless ones; `None` without materials.
    ///
    /// A run warns of an implausible density: `Mistake::UnusualDensity`.
    pub densities: Option<[f64; 2]>,
    /// Number of element faces beside the base, and the middle of the first one, m.
    ///
    /// They are at the height of the base, but not part of it. These faces do not touch the ground. A run warns of
    /// them: `Mistake::FacesOffGround`.
    pub faces_off_ground: Option<(usize, [f64; 2])>,
}

impl StructureDescription {
    /// Description of a finite-element model, with faces that are not part of its base.
    pub(crate) fn for_mesh(mesh: &Mesh, faces_off_ground: Option<(usize, [f64; 2])>) -> Self {
        Self { densities: mesh.densities(), faces_off_ground }
    }

    /// Description of the structure shifted along x by `shift`, m.
    pub(crate) fn shifted(self, shift: f64) -> Self {
        let faces_off_ground =
            self.faces_off_ground.map(|(face_count, [x, y])| (face_count, [x + shift, y]));
        Self { faces_off_ground, ..self }
    }

    /// Description of two structures together: sum of faces, range of densities.
    pub(crate) fn combined(self, other: Self) -> Self {
        let faces = [self.faces_off_ground, other.faces_off_ground].into_iter().flatten();
        let densities = [self.densities, other.densities].into_iter().flatten();
        Self {
            faces_off_ground: faces
                .reduce(|(sum, first_middle), (face_count, _)| (sum + face_count, first_middle)),
            densities: densities
                .reduce(|range, other| [range[0].min(other[0]), range[1].max(other[1])]),
        }
    }
}
