//! Dynamic stiffness and kinematic motion of a rigid body in a trench.
//!
//! F(s) are the compliances of the faces. The columns of A are the resultants of unit tractions, which also describe the
//! rigid motions. Then K = Aᵀ F⁻¹ A. With the displacements u and the tractions t of the free field at the faces (t on
//! the soil), soil that moves by w has the tractions t + F⁻¹(w − u). A body without mass exerts no resultant:
//! K U = Aᵀ (F⁻¹ u − t).

use basemat_fourier::num_complex::Complex64;

use super::compliance::HalfCompliances;
use super::ground::TrenchGround;
use super::soil::{FreeFieldAtFaces, TrenchMesh, TrenchSoil};
use crate::bem::layered::{
    StripImpedance, extrapolated_stiffnesses, impedance_progress, laplace_variables,
};
use crate::error::{Error, GroundError, Observer, Result, require, require_part};
use crate::linalg::{Complex, ComplexBlock, DenseFactor};
use crate::soil::Bedrock;

/// Motion of a rigid body without mass in a trench, e^(iωt), per unit motion of the surface of the free field.
///
/// It is the input motion of the structure: kinematic interaction. Waves travel vertically. x to the right, y down; a
/// positive rotation lowers the right end. Translations are of the middle of the base.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct KinematicMotion {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Horizontal translation per unit horizontal motion of the surface by shear waves.
    pub horizontal: Complex,
    /// Rotation per unit horizontal motion of the surface by shear waves, 1/m.
    pub rotation: Complex,
    /// Vertical translation per unit vertical motion of the surface by pressure waves.
    pub vertical: Complex,
}

/// Response of a rigid body in the trench at one Laplace variable.
#[derive(Clone, Copy)]
pub(super) struct TrenchResponse {
    /// hh, vv, rr and hr of the dynamic stiffness.
    pub(super) stiffness: [Complex; 4],
    /// Horizontal translation, rotation and vertical translation due to the free field.
    pub(super) motion: [Complex; 3],
}

/// Numbers of a [`TrenchResponse`] in one list: stiffness, then motion.
const RESPONSE_LENGTH: usize = 7;

impl TrenchResponse {
    fn from_list(list: [Complex; RESPONSE_LENGTH]) -> Self {
        let [hh, vv, rr, hr, horizontal, rotation, vertical] = list;
        Self { stiffness: [hh, vv, rr, hr], motion: [horizontal, rotation, vertical] }
    }

    fn list(&self) -> [Complex; RESPONSE_LENGTH] {
        let mut list = [Complex::default(); RESPONSE_LENGTH];
        list[..4].copy_from_slice(&self.stiffness);
        list[4..].copy_from_slice(&self.motion);
        list
    }
}

/// Number of rigid motions: horizontal, vertical, rotation.
const RIGID_MOTION_COUNT: usize = 3;

impl TrenchGround {
    /// Dynamic stiffness of a rigid body welded to walls and base, at each of `frequencies` (Hz).
    ///
    /// The reference point is the middle of the base. The observer counts points of the Laplace plane, eight per
    /// frequency. Frequency 0 is the static stiffness on rigid bedrock. Layers may have any damping, including
    /// hysteretic damping; without damping they take up to eight times as long.
    ///
    /// ```
    /// use basemat::bem::embedded::{Trench, TrenchGround};
    /// use basemat::soil::{Hysteretic, SoilProfile};
    /// use basemat::{Soil, unobserved};
    /// // A basement of 12 m × 5 m in 10 m of clay on rigid rock.
    /// let clay = Soil::from_shear_wave_speed(150.0, 0.45, 1800.0)?;
    /// let profile = SoilProfile::on_rigid_bedrock()
    ///     .with_layer(clay, 10.0)?
    ///     .with_damping(Hysteretic::new(0.05)?);
    /// let elements = Trench::new(-6.0..6.0, 5.0)?.elements(8, 6)?;
    /// let ground = TrenchGround::new(profile, elements)?;
    /// let found = ground.impedances(&[0.0, 2.0], &mut unobserved)?;
    /// // Below the first frequency of the layer, 3.75 Hz, only the soil damps: Im K ≈ 2ξ Re K.
    /// assert!((found[1].rocking.im / found[0].rocking.re - 0.10).abs() < 0.01);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`] for a frequency that is negative, not finite or too high for the elements, or 0 on a
    /// half-plane, whose static stiffness is 0; [`GroundError::GuidedWave`] without damping at a frequency at which
    /// guided waves begin; [`Error::Singular`] if the stiffnesses of soils differ by more than double precision
    /// carries; [`Error::Stopped`] by the observer.
    pub fn impedances(
        &self,
        frequencies: &[f64],
        observer: &mut Observer<'_>,
    ) -> Result<Vec<StripImpedance>> {
        let responses = self.soil().responses(frequencies, observer)?;
        let mut impedances = Vec::with_capacity(frequencies.len());
        for (&frequency, response) in frequencies.iter().zip(responses) {
            let [horizontal, vertical, rocking, coupling] = response.stiffness;
            let impedance = StripImpedance { frequency, horizontal, vertical, rocking, coupling };
            impedances.push(impedance);
        }
        Ok(impedances)
    }

