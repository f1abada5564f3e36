//! Soil around a trench, and its compliance at one Laplace variable.

use realfft::num_complex::Complex64;

use super::bottom::Bottom;
use super::compliance::{Halves, Model};
use super::free_field::{Piece, VerticalField};
use super::grid::{Grid, Layer};
use super::stack::Moduli;
use super::trench::TrenchElements;
use crate::error::{GroundError, Result, positive, require};
use crate::linalg::Complex;
use crate::soil::{Bedrock, Relaxation, Soil, SoilProfile};

/// Profile, contact elements and backfill around a trench.
#[derive(Debug, Clone)]
pub(super) struct TrenchSoil {
    profile: SoilProfile,
    elements: TrenchElements,
    /// Width of the backfill, m, and a profile of it alone.
    backfill: Option<(f64, SoilProfile)>,
    grid: Grid,
}

/// Degree of the elements.
const DEGREE: usize = 4;
/// Largest degree.
const HIGHEST: usize = 12;
/// Length of an element of the near field for each degree, in c/|s|.
const PER_DEGREE: f64 = 0.75;
/// Longest contact element, in c/ω: a quarter of a shear wave.
const CONTACT: f64 = 0.25 * std::f64::consts::TAU;
/// Longest interval of the near field in half widths of the trench, for the slowest soil.
const LONGEST: f64 = 0.5;
/// Depth of the stretched elements, in c/|s|, and the factor by which it grows.
const DEPTH: f64 = 24.0;
const DEEPER: f64 = 1.3;
/// Largest depth.
const DEEPEST: f64 = 100.0;
/// Relative difference between the compliances of two depths that does not count.
const SETTLED: f64 = 1e-6;
/// Re s·b/c below which depths of undamped layers are compared.
const NEAR_AXIS: f64 = 1e-2;
/// 2ξ of the least damping with which no comparison is needed.
const DAMPED: f64 = 4e-3;
/// Laplace variable that stands for rest on a half-plane, in c/b.
const SLOW: f64 = 1e-4;
/// Distance between interface and wall element that counts as rounding, in half widths.
const ROUNDING: f64 = 1e-6;

/// Numbers of a model at Laplace variables near iω.
pub(super) struct Mesh {
    degree: usize,
    bottom: Bottom,
}

impl TrenchSoil {
    /// Soil of `profile` around a trench with these `elements`.
    ///
    /// # Errors
    /// As for [`TrenchGround::new`](super::TrenchGround::new).
    pub(super) fn new(profile: SoilProfile, elements: TrenchElements) -> Result<Self> {
        profile.check()?;
        let depth = elements.trench().depth();
        let above = !matches!(profile.bedrock(), Bedrock::Rigid)
            || depth + ROUNDING * elements.trench().half_width() < profile.depth();
        require("depth of a trench", depth, above, "above rigid bedrock")?;
        let grid = grid(&profile, &elements, 0.0);
        Ok(Self { profile, elements, backfill: None, grid })
    }

