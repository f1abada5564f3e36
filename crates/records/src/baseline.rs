//! Baseline treatments of accelerograms.

use crate::error::{Error, Result, require};

/// Baseline correction, so that a record ends at, or near, rest.
///
/// Every treatment subtracts a polynomial in time from the acceleration at the samples. The treated record is
/// linear between samples, as before, and its exact integrals meet the conditions named below to rounding. Every
/// record starts from u = v = 0. T is the duration. Choose with care: displacements depend strongly on the choice,
/// motions relative to the ground hardly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
#[non_exhaustive]
pub enum Baseline {
    /// No correction, which leaves the record as it is.
    #[default]
    None,
    /// Constant in acceleration, its mean over time, which makes v(T) = 0.
    RemoveMean,
    /// Parabola in acceleration that minimises ∫ v² dt; nothing is enforced at the end.
    ///
    /// Newmark, Blume & Kapur, "Seismic design spectra for nuclear power plants", J. Power
    /// Division ASCE 99 (1973), 287–303; also *Abaqus Theory Manual*, 6.1.2, with one interval.
    NewmarkParabola,
    /// Polynomial in velocity that minimises ∫ v² dt with v(T) = 0.
    ///
    /// Its `degree` is from 1 to 8, and it is zero at t = 0. Its derivative is subtracted from the acceleration, as in
    /// Chiu, "Stable baseline correction of digital strong-motion data", Bull. Seism. Soc. Am. 87 (1997), 932–944, and
    /// Boore, "Effect of baseline corrections on displacements and response spectra …", Bull. Seism. Soc. Am. 91
    /// (2001), 1199–1211; the condition at T is added here. Degree 1 is [`RemoveMean`](Self::RemoveMean).
    VelocityPolynomial {
        /// Degree of the polynomial in velocity.
        degree: usize,
    },
    /// Polynomial in displacement that minimises ∫ u² dt.
    ///
    /// Its `degree` is from 2 to 8. It has no constant and linear terms; nothing is enforced at the end. Its second
    /// derivative is subtracted from the acceleration; degree 6 is the practice of Ancheta et al., *PEER NGA-West2
    /// Database*, report PEER 2013/03, ch. 2.
    DisplacementPolynomial {
        /// Degree of the polynomial in displacement.
        degree: usize,
    },
    /// Polynomial in velocity that makes v(T) = u(T) = 0.
    ///
    /// Its `degree` is from 3 to 8. It has no constant and linear terms, and minimises ∫ v² dt under these conditions.
    ///
    /// The correction of the acceleration starts from zero, so that a record without a jump at the start keeps
    /// none; the record ends at rest where it began. This is the least-squares fit of
    /// [`VelocityPolynomial`](Self::VelocityPolynomial) with two more conditions.
    RestToRest {
        /// Degree of the polynomial in velocity.
        degree: usize,
    },
}

words_with_numbers! {
    /// Parses one of its words, or returns [`Error::Name`].
    ///
    /// The degree is checked when a treatment is applied.
    ///
    /// ```
    /// use basemat::motion::Baseline;
    /// let baseline = Baseline::RestToRest { degree: 4 };
    /// assert_eq!("rest_to_rest(4)".parse(), Ok(baseline));
    /// assert_eq!(baseline.to_string(), "rest_to_rest(4)");
    /// assert!("rest_to_rest".parse::<Baseline>().is_err());
    /// ```
    Baseline, "baseline treatment", {
        None = "none", RemoveMean = "remove_mean", NewmarkParabola = "newmark_parabola";
        VelocityPolynomial { degree } = "velocity_polynomial",
        DisplacementPolynomial { degree } = "displacement_polynomial",
        RestToRest { degree } = "rest_to_rest",
    }
}

/// Largest degree of a polynomial: higher ones follow the motion itself.
const MAX_POLYNOMIAL_DEGREE: usize = 8;

/// Linear least-squares fit of the polynomial in acceleration.
struct BaselineFit {
    /// Number of coefficients.
    term_count: usize,
    /// Whether the polynomial has the factor t.
    starts_from_zero: bool,
    /// Quantity whose square is minimised.
    minimized_quantity: FitQuantity,
    /// Quantities that are zero at the end.
    zero_end_quantities: &'static [FitQuantity],
}

/// An integral of the acceleration to which a condition applies.
#[derive(Clone, Copy)]
enum FitQuantity {
    Velocity,
    Displacement,
}

