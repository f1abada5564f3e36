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

/// Motion of a rigid body without mass in a trench, e^(iωt).
///
/// The motion is per unit motion of the surface of the free field, and is the input of the structure (kinematic
/// interaction). Waves travel vertically. x points to the right, y down; a positive rotation lowers the right end.
/// Translations refer to the middle of the base.
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
    /// Dynamic stiffness: horizontal, vertical, rocking, and coupling of sliding and rocking.
    pub(super) stiffness: [Complex; 4],
    /// Horizontal translation, rotation and vertical translation due to the free field.
    pub(super) motion: [Complex; 3],
}

/// Number of values of a [`TrenchResponse`]: stiffness, then motion.
const RESPONSE_VALUE_COUNT: usize = 7;

impl TrenchResponse {
    fn from_values(values: [Complex; RESPONSE_VALUE_COUNT]) -> Self {
        let [hh, vv, rr, hr, horizontal, rotation, vertical] = values;
        Self { stiffness: [hh, vv, rr, hr], motion: [horizontal, rotation, vertical] }
    }

    fn values(&self) -> [Complex; RESPONSE_VALUE_COUNT] {
        let mut values = [Complex::default(); RESPONSE_VALUE_COUNT];
        values[..4].copy_from_slice(&self.stiffness);
        values[4..].copy_from_slice(&self.motion);
        values
    }
}

/// Number of rigid motions: horizontal, vertical, rotation.
const RIGID_MOTION_COUNT: usize = 3;

impl TrenchGround {
    /// Dynamic stiffness of a bonded rigid body at each of `frequencies` (Hz).
    ///
    /// The body is bonded to walls and base. The reference point is the middle of the base. The observer counts points of
    /// the Laplace plane, eight per frequency. At frequency 0 the result is the static stiffness on rigid bedrock. Layers
    /// may have any damping, including hysteretic damping; the computation takes up to eight times as long for layers
    /// without damping.
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
    /// let impedances = ground.impedances(&[0.0, 2.0], &mut unobserved)?;
    /// // Below the first frequency of the layer, 3.75 Hz, waves radiate no energy: Im K ≈ 2ξ Re K.
    /// let loss_ratio = impedances[1].rocking.im / impedances[0].rocking.re;
    /// assert!((loss_ratio - 0.10).abs() < 0.01);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`] for a frequency that is negative, not finite or too high for the elements, or 0 on a
    /// half-plane, whose static stiffness is 0; [`GroundError::GuidedWave`] without damping at a frequency at which
    /// guided waves begin; [`Error::Singular`] if the stiffnesses of soils differ too much for double
    /// precision; [`Error::Stopped`] by the observer.
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

