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
    /// Polynomial of the `degree` (1 to 8) in velocity that minimises ∫ v² dt with v(T) = 0.
    ///
    /// The polynomial is zero at t = 0.
    ///
    /// Its derivative is subtracted from the acceleration, as in Chiu, "Stable baseline
    /// correction of digital strong-motion data", Bull. Seism. Soc. Am. 87 (1997), 932–944, and
    /// Boore, "Effect of baseline corrections on displacements and response spectra …", Bull.
    /// Seism. Soc. Am. 91 (2001), 1199–1211; the condition at T is added here. Degree 1 is
    /// [`RemoveMean`](Self::RemoveMean).
    VelocityPolynomial {
        /// Degree of the polynomial in velocity.
        degree: usize,
    },
    /// Polynomial of the `degree` (2 to 8) in displacement that minimises ∫ u² dt.
    ///
    /// It has no constant and linear terms; nothing is enforced at the end.
    ///
    /// Its second derivative is subtracted from the acceleration; degree 6 is the practice of
    /// Ancheta et al., *PEER NGA-West2 Database*, report PEER 2013/03, ch. 2.
    DisplacementPolynomial {
        /// Degree of the polynomial in displacement.
        degree: usize,
    },
    /// Polynomial of the `degree` (3 to 8) in velocity that makes v(T) = u(T) = 0.
    ///
    /// It has no constant and linear terms, and minimises ∫ v² dt under these conditions.
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
    /// Parses one of its words, or returns [`Error::Name`]. The degree is checked when a treatment is applied.
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

/// A linear least-squares problem for the polynomial in acceleration.
struct Fit {
    /// Number of coefficients.
    terms: usize,
    /// Whether the polynomial has the factor t.
    starts_from_zero: bool,
    /// Quantity that is minimised.
    least: Integral,
    /// Quantities that are zero at the end.
    zero_at_end: &'static [Integral],
}

#[derive(Clone, Copy)]
enum Integral {
    Velocity,
    Displacement,
}

impl Baseline {
    /// Returns the treated samples.
    pub(super) fn apply(self, samples: &[f64]) -> Result<Vec<f64>> {
        let newmark =
            Fit { terms: 3, starts_from_zero: false, least: Integral::Velocity, zero_at_end: &[] };
        let fit = match self {
            Self::None => return Ok(samples.to_vec()),
            Self::RemoveMean => Fit { terms: 1, zero_at_end: &[Integral::Velocity], ..newmark },
            Self::NewmarkParabola => newmark,
            Self::VelocityPolynomial { degree } => {
                check_degree(degree, 1, "between 1 and 8")?;
                Fit { terms: degree, zero_at_end: &[Integral::Velocity], ..newmark }
            }
            Self::DisplacementPolynomial { degree } => {
                check_degree(degree, 2, "between 2 and 8")?;
                Fit { terms: degree - 1, least: Integral::Displacement, ..newmark }
            }
            Self::RestToRest { degree } => {
                check_degree(degree, 3, "between 3 and 8")?;
                Fit {
                    terms: degree - 1,
                    starts_from_zero: true,
                    zero_at_end: &[Integral::Velocity, Integral::Displacement],
                    ..newmark
                }
            }
        };
        fit.subtract(samples)
    }
}

fn check_degree(degree: usize, least: usize, needed: &'static str) -> Result<()> {
    let is_known = (least..=8).contains(&degree);
    require("degree of the baseline polynomial", degree as f64, is_known, needed).map(drop)
}

impl Fit {
    /// Samples minus the fitted polynomial.
    ///
    /// V and U are the exact integrals of the basis functions φ, which are linear between samples; v and u are the
    /// integrals of the samples. The coefficients c minimise ∫ (v − Σ c V)² under the conditions Σ c V(T) = v(T), Σ c
    /// U(T) = u(T): a symmetric system with Lagrange multipliers. Time runs from 0 to 1, which changes no coefficient.
    fn subtract(&self, samples: &[f64]) -> Result<Vec<f64>> {
        let quantity = "number of samples under a baseline fit";
        let needed = "above the number of coefficients by two at least";
        require(quantity, samples.len() as f64, samples.len() > self.terms + 1, needed)?;
        let scale = samples.iter().fold(0.0, |most: f64, a| most.max(a.abs()));
        if scale == 0.0 {
            return Ok(samples.to_vec());
        }
        let step = 1.0 / (samples.len() - 1) as f64;
        let basis: Vec<Vec<f64>> =
            (0..self.terms).map(|term| self.basis(term, samples.len())).collect();
        let target: Vec<f64> = samples.iter().map(|a| a / scale).collect();
        let motions: Vec<Integrals> =
            basis.iter().chain([&target]).map(|a| Integrals::new(step, a, self.least)).collect();
        let coefficients = self.solve(&motions)?;
        let correction = |index: usize| -> f64 {
            coefficients.iter().zip(&basis).map(|(c, phi)| c * phi[index]).sum()
        };
        Ok(samples.iter().enumerate().map(|(i, a)| a - scale * correction(i)).collect())
    }

