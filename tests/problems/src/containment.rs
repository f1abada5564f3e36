//! The containment of Patel & Spyrakos: soil, structure and time step, in the paper's units.
//!
//! Contact length and height are calibrated on the first two rows of the paper's Table 1; other data
//! that are not printed are assumed: see docs/paper.md.

use std::ops::Range;

use basemat::Soil;
use basemat::coupled::Probe;
use basemat::fem::{Direction, Layer, Material, Mesh, QuadFormulation};
use basemat::interface::{
    Condition, ContactState, InterfaceLaw, Mode, PlaneLaw, PreviousContact, ThinLayer, Tolerance,
};
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::{DofCombination, FemModel, RayleighDamping, Structure};

pub const METRES_PER_FOOT: f64 = 0.3048;
/// One pound-force per foot, N/m.
pub const POUND_FORCE_PER_FOOT: f64 = 14.593_902_937_206_364;
/// One pound per square foot, Pa.
pub const POUND_PER_SQUARE_FOOT: f64 = 47.880_258_980_335_84;
/// One slug per cubic foot, kg/m³.
pub const SLUG_PER_CUBIC_FOOT: f64 = 515.378_818_393_229_5;

/// Rows of the paper's Table 1 and their friction; `None` is bonded, infinity uplift only.
pub const TABLE_1_ROWS: [(&str, Option<f64>); 5] = [
    ("bonded", None),
    ("uplift only", Some(f64::INFINITY)),
    ("friction 0.4", Some(0.4)),
    ("friction 0.3", Some(0.3)),
    ("friction 0.2", Some(0.2)),
];
/// Peak base shears of these rows. The paper prints them in lb; they are taken as lb/ft.
pub const PAPER_SHEARS: [f64; 5] = [28_970.0, 20_130.0, 10_233.0, 6_415.0, 5_958.0];

/// Parameters of the model; the defaults are printed in the paper, calibrated, or assumed.
#[derive(Debug, Clone, Copy)]
pub struct Containment {
    /// Contact length, ft; calibrated.
    pub width: f64,
    /// Height, ft; calibrated.
    pub height: f64,
    /// Layers of rectangles of equal height; the lowest layer is assumed to be the basemat.
    pub layers: usize,
    /// Elements along the base.
    pub elements: usize,
    pub formulation: QuadFormulation,
    /// Density of the basemat, slug/ft³.
    pub foundation_density: f64,
    /// Damping ratio of the structure at 1 and 10 Hz (Rayleigh).
    pub damping: f64,
    /// Shear and pressure wave speed of the soil, ft/s.
    pub wave_speeds: [f64; 2],
    /// Density of the soil, slug/ft³.
    pub soil_density: f64,
}

impl Default for Containment {
    fn default() -> Self {
        Self {
            width: 34.0,
            height: 80.0,
            layers: 13,
            elements: 10,
            formulation: QuadFormulation::Full,
            foundation_density: 3.043_48,
            damping: 0.0,
            wave_speeds: [650.0, 1300.0],
            soil_density: 3.5,
        }
    }
}

/// Density of the superstructure, slug/ft³.
const SUPERSTRUCTURE_DENSITY: f64 = 0.590_06;

/// A material by Young's modulus (psf) and density (slug/ft³).
fn solid(young_psf: f64, density: f64) -> basemat::Result<Material> {
    Material::new(young_psf * POUND_PER_SQUARE_FOOT, 1.0 / 3.0, density * SLUG_PER_CUBIC_FOOT)
}

impl Containment {
    pub fn soil(&self) -> basemat::Result<Soil> {
        let speeds = self.wave_speeds.map(|speed| speed * METRES_PER_FOOT);
        Soil::from_wave_speeds(speeds[0], speeds[1], self.soil_density * SLUG_PER_CUBIC_FOOT)
    }

    /// The base, m.
    pub fn base(&self) -> Range<f64> {
        let half = 0.5 * self.width * METRES_PER_FOOT;
        -half..half
    }

    /// Height of a layer, m.
    pub fn layer_height(&self) -> f64 {
        self.height * METRES_PER_FOOT / self.layers as f64
    }

    /// Height of all layers but the basemat, m.
    fn superstructure_height(&self) -> f64 {
        self.layer_height() * (self.layers - 1) as f64
    }

    /// Time in which a P wave crosses the fraction `beta` of an element, s; the paper has ½.
    pub fn time_step(&self, beta: f64) -> f64 {
        beta * (self.width / self.elements as f64) / self.wave_speeds[1]
    }

