//! Facts of a structure by which a run warns of probable mistakes.

use crate::fem::{Mesh, triangle_sides};

/// Facts of a structure by which a run warns of probable mistakes.
///
/// They change no result. Default: nothing is known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StructureDescription {
    /// Largest height of a storey, m; `None` without storeys.
    ///
    /// A run warns of a height above 100 m: `Mistake::TallStorey`.
    pub tallest_storey: Option<f64>,
    /// Mean side of the triangles of doubly curved thin shells, and the longest with which they bend right, m.
    ///
    /// The longest is √(R t) for the radius R and the thickness t ([`Shell`](crate::fem::Shell)). A run warns of longer
    /// sides: `Warning::LongTriangles`.
    pub triangle_sides: Option<[f64; 2]>,
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
    /// Description of a building with storeys of these heights, m.
    pub(crate) fn of_storeys(heights: impl Iterator<Item = f64>) -> Self {
        Self { tallest_storey: heights.reduce(f64::max), ..Self::default() }
    }

    /// Description of a model of finite elements, with these faces beside its base.
    pub(crate) fn of_mesh(mesh: &Mesh, faces_off_ground: Option<(usize, [f64; 2])>) -> Self {
        let triangle_sides = triangle_sides(mesh);
        Self { triangle_sides, densities: mesh.densities(), faces_off_ground, ..Self::default() }
    }

    /// Description of the structure moved along x by this distance, m.
    pub(crate) fn moved(self, distance: f64) -> Self {
        let moved = |(count, [x, y]): (usize, [f64; 2])| (count, [x + distance, y]);
        Self { faces_off_ground: self.faces_off_ground.map(moved), ..self }
    }

    /// Description of two structures together: of each fact the one that is further from usual numbers.
    pub(crate) fn joined(self, other: Self) -> Self {
        let storeys = [self.tallest_storey, other.tallest_storey].into_iter().flatten();
        let sides = [self.triangle_sides, other.triangle_sides].into_iter().flatten();
        let faces = [self.faces_off_ground, other.faces_off_ground].into_iter().flatten();
        let densities = [self.densities, other.densities].into_iter().flatten();
        Self {
            tallest_storey: storeys.reduce(f64::max),
            triangle_sides: sides
                .max_by(|one, other| (one[0] / one[1]).total_cmp(&(other[0] / other[1]))),
            faces_off_ground: faces.reduce(|(sum, first), (count, _)| (sum + count, first)),
            densities: densities.reduce(|one, other| [one[0].min(other[0]), one[1].max(other[1])]),
        }
    }
}
