//! Box of soil of finite elements around a foundation: its mesh, and the ground around it.

use std::sync::Arc;

use super::box_lines::BoxLines;
use super::ground::TrenchGround;
use super::trench::Trench;
use crate::error::{Error, Result, memory, not_negative, positive, require, same_length};
use crate::fem::{Iwan, Material, Mesh, SharedMaterial};
use crate::soil::{Soil, SoilProfile};

/// Number of elements under the foundation, unless set.
const FOUNDATION_ELEMENTS: usize = 6;
/// Half width of the box over that of the foundation, unless set.
const WIDTH_RATIO: f64 = 2.0;
/// Depth of the box over the half width of the foundation, unless set.
const DEPTH_RATIO: f64 = 1.0;
/// Contact elements of the trench on a length of one mean element under the foundation.
const CONTACTS_PER_ELEMENT: f64 = 1.0;
/// Smallest number of contact elements of a wall of the trench, and half of the smallest number of its base.
const MIN_WALL_CONTACTS: usize = 4;
/// Strain at which clay has its strength, over the ratio of strength and shear modulus.
const LIMIT_STRAIN_RATIO: f64 = 200.0;
/// Bytes of an element and its nodes.
const BYTES_PER_ELEMENT: f64 = 900.0;

/// Strength of clay at a depth (m), Pa.
type StrengthProfile = Arc<dyn Fn(f64) -> f64 + Send + Sync>;

/// Box of soil around a foundation at the surface, as finite elements that may yield.
///
/// The box begins at rest ([`Mesh::with_stress_at_rest`]) and fills a trench, to which it is bonded. The foundation stands on
/// the nodes under it ([`foundation_nodes`](NearField::foundation_nodes)) by a joint
/// ([`Joint::around_nodes`](crate::coupled::Joint::around_nodes)), or is welded to them.
/// [`ground`](NearField::ground) is the soil around the box, which stays linear.
///
/// | default | value |
/// |---|---|
/// | half width and depth of the box | 2 b and b, b half the width of the foundation |
/// | elements | `Quad8`, 6 under the foundation; short ones at both its ends, lines at the boundaries of layers |
/// | contact elements of the trench | as many as elements of the mean length under the foundation, 12 of the base and 4 of each wall |
/// | soil | elastic, with the constants of the profile, or [clay](NearField::with_strength_profile) |
/// | K₀ | ν/(1 − ν) of each soil |
///
/// On elastic soil, beside the half-plane (b = 6 m, shear waves of 200 m/s, ν = ⅓, Ricker's wavelet of 2 Hz): the top of a
/// welded block 8 m high moves within 0.2 % of its largest motion, its lower corner moves up within 1 %, and a block 24 m high
/// that lifts off rotates within 0.9 %. Without a foundation all nodes move with the free field within 0.5 %. A foundation on
/// clay with a safety of 2.6 settles within 1 % as with twice as many elements.
///
/// Elements must be shorter than an eighth of the shortest wave of interest. They have no viscous damping, whatever that of
/// the profile: see [`FemModel::with_rayleigh`](crate::structure::FemModel::with_rayleigh).
///
/// ```
/// use basemat::Soil;
/// use basemat::bem::embedded::NearField;
/// use basemat::structure::FemModel;
///
/// let clay = Soil::from_shear_wave_speed(150.0, 0.45, 1800.0)?;
/// // A foundation 6 m wide on clay of 40 kPa, and 2 kPa more for each metre of depth.
/// let near_field = NearField::new(clay, 3.0)?.with_strength_profile(|depth| 40.0e3 + 2.0e3 * depth);
/// let mesh = near_field.mesh()?;
/// assert_eq!(mesh.elements().len(), 14 * 4);
/// assert_eq!(near_field.ground()?.trench_elements().elements().len(), 12 + 2 * 4);
/// let model = FemModel::on_soil_at_rest(mesh)?;
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Clone)]
pub struct NearField {
    profile: SoilProfile,
    /// Half the width of the foundation, m.
    foundation_half_width: f64,
    /// Half width and depth of the box, m.
    half_width: f64,
    depth: f64,
    foundation_elements: usize,
    gravity: f64,
    /// K₀; `None`: ν/(1 − ν) of each soil.
    ratio: Option<f64>,
    strength: Option<StrengthProfile>,
}

