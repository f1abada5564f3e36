//! Modulus reduction and damping of soils over shear strain.

use super::published_curves::{
    EPRI_CURVES, NINE_STRAINS, SEED_IDRISS_CURVES, SEVENTEEN_STRAINS, VUCETIC_DOBRY_CURVES,
};
use crate::error::{Error, Result, damping_ratio, finite, not_negative, positive, require};

/// Secant shear modulus and damping ratio of a soil as functions of the shear strain's amplitude.
///
/// Published curves are drawings; their numbers are the digitized values of pystrata 0.5.4. Darendeli's curves are
/// computed from his equations. Between points both quantities are linear in the logarithm of strain. Outside the range
/// of the points both are constant. Strains are plain numbers: 0.01 is 1 %.
///
/// ```
/// use basemat::soil::StrainCurves;
/// let clay = StrainCurves::VuceticDobry { plasticity_index: 30.0 };
/// assert_eq!(clay.at(1.0e-3)?, [0.53, 0.088]); // G/G_max and damping ratio at 0.1 %
/// let table = StrainCurves::Table(vec![[1.0e-5, 1.0, 0.01], [1.0e-3, 0.5, 0.09]]);
/// let [reduction, damping] = table.at(1.0e-4)?;
/// assert!((reduction - 0.75).abs() < 1e-12 && (damping - 0.05).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
#[non_exhaustive]
pub enum StrainCurves {
    /// Soil or rock that stays linear, with a constant damping ratio.
    Linear {
        /// Damping ratio, from 0 to below 1.
        damping: f64,
    },
    /// Sand, mean of the data (Seed & Idriss 1970, EERC 70-10).
    SeedIdrissMean,
    /// Sand, upper modulus with lower damping of the same data: the usual pair for dense sand.
    SeedIdrissUpper,
    /// Soil by its plasticity (Vucetic & Dobry 1991, J. Geotech. Eng. 117, 89–107).
    ///
    /// Linear between the curves drawn for the indices 0, 15, 30, 50, 100 and 200.
    VuceticDobry {
        /// Plasticity index, per cent, from 0 to 200.
        plasticity_index: f64,
    },
    /// Sand by its depth (EPRI 1993, TR-102293, appendix 7.A).
    ///
    /// The curves hold for the report's ranges down to 20, 50, 120, 250, 500 and 1000 ft.
    Epri {
        /// Depth of the layer's middle below the surface, m, from 0 to 304.8.
        depth: f64,
    },
    /// Soil by its state (Darendeli 2001, dissertation, University of Texas at Austin, ch. 9), up to a strain of 1 %.
    Darendeli {
        /// Plasticity index, per cent.
        plasticity_index: f64,
        /// Overconsolidation ratio.
        overconsolidation: f64,
        /// Mean effective stress, Pa.
        mean_stress: f64,
        /// Frequency of the shaking, Hz; usually 1. At least 0.05, below which the small-strain damping turns negative.
        frequency: f64,
        /// Number of cycles; usually 10.
        cycles: f64,
    },
    /// Rows of strain, G/G_max and damping ratio. Strains increase from row to row, and G/G_max never increases.
    Table(Vec<[f64; 3]>),
}

/// Curves of one layer, ready for evaluation.
#[derive(Debug)]
pub(crate) enum ResolvedCurves {
    /// Rows of strain, G/G_max and damping ratio.
    Rows(Vec<[f64; 3]>),
    /// Parameters of Darendeli's model.
    Darendeli {
        reference_strain: f64,
        small_strain_damping: f64,
        /// Factor of the Masing damping.
        masing_factor: f64,
    },
}

/// Curvature a of Darendeli's hyperbola, φ₅.
const HYPERBOLA_CURVATURE: f64 = 0.919;
/// Strain over the reference strain above which Darendeli's damping stays constant: it would decrease.
const MAX_DAMPING_STRAIN_RATIO: f64 = 55.45;
/// Strain over the reference strain below which the exact loop area loses digits by cancellation.
const MIN_EXACT_STRAIN_RATIO: f64 = 1e-5;
/// Lowest frequency of Darendeli's curves (Hz), below which the small-strain damping turns negative.
const MIN_DARENDELI_FREQUENCY: f64 = 0.05;
/// Largest strain of Darendeli's curves.
const MAX_DARENDELI_STRAIN: f64 = 0.01;
/// Atmospheric pressure, Pa.
const ATMOSPHERIC_PRESSURE: f64 = 101_325.0;

