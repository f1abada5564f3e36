//! Dynamic stiffness and kinematic motion of a rigid body in a trench.
//!
//! F(s) are the compliances of the faces. The columns of A are the resultants of unit tractions, which also describe the
//! rigid motions. Then K = Aᵀ F⁻¹ A. With the displacements u and the tractions t of the free field at the faces (t on
//! the soil), soil that moves by w has the tractions t + F⁻¹(w − u). A body without mass exerts no resultant:
//! K U = Aᵀ (F⁻¹ u − t).

use realfft::num_complex::Complex64;

use super::compliance::Halves;
use super::ground::TrenchGround;
use super::motion::KinematicMotion;
use super::soil::{FreeFieldAtFaces, Mesh, TrenchSoil};
use crate::bem::layered::{StripImpedance, impedance_watch, points, stiffnesses};
use crate::error::{Error, GroundError, Observer, Result, require, require_part};
use crate::linalg::{Complex, ComplexBlock, DenseFactor};
use crate::soil::Bedrock;

/// hh, vv, rr and hr of the stiffness; horizontal, rotation and vertical of the motion.
pub(super) type Response = [Complex; 7];

/// Rigid motions: horizontal, vertical, rotation.
const MOTIONS: usize = 3;

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
        let found = self.soil().responses(frequencies, observer)?;
        let impedance = |(frequency, values): (&f64, Response)| {
            let [horizontal, vertical, rocking, coupling, ..] = values;
            StripImpedance { frequency: *frequency, horizontal, vertical, rocking, coupling }
        };
        Ok(frequencies.iter().zip(found).map(impedance).collect())
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
        let found = self.soil().responses(frequencies, observer)?;
        let motion = |(frequency, values): (&f64, Response)| {
            let [.., horizontal, rotation, vertical] = values;
            KinematicMotion { frequency: *frequency, horizontal, rotation, vertical }
        };
        Ok(frequencies.iter().zip(found).map(motion).collect())
    }
}

impl TrenchSoil {
    fn responses(&self, frequencies: &[f64], observer: &mut Observer<'_>) -> Result<Vec<Response>> {
        let watch = &mut impedance_watch(frequencies, observer);
        let profile = self.profile();
        let trench = self.elements().trench();
        let span = 2.0 * (trench.half_width() + trench.depth());
        let mut lists = Vec::with_capacity(frequencies.len());
        for frequency in frequencies {
            let exists = *frequency != 0.0 || matches!(profile.bedrock(), Bedrock::Rigid);
            require("frequency of an impedance on a half-plane", *frequency, exists, "above zero")?;
            lists.push(points(profile, span, *frequency)?);
        }
        let mut mesh: Option<(f64, Mesh)> = None;
        let found = stiffnesses(&lists, &[0, 1, 2], watch, |s| {
            // All points of a frequency have one mesh, which therefore is analytic in s.
            let known = mesh.take().filter(|(omega, _)| *omega == s.im);
            let (own, compliances) = match known {
                Some((_, own)) => (own, None),
                None => self.mesh(s)?,
            };
            let (_, own) = mesh.insert((s.im, own));
            match compliances {
                Some(compliances) => self.response_of(s, &compliances),
                None => self.response(s, own),
            }
        });
        found.map_err(|error| match error {
            Error::Ground(GroundError::Unresolved { re, im, .. }) => {
                GroundError::GuidedWave { re, im }.into()
            }
            other => other,
        })
    }

    pub(super) fn response(&self, s: Complex, mesh: &Mesh) -> Result<Response> {
        self.response_of(s, &self.compliances(s, mesh)?)
    }

    fn response_of(&self, s: Complex, compliances: &Halves) -> Result<Response> {
        let Halves { symmetric, antisymmetric } = compliances;
        let faces = Faces::new(self);
        let field = self.free_field(s)?;
        let motions = faces.motions();
        let [shear, pressure] = [0, 1].map(|wave| faces.free_field(&field, wave));
        let (stiff, forces) = reduced(antisymmetric, &motions, &shear)?;
        let (vertical, lift) = reduced(symmetric, &motions, &pressure)?;
        let coupling = (stiff[0][2] + stiff[2][0]) * 0.5;
        let determinant = stiff[0][0] * stiff[2][2] - coupling * coupling;
        let horizontal = (stiff[2][2] * forces[0] - coupling * forces[2]) / determinant;
        let rotation = (stiff[0][0] * forces[2] - coupling * forces[0]) / determinant;
        let found = [stiff[0][0], vertical[1][1], stiff[2][2], coupling].map(|half| half * 2.0);
        let [hh, vv, rr, hr] = found;
        let all = [hh, vv, rr, hr, horizontal, rotation, lift[1] / vertical[1][1]];
        Ok(all.map(|value| Complex::new(value.re, value.im)))
    }
}

