//! Facts of a structure by which a run warns of probable mistakes.

use crate::fem::{Mesh, triangle_sides};

/// Facts of a structure by which a run warns of probable mistakes.
///
/// They change no result. Default: nothing is known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StructureDescription {
    /// Largest height of a storey, m; `None` without storeys.
    ///
    /// A run warns of a height above 100 m: [`Warning::TallStorey`](crate::coupled::Warning::TallStorey).
    pub tallest_storey: Option<f64>,
    /// Mean side of the triangles of doubly curved thin shells, and the longest with which they bend right, m.
    ///
    /// The longest is √(R t) for the radius R and the thickness t ([`Shell`](crate::fem::Shell)). A run warns of longer
    /// sides: [`Warning::LongTriangles`](crate::coupled::Warning::LongTriangles).
    pub triangle_sides: Option<[f64; 2]>,
    /// Smallest and largest density of the materials, kg/m³, without massless ones; `None` without materials.
    ///
    /// A run warns of a density that no material has:
    /// [`Warning::UnusualDensity`](crate::coupled::Warning::UnusualDensity).
    pub densities: Option<[f64; 2]>,
}

impl StructureDescription {
    /// Description of a building with storeys of these heights, m.
    pub(crate) fn of_storeys(heights: impl Iterator<Item = f64>) -> Self {
        Self { tallest_storey: heights.reduce(f64::max), ..Self::default() }
    }

    /// Description of a model of finite elements.
    pub(crate) fn of_mesh(mesh: &Mesh) -> Self {
        let (triangle_sides, densities) = (triangle_sides(mesh), mesh.densities());
        Self { triangle_sides, densities, ..Self::default() }
    }

    /// Description of two structures together: of each fact the one that is further from usual numbers.
    pub(crate) fn joined(self, other: Self) -> Self {
        let storeys = [self.tallest_storey, other.tallest_storey].into_iter().flatten();
        let sides = [self.triangle_sides, other.triangle_sides].into_iter().flatten();
        let densities = [self.densities, other.densities].into_iter().flatten();
        Self {
            tallest_storey: storeys.reduce(f64::max),
            triangle_sides: sides
                .max_by(|one, other| (one[0] / one[1]).total_cmp(&(other[0] / other[1]))),
            densities: densities.reduce(|one, other| [one[0].min(other[0]), one[1].max(other[1])]),
        }
    }
}