impl Baseline {
    /// Returns the treated samples.
    pub(super) fn apply(self, samples: &[f64]) -> Result<Vec<f64>> {
        let newmark_fit = BaselineFit {
            term_count: 3,
            starts_from_zero: false,
            minimized_quantity: FitQuantity::Velocity,
            zero_end_quantities: &[],
        };
        let end_velocity_only = &[FitQuantity::Velocity];
        let fit = match self {
            Self::None => return Ok(samples.to_vec()),
            Self::RemoveMean => {
                BaselineFit { term_count: 1, zero_end_quantities: end_velocity_only, ..newmark_fit }
            }
            Self::NewmarkParabola => newmark_fit,
            Self::VelocityPolynomial { degree } => {
                check_degree(degree, 1, "between 1 and 8")?;
                BaselineFit {
                    term_count: degree,
                    zero_end_quantities: end_velocity_only,
                    ..newmark_fit
                }
            }
            Self::DisplacementPolynomial { degree } => {
                check_degree(degree, 2, "between 2 and 8")?;
                BaselineFit {
                    term_count: degree - 1,
                    minimized_quantity: FitQuantity::Displacement,
                    ..newmark_fit
                }
            }
            Self::RestToRest { degree } => {
                check_degree(degree, 3, "between 3 and 8")?;
                BaselineFit {
                    term_count: degree - 1,
                    starts_from_zero: true,
                    zero_end_quantities: &[FitQuantity::Velocity, FitQuantity::Displacement],
                    ..newmark_fit
                }
            }
        };
        fit.subtract(samples)
    }
}

/// Returns an error unless `min_degree` ≤ `degree` ≤ [`MAX_POLYNOMIAL_DEGREE`].
fn check_degree(degree: usize, min_degree: usize, needed: &'static str) -> Result<()> {
    let is_in_range = (min_degree..=MAX_POLYNOMIAL_DEGREE).contains(&degree);
    require("degree of the baseline polynomial", degree as f64, is_in_range, needed).map(drop)
}

impl BaselineFit {
    /// Samples minus the fitted polynomial.
    ///
    /// V and U are the exact integrals of the basis functions φ, which are linear between samples; v and u are the
    /// integrals of the samples. The coefficients c minimise ∫ (v − Σ c V)² under the conditions Σ c V(T) = v(T), Σ c
    /// U(T) = u(T): a symmetric system with Lagrange multipliers. Time runs from 0 to 1, which changes no coefficient.
    fn subtract(&self, samples: &[f64]) -> Result<Vec<f64>> {
        let quantity = "number of samples under a baseline fit";
        let needed = "at least two more than the number of coefficients";
        require(quantity, samples.len() as f64, samples.len() > self.term_count + 1, needed)?;
        let peak = samples.iter().fold(0.0, |max_sample: f64, sample| max_sample.max(sample.abs()));
        if peak == 0.0 {
            return Ok(samples.to_vec());
        }
        let step = 1.0 / (samples.len() - 1) as f64;
        let basis: Vec<Vec<f64>> =
            (0..self.term_count).map(|term| self.basis_function(term, samples.len())).collect();
        let scaled_samples: Vec<f64> = samples.iter().map(|sample| sample / peak).collect();
        let integrals: Vec<FitIntegrals> = basis
            .iter()
            .chain([&scaled_samples])
            .map(|acceleration| FitIntegrals::new(step, acceleration, self.minimized_quantity))
            .collect();
        let coefficients = self.solve(&integrals)?;
        let mut treated_samples = Vec::with_capacity(samples.len());
        for (index, sample) in samples.iter().enumerate() {
            let correction: f64 =
                coefficients.iter().zip(&basis).map(|(c, phi)| c * phi[index]).sum();
            treated_samples.push(sample - peak * correction);
        }
        Ok(treated_samples)
    }

    /// Legendre polynomial on [0, 1] at the samples, times t if `starts_from_zero`.
    ///
    /// Powers of t would make the system ill-conditioned.
    fn basis_function(&self, degree: usize, sample_count: usize) -> Vec<f64> {
        let mut values = Vec::with_capacity(sample_count);
        for index in 0..sample_count {
            let time = index as f64 / (sample_count - 1) as f64;
            let polynomial = legendre(degree, 2.0 * time - 1.0);
            values.push(if self.starts_from_zero { time * polynomial } else { polynomial });
        }
        values
    }