    /// Motion of a rigid body without mass under vertical shear and pressure waves, at each of `frequencies` (Hz).
    ///
    /// The observer counts as for [`impedances`](TrenchGround::impedances).
    ///
    /// ```
    /// use basemat::bem::embedded::{Trench, TrenchGround};
    /// use basemat::{Soil, unobserved};
    /// let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0)?;
    /// let ground = TrenchGround::new(soil, Trench::new(-6.0..6.0, 5.0)?.elements(8, 6)?)?;
    /// let found = ground.kinematic_motions(&[0.5, 5.0], &mut unobserved)?;
    /// // Long waves move the body as they move the surface.
    /// assert!((found[0].horizontal.abs() - 1.0).abs() < 0.01);
    /// // At 5 Hz the base moves about as the soil at its depth, cos(ωd/c) = 0.71, and rotates.
    /// assert!((found[1].horizontal.abs() - 0.72).abs() < 0.01, "{:?}", found[1]);
    /// assert!((6.0 * found[1].rotation.abs() - 0.076).abs() < 0.002);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Scene`] with [backfill](TrenchGround::with_backfill), beside which waves do not travel vertically;
    /// otherwise as for [`impedances`](TrenchGround::impedances).
    pub fn kinematic_motions(
        &self,
        frequencies: &[f64],
        observer: &mut Observer<'_>,
    ) -> Result<Vec<KinematicMotion>> {
        let needed =
            "a trench without it: beside backfill waves of the free field do not travel vertically";
        require_part("backfill", self.soil().fill().is_none(), needed)?;
        let responses = self.soil().responses(frequencies, observer)?;
        let mut motions = Vec::with_capacity(frequencies.len());
        for (&frequency, response) in frequencies.iter().zip(responses) {
            motions.push(KinematicMotion {
                frequency,
                horizontal: response.motion[0],
                rotation: response.motion[1],
                vertical: response.motion[2],
            });
        }
        Ok(motions)
    }
}

impl TrenchSoil {
    /// Responses at some frequencies, Hz.
    fn responses(
        &self,
        frequencies: &[f64],
        observer: &mut Observer<'_>,
    ) -> Result<Vec<TrenchResponse>> {
        let watch = &mut impedance_progress(frequencies, observer);
        let profile = self.profile();
        let trench = self.elements().trench();
        let span = 2.0 * (trench.half_width() + trench.depth());
        let mut variables = Vec::with_capacity(frequencies.len());
        for frequency in frequencies {
            let exists = *frequency != 0.0 || matches!(profile.bedrock(), Bedrock::Rigid);
            require("frequency of an impedance on a half-plane", *frequency, exists, "above zero")?;
            variables.push(laplace_variables(profile, span, *frequency)?);
        }
        // Mesh of one frequency, with its ω.
        let mut mesh: Option<(f64, TrenchMesh)> = None;
        let lists = extrapolated_stiffnesses(&variables, &[0, 1, 2], watch, |s| {
            // All points of a frequency have one mesh. The response is therefore analytic in s.
            let response = match &mesh {
                Some((omega, mesh)) if *omega == s.im => self.response(s, mesh)?,
                _ => {
                    let found = self.mesh(s)?;
                    let response = match &found.compliances {
                        Some(compliances) => self.response_with(s, compliances)?,
                        None => self.response(s, &found.mesh)?,
                    };
                    mesh = Some((s.im, found.mesh));
                    response
                }
            };
            Ok(response.list())
        });
        let lists = lists.map_err(|error| match error {
            Error::Ground(GroundError::Unresolved { re, im, .. }) => {
                GroundError::GuidedWave { re, im }.into()
            }
            other => other,
        })?;
        Ok(lists.into_iter().map(TrenchResponse::from_list).collect())
    }

    /// Response at `s` by finite elements on a mesh.
    pub(super) fn response(&self, s: Complex, mesh: &TrenchMesh) -> Result<TrenchResponse> {
        self.response_with(s, &self.compliances(s, mesh)?)
    }

    /// Response at `s` from the compliances of the faces.
    fn response_with(&self, s: Complex, compliances: &HalfCompliances) -> Result<TrenchResponse> {
        let HalfCompliances { symmetric, antisymmetric } = compliances;
        let faces = TrenchFaces::new(self);
        let field = self.free_field(s)?;
        let motions = faces.rigid_motions();
        let shear = faces.free_field(&field, 0);
        let pressure = faces.free_field(&field, 1);
        let ReducedSystem { stiffness, forces } = reduce(antisymmetric, &motions, &shear)?;
        let vertical = reduce(symmetric, &motions, &pressure)?;
        let vv = vertical.stiffness[1][1];
        let coupling = (stiffness[0][2] + stiffness[2][0]) * 0.5;
        let determinant = stiffness[0][0] * stiffness[2][2] - coupling * coupling;
        let horizontal = (stiffness[2][2] * forces[0] - coupling * forces[2]) / determinant;
        let rotation = (stiffness[0][0] * forces[2] - coupling * forces[0]) / determinant;
        let motion = [horizontal, rotation, vertical.forces[1] / vv];
        // The stiffnesses are of the right half.
        let whole = [stiffness[0][0], vv, stiffness[2][2], coupling].map(|half| half * 2.0);
        Ok(TrenchResponse {
            stiffness: whole.map(|value| Complex::new(value.re, value.im)),
            motion: motion.map(|value| Complex::new(value.re, value.im)),
        })
    }
}

