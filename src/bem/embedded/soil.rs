//! Soil around a trench, and its compliance at one Laplace variable.

use basemat_fourier::num_complex::Complex64;

use super::compliance::{Bottom, HalfCompliances, TrenchModel};
use super::forms::Moduli;
use super::free_field::{FieldOverPiece, ProfilePiece, VerticalField};
use super::grid::{GridLayer, TrenchGrid, WallInterval};
use super::mesh::MeshPlans;
use super::trench::TrenchElements;
use crate::error::{GroundError, Result, positive, require};
use crate::linalg::Complex;
use crate::soil::{Bedrock, Relaxation, Soil, SoilProfile};

/// Profile, contact elements and backfill around a trench.
#[derive(Debug, Clone)]
pub(super) struct TrenchSoil {
    profile: SoilProfile,
    elements: TrenchElements,
    backfill: Option<Backfill>,
    grid: TrenchGrid,
    plans: MeshPlans,
}

/// Soil that fills the space beside the walls.
#[derive(Debug, Clone)]
struct Backfill {
    /// Width, m.
    width: f64,
    /// Half-plane of the soil, with its damping law.
    profile: SoilProfile,
}

/// Smallest degree of the elements of the near field.
const MIN_NEAR_FIELD_DEGREE: usize = 4;
/// Largest degree of the elements of the near field.
const MAX_NEAR_FIELD_DEGREE: usize = 12;
/// Longest element of the near field, divided by its degree, in c/|s|.
///
/// Below, c is a speed of shear waves and b half of the width of the trench.
const LENGTH_PER_DEGREE: f64 = 0.75;
/// Largest phase over a contact element, rad: a quarter of a shear wave.
const MAX_CONTACT_PHASE: f64 = 0.25 * std::f64::consts::TAU;
/// Longest interval of the near field in the slowest soil, in half widths.
const MAX_NEAR_INTERVAL_RATIO: f64 = 0.5;
/// Smallest depth of the stretched elements, in c/|s| of shear waves.
const MIN_BOTTOM_DEPTH: f64 = 24.0;
/// Smallest depth of the stretched elements, in c/|s| of pressure waves.
const MIN_PRESSURE_WAVE_DEPTH: f64 = 15.0;
/// Ratio of two depths that are compared.
const BOTTOM_DEPTH_GROWTH: f64 = 1.3;
/// Largest depth of the stretched elements, relative to the first one.
const MAX_BOTTOM_DEPTH_RATIO: f64 = 4.0;
/// Largest relative difference between the compliances of two depths.
const DEPTH_CHANGE_TOLERANCE: f64 = 1e-6;
/// Largest Re s b/c for which depths are compared under undamped layers.
const MAX_COMPARED_DECAY: f64 = 1e-2;
/// Smallest 2ξ of damped layers, for which no comparison is needed.
const MIN_LOSS_RATIO: f64 = 4e-3;
/// Laplace variable in place of zero on a half-plane, in c/b.
const STATIC_LAPLACE_RATIO: f64 = 1e-4;
/// Largest distance between an interface and an element's end that counts as rounding.
///
/// In half widths of the trench.
const INTERFACE_TOLERANCE: f64 = 1e-6;

/// Degree and stretched elements for Laplace variables near iω.
pub(super) struct TrenchMesh {
    degree: usize,
    bottom: Bottom,
}

/// Mesh that is deep enough at a Laplace variable.
pub(super) struct ChosenMesh {
    pub(super) mesh: TrenchMesh,
    /// Compliances at the Laplace variable, if the choice of the mesh needed them.
    pub(super) compliances: Option<HalfCompliances>,
}

impl TrenchSoil {
    /// Soil of `profile` around a trench with these `elements`.
    ///
    /// # Errors
    /// As for [`TrenchGround::new`](super::TrenchGround::new).
    pub(super) fn new(profile: SoilProfile, elements: TrenchElements) -> Result<Self> {
        profile.check()?;
        let depth = elements.trench().depth();
        let is_above_bedrock = !matches!(profile.bedrock(), Bedrock::Rigid)
            || depth + INTERFACE_TOLERANCE * elements.trench().half_width() < profile.depth();
        require("depth of a trench", depth, is_above_bedrock, "above rigid bedrock")?;
        let grid = trench_grid(&profile, &elements, 0.0);
        Ok(Self { profile, elements, backfill: None, grid, plans: MeshPlans::default() })
    }