    /// Coefficients of the fit; the last of `integrals` belongs to its target.
    fn solve(&self, integrals: &[FitIntegrals]) -> Result<Vec<f64>> {
        let term_count = self.term_count;
        let order = term_count + self.zero_end_quantities.len();
        // The last column is the right-hand side.
        let mut rows = vec![vec![0.0; order + 1]; order];
        for i in 0..term_count {
            for (j, other_integrals) in integrals.iter().enumerate() {
                let column = if j == term_count { order } else { j };
                rows[i][column] = integrals[i].product(other_integrals);
            }
            for (k, &quantity) in self.zero_end_quantities.iter().enumerate() {
                rows[i][term_count + k] = integrals[i].at_end(quantity);
                rows[term_count + k][i] = integrals[i].at_end(quantity);
                rows[term_count + k][order] = integrals[term_count].at_end(quantity);
            }
        }
        let mut solution = solve_dense(rows)
            .ok_or(Error::Singular { matrix: "system of the baseline fit", order })?;
        solution.truncate(term_count);
        Ok(solution)
    }
}

/// Legendre polynomial on [−1, 1], by its three-term recurrence.
fn legendre(degree: usize, x: f64) -> f64 {
    let mut previous_value = 0.0;
    let mut value = 1.0;
    for n in 0..degree {
        let n = n as f64;
        let next_value = ((2.0 * n + 1.0) * x * value - n * previous_value) / (n + 1.0);
        previous_value = value;
        value = next_value;
    }
    value
}

/// Integrals of an acceleration for the fit.
struct FitIntegrals {
    /// The minimised quantity at the Gauss points of each interval, times the root of the weight.
    values: Vec<f64>,
    /// Velocity at the end of the record.
    end_velocity: f64,
    /// Displacement at the end of the record.
    end_displacement: f64,
}

/// Gauss–Legendre points and weights on [0, 1], exact for squares of the cubic displacement.
const GAUSS_POINTS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

impl FitIntegrals {
    fn new(step: f64, samples: &[f64], minimized: FitQuantity) -> Self {
        let super::integral::Integrals { velocity, displacement } =
            super::integral::integrate(step, samples);
        let last_index = samples.len() - 1;
        let mut values = Vec::with_capacity(GAUSS_POINTS.len() * last_index);
        for index in 0..last_index {
            let start = super::integral::Motion {
                acceleration: samples[index],
                velocity: velocity[index],
                displacement: displacement[index],
            };
            let jerk = (samples[index + 1] - samples[index]) / step;
            for (point, weight) in GAUSS_POINTS {
                let motion = start.after(point * step, jerk);
                let value = match minimized {
                    FitQuantity::Velocity => motion.velocity,
                    FitQuantity::Displacement => motion.displacement,
                };
                values.push(value * (weight * step).sqrt());
            }
        }
        Self {
            values,
            end_velocity: velocity[last_index],
            end_displacement: displacement[last_index],
        }
    }

    /// Velocity or displacement at the end of the record.
    fn at_end(&self, quantity: FitQuantity) -> f64 {
        match quantity {
            FitQuantity::Velocity => self.end_velocity,
            FitQuantity::Displacement => self.end_displacement,
        }
    }

    /// Integral over time of the product of two minimised quantities.
    fn product(&self, other: &Self) -> f64 {
        self.values.iter().zip(&other.values).map(|(a, b)| a * b).sum()
    }
}

/// Solution of a small dense system by elimination with row pivoting.
///
/// The last column is the right-hand side. `None` if a pivot vanishes or is not finite.
fn solve_dense(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let order = rows.len();
    for k in 0..order {
        let pivot_index =
            (k..order).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()))?;
        rows.swap(k, pivot_index);
        if rows[k][k] == 0.0 || !rows[k][k].is_finite() {
            return None;
        }
        let (solved_rows, remaining_rows) = rows.split_at_mut(k + 1);
        let pivot_row = &solved_rows[k];
        for row in remaining_rows {
            let factor = row[k] / pivot_row[k];
            for (entry, pivot_entry) in row.iter_mut().zip(pivot_row).skip(k) {
                *entry -= factor * pivot_entry;
            }
        }
    }
    let mut solution = vec![0.0; order];
    for k in (0..order).rev() {
        let solved_terms: f64 = (k + 1..order).map(|j| rows[k][j] * solution[j]).sum();
        solution[k] = (rows[k][order] - solved_terms) / rows[k][k];
    }
    Some(solution)
}