    /// The finite elements.
    pub fn structure(&self) -> basemat::Result<FemModel> {
        let foundation = solid(106_560_369.0, self.foundation_density)?;
        let superstructure = solid(106_577_648.0, SUPERSTRUCTURE_DENSITY)?;
        let layers = [
            Layer::new(self.layer_height(), 1, foundation),
            Layer::new(self.superstructure_height(), self.layers - 1, superstructure),
        ]
        .map(|layer| Layer { formulation: self.formulation, ..layer });
        let mesh = Mesh::layered_block(self.base(), self.elements, &layers)?;
        let model = FemModel::on_base(mesh)?;
        if self.damping > 0.0 {
            let damping = RayleighDamping::from_ratios([1.0, 10.0], [self.damping; 2])?;
            return Ok(model.with_rayleigh(damping));
        }
        Ok(model)
    }

    /// Mass per metre of thickness, kg/m.
    pub fn mass(&self) -> f64 {
        let superstructure = (self.layers - 1) as f64 * SUPERSTRUCTURE_DENSITY;
        let density = (self.foundation_density + superstructure) * SLUG_PER_CUBIC_FOOT;
        self.width * METRES_PER_FOOT * self.layer_height() * density
    }

    /// Mass of the superstructure per metre of thickness, kg/m.
    pub fn superstructure_mass(&self) -> f64 {
        let height = self.superstructure_height();
        self.width * METRES_PER_FOOT * height * SUPERSTRUCTURE_DENSITY * SLUG_PER_CUBIC_FOOT
    }

    /// Weights of the whole structure and of the superstructure per metre of thickness, N/m.
    pub fn weights(&self) -> [f64; 2] {
        [self.mass(), self.superstructure_mass()].map(|mass| STANDARD_GRAVITY * mass)
    }

    /// Mean horizontal motion of the nodes at the foundation's top, as terms of a probe.
    pub fn foundation_top(&self, model: &FemModel) -> basemat::Result<Vec<(usize, f64)>> {
        let node_weight = 1.0 / (self.elements + 1) as f64;
        let Range { start, end } = self.base();
        let mut terms = Vec::new();
        for k in 0..=self.elements {
            let x = start + (end - start) * k as f64 / self.elements as f64;
            let row = model.row(model.mesh().node_at(x, self.layer_height())?, Direction::X)?;
            terms.extend(row.iter().map(|(dof, weight)| (*dof, node_weight * weight)));
        }
        Ok(terms)
    }

    /// The roof's left corner, m, which is assumed to be the paper's location A.
    pub fn corner(&self) -> [f64; 2] {
        [self.base().start, self.layer_height() + self.superstructure_height()]
    }

    /// Probes of the roof and of the base.
    ///
    /// "roof x" and "roof y" are the absolute displacement of location A. "base shear" is the force on the foundation.
    /// "sway" is the horizontal displacement of A relative to the base.
    pub fn probes(&self, model: &FemModel) -> basemat::Result<[Probe; 4]> {
        let corner_point = self.corner();
        let corner = model.mesh().node_at(corner_point[0], corner_point[1])?;
        let x = model.row(corner, Direction::X)?;
        let y = model.row(corner, Direction::Y)?;
        let base_terms: Vec<_> =
            model.base().nodes().flat_map(|node| node.horizontal.to_vec()).collect();
        let term_weight = 1.0 / base_terms.len() as f64;
        let base_terms = base_terms.into_iter().map(|(dof, weight)| (dof, -term_weight * weight));
        let sway: DofCombination = x.iter().copied().chain(base_terms).collect();
        Ok([
            Probe::absolute_displacement("roof x", x),
            Probe::absolute_displacement("roof y", y),
            self.base_shear(model)?,
            Probe::displacement("sway", sway),
        ])
    }

    /// Horizontal force of the superstructure on the foundation, where the paper takes its base
    /// shear.
    pub fn base_shear(&self, model: &FemModel) -> basemat::Result<Probe> {
        Ok(Probe::section("base shear", &model.section(self.layer_height(), 0.0)?.shear))
    }
}

/// Newtons per metre as pounds per foot.
pub fn pounds_per_foot(force: f64) -> f64 {
    force / POUND_FORCE_PER_FOOT
}

/// A thin layer that never opens or slides: the "bonded" case with the paper's interface elements.
pub struct PermanentLayer(pub ThinLayer);

impl PlaneLaw for PermanentLayer {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick]
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        self.0.conditions(mode, start)
    }

    fn next_mode(&self, _: Mode, _: &PreviousContact, _: &ContactState, _: Tolerance) -> Mode {
        Mode::Stick
    }

    fn compliance(&self, mode: Mode, start: &PreviousContact) -> [f64; 2] {
        self.0.compliance(mode, start)
    }
}