    /// Fills the soil beside the walls with `soil`, over a `width` in m and from the surface down to the base.
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
        self.grid = grid(&self.profile, &self.elements, width);
        let alone = SoilProfile::on_half_plane(soil).with_bedrock_damping(damping);
        self.backfill = Some((width, alone));
        Ok(self)
    }

    /// The same soil around faces divided into halves of all elements.
    pub(super) fn halved(&self) -> Self {
        let width = self.backfill.as_ref().map_or(0.0, |(width, _)| *width);
        let elements = self.elements.halved();
        Self { grid: grid(&self.profile, &elements, width), elements, ..self.clone() }
    }

    /// Soil beside and below the trench.
    pub(super) fn profile(&self) -> &SoilProfile {
        &self.profile
    }

    /// Contact elements of the trench.
    pub(super) fn elements(&self) -> &TrenchElements {
        &self.elements
    }

    /// Soil of the backfill.
    pub(super) fn fill(&self) -> Option<Soil> {
        self.backfill.as_ref().and_then(|(_, alone)| alone.surface())
    }

    /// Soils from the surface down, and the backfill.
    pub(super) fn soils(&self) -> impl Iterator<Item = Soil> {
        let fill = self.backfill.iter().flat_map(|(_, alone)| alone.soils());
        self.profile.soils().chain(fill).map(|(soil, _)| soil)
    }

    /// Error if a damping law is not causal.
    pub(super) fn check_causal(&self) -> Result<()> {
        self.profile.check_causal()?;
        self.backfill.iter().try_for_each(|(_, alone)| alone.check_causal())
    }

    /// Numbers that tell soils and backfill from others; `None` for a damping law without such numbers.
    pub(super) fn identity(&self) -> Option<Vec<f64>> {
        let mut numbers = self.profile.identity()?;
        if let Some((width, alone)) = &self.backfill {
            numbers.push(*width);
            numbers.extend(alone.identity()?);
        }
        Some(numbers)
    }

    /// Elastic constants at `s`, with the inertia at the Laplace variable `own`.
    fn moduli(&self, s: Complex, own: Complex) -> Result<Vec<Moduli>> {
        let mut shear = vec![];
        let mut fill = vec![];
        self.profile.moduli(s, &mut shear)?;
        if let Some((_, alone)) = &self.backfill {
            alone.moduli(s, &mut fill)?;
        }
        let square = own.inner() * own.inner();
        let all = shear.iter().chain(&fill).zip(self.soils());
        Ok(all
            .map(|(modulus, soil)| {
                let shear = modulus.inner();
                let lame = shear * (2.0 * soil.poisson() / (1.0 - 2.0 * soil.poisson()));
                Moduli { shear, lame, inertia: square * soil.density() }
            })
            .collect())
    }

    /// Mesh for Laplace variables near `s`, and the compliances there if they were needed to find it.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a frequency that the elements do not resolve; as for
    /// [`TrenchSoil::mesh_of_degree`].
    pub(super) fn mesh(&self, s: Complex) -> Result<(Mesh, Option<Halves>)> {
        let size = self.elements.trench().half_width();
        let speeds: Vec<f64> = self.soils().map(|soil| soil.shear_wave_speed()).collect();
        let slowest = speeds.iter().copied().fold(f64::INFINITY, f64::min);
        let crossing = LONGEST * size * s.im / slowest;
        let degree = (DEGREE..=HIGHEST).find(|degree| crossing <= PER_DEGREE * *degree as f64);
        let resolved = degree.is_some() && s.im * self.grid.slowest_crossing(&speeds) <= CONTACT;
        let frequency = s.im / std::f64::consts::TAU;
        let needed = "low enough for four contact elements in a shear wave, and at most five waves in the width of the trench";
        require("frequency of a trench (Hz)", frequency, resolved, needed)?;
        self.mesh_of_degree(s, degree.unwrap_or(HIGHEST))
    }

    /// Mesh of a `degree` that is deep enough at `s`, and the compliances there if they were needed to find it.
    ///
    /// # Errors
    /// [`GroundError::GuidedWave`]; as for [`SoilProfile::moduli`].
    pub(super) fn mesh_of_degree(
        &self,
        s: Complex,
        degree: usize,
    ) -> Result<(Mesh, Option<Halves>)> {
        let mut found = self.mesh_of_depth(s, DEPTH, degree);
        if !self.needs_comparison(s)? {
            return Ok((found, None));
        }
        let mut depth = DEPTH;
        let mut before = self.compliances(s, &found)?;
        loop {
            depth *= DEEPER;
            if depth > DEEPEST {
                return Err(GroundError::GuidedWave { re: s.re, im: s.im }.into());
            }
            let deeper = self.mesh_of_depth(s, depth, degree);
            let after = self.compliances(s, &deeper)?;
            if before.difference(&after) < SETTLED {
                return Ok((found, Some(before)));
            }
            (found, before) = (deeper, after);
        }
    }

    /// Mesh for Laplace variables near `s` with stretched elements to a `depth` in c/|s|, of a `degree` or higher.
    pub(super) fn mesh_of_depth(&self, s: Complex, depth: f64, degree: usize) -> Mesh {
        let Bedrock::HalfPlane { soil, .. } = self.profile.bedrock() else {
            return Mesh { degree, bottom: Bottom::rigid(degree) };
        };
        let size = self.elements.trench().half_width();
        let last = self.grid.below.last().map_or(size, |interval| interval.length);
        let bottom = Bottom::new(s.inner(), last, soil.shear_wave_speed(), depth, degree);
        Mesh { degree, bottom }
    }

    /// Whether a guided wave near its cut-off may need a deeper bottom at `s`.
    fn needs_comparison(&self, s: Complex) -> Result<bool> {
        let size = self.elements.trench().half_width();
        let fastest = self.soils().map(|soil| soil.shear_wave_speed()).fold(0.0, f64::max);
        let open = matches!(self.profile.bedrock(), Bedrock::HalfPlane { .. });
        let near = open && s.re * size < NEAR_AXIS * fastest;
        let place = Complex::new(0.0, s.im);
        let moduli = self.moduli(place, place)?;
        let layers = self.profile.layers().len();
        let damped = |own: &Moduli| own.shear.im.abs() >= DAMPED * own.shear.re;
        Ok(near && layers > 0 && !moduli[..layers + usize::from(open)].iter().all(damped))
    }

    /// Compliances of the faces at `s`.
    ///
    /// # Errors
    /// [`Error::Singular`](crate::Error::Singular), [`GroundError::GuidedWave`]; as for [`SoilProfile::moduli`].
    pub(super) fn compliances(&self, s: Complex, mesh: &Mesh) -> Result<Halves> {
        self.compliances_of(s, mesh, &self.moduli(s, s)?)
    }

    /// Compliances of the faces at rest, with long-term moduli; on a half-plane up to rigid translations.
    ///
    /// # Errors
    /// As for [`TrenchSoil::compliances`].
    pub(super) fn static_compliances(&self) -> Result<Halves> {
        let s = match self.profile.bedrock() {
            Bedrock::HalfPlane { soil, .. } => {
                SLOW * soil.shear_wave_speed() / self.elements.trench().half_width()
            }
            Bedrock::Rigid => 0.0,
        };
        let s = Complex::real(s);
        let mesh = self.mesh_of_depth(s, DEPTH, DEGREE);
        self.compliances_of(s, &mesh, &self.moduli(Complex::default(), s)?)
    }

    fn compliances_of(&self, s: Complex, mesh: &Mesh, soils: &[Moduli]) -> Result<Halves> {
        let Mesh { degree, bottom } = mesh;
        Model { grid: &self.grid, degree: *degree, bottom, soils }
            .compliances()?
            .ok_or_else(|| GroundError::GuidedWave { re: s.re, im: s.im }.into())
    }

    /// Shear and pressure waves that move the surface by one: integrals over each wall element, and values at the base.
    ///
    /// Lists are ordered as [`TrenchElements::wall`], from the surface down. Each pair: shear, pressure.
    pub(super) fn free_field(&self, s: Complex) -> Result<FreeFieldAtFaces> {
        let moduli = self.moduli(s, s)?;
        let zero = VerticalField { displacement: Complex64::ZERO, stress: Complex64::ZERO };
        let mut fields = [VerticalField::SURFACE; 2];
        let mut walls = vec![[zero; 2]; self.grid.walls()];
        let mut ratios = vec![Complex64::ZERO; self.grid.walls()];
        for (interval, element) in &self.grid.wall {
            let Moduli { shear, lame, inertia } = moduli[interval.soil];
            let pressure = lame + shear * 2.0;
            for (wave, modulus) in [shear, pressure].into_iter().enumerate() {
                let piece = Piece { height: interval.length, modulus, inertia };
                let (below, integrals) = fields[wave].below(piece);
                fields[wave] = below;
                walls[*element][wave].displacement += integrals.displacement;
                walls[*element][wave].stress += integrals.stress;
                if wave == 1 {
                    ratios[*element] += lame / pressure * integrals.stress;
                }
            }
        }
        Ok(FreeFieldAtFaces { walls, side_stresses: ratios, base: fields })
    }
}