short_debug! {
    NearField; self; profile: self.profile, foundation_half_width: self.foundation_half_width,
    half_width: self.half_width, depth: self.depth, foundation_elements: self.foundation_elements
}

impl NearField {
    /// Box around a foundation between x = −`half_width` and `half_width`, m, on soil of `profile`.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a half width that is not finite and above zero.
    pub fn new(profile: impl Into<SoilProfile>, half_width: f64) -> Result<Self> {
        let foundation_half_width = positive("half width of the foundation", half_width)?;
        Ok(Self {
            profile: profile.into(),
            foundation_half_width,
            half_width: WIDTH_RATIO * foundation_half_width,
            depth: DEPTH_RATIO * foundation_half_width,
            foundation_elements: FOUNDATION_ELEMENTS,
            gravity: crate::motion::STANDARD_GRAVITY,
            ratio: None,
            strength: None,
        })
    }

    /// Replaces half width and depth of the box, m.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the half width is above that of the foundation, the depth above zero, and
    /// both finite.
    pub fn with_size(self, half_width: f64, depth: f64) -> Result<Self> {
        let is_wider = half_width.is_finite() && half_width > self.foundation_half_width;
        require("half width of the box", half_width, is_wider, "above that of the foundation")?;
        Ok(Self { half_width, depth: positive("depth of the box", depth)?, ..self })
    }

    /// Replaces the number of elements under the foundation, an even number.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for zero or an odd number.
    pub fn with_foundation_elements(self, count: usize) -> Result<Self> {
        let is_even = count > 0 && count.is_multiple_of(2);
        require("elements under the foundation", count as f64, is_even, "even and above zero")?;
        Ok(Self { foundation_elements: count, ..self })
    }

    /// Replaces gravity (m/s²) and K₀, the ratio of horizontal to vertical pressure at rest.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless gravity is above zero, the ratio not negative, and both finite.
    pub fn with_pressure_at_rest(self, gravity: f64, ratio: f64) -> Result<Self> {
        positive("gravity", gravity)?;
        let ratio = not_negative("pressure at rest over the vertical pressure", ratio)?;
        Ok(Self { gravity, ratio: Some(ratio), ..self })
    }

    /// Makes the soil clay without drainage, with this strength s_u (Pa) at a depth (m).
    ///
    /// The elements are [`Iwan::hyperbolic`] with the shear modulus G, Poisson's ratio and density of the profile, and the
    /// strength in the middle of their height, reached at a strain of 200 s_u/G.
    #[must_use]
    pub fn with_strength_profile(
        self,
        strength: impl Fn(f64) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self { strength: Some(Arc::new(strength)), ..self }
    }

    /// Mesh of the box at rest, whose surface has nodes at both ends of the foundation.
    ///
    /// # Errors
    /// [`Error::Item`](crate::Error::Item) with the element for a strength that its material cannot have, or that is below
    /// the stress at rest; [`Error::Input`](crate::Error::Input) for a box deeper than rigid bedrock;
    /// [`Error::Memory`](crate::Error::Memory) for too many elements; [`Error::Size`](crate::Error::Size) for rigid bedrock
    /// without layers.
    pub fn mesh(&self) -> Result<Mesh> {
        let x_lines = self.x_lines()?;
        let y_lines = self.y_lines()?;
        let mut materials = Vec::with_capacity(y_lines.len());
        for heights in y_lines.windows(2) {
            let depth = -0.5 * (heights[0] + heights[1]);
            let material = self
                .material(depth)
                .map_err(|fault| fault.within(format!("soil at a depth of {depth:.3} m")))?;
            materials.push(material);
        }
        let stress = self.profile.stress_at_rest(self.gravity, self.ratio)?;
        Mesh::quad8_block(&x_lines, &y_lines, |_, row| materials[row].clone())?
            .with_stress_at_rest(&stress)
    }

