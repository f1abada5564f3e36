//! Facts of a structure by which a run warns of probable mistakes.

use crate::fem::Mesh;

/// Facts of a structure by which a run warns of probable mistakes.
///
/// They change no result. Default: nothing is known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StructureDescription {
    /// Smallest and largest density of the materials, kg/m³, without massless ones; `None` without materials.
    ///
    /// A run warns of a density that no material has:
    /// `Mistake::UnusualDensity`.
    pub densities: Option<[f64; 2]>,
    /// Number of faces of elements at the height of the base that the base does not name, and the middle of the first, m.
    ///
    /// They do not touch the ground. A run warns of them:
    /// `Mistake::FacesOffGround`.
    pub faces_off_ground: Option<(usize, [f64; 2])>,
}

impl StructureDescription {
    /// Description of a model of finite elements, with these faces beside its base.
    pub(crate) fn of_mesh(mesh: &Mesh, faces_off_ground: Option<(usize, [f64; 2])>) -> Self {
        Self { densities: mesh.densities(), faces_off_ground }
    }

    /// Description of the structure moved along x by this distance, m.
    pub(crate) fn moved(self, distance: f64) -> Self {
        let faces_off_ground =
            self.faces_off_ground.map(|(count, [x, y])| (count, [x + distance, y]));
        Self { faces_off_ground, ..self }
    }

    /// Description of two structures together: of each fact the one that is further from usual numbers.
    pub(crate) fn joined(self, other: Self) -> Self {
        let faces = [self.faces_off_ground, other.faces_off_ground].into_iter().flatten();
        let densities = [self.densities, other.densities].into_iter().flatten();
        Self {
            faces_off_ground: faces.reduce(|(sum, first), (count, _)| (sum + count, first)),
            densities: densities.reduce(|one, other| [one[0].min(other[0]), one[1].max(other[1])]),
        }
    }
}