impl StrainCurves {
    /// G/G_max and damping ratio at a `strain` amplitude.
    ///
    /// # Errors
    /// [`Error::Input`] for a negative strain, for parameters out of their range, and for a table without rows or with rows out
    /// of order or out of range.
    pub fn at(&self, strain: f64) -> Result<[f64; 2]> {
        not_negative("shear strain", strain)?;
        Ok(self.resolved()?.at(strain))
    }

    /// Checks the parameters of these curves, and returns the curves for evaluation.
    pub(crate) fn resolved(&self) -> Result<ResolvedCurves> {
        let rows = match self {
            Self::Linear { damping } => {
                vec![[
                    f64::INFINITY,
                    1.0,
                    damping_ratio("damping ratio of a linear soil", *damping)?,
                ]]
            }
            Self::SeedIdrissMean => {
                rows(&NINE_STRAINS, &SEED_IDRISS_CURVES[0], &SEED_IDRISS_CURVES[1])
            }
            Self::SeedIdrissUpper => {
                rows(&NINE_STRAINS, &SEED_IDRISS_CURVES[2], &SEED_IDRISS_CURVES[3])
            }
            Self::VuceticDobry { plasticity_index } => vucetic_dobry(*plasticity_index)?,
            Self::Epri { depth } => {
                let curve =
                    EPRI_CURVES.iter().find(|curve| (0.0..=curve.parameter).contains(depth));
                let curve = curve.ok_or(Error::Input {
                    quantity: "depth of EPRI's curves (m)",
                    value: *depth,
                    needed: "from 0 to 304.8",
                })?;
                rows(&SEVENTEEN_STRAINS, &curve.reduction, &curve.damping)
            }
            &Self::Darendeli {
                plasticity_index,
                overconsolidation,
                mean_stress,
                frequency,
                cycles,
            } => {
                return darendeli(
                    plasticity_index,
                    overconsolidation,
                    mean_stress,
                    frequency,
                    cycles,
                );
            }
            Self::Table(rows) => checked_rows(rows)?.to_vec(),
        };
        Ok(ResolvedCurves::Rows(rows))
    }
}

impl ResolvedCurves {
    /// G/G_max and damping ratio at a strain that is not negative.
    pub(crate) fn at(&self, strain: f64) -> [f64; 2] {
        match self {
            Self::Rows(rows) => {
                let upper_index = rows.partition_point(|row| row[0] <= strain);
                let Some(low_row) = upper_index.checked_sub(1).map(|i| rows[i]) else {
                    return rows.first().map_or([1.0, 0.0], |row| [row[1], row[2]]);
                };
                let high_row = rows.get(upper_index).copied().unwrap_or(low_row);
                let fraction = if high_row[0] > low_row[0] {
                    (strain / low_row[0]).ln() / (high_row[0] / low_row[0]).ln()
                } else {
                    0.0
                };
                [1, 2].map(|k| low_row[k] + fraction * (high_row[k] - low_row[k]))
            }
            Self::Darendeli { reference_strain, small_strain_damping, masing_factor } => {
                let x = (strain / reference_strain).min(MAX_DAMPING_STRAIN_RATIO);
                // Masing damping for a = 1, per cent. For small x the limit 2x/3 is used, because the
                // difference cancels.
                let loop_area = if x < MIN_EXACT_STRAIN_RATIO {
                    x / 1.5
                } else {
                    4.0 * (x - x.ln_1p()) * (1.0 + x) / (x * x) - 2.0
                };
                let ideal_masing_damping = 100.0 / std::f64::consts::PI * loop_area;
                let a = HYPERBOLA_CURVATURE;
                let c1 = -1.1143 * a * a + 1.8618 * a + 0.2523;
                let c2 = 0.0805 * a * a - 0.0710 * a - 0.0095;
                let c3 = -0.0005 * a * a + 0.0002 * a + 0.0003;
                let masing = ideal_masing_damping
                    * (c1 + ideal_masing_damping * (c2 + ideal_masing_damping * c3));
                [
                    darendeli_reduction(strain / reference_strain),
                    small_strain_damping
                        + 0.01 * masing_factor * darendeli_reduction(x).powf(0.1) * masing,
                ]
            }
        }
    }

    /// Largest strain of the curves.
    pub(crate) fn max_strain(&self) -> f64 {
        match self {
            Self::Rows(rows) => rows.last().map_or(f64::INFINITY, |row| row[0]),
            Self::Darendeli { .. } => MAX_DARENDELI_STRAIN,
        }
    }
}

/// G/G_max of Darendeli's hyperbola at a strain over the reference strain.
fn darendeli_reduction(strain_ratio: f64) -> f64 {
    1.0 / (1.0 + strain_ratio.powf(HYPERBOLA_CURVATURE))
}