    /// Replaces the soil beside the walls by backfill of a `width`, m.
    ///
    /// The backfill reaches from the surface to the base.
    ///
    /// # Errors
    /// As for [`TrenchGround::with_backfill`](super::TrenchGround::with_backfill).
    pub(super) fn with_backfill(
        mut self,
        width: f64,
        soil: Soil,
        damping: impl Relaxation + 'static,
    ) -> Result<Self> {
        positive("width of the backfill", width)?;
        self.grid = trench_grid(&self.profile, &self.elements, width);
        self.plans = MeshPlans::default();
        let profile = SoilProfile::on_half_plane(soil).with_bedrock_damping(damping);
        self.backfill = Some(Backfill { width, profile });
        Ok(self)
    }

    /// The same soil with each contact element divided into two.
    pub(super) fn halved(&self) -> Self {
        let width = self.backfill.as_ref().map_or(0.0, |backfill| backfill.width);
        let elements = self.elements.halved();
        let grid = trench_grid(&self.profile, &elements, width);
        Self { grid, plans: MeshPlans::default(), elements, ..self.clone() }
    }

    /// Soil beside and below the trench.
    pub(super) fn profile(&self) -> &SoilProfile {
        &self.profile
    }

    /// Contact elements of the trench.
    pub(super) fn elements(&self) -> &TrenchElements {
        &self.elements
    }

    /// Soil of the backfill, if there is any.
    pub(super) fn backfill_soil(&self) -> Option<Soil> {
        self.backfill.as_ref().and_then(|backfill| backfill.profile.surface())
    }

    /// Soils from the surface down, and the backfill.
    pub(super) fn soils(&self) -> impl Iterator<Item = Soil> {
        let fill = self.backfill.iter().flat_map(|backfill| backfill.profile.soils());
        self.profile.soils().chain(fill).map(|(soil, _)| soil)
    }

    /// Returns an error if a damping law is not causal.
    pub(super) fn check_causal(&self) -> Result<()> {
        self.profile.check_causal()?;
        self.backfill.iter().try_for_each(|backfill| backfill.profile.check_causal())
    }

    /// Numbers that identify soils and backfill; `None` if a damping law has no identity.
    pub(super) fn identity(&self) -> Option<Vec<f64>> {
        let mut identity = self.profile.identity()?;
        if let Some(Backfill { width, profile }) = &self.backfill {
            identity.push(*width);
            identity.extend(profile.identity()?);
        }
        Some(identity)
    }

    /// Elastic constants of all soils at `s`, with the inertia at the Laplace variable `inertia_s`.
    fn moduli(&self, s: Complex, inertia_s: Complex) -> Result<Vec<Moduli>> {
        let mut shear_moduli = vec![];
        self.profile.moduli(s, &mut shear_moduli)?;
        if let Some(backfill) = &self.backfill {
            let mut fill_moduli = vec![];
            backfill.profile.moduli(s, &mut fill_moduli)?;
            shear_moduli.extend(fill_moduli);
        }
        let inertia_s_squared = inertia_s.to_complex64() * inertia_s.to_complex64();
        let mut moduli = Vec::with_capacity(shear_moduli.len());
        for (modulus, soil) in shear_moduli.iter().zip(self.soils()) {
            let shear = modulus.to_complex64();
            let lame = shear * (2.0 * soil.poisson() / (1.0 - 2.0 * soil.poisson()));
            moduli.push(Moduli { shear, lame, inertia: inertia_s_squared * soil.density() });
        }
        Ok(moduli)
    }

    /// Mesh for Laplace variables near `s`.
    ///
    /// The result contains the compliances at `s` if the choice needed them.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a frequency that the elements do not resolve; as for
    /// [`TrenchSoil::mesh_of_degree`].
    pub(super) fn mesh(&self, s: Complex) -> Result<ChosenMesh> {
        let half_width = self.elements.trench().half_width();
        let speeds: Vec<f64> = self.soils().map(|soil| soil.shear_wave_speed()).collect();
        let min_speed = speeds.iter().copied().fold(f64::INFINITY, f64::min);
        let interval_phase = MAX_NEAR_INTERVAL_RATIO * half_width * s.im / min_speed;
        let degree = (MIN_NEAR_FIELD_DEGREE..=MAX_NEAR_FIELD_DEGREE)
            .find(|degree| interval_phase <= LENGTH_PER_DEGREE * *degree as f64);
        let contact_phase = s.im * self.grid.max_crossing_time(&speeds);
        let is_resolved = degree.is_some() && contact_phase <= MAX_CONTACT_PHASE;
        let frequency = s.im / std::f64::consts::TAU;
        let needed = "low enough for four contact elements in a shear wave, and at most five waves in the width of the trench";
        require("frequency of a trench (Hz)", frequency, is_resolved, needed)?;
        self.mesh_of_degree(s, degree.unwrap_or(MAX_NEAR_FIELD_DEGREE))
    }