    /// Motions of a rigid body without mass at each of `frequencies` (Hz).
    ///
    /// The waves are vertical shear and pressure waves. The observer counts as for
    /// [`impedances`](TrenchGround::impedances).
    ///
    /// ```
    /// use basemat::bem::embedded::{Trench, TrenchGround};
    /// use basemat::{Soil, unobserved};
    /// let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0)?;
    /// let ground = TrenchGround::new(soil, Trench::new(-6.0..6.0, 5.0)?.elements(8, 6)?)?;
    /// let motions = ground.kinematic_motions(&[0.5, 5.0], &mut unobserved)?;
    /// // Long waves displace the body and the surface equally.
    /// assert!((motions[0].horizontal.abs() - 1.0).abs() < 0.01);
    /// // At 5 Hz the base translates nearly like the soil at its depth, cos(ωd/c) = 0.71, and rotates.
    /// assert!((motions[1].horizontal.abs() - 0.72).abs() < 0.01, "{:?}", motions[1]);
    /// assert!((6.0 * motions[1].rotation.abs() - 0.076).abs() < 0.002);
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
        require_part("backfill", self.soil().backfill_soil().is_none(), needed)?;
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
    /// Responses at all `frequencies`, Hz.
    fn responses(
        &self,
        frequencies: &[f64],
        observer: &mut Observer<'_>,
    ) -> Result<Vec<TrenchResponse>> {
        let progress = &mut impedance_progress(frequencies, observer);
        let profile = self.profile();
        let trench = self.elements().trench();
        let span = 2.0 * (trench.half_width() + trench.depth());
        let mut variables = Vec::with_capacity(frequencies.len());
        for frequency in frequencies {
            let is_defined = *frequency != 0.0 || matches!(profile.bedrock(), Bedrock::Rigid);
            require(
                "frequency of an impedance on a half-plane",
                *frequency,
                is_defined,
                "above zero",
            )?;
            variables.push(laplace_variables(profile, span, *frequency)?);
        }
        // Mesh of one frequency, with its ω.
        let mut mesh: Option<(f64, TrenchMesh)> = None;
        let values_by_frequency = extrapolated_stiffnesses(&variables, &[0, 1, 2], progress, |s| {
            // All points of a frequency share one mesh. The response is therefore analytic in s.
            let response = match &mesh {
                Some((omega, mesh)) if *omega == s.im => self.response(s, mesh)?,
                _ => {
                    let chosen = self.mesh(s)?;
                    let response = match &chosen.compliances {
                        Some(compliances) => self.response_with(s, compliances)?,
                        None => self.response(s, &chosen.mesh)?,
                    };
                    mesh = Some((s.im, chosen.mesh));
                    response
                }
            };
            Ok(response.values())
        });
        let values_by_frequency = values_by_frequency.map_err(|error| match error {
            Error::Ground(GroundError::Unresolved { re, im, .. }) => {
                GroundError::GuidedWave { re, im }.into()
            }
            other => other,
        })?;
        Ok(values_by_frequency.into_iter().map(TrenchResponse::from_values).collect())
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
        let rigid_motions = faces.rigid_motions();
        let shear_field = faces.free_field(&field, 0);
        let pressure_field = faces.free_field(&field, 1);
        let ReducedSystem { stiffness, forces } =
            reduce(antisymmetric, &rigid_motions, &shear_field)?;
        let vertical = reduce(symmetric, &rigid_motions, &pressure_field)?;
        let vv = vertical.stiffness[1][1];
        let coupling = (stiffness[0][2] + stiffness[2][0]) * 0.5;
        let determinant = stiffness[0][0] * stiffness[2][2] - coupling * coupling;
        let horizontal = (stiffness[2][2] * forces[0] - coupling * forces[2]) / determinant;
        let rotation = (stiffness[0][0] * forces[2] - coupling * forces[0]) / determinant;
        let motion = [horizontal, rotation, vertical.forces[1] / vv];
        // The matrices contain the stiffnesses of the right half.
        let whole_stiffness =
            [stiffness[0][0], vv, stiffness[2][2], coupling].map(|half| half * 2.0);
        Ok(TrenchResponse {
            stiffness: whole_stiffness.map(|value| Complex::new(value.re, value.im)),
            motion: motion.map(|value| Complex::new(value.re, value.im)),
        })
    }
}

/// Ends of the elements of the right half, in the order of [`HalfCompliances`].
struct TrenchFaces<'a> {
    base_ends: &'a [f64],
    wall_ends: &'a [f64],
}

/// Free field at the elements: horizontal and then vertical component of each.
struct FaceField {
    /// Integrals of displacements.
    displacements: Vec<Complex64>,
    /// Means of tractions on the soil.
    tractions: Vec<Complex64>,
}

impl<'a> TrenchFaces<'a> {
    fn new(soil: &'a TrenchSoil) -> Self {
        Self { base_ends: soil.elements().base_ends(), wall_ends: soil.elements().wall_ends() }
    }