/// Vertical waves at the faces of a trench: shear and pressure.
pub(super) struct FreeFieldAtFaces {
    /// Integrals over wall elements: displacement, σ_xz of shear and σ_zz of pressure waves.
    pub(super) walls: Vec<[VerticalField; 2]>,
    /// Integrals of σ_xx of pressure waves.
    pub(super) side_stresses: Vec<Complex64>,
    /// At the depth of the base.
    pub(super) base: [VerticalField; 2],
}

/// Lines of the mesh around `elements` with backfill of a `width`, which may be zero.
fn grid(profile: &SoilProfile, elements: &TrenchElements, width: f64) -> Grid {
    let size = elements.trench().half_width();
    let slowest =
        profile.soils().map(|(soil, _)| soil.shear_wave_speed()).fold(f64::INFINITY, f64::min);
    let layer = |(soil, bottom): (Soil, f64)| {
        // An interface beside a line of the wall is this line.
        let line = elements.wall().iter().find(|line| (*line - bottom).abs() < ROUNDING * size);
        let longest = LONGEST * size * soil.shear_wave_speed() / slowest;
        Layer { bottom: line.copied().unwrap_or(bottom), longest }
    };
    let layers: Vec<Layer> = profile.soils_to().map(layer).collect();
    let rigid = matches!(profile.bedrock(), Bedrock::Rigid);
    Grid::new(elements.base(), elements.wall(), &layers, rigid, width)
}
