//! Bearing capacity of shallow foundations (EN 1997-1:2004, Annex D), and their capacity to resist rocking.
//!
//! | symbol | meaning |
//! |---|---|
//! | φ, c, c_u | friction angle and cohesion of drained soil, strength of undrained soil |
//! | γ, q | unit weight of the soil below the base, vertical pressure of the soil beside it |
//! | B′, L′, A′ | shorter and longer effective side, effective area |
//! | V, H | vertical and horizontal load on the base |
//! | N, b, s, i | factors of bearing capacity, of the base's tilt, of its shape, of the load's inclination |

use std::f64::consts::{FRAC_PI_4, PI};

use super::bearing_factors::UNDRAINED_COHESION_FACTOR;
use super::{BearingFactors, SoilStrength};
use crate::error::{Result, finite, not_negative, positive, require};

/// Number of halvings of the interval of an angle: its width is then below rounding.
const ANGLE_HALVINGS: usize = 60;

/// Load on the base of a footing, N; of an endless strip N/m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FootingLoad {
    /// Vertical force V, positive down.
    pub vertical: f64,
    /// Horizontal force along x and along y; signs have no effect.
    pub horizontal: [f64; 2],
}

/// Outline of the base of a footing.
#[derive(Debug, Clone, Copy, PartialEq)]
enum FootingOutline {
    Rectangle,
    Circle,
}

/// Shallow footing whose bearing capacity follows EN 1997-1:2004, Annex D.
///
/// All values are characteristic, without partial factors. Annex D has no factors for depth and for sloping ground;
/// sliding needs a separate check. The pressure can be the bearing pressure of [`Yielding`](crate::interface::Yielding) and
/// [`CyclicYielding`](crate::interface::CyclicYielding).
///
/// ```
/// use basemat::soil::{ShallowFooting, SoilStrength};
/// // Footing of the centrifuge test SSG02_03 on dense sand of 1657 kg/m³; its data base states 814 kPa.
/// let footing = ShallowFooting::rectangle([2.8, 0.65])?;
/// let sand = SoilStrength::new(42.0_f64.to_radians())?;
/// let pressure = footing.drained_pressure(&sand, 1657.0 * 9.81)?;
/// assert!((pressure - 746.8e3).abs() < 0.1e3);
/// // Under 285 kN the footing rocks on a fifth of its base.
/// let capacity = footing.rocking_capacity(285.0e3, 814.0e3)?;
/// assert!((capacity.contact_ratio - 0.192).abs() < 5e-4);
/// assert!((capacity.moments[0] - 322.3e3).abs() < 0.1e3);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShallowFooting {
    outline: FootingOutline,
    /// Sides along x and y, m; infinite along an endless strip.
    sides: [f64; 2],
    /// Eccentricities of the load along x and y, m.
    eccentricity: [f64; 2],
    load: FootingLoad,
    /// Vertical pressure of the soil beside the base, Pa.
    surcharge: f64,
    /// Tilt of the base against the horizontal, rad.
    tilt: f64,
}

/// Capacity of a footing to resist rocking.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct RockingCapacity {
    /// Critical contact area over the area of the base, A_c/A = V/(q A).
    pub contact_ratio: f64,
    /// Moments about the middle of the base that make it rock along x and along y, N·m; of a strip N·m/m.
    ///
    /// Infinite along an endless strip.
    pub moments: [f64; 2],
}

/// Products of the factors of tilt, shape and inclination, for each of the [`BearingFactors`].
struct FactorProducts {
    cohesion: f64,
    surcharge: f64,
    unit_weight: f64,
}

impl ShallowFooting {
    /// Rectangle with sides along x and y, m.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless both are finite and above zero.
    pub fn rectangle(sides: [f64; 2]) -> Result<Self> {
        positive("side of a footing along x", sides[0])?;
        positive("side of a footing along y", sides[1])?;
        Ok(Self::of_outline(FootingOutline::Rectangle, sides))
    }

    /// Square with a side, m.
    ///
    /// # Errors
    /// As for [`rectangle`](ShallowFooting::rectangle).
    pub fn square(side: f64) -> Result<Self> {
        Self::rectangle([side; 2])
    }

    /// Circle with a diameter, m.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is finite and above zero.
    pub fn circle(diameter: f64) -> Result<Self> {
        positive("diameter of a footing", diameter)?;
        Ok(Self::of_outline(FootingOutline::Circle, [diameter; 2]))
    }