    /// Nodes of the surface under the foundation, from left to right, in a mesh that begins with [`mesh`](Self::mesh).
    ///
    /// Every second node is a corner of elements, beginning with the first one. A welded foundation has these nodes in
    /// common with the soil; a [`Joint`](crate::coupled::Joint) takes them as its lower side.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) for a mesh with another number of nodes there.
    pub fn foundation_nodes(&self, mesh: &Mesh) -> Result<Vec<usize>> {
        let mut nodes = mesh.nodes_at_height(0.0, 0.0)?;
        nodes.retain(|node| mesh.nodes()[*node][0].abs() <= self.foundation_half_width);
        let needed = 2 * self.foundation_elements + 1;
        same_length("list of nodes of the surface under the foundation", nodes.len(), needed)?;
        Ok(nodes)
    }

    /// The soil around the box.
    ///
    /// # Errors
    /// As for [`TrenchGround::new`]; [`Error::Memory`](crate::Error::Memory) for too many contact elements.
    pub fn ground(&self) -> Result<TrenchGround> {
        let trench = Trench::new(-self.half_width..self.half_width, self.depth)?;
        let half_base_count = self.contact_count(self.half_width)?;
        let wall_count = self.contact_count(self.depth)?;
        let elements = trench.elements(2 * half_base_count, wall_count)?;
        TrenchGround::new(self.profile.clone(), elements)
    }

    /// Number of contact elements on a length of the trench, m.
    fn contact_count(&self, length: f64) -> Result<usize> {
        let element_length = 2.0 * self.foundation_half_width / self.foundation_elements as f64;
        let count = (CONTACTS_PER_ELEMENT * length / element_length).round();
        memory::check("contact elements of a trench", count, BYTES_PER_ELEMENT * count)?;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
        let count = count as usize;
        Ok(count.max(MIN_WALL_CONTACTS))
    }

    fn box_lines(&self) -> BoxLines {
        BoxLines { half_width: self.foundation_half_width, element_count: self.foundation_elements }
    }

    /// Vertical lines of the mesh, x in m.
    fn x_lines(&self) -> Result<Vec<f64>> {
        let lines = self.box_lines();
        let side_count = lines.line_bound(self.half_width - self.foundation_half_width, 1);
        let column_count = self.foundation_elements as f64 + 2.0 * side_count;
        let row_count = lines.line_bound(self.depth, self.profile.layers().len() + 1);
        let element_count = column_count * row_count;
        memory::check("elements of the box", element_count, BYTES_PER_ELEMENT * element_count)?;
        Ok(lines.x_lines(self.half_width))
    }

    /// Horizontal lines of the mesh, y in m, from the bottom up.
    fn y_lines(&self) -> Result<Vec<f64>> {
        let mut part_ends = Vec::new();
        let mut top = 0.0;
        for (_, bottom) in self.profile.soils_to() {
            if top < self.depth {
                part_ends.push(bottom.min(self.depth));
            }
            top = bottom;
        }
        let reaches_down = part_ends.last() == Some(&self.depth);
        require(
            "depth of the box",
            self.depth,
            reaches_down,
            "at most the depth of rigid bedrock",
        )?;
        let depths = self.box_lines().distances(&part_ends);
        Ok(depths.iter().rev().map(|depth| -depth).chain([0.0]).collect())
    }

    /// Soil of the profile at a depth, m.
    fn soil_at(&self, depth: f64) -> Option<Soil> {
        self.profile.soils_to().find(|(_, bottom)| depth < *bottom).map(|(soil, _)| soil)
    }

    /// Material at a depth, m.
    fn material(&self, depth: f64) -> Result<SharedMaterial> {
        let quantity = "soil layers on rigid bedrock";
        let soil = self.soil_at(depth).ok_or(Error::Size { quantity, found: 0, needed: 1 })?;
        let shear_modulus = soil.shear_modulus();
        let Some(strength) = &self.strength else {
            let young_modulus = 2.0 * shear_modulus * (1.0 + soil.poisson());
            return Ok(Material::new(young_modulus, soil.poisson(), soil.density())?.into());
        };
        let strength = positive("strength of the soil", strength(depth))?;
        let limit_strain = LIMIT_STRAIN_RATIO * strength / shear_modulus;
        let clay = Iwan::hyperbolic(
            shear_modulus,
            strength,
            limit_strain,
            soil.poisson(),
            soil.density(),
        )?;
        Ok(clay.into())
    }
}