    /// Mesh of a `degree` that is deep enough at `s`.
    ///
    /// The result contains the compliances at `s` if the choice needed them.
    ///
    /// # Errors
    /// [`GroundError::GuidedWave`]; as for [`SoilProfile::moduli`].
    pub(super) fn mesh_of_degree(&self, s: Complex, degree: usize) -> Result<ChosenMesh> {
        let first_depth = self.first_bottom_depth();
        let mut mesh = self.mesh_of_depth(s, first_depth, degree);
        if !self.needs_comparison(s)? {
            return Ok(ChosenMesh { mesh, compliances: None });
        }
        let mut depth = first_depth;
        let mut compliances = self.compliances(s, &mesh)?;
        loop {
            depth *= BOTTOM_DEPTH_GROWTH;
            if depth > MAX_BOTTOM_DEPTH_RATIO * first_depth {
                return Err(GroundError::GuidedWave { re: s.re, im: s.im }.into());
            }
            let deeper_mesh = self.mesh_of_depth(s, depth, degree);
            let deeper_compliances = self.compliances(s, &deeper_mesh)?;
            if compliances.difference(&deeper_compliances) < DEPTH_CHANGE_TOLERANCE {
                return Ok(ChosenMesh { mesh, compliances: Some(compliances) });
            }
            mesh = deeper_mesh;
            compliances = deeper_compliances;
        }
    }

    /// First depth of the stretched elements, in c/|s| of shear waves.
    fn first_bottom_depth(&self) -> f64 {
        let Bedrock::HalfPlane { soil, .. } = self.profile.bedrock() else {
            return MIN_BOTTOM_DEPTH;
        };
        let speed_ratio = soil.pressure_wave_speed() / soil.shear_wave_speed();
        MIN_BOTTOM_DEPTH.max(MIN_PRESSURE_WAVE_DEPTH * speed_ratio)
    }

    /// Mesh for Laplace variables near `s`, with stretched elements down to a `depth`.
    ///
    /// `depth`: in c/|s| of shear waves. `degree`: of the near field; stretched elements may have a higher degree.
    pub(super) fn mesh_of_depth(&self, s: Complex, depth: f64, degree: usize) -> TrenchMesh {
        let Bedrock::HalfPlane { soil, .. } = self.profile.bedrock() else {
            return TrenchMesh { degree, bottom: Bottom::rigid(degree) };
        };
        let half_width = self.elements.trench().half_width();
        let lowest = self.grid.lower_intervals.last();
        let upper_length = lowest.map_or(half_width, |interval| interval.length);
        let bottom = Bottom::new(s.to_complex64(), upper_length, *soil, depth, degree);
        TrenchMesh { degree, bottom }
    }

    /// Whether a guided wave near its cut-off may need a deeper bottom at `s`.
    fn needs_comparison(&self, s: Complex) -> Result<bool> {
        let half_width = self.elements.trench().half_width();
        let max_speed = self.soils().map(|soil| soil.shear_wave_speed()).fold(0.0, f64::max);
        let has_half_plane = matches!(self.profile.bedrock(), Bedrock::HalfPlane { .. });
        let is_near_axis = s.re * half_width < MAX_COMPARED_DECAY * max_speed;
        Ok(has_half_plane && is_near_axis && self.has_undamped_layers(s)?)
    }

    /// Whether waves in layers have no damping but Re `s`.
    pub(super) fn has_undamped_layers(&self, s: Complex) -> Result<bool> {
        let has_half_plane = matches!(self.profile.bedrock(), Bedrock::HalfPlane { .. });
        let imaginary_s = Complex::new(0.0, s.im);
        let moduli = self.moduli(imaginary_s, imaginary_s)?;
        let layer_count = self.profile.layers().len();
        let is_undamped = moduli[..layer_count + usize::from(has_half_plane)]
            .iter()
            .any(|moduli| moduli.shear.im.abs() < MIN_LOSS_RATIO * moduli.shear.re);
        Ok(layer_count > 0 && is_undamped)
    }

    /// Compliances of the faces at `s`.
    ///
    /// # Errors
    /// [`Error::Singular`](crate::Error::Singular), [`GroundError::GuidedWave`]; as for [`SoilProfile::moduli`].
    pub(super) fn compliances(&self, s: Complex, mesh: &TrenchMesh) -> Result<HalfCompliances> {
        self.compliances_with(s, mesh, &self.moduli(s, s)?)
    }