    /// Strip with a width along x (m), endless along y; its loads are per metre.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is finite and above zero.
    pub fn strip(width: f64) -> Result<Self> {
        positive("width of a strip footing", width)?;
        Ok(Self::of_outline(FootingOutline::Rectangle, [width, f64::INFINITY]))
    }

    fn of_outline(outline: FootingOutline, sides: [f64; 2]) -> Self {
        let load = FootingLoad { vertical: 0.0, horizontal: [0.0; 2] };
        Self { outline, sides, eccentricity: [0.0; 2], load, surcharge: 0.0, tilt: 0.0 }
    }

    /// Sets the vertical pressure q of the soil beside the base at its level, Pa: unit weight times depth.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is finite and not negative.
    pub fn with_surcharge(self, surcharge: f64) -> Result<Self> {
        let surcharge = not_negative("pressure of the soil beside a footing", surcharge)?;
        Ok(Self { surcharge, ..self })
    }

    /// Sets the eccentricities of the load along x and y (m): effective sides B − 2|e|.
    ///
    /// Annex D states no effective area of a circle, whose load must be in its middle.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for an eccentricity of half a side or more, any of a circle, and numbers
    /// that are not finite.
    pub fn with_eccentricity(self, eccentricity: [f64; 2]) -> Result<Self> {
        for (e, side) in eccentricity.into_iter().zip(self.sides) {
            finite("eccentricity of the load on a footing", e)?;
            let (is_allowed, needed) = match self.outline {
                FootingOutline::Rectangle => (2.0 * e.abs() < side, "below half of the side"),
                FootingOutline::Circle => (e == 0.0, "zero on a circle"),
            };
            require("eccentricity of the load on a footing", e, is_allowed, needed)?;
        }
        Ok(Self { eccentricity, ..self })
    }

    /// Sets the load, whose inclination reduces the capacity; default: vertical.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a vertical force below zero and numbers that are not finite.
    pub fn with_load(self, load: FootingLoad) -> Result<Self> {
        not_negative("vertical force on a footing", load.vertical)?;
        finite("horizontal force on a footing along x", load.horizontal[0])?;
        finite("horizontal force on a footing along y", load.horizontal[1])?;
        Ok(Self { load, ..self })
    }

    /// Sets the tilt of the base against the horizontal, rad.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a tilt below zero or above π/4.
    pub fn with_base_tilt(self, tilt: f64) -> Result<Self> {
        let is_allowed = (0.0..=FRAC_PI_4).contains(&tilt);
        require("tilt of the base of a footing (rad)", tilt, is_allowed, "from 0 to π/4")?;
        Ok(Self { tilt, ..self })
    }

