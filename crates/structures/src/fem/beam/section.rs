//! Cross-section of a beam in space.

use crate::error::{Result, positive};

/// Cross-section of a beam in space: area, second moments, torsion constant, shear areas.
///
/// y and z are the principal axes of the section through its centroid: y along the orientation of the beam, z at a
/// right angle to it.
///
/// ```
/// use basemat::fem::{BeamSection, Element, Material, SpaceBeam};
///
/// // A rectangle 0.3 m along y by 0.4 m along z; the beam runs along x, its y axis points up.
/// let section = BeamSection::new(0.12, [1.6e-3, 0.9e-3], 1.94e-3)?.with_shear_areas([0.1, 0.1])?;
/// let concrete = Material::new(30.0e9, 0.2, 2500.0)?;
/// let beam = SpaceBeam::new([0, 1], concrete, section, [0.0, 0.0, 1.0])?;
/// let mut stiffness = vec![0.0; 144];
/// beam.stiffness(&[[0.0; 3], [4.0, 0.0, 0.0]], &mut stiffness);
/// let vertical = stiffness[2 * 12 + 2];
/// let shear_ratio = 12.0 * 30.0e9 * 0.9e-3 / (12.5e9 * 0.1 * 16.0); // 12 E I_z/(G A_sy L²)
/// let exact = 12.0 * 30.0e9 * 0.9e-3 / 64.0 / (1.0 + shear_ratio);
/// assert!((vertical / exact - 1.0).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamSection {
    pub(super) area: f64,
    /// About y and about z, m⁴.
    pub(super) second_moments: [f64; 2],
    pub(super) torsion_constant: f64,
    /// For shear along y and along z, m²; `None` without shear deformation.
    pub(super) shear_areas: Option<[f64; 2]>,
}

impl BeamSection {
    /// Section with area (m²), second moments \[I_y, I_z\] (m⁴) and torsion constant J (m⁴).
    ///
    /// I_y = ∫ z² dA resists bending in the plane of the beam and z, I_z = ∫ y² dA bending in the plane of
    /// the beam and y. J is St Venant's constant, for a rectangle a × b about a b³ (1/3 − 0.21 b/a) with
    /// a ≥ b; it is I_y + I_z for circles and pipes only.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless all are positive.
    pub fn new(area: f64, second_moments: [f64; 2], torsion_constant: f64) -> Result<Self> {
        positive("area of the section", area)?;
        positive("second moment I_y of the section", second_moments[0])?;
        positive("second moment I_z of the section", second_moments[1])?;
        positive("torsion constant of the section", torsion_constant)?;
        Ok(Self { area, second_moments, torsion_constant, shear_areas: None })
    }

    /// Adds shear deformation by the shear areas along y and along z, m².
    ///
    /// The shear area of a rectangle is 5/6 of its area.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless both are positive.
    pub fn with_shear_areas(self, shear_areas: [f64; 2]) -> Result<Self> {
        positive("shear area along y of the section", shear_areas[0])?;
        positive("shear area along z of the section", shear_areas[1])?;
        Ok(Self { shear_areas: Some(shear_areas), ..self })
    }
}