    /// Legendre polynomial on [0, 1] at the samples, times t if `starts_from_zero`.
    ///
    /// Powers of t would leave the system ill-conditioned.
    fn basis(&self, term: usize, count: usize) -> Vec<f64> {
        let value = |index: usize| {
            let time = index as f64 / (count - 1) as f64;
            let x = 2.0 * time - 1.0;
            let (mut before, mut now) = (0.0, 1.0);
            for n in 0..term {
                let n = n as f64;
                (before, now) = (now, ((2.0 * n + 1.0) * x * now - n * before) / (n + 1.0));
            }
            if self.starts_from_zero { time * now } else { now }
        };
        (0..count).map(value).collect()
    }

    /// Coefficients; the last of `motions` is the target of the fit.
    fn solve(&self, motions: &[Integrals]) -> Result<Vec<f64>> {
        let terms = self.terms;
        let order = terms + self.zero_at_end.len();
        // one row more than columns: the right-hand side is the last column
        let mut rows = vec![vec![0.0; order + 1]; order];
        for i in 0..terms {
            for (j, motion) in motions.iter().enumerate() {
                let column = if j == terms { order } else { j };
                rows[i][column] = motions[i].product(motion);
            }
            for (k, &quantity) in self.zero_at_end.iter().enumerate() {
                rows[i][terms + k] = motions[i].end(quantity);
                rows[terms + k][i] = motions[i].end(quantity);
                rows[terms + k][order] = motions[terms].end(quantity);
            }
        }
        let mut solution = eliminate(rows)
            .ok_or(Error::Singular { matrix: "system of the baseline fit", order })?;
        solution.truncate(terms);
        Ok(solution)
    }
}

/// Integrals of an acceleration for the fit.
struct Integrals {
    /// The fitted quantity at the Gauss points of each interval, times the root of the weight.
    values: Vec<f64>,
    velocity: f64,
    displacement: f64,
}

/// Gauss–Legendre points and weights on [0, 1], exact for squares of the cubic displacement.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

impl Integrals {
    fn new(step: f64, samples: &[f64], least: Integral) -> Self {
        let (velocity, displacement) = super::integral::integrate(step, samples);
        let last = samples.len() - 1;
        let mut values = Vec::with_capacity(GAUSS.len() * last);
        for index in 0..last {
            let start = super::integral::Motion {
                acceleration: samples[index],
                velocity: velocity[index],
                displacement: displacement[index],
            };
            let jerk = (samples[index + 1] - samples[index]) / step;
            for (point, weight) in GAUSS {
                let at = start.after(point * step, jerk);
                let value = match least {
                    Integral::Velocity => at.velocity,
                    Integral::Displacement => at.displacement,
                };
                values.push(value * (weight * step).sqrt());
            }
        }
        Self { values, velocity: velocity[last], displacement: displacement[last] }
    }

    /// Velocity or displacement at the end of the record.
    fn end(&self, quantity: Integral) -> f64 {
        match quantity {
            Integral::Velocity => self.velocity,
            Integral::Displacement => self.displacement,
        }
    }

    /// ∫ of the product of the fitted quantities.
    fn product(&self, other: &Self) -> f64 {
        self.values.iter().zip(&other.values).map(|(a, b)| a * b).sum()
    }
}

/// Solution of a small dense system by elimination with row pivoting.
///
/// The last column is the right-hand side. `None` if a pivot vanishes or is not finite.
fn eliminate(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let order = rows.len();
    for k in 0..order {
        let pivot = (k..order).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()))?;
        rows.swap(k, pivot);
        if rows[k][k] == 0.0 || !rows[k][k].is_finite() {
            return None;
        }
        let (done, below) = rows.split_at_mut(k + 1);
        let row = &done[k];
        for other in below {
            let factor = other[k] / row[k];
            for (entry, above) in other.iter_mut().zip(row).skip(k) {
                *entry -= factor * above;
            }
        }
    }
    let mut solution = vec![0.0; order];
    for k in (0..order).rev() {
        let known: f64 = (k + 1..order).map(|j| rows[k][j] * solution[j]).sum();
        solution[k] = (rows[k][order] - known) / rows[k][k];
    }
    Some(solution)
}