    /// Effective sides along x and y, m.
    pub fn effective_sides(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.sides[axis] - 2.0 * self.eccentricity[axis].abs())
    }

    /// Effective area A′, m²; of a strip its effective width, m²/m.
    pub fn effective_area(&self) -> f64 {
        area(self.outline, self.effective_sides())
    }

    /// Bearing pressure of drained soil on the effective area, Pa.
    ///
    /// c N_c b_c s_c i_c + q N_q b_q s_q i_q + ½ γ B′ N_γ b_γ s_γ i_γ (EN 1997-1:2004, eq. D.2). `unit_weight` γ of the
    /// soil below the base, N/m³; below the water table the effective one. The strength's wall friction has no effect.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a friction angle of zero (see
    /// [`undrained_pressure`](ShallowFooting::undrained_pressure)), a unit weight below zero, a horizontal force of
    /// V + A′ c cot φ and more, and a pressure that is not above zero.
    pub fn drained_pressure(&self, strength: &SoilStrength, unit_weight: f64) -> Result<f64> {
        not_negative("unit weight of the soil", unit_weight)?;
        let factors = BearingFactors::of(strength)?;
        let products = self.drained_products(strength, &factors)?;
        let pressure = strength.cohesion() * factors.cohesion * products.cohesion
            + self.surcharge * factors.surcharge * products.surcharge
            + 0.5 * unit_weight * self.shorter_side() * factors.unit_weight * products.unit_weight;
        positive("bearing pressure of drained soil", pressure)
    }

    /// Increase of the drained bearing pressure with depth as the base settles, Pa/m.
    ///
    /// The increase is γ N_q b_q s_q i_q, because the pressure of the soil beside the base grows by γ times the settlement.
    /// Without the factors of tilt, shape and inclination it is γ N_q.
    ///
    /// ```
    /// use basemat::soil::{ShallowFooting, SoilStrength};
    /// let sand = SoilStrength::new(42.0_f64.to_radians())?;
    /// let growth = ShallowFooting::strip(0.65)?.pressure_growth(&sand, 1657.0 * 9.81)?;
    /// assert!((growth - 1.388e6).abs() < 1e3);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`drained_pressure`](ShallowFooting::drained_pressure).
    pub fn pressure_growth(&self, strength: &SoilStrength, unit_weight: f64) -> Result<f64> {
        not_negative("unit weight of the soil", unit_weight)?;
        let factors = BearingFactors::of(strength)?;
        let products = self.drained_products(strength, &factors)?;
        Ok(unit_weight * factors.surcharge * products.surcharge)
    }

    /// Bearing pressure of undrained soil of strength c_u (Pa) on the effective area, Pa.
    ///
    /// (π + 2) c_u b_c s_c i_c + q (EN 1997-1:2004, eq. D.1).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the strength is finite and above zero, and for a horizontal force
    /// above A′ c_u.
    pub fn undrained_pressure(&self, undrained_strength: f64) -> Result<f64> {
        positive("undrained strength of the soil", undrained_strength)?;
        let horizontal = self.horizontal_force();
        let mobilization = horizontal / (self.effective_area() * undrained_strength);
        let needed = "at most the effective area times the undrained strength";
        require("horizontal force on a footing", horizontal, mobilization <= 1.0, needed)?;
        let tilt_factor = 1.0 - 2.0 * self.tilt / UNDRAINED_COHESION_FACTOR;
        let shape_factor = 1.0 + 0.2 * self.side_ratio();
        let inclination_factor = 0.5 * (1.0 + (1.0 - mobilization).sqrt());
        let pressure = UNDRAINED_COHESION_FACTOR
            * undrained_strength
            * tilt_factor
            * shape_factor
            * inclination_factor;
        positive("bearing pressure of undrained soil", pressure + self.surcharge)
    }

    /// Capacity of the footing to resist rocking under a `vertical` force (N; of a strip N/m).
    ///
    /// The force is resisted by the bearing pressure q (Pa) on the critical contact area A_c at the edge, so that
    /// the moment of a rectangle of length L is (V L/2)(1 − A_c/A) (Gajan and Kutter, Journal of Geotechnical and
    /// Geoenvironmental Engineering 134 (2008), 1129–1141); for a circle A_c is a segment. Eccentricity and
    /// inclination of the footing's load have no effect.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless both are finite and above zero, and for a force above q A.
    pub fn rocking_capacity(
        &self,
        vertical: f64,
        bearing_pressure: f64,
    ) -> Result<RockingCapacity> {
        positive("vertical force on a footing", vertical)?;
        positive("bearing pressure", bearing_pressure)?;
        let contact_ratio = vertical / bearing_pressure / area(self.outline, self.sides);
        let needed = "at most the bearing pressure times the area of the base";
        require("vertical force on a footing", vertical, contact_ratio <= 1.0, needed)?;
        let arms = match self.outline {
            // An infinite side times zero would be NaN.
            FootingOutline::Rectangle if contact_ratio == 1.0 => [0.0; 2],
            FootingOutline::Rectangle => self.sides.map(|side| 0.5 * side * (1.0 - contact_ratio)),
            FootingOutline::Circle => [0.5 * self.sides[0] * segment_arm(contact_ratio); 2],
        };
        Ok(RockingCapacity { contact_ratio, moments: arms.map(|arm| vertical * arm) })
    }

    /// Products of the factors b, s and i of drained soil (EN 1997-1:2004, D.4).
    fn drained_products(
        &self,
        strength: &SoilStrength,
        factors: &BearingFactors,
    ) -> Result<FactorProducts> {
        let angle = strength.friction_angle();
        let needed = "above 0; `undrained_pressure` is for undrained soil";
        require("friction angle of drained soil (rad)", angle, angle > 0.0, needed)?;
        let friction_slope = angle.tan();
        // N_q − 1 = N_c tan φ.
        let surcharge_minus_one = factors.cohesion * friction_slope;

        let tilt_reduction = self.tilt * friction_slope;
        let quantity = "tilt of the base of a footing (rad)";
        require(quantity, self.tilt, tilt_reduction < 1.0, "below cot φ of the drained soil")?;
        let tilt_factor = (1.0 - tilt_reduction).powi(2);
        // 1 − b_q without loss of digits.
        let cohesion_tilt =
            tilt_factor - tilt_reduction * (2.0 - tilt_reduction) / surcharge_minus_one;

        let side_ratio = self.side_ratio();
        let surcharge_shape = 1.0 + side_ratio * angle.sin();
        // (s_q N_q − 1)/(N_q − 1) without loss of digits.
        let cohesion_shape =
            1.0 + side_ratio * angle.sin() * factors.surcharge / surcharge_minus_one;
        let unit_weight_shape = 1.0 - 0.3 * side_ratio;

        let horizontal = self.horizontal_force();
        let mobilization = self.mobilization(strength, horizontal)?;
        // i_q − 1 = (1 − H/(V + A′ c cot φ))^m − 1 without loss of digits.
        let inclination_change = (self.inclination_exponent() * (-mobilization).ln_1p()).exp_m1();
        let inclination = 1.0 + inclination_change;
        let cohesion_inclination = inclination + inclination_change / surcharge_minus_one;
        Ok(FactorProducts {
            cohesion: cohesion_tilt * cohesion_shape * cohesion_inclination,
            surcharge: tilt_factor * surcharge_shape * inclination,
            unit_weight: tilt_factor * unit_weight_shape * inclination * (1.0 - mobilization),
        })
    }

    /// Horizontal force over its drained resistance, H/(V + A′ c cot φ).
    fn mobilization(&self, strength: &SoilStrength, horizontal: f64) -> Result<f64> {
        if horizontal == 0.0 {
            return Ok(0.0);
        }
        let slope = strength.friction_angle().tan();
        let resistance = self.load.vertical + self.effective_area() * strength.cohesion() / slope;
        let needed = "below the vertical force + effective area × cohesion × cot φ";
        require("horizontal force on a footing", horizontal, horizontal < resistance, needed)?;
        Ok(horizontal / resistance)
    }

    /// Exponent m of the inclination factors: m_B for a load along B′, m_L along L′, and values in between.
    fn inclination_exponent(&self) -> f64 {
        let side_ratio = self.side_ratio();
        let shorter_side_exponent = (2.0 + side_ratio) / (1.0 + side_ratio);
        let longer_side_exponent = (1.0 + 2.0 * side_ratio) / (1.0 + side_ratio);
        let [x, y] = self.effective_sides();
        let [x_force, y_force] = self.load.horizontal;
        let [shorter_side_force, longer_side_force] =
            if x <= y { [x_force, y_force] } else { [y_force, x_force] };
        // Angle θ between the force and L′; without a force the exponent has no effect.
        let force_angle = shorter_side_force.atan2(longer_side_force);
        shorter_side_exponent * force_angle.sin().powi(2)
            + longer_side_exponent * force_angle.cos().powi(2)
    }

    fn horizontal_force(&self) -> f64 {
        self.load.horizontal[0].hypot(self.load.horizontal[1])
    }

    fn shorter_side(&self) -> f64 {
        let sides = self.effective_sides();
        sides[0].min(sides[1])
    }

    /// B′/L′: zero for a strip, one for a square and a circle.
    fn side_ratio(&self) -> f64 {
        let sides = self.effective_sides();
        sides[0].min(sides[1]) / sides[0].max(sides[1])
    }
}

/// Area of an outline, m²; of a strip per metre.
fn area(outline: FootingOutline, [x, y]: [f64; 2]) -> f64 {
    match outline {
        FootingOutline::Circle => FRAC_PI_4 * x * x,
        FootingOutline::Rectangle if y == f64::INFINITY => x,
        FootingOutline::Rectangle => x * y,
    }
}

/// Distance of the centroid of a circle's segment from the middle, over the radius.
///
/// `area_ratio`: area of the segment over the area of the circle, above 0 and at most 1.
fn segment_arm(area_ratio: f64) -> f64 {
    // Half the angle of the segment: α − sin α cos α = π `area_ratio`.
    let mut min_angle = 0.0;
    let mut max_angle = PI;
    for _ in 0..ANGLE_HALVINGS {
        let angle = 0.5 * (min_angle + max_angle);
        if angle - angle.sin() * angle.cos() < PI * area_ratio {
            min_angle = angle;
        } else {
            max_angle = angle;
        }
    }
    min_angle.sin().powi(3) / (1.5 * PI * area_ratio)
}