/// Elements of the right half, in the order of [`HalfCompliances`].
struct TrenchFaces<'a> {
    base: &'a [f64],
    wall: &'a [f64],
}

/// Free field at the elements: horizontal and then vertical component of each.
struct FaceField {
    /// Integrals of displacements.
    displacements: Vec<Complex64>,
    /// Means of tractions on the soil.
    tractions: Vec<Complex64>,
}

impl<'a> TrenchFaces<'a> {
    fn new(ground: &'a TrenchSoil) -> Self {
        Self { base: ground.elements().base(), wall: ground.elements().wall() }
    }

    /// Resultants of unit tractions about the middle of the base: three for each row.
    fn rigid_motions(&self) -> Vec<[f64; RIGID_MOTION_COUNT]> {
        let Self { base, wall } = self;
        let half_width = base[base.len() - 1];
        let depth = wall[wall.len() - 1];
        let mut rows = vec![];
        for ends in base.windows(2) {
            let length = ends[1] - ends[0];
            rows.push([length, 0.0, 0.0]);
            rows.push([0.0, length, length * (0.5 * (ends[0] + ends[1]))]);
        }
        for ends in wall.windows(2) {
            let length = ends[1] - ends[0];
            let height_above_base = depth - 0.5 * (ends[0] + ends[1]);
            rows.push([length, 0.0, length * height_above_base]);
            rows.push([0.0, length, length * half_width]);
        }
        rows
    }

    /// The free field of shear (0) or pressure waves (1).
    fn free_field(&self, field: &FreeFieldAtFaces, wave: usize) -> FaceField {
        let count = self.base.len() + self.wall.len() - 2;
        let mut displacements = vec![Complex64::ZERO; 2 * count];
        let mut tractions = displacements.clone();
        // The displacement is along x (0) in shear waves and along z (1) in pressure waves; so is the traction of the
        // base. The traction of a wall has the other direction.
        let direction = wave;
        let at_base = field.base[wave];
        for (element, ends) in self.base.windows(2).enumerate() {
            displacements[2 * element + direction] = at_base.displacement * (ends[1] - ends[0]);
            tractions[2 * element + direction] = -at_base.stress;
        }
        for (element, ends) in self.wall.windows(2).enumerate() {
            let at_wall = field.walls[element][wave];
            let stress = if wave == 0 { at_wall.stress } else { field.side_stresses[element] };
            let row = 2 * (self.base.len() - 1 + element);
            displacements[row + direction] = at_wall.displacement;
            tractions[row + 1 - direction] = -stress / (ends[1] - ends[0]);
        }
        FaceField { displacements, tractions }
    }
}

/// Equations of a rigid body.
struct ReducedSystem {
    /// Aᵀ F⁻¹ A.
    stiffness: [[Complex64; RIGID_MOTION_COUNT]; RIGID_MOTION_COUNT],
    /// Aᵀ (F⁻¹ u − t).
    forces: [Complex64; RIGID_MOTION_COUNT],
}

/// Number of right-hand sides: the rigid motions and the free field.
const SOLVED_COLUMN_COUNT: usize = RIGID_MOTION_COUNT + 1;

/// Reduces the compliances of a half to the rigid motions.
fn reduce(
    compliance: &ComplexBlock,
    motions: &[[f64; RIGID_MOTION_COUNT]],
    field: &FaceField,
) -> Result<ReducedSystem> {
    let order = compliance.rows();
    let mut solved: Vec<Complex64> = vec![];
    for (motion, displacement) in motions.iter().zip(&field.displacements) {
        solved.extend(motion.map(Complex64::from));
        solved.push(*displacement);
    }
    let mut factor = DenseFactor::with_columns(order, SOLVED_COLUMN_COUNT);
    if !factor.factor(compliance.values(), order) {
        return Err(Error::Singular { matrix: "compliance of a trench", order });
    }
    factor.solve_columns(&mut solved, SOLVED_COLUMN_COUNT);
    let product = |motion: usize, column: usize| -> Complex64 {
        let rows = motions.iter().zip(solved.chunks_exact(SOLVED_COLUMN_COUNT));
        rows.map(|(a, row)| row[column] * a[motion]).sum()
    };
    let stiffness = std::array::from_fn(|i| std::array::from_fn(|j| product(i, j)));
    let forces = std::array::from_fn(|i| {
        let tractions = motions.iter().zip(&field.tractions);
        let resultant: Complex64 = tractions.map(|(a, t)| *t * a[i]).sum();
        product(i, RIGID_MOTION_COUNT) - resultant
    });
    Ok(ReducedSystem { stiffness, forces })
}