    /// Resultants of unit tractions about the middle of the base: three for each row.
    fn rigid_motions(&self) -> Vec<[f64; RIGID_MOTION_COUNT]> {
        let Self { base_ends, wall_ends } = self;
        let half_width = base_ends[base_ends.len() - 1];
        let depth = wall_ends[wall_ends.len() - 1];
        let mut rows = vec![];
        for ends in base_ends.windows(2) {
            let length = ends[1] - ends[0];
            rows.push([length, 0.0, 0.0]);
            rows.push([0.0, length, length * (0.5 * (ends[0] + ends[1]))]);
        }
        for ends in wall_ends.windows(2) {
            let length = ends[1] - ends[0];
            let height_above_base = depth - 0.5 * (ends[0] + ends[1]);
            rows.push([length, 0.0, length * height_above_base]);
            rows.push([0.0, length, length * half_width]);
        }
        rows
    }

    /// Free field of shear waves (`wave` 0) or pressure waves (1) at the elements.
    fn free_field(&self, field: &FreeFieldAtFaces, wave: usize) -> FaceField {
        let element_count = self.base_ends.len() + self.wall_ends.len() - 2;
        let mut displacements = vec![Complex64::ZERO; 2 * element_count];
        let mut tractions = displacements.clone();
        // Displacement, and traction on the base: along x (0) in shear waves and along z (1) in pressure waves. The
        // traction on a wall has the other direction.
        let direction = wave;
        let base_field = field.base_fields[wave];
        for (element, ends) in self.base_ends.windows(2).enumerate() {
            displacements[2 * element + direction] = base_field.displacement * (ends[1] - ends[0]);
            tractions[2 * element + direction] = -base_field.stress;
        }
        for (element, ends) in self.wall_ends.windows(2).enumerate() {
            let wall_integrals = field.wall_integrals[element][wave];
            let stress = if wave == 0 {
                wall_integrals.stress
            } else {
                field.side_stress_integrals[element]
            };
            let row = 2 * (self.base_ends.len() - 1 + element);
            displacements[row + direction] = wall_integrals.displacement;
            tractions[row + 1 - direction] = -stress / (ends[1] - ends[0]);
        }
        FaceField { displacements, tractions }
    }
}

/// Equations K U = f of a rigid body.
struct ReducedSystem {
    /// K = Aᵀ F⁻¹ A.
    stiffness: [[Complex64; RIGID_MOTION_COUNT]; RIGID_MOTION_COUNT],
    /// f = Aᵀ (F⁻¹ u − t).
    forces: [Complex64; RIGID_MOTION_COUNT],
}

/// Number of right-hand sides: the rigid motions and the free field.
const SOLVED_COLUMN_COUNT: usize = RIGID_MOTION_COUNT + 1;

/// Reduces the compliances of a half to the rigid motions.
fn reduce(
    compliance: &ComplexBlock,
    rigid_motions: &[[f64; RIGID_MOTION_COUNT]],
    field: &FaceField,
) -> Result<ReducedSystem> {
    let order = compliance.rows();
    let mut solutions: Vec<Complex64> = vec![];
    for (motion, displacement) in rigid_motions.iter().zip(&field.displacements) {
        solutions.extend(motion.map(Complex64::from));
        solutions.push(*displacement);
    }
    let mut factor = DenseFactor::with_columns(order, SOLVED_COLUMN_COUNT);
    if !factor.factor(compliance.values(), order) {
        return Err(Error::Singular { matrix: "compliance of a trench", order });
    }
    factor.solve_columns(&mut solutions, SOLVED_COLUMN_COUNT);
    let product = |motion: usize, column: usize| -> Complex64 {
        let rows = rigid_motions.iter().zip(solutions.chunks_exact(SOLVED_COLUMN_COUNT));
        rows.map(|(motions, solution)| solution[column] * motions[motion]).sum()
    };
    let stiffness = std::array::from_fn(|i| std::array::from_fn(|j| product(i, j)));
    let forces = std::array::from_fn(|i| {
        let rows = rigid_motions.iter().zip(&field.tractions);
        let resultant: Complex64 = rows.map(|(motions, traction)| *traction * motions[i]).sum();
        product(i, RIGID_MOTION_COUNT) - resultant
    });
    Ok(ReducedSystem { stiffness, forces })
}