/// Curves of Darendeli's model with the mean values of its parameters (2001).
fn darendeli(
    plasticity_index: f64,
    overconsolidation_ratio: f64,
    mean_stress: f64,
    frequency: f64,
    cycles: f64,
) -> Result<ResolvedCurves> {
    not_negative("plasticity index", plasticity_index)?;
    positive("overconsolidation ratio", overconsolidation_ratio)?;
    let stress_ratio = positive("mean effective stress (Pa)", mean_stress)? / ATMOSPHERIC_PRESSURE;
    let is_in_range = frequency >= MIN_DARENDELI_FREQUENCY && frequency.is_finite();
    let quantity = "frequency of Darendeli's curves (Hz)";
    require(quantity, frequency, is_in_range, "finite and at least 0.05")?;
    let is_cycle_count = cycles >= 1.0 && cycles.is_finite();
    require(
        "number of cycles of Darendeli's curves",
        cycles,
        is_cycle_count,
        "finite and at least 1",
    )?;
    let reference_strain = 0.01
        * (0.0352 + 0.0010 * plasticity_index * overconsolidation_ratio.powf(0.3246))
        * stress_ratio.powf(0.3483);
    let small_strain_damping = 0.01
        * (0.8005 + 0.0129 * plasticity_index * overconsolidation_ratio.powf(-0.1069))
        * stress_ratio.powf(-0.2889)
        * (1.0 + 0.2919 * frequency.ln());
    positive("reference strain of Darendeli's curves", reference_strain)?;
    damping_ratio("small-strain damping of Darendeli's curves", small_strain_damping)?;
    let masing_factor = 0.6329 - 0.00566 * cycles.ln();
    Ok(ResolvedCurves::Darendeli { reference_strain, small_strain_damping, masing_factor })
}

/// Rows of strain, G/G_max and damping ratio.
fn rows<const N: usize>(
    strains: &[f64; N],
    reduction: &[f64; N],
    damping: &[f64; N],
) -> Vec<[f64; 3]> {
    (0..N).map(|i| [strains[i], reduction[i], damping[i]]).collect()
}

/// Interpolates between the two drawn curves next to a plasticity index.
fn vucetic_dobry(plasticity_index: f64) -> Result<Vec<[f64; 3]>> {
    let last_index = VUCETIC_DOBRY_CURVES.len() - 1;
    let is_in_range =
        (0.0..=VUCETIC_DOBRY_CURVES[last_index].parameter).contains(&plasticity_index);
    require("plasticity index", plasticity_index, is_in_range, "from 0 to 200")?;
    let upper_index = VUCETIC_DOBRY_CURVES
        .partition_point(|curve| curve.parameter <= plasticity_index)
        .clamp(1, last_index);
    let low_curve = &VUCETIC_DOBRY_CURVES[upper_index - 1];
    let high_curve = &VUCETIC_DOBRY_CURVES[upper_index];
    let fraction =
        (plasticity_index - low_curve.parameter) / (high_curve.parameter - low_curve.parameter);
    let low_rows = rows(&NINE_STRAINS, &low_curve.reduction, &low_curve.damping);
    let high_rows = rows(&NINE_STRAINS, &high_curve.reduction, &high_curve.damping);
    let mut interpolated_rows = Vec::with_capacity(low_rows.len());
    for (low_row, high_row) in low_rows.iter().zip(high_rows) {
        let reduction = low_row[1] + fraction * (high_row[1] - low_row[1]);
        let damping = low_row[2] + fraction * (high_row[2] - low_row[2]);
        interpolated_rows.push([low_row[0], reduction, damping]);
    }
    Ok(interpolated_rows)
}

/// The rows of a table; an error unless they form a curve.
fn checked_rows(rows: &[[f64; 3]]) -> Result<&[[f64; 3]]> {
    let quantity = "number of rows of a table of strain curves";
    require(quantity, rows.len() as f64, !rows.is_empty(), "at least 1")?;
    let mut previous_strain = 0.0;
    let mut previous_reduction = 1.0;
    for &[strain, reduction, damping] in rows {
        finite("strain of a table", strain)?;
        let needed = "above zero and above the strain of the row before";
        previous_strain = require("strain of a table", strain, strain > previous_strain, needed)?;
        let is_in_range = reduction > 0.0 && reduction <= 1.0;
        require("G/G_max of a table", reduction, is_in_range, "above 0 and at most 1")?;
        let needed = "at most the ratio of the row before: soil softens as strain grows";
        let is_not_stiffer = reduction <= previous_reduction;
        previous_reduction = require("G/G_max of a table", reduction, is_not_stiffer, needed)?;
        damping_ratio("damping ratio of a table", damping)?;
    }
    Ok(rows)
}
