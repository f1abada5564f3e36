//! Faces of elements.

/// A face of an element: a side of a solid, or a shell.
///
/// From faces follow the base of a mesh in space, pressures, pictures and ParaView's cells.
///
/// ```
/// use basemat::fem::{Element, ElementFace, Material, Quad4, QuadFormulation};
///
/// let material = Material::new(1.0e9, 0.3, 2000.0)?;
/// let quad = Quad4::new([4, 5, 9, 8], material, QuadFormulation::default());
/// assert_eq!(quad.faces(), [ElementFace::side(&[4, 5, 9, 8])]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ElementFace {
    corners: Vec<usize>,
    thickness: f64,
}

impl ElementFace {
    /// Side of a solid, by its corner nodes counter-clockwise seen from outside.
    ///
    /// In the plane the outline of a solid, counter-clockwise.
    pub fn side(corners: &[usize]) -> Self {
        Self { corners: corners.to_vec(), thickness: 0.0 }
    }

    /// Shell through its corner nodes, in order round it; `thickness` in m.
    pub fn shell(corners: &[usize], thickness: f64) -> Self {
        Self { corners: corners.to_vec(), thickness }
    }

    /// Corner nodes, in order round the face.
    pub fn corners(&self) -> &[usize] {
        &self.corners
    }

    /// Thickness of a shell, m; zero for a side of a solid.
    ///
    /// The surfaces of a shell lie half of it above and below the nodes.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// Whether the face bounds a solid.
    pub(crate) fn is_side(&self) -> bool {
        self.thickness == 0.0
    }
}
