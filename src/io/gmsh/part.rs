//! Parts of a structure that groups of elements stand for.

use crate::fem::{BeamSection, Material};

/// Part of a structure: the elements of a physical group, for [`GmshSpaceMesh`](super::GmshSpaceMesh).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum GmshPart {
    /// Lines become [`SpaceBeam`](crate::fem::SpaceBeam)s of this material, section and orientation.
    ///
    /// The orientation is the vector of [`SpaceBeam::new`](crate::fem::SpaceBeam::new), the same for all lines of the
    /// group.
    Beam(Material, BeamSection, [f64; 3]),
    /// Triangles and quadrilaterals become [`Shell`](crate::fem::Shell)s of this material and thickness (m).
    ///
    /// Let Gmsh recombine curved shells: triangles are too stiff there.
    Shell(Material, f64),
    /// Hexahedra become [`Hex8`](crate::fem::Hex8) bricks of this material.
    Solid(Material),
    /// Lines, surfaces and volumes of this name make no elements; you can add your own.
    LeftOut,
}

impl GmshPart {
    /// Dimension of its elements; `None` for all.
    pub(super) fn dimension(&self) -> Option<usize> {
        match self {
            Self::Beam(..) => Some(1),
            Self::Shell(..) => Some(2),
            Self::Solid(_) => Some(3),
            Self::LeftOut => None,
        }
    }

    /// Whether it is a part for elements of this dimension.
    pub(super) fn fits(&self, dimension: usize) -> bool {
        self.dimension().map_or(dimension > 0, |own| own == dimension)
    }
}