/// Elements of the right half, in the order of [`Halves`].
struct Faces<'a> {
    base: &'a [f64],
    wall: &'a [f64],
}

/// Horizontal and vertical numbers of each element: integrals of displacements, and means of tractions on the soil.
struct Field {
    displacements: Vec<Complex64>,
    tractions: Vec<Complex64>,
}

impl<'a> Faces<'a> {
    fn new(ground: &'a TrenchSoil) -> Self {
        Self { base: ground.elements().base(), wall: ground.elements().wall() }
    }

    /// Resultants of unit tractions about the middle of the base: three for each row.
    fn motions(&self) -> Vec<[f64; MOTIONS]> {
        let Self { base, wall } = self;
        let (half, depth) = (base[base.len() - 1], wall[wall.len() - 1]);
        let rows = |length: f64, x: f64, above: f64| {
            [[length, 0.0, length * above], [0.0, length, length * x]]
        };
        let along = base.windows(2).map(|ends| (ends[1] - ends[0], 0.5 * (ends[0] + ends[1]), 0.0));
        let down = wall
            .windows(2)
            .map(|ends| (ends[1] - ends[0], half, depth - 0.5 * (ends[0] + ends[1])));
        along.chain(down).flat_map(|(length, x, above)| rows(length, x, above)).collect()
    }

    /// The free field of shear (0) or pressure waves (1).
    fn free_field(&self, field: &FreeFieldAtFaces, wave: usize) -> Field {
        let zero = Complex64::ZERO;
        let mut found = Field { displacements: vec![], tractions: vec![] };
        // The displacement is along x in shear waves and along z in pressure waves; so is the traction of the base.
        let mut add = |displacement: Complex64, [along, across]: [Complex64; 2]| {
            let in_order =
                |own: Complex64, other| if wave == 0 { [own, other] } else { [other, own] };
            found.displacements.extend(in_order(displacement, zero));
            found.tractions.extend(in_order(along, across));
        };
        let at_base = field.base[wave];
        for ends in self.base.windows(2) {
            add(at_base.displacement * (ends[1] - ends[0]), [-at_base.stress, zero]);
        }
        for (element, ends) in self.wall.windows(2).enumerate() {
            let own = field.walls[element][wave];
            let across = if wave == 0 { own.stress } else { field.side_stresses[element] };
            add(own.displacement, [zero, -across / (ends[1] - ends[0])]);
        }
        found
    }
}

/// Aᵀ F⁻¹ A, and Aᵀ (F⁻¹ u − t).
type Reduced = ([[Complex64; MOTIONS]; MOTIONS], [Complex64; MOTIONS]);

fn reduced(
    compliance: &ComplexBlock,
    motions: &[[f64; MOTIONS]],
    field: &Field,
) -> Result<Reduced> {
    const COLUMNS: usize = MOTIONS + 1;
    let order = compliance.rows();
    let rows = motions.iter().zip(&field.displacements);
    let mut solved: Vec<Complex64> = rows
        .flat_map(|([h, v, r], u)| [Complex64::from(h), Complex64::from(v), Complex64::from(r), *u])
        .collect();
    let mut factor = DenseFactor::with_columns(order, COLUMNS);
    if !factor.factor(compliance.values(), order) {
        return Err(Error::Singular { matrix: "compliance of a trench", order });
    }
    factor.solve_columns(&mut solved, COLUMNS);
    let product = |motion: usize, column: usize| -> Complex64 {
        let rows = motions.iter().zip(solved.chunks_exact(COLUMNS));
        rows.map(|(a, own)| own[column] * a[motion]).sum()
    };
    let stiffness = std::array::from_fn(|i| std::array::from_fn(|j| product(i, j)));
    let forces = std::array::from_fn(|i| {
        let tractions = motions.iter().zip(&field.tractions);
        let resultant: Complex64 = tractions.map(|(a, t)| *t * a[i]).sum();
        product(i, MOTIONS) - resultant
    });
    Ok((stiffness, forces))
}