    /// Compliances of the faces at rest, with long-term moduli.
    ///
    /// On a half-plane they are determined up to rigid translations.
    ///
    /// # Errors
    /// As for [`TrenchSoil::compliances`].
    pub(super) fn static_compliances(&self) -> Result<HalfCompliances> {
        let s = match self.profile.bedrock() {
            Bedrock::HalfPlane { soil, .. } => {
                STATIC_LAPLACE_RATIO * soil.shear_wave_speed() / self.elements.trench().half_width()
            }
            Bedrock::Rigid => 0.0,
        };
        let s = Complex::real(s);
        let mesh = self.mesh_of_depth(s, self.first_bottom_depth(), MIN_NEAR_FIELD_DEGREE);
        self.compliances_with(s, &mesh, &self.moduli(Complex::default(), s)?)
    }

    /// Compliances of the faces at `s` with these elastic constants.
    fn compliances_with(
        &self,
        s: Complex,
        mesh: &TrenchMesh,
        soils: &[Moduli],
    ) -> Result<HalfCompliances> {
        let TrenchMesh { degree, bottom } = mesh;
        TrenchModel { grid: &self.grid, plans: &self.plans, degree: *degree, bottom, soils }
            .compliances()?
            .ok_or_else(|| GroundError::GuidedWave { re: s.re, im: s.im }.into())
    }

    /// Shear and pressure waves that displace the surface by one.
    ///
    /// Lists follow the wall from the surface down. Each pair: shear, pressure.
    pub(super) fn free_field(&self, s: Complex) -> Result<FreeFieldAtFaces> {
        let moduli = self.moduli(s, s)?;
        let zero = VerticalField { displacement: Complex64::ZERO, stress: Complex64::ZERO };
        let mut fields = [VerticalField::AT_SURFACE; 2];
        let element_count = self.grid.wall_element_count();
        let mut wall_integrals = vec![[zero; 2]; element_count];
        let mut side_stress_integrals = vec![Complex64::ZERO; element_count];
        for WallInterval { interval, element } in &self.grid.wall_intervals {
            let Moduli { shear, lame, inertia } = moduli[interval.soil_index];
            let pressure = lame + shear * 2.0;
            for (wave, modulus) in [shear, pressure].into_iter().enumerate() {
                let piece = ProfilePiece { height: interval.length, modulus, inertia };
                let FieldOverPiece { bottom, integrals } = fields[wave].over_piece(piece);
                fields[wave] = bottom;
                wall_integrals[*element][wave].displacement += integrals.displacement;
                wall_integrals[*element][wave].stress += integrals.stress;
                if wave == 1 {
                    side_stress_integrals[*element] += lame / pressure * integrals.stress;
                }
            }
        }
        Ok(FreeFieldAtFaces { wall_integrals, side_stress_integrals, base_fields: fields })
    }
}

/// Vertical waves at the faces of a trench: shear and pressure.
pub(super) struct FreeFieldAtFaces {
    /// Integrals over wall elements: displacement, σ_xz of shear and σ_zz of pressure waves.
    pub(super) wall_integrals: Vec<[VerticalField; 2]>,
    /// Integrals over wall elements of σ_xx of pressure waves.
    pub(super) side_stress_integrals: Vec<Complex64>,
    /// Waves at the depth of the base.
    pub(super) base_fields: [VerticalField; 2],
}

/// Lines of the mesh around `elements` with backfill of a `width`, which may be zero.
fn trench_grid(profile: &SoilProfile, elements: &TrenchElements, width: f64) -> TrenchGrid {
    let half_width = elements.trench().half_width();
    let min_speed = profile
        .soils()
        .map(|(soil, _)| soil.shear_wave_speed())
        .fold(f64::INFINITY, f64::min);
    let mut layers = vec![];
    for (soil, bottom) in profile.soils_to() {
        // An interface near the end of a wall element moves to this end.
        let mut ends = elements.wall_ends().iter();
        let near_end = ends.find(|end| (*end - bottom).abs() < INTERFACE_TOLERANCE * half_width);
        let max_interval =
            MAX_NEAR_INTERVAL_RATIO * half_width * soil.shear_wave_speed() / min_speed;
        layers.push(GridLayer { bottom: near_end.copied().unwrap_or(bottom), max_interval });
    }
    let is_rigid = matches!(profile.bedrock(), Bedrock::Rigid);
    TrenchGrid::new(elements.base_ends(), elements.wall_ends(), &layers, is_rigid, width)
}
