//! Gauss–Legendre rules, and the choice of a rule for an integrand with known singularities.

use std::sync::OnceLock;

/// Orders of the cached rules, ascending.
const CACHED_ORDERS: [usize; 12] = [2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 26];

/// Gauss–Legendre rule on [−1, 1].
#[derive(Debug)]
pub struct Rule {
    /// Points of the rule.
    pub nodes: Vec<f64>,
    /// Weights of the points; their sum is 2.
    pub weights: Vec<f64>,
    /// (ρ + 1/ρ)/2 of the smallest Bernstein ellipse inside which an integrand must be analytic.
    min_ellipse_size: f64,
}

/// Relative error of a rule on one piece: near rounding errors.
const RULE_ERROR_TOLERANCE: f64 = 1e-14;

/// Number of Newton's iterations for a node: errors are then rounding errors at all orders.
const NEWTON_ITERATIONS: usize = 6;

impl Rule {
    /// Rule with `order` points.
    ///
    /// Two and three points have closed forms. More points are computed by Newton's iteration for the roots of the
    /// Legendre polynomial (Davis & Rabinowitz 1984, § 2.7).
    pub fn new(order: usize) -> Self {
        match order {
            2 => {
                let node = 1.0 / 3.0_f64.sqrt();
                Self::from_points(vec![-node, node], vec![1.0, 1.0])
            }
            3 => {
                let node = 0.6_f64.sqrt();
                Self::from_points(vec![-node, 0.0, node], vec![5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0])
            }
            _ => Self::by_iteration(order),
        }
    }

    /// Rule with these points and weights.
    fn from_points(nodes: Vec<f64>, weights: Vec<f64>) -> Self {
        // The error of a rule of order n decreases like ρ^(−2n).
        let rho = RULE_ERROR_TOLERANCE.powf(-0.5 / nodes.len() as f64);
        Self { nodes, weights, min_ellipse_size: 0.5 * (rho + 1.0 / rho) }
    }

    /// Rule with `order` points by Newton's iteration.
    fn by_iteration(order: usize) -> Self {
        let degree = order as f64;
        let mut nodes = vec![0.0; order];
        let mut weights = vec![0.0; order];
        for i in 0..order {
            let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (degree + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..NEWTON_ITERATIONS {
                // Polynomials of degrees k − 1 and k.
                let mut lower_value = 1.0;
                let mut value = x;
                for k in 2..=order {
                    let next_value = next_legendre(k, x, [lower_value, value]);
                    lower_value = value;
                    value = next_value;
                }
                slope = degree * (x * value - lower_value) / (x * x - 1.0);
                x -= value / slope;
            }
            nodes[i] = x;
            weights[i] = 2.0 / ((1.0 - x * x) * slope * slope);
        }
        Self::from_points(nodes, weights)
    }
}

/// Legendre polynomial of `degree` at `x`, from the polynomials of the two lower degrees.
///
/// k Pₖ = (2k−1) x Pₖ₋₁ − (k−1) Pₖ₋₂, for the values `[Pₖ₋₂, Pₖ₋₁]`.
#[inline]
pub fn next_legendre(degree: usize, x: f64, [second_lower, lower]: [f64; 2]) -> f64 {
    let k = degree as f64;
    ((2.0 * k - 1.0) * x * lower - (k - 1.0) * second_lower) / k
}

impl Rule {
    /// Points with their weights on [−1, 1].
    #[inline]
    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> + Clone {
        self.nodes.iter().copied().zip(self.weights.iter().copied())
    }

    /// Points with their weights on [0, 1].
    #[inline]
    pub fn points_on_unit_interval(&self) -> impl Iterator<Item = (f64, f64)> + Clone {
        self.points().map(|(x, weight)| (0.5 * (1.0 + x), 0.5 * weight))
    }
}

/// Points with their weights on the square [−1, 1]².
///
/// `order`: number of points along each side, from 2 to 8.
#[inline]
pub fn square(order: usize) -> impl Iterator<Item = ([f64; 2], f64)> {
    let points = rule(order).points();
    points
        .clone()
        .flat_map(move |(x, v)| points.clone().map(move |(y, w)| ([x, y], v * w)))
}

/// Points with their weights on the cube [−1, 1]³.
///
/// `order`: number of points along each side, from 2 to 8.
#[inline]
pub fn cube(order: usize) -> impl Iterator<Item = ([f64; 3], f64)> {
    square(order)
        .flat_map(move |([x, y], v)| rule(order).points().map(move |(z, w)| ([x, y, z], v * w)))
}

/// The cached rules, in ascending order.
fn rules() -> &'static [Rule] {
    static RULES: OnceLock<Vec<Rule>> = OnceLock::new();
    RULES.get_or_init(|| CACHED_ORDERS.iter().map(|&order| Rule::new(order)).collect())
}

/// Index of the largest rule for a piece, which has 16 points.
///
/// Two halves with smaller rules cost less than a larger rule.
const LARGEST_PIECE_RULE: usize = 10;

/// The rule with `order` points, from 2 to 8.
pub fn rule(order: usize) -> &'static Rule {
    &rules()[order.clamp(2, 8) - 2]
}

/// The cached rule with the most points, 26: it is exact for polynomials up to degree 51.
pub fn largest_rule() -> &'static Rule {
    &rules()[CACHED_ORDERS.len() - 1]
}

/// The smallest rule for an integrand that is analytic inside an ellipse about [−1, 1].
///
/// `ellipse_size`: (|z−1| + |z+1|)/2 on the ellipse. `None` if a piece should be halved instead.
pub fn rule_for(ellipse_size: f64) -> Option<&'static Rule> {
    rules()[..=LARGEST_PIECE_RULE]
        .iter()
        .find(|rule| rule.min_ellipse_size <= ellipse_size)
}

/// Size of the ellipse through a point, with foci at the ends of an interval.
///
/// It is (|p − a| + |p − b|)/(b − a) for the point p of the complex plane and the interval [a, b].
#[inline]
pub fn ellipse_size(point: [f64; 2], low: f64, high: f64) -> f64 {
    if point[1] == 0.0 {
        // For intervals of tiny slownesses, the squares of the formula below underflow to zero, and pieces would be
        // halved endlessly.
        return ((point[0] - low).abs() + (point[0] - high).abs()) / (high - low);
    }
    let squared_height = point[1] * point[1];
    let low_distance = ((point[0] - low).powi(2) + squared_height).sqrt();
    let high_distance = ((point[0] - high).powi(2) + squared_height).sqrt();
    (low_distance + high_distance) / (high - low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_have_their_order() {
        for order in 2..=8 {
            assert_eq!(rule(order).nodes.len(), order);
        }
        let third = 1.0 / 3.0_f64.sqrt();
        let mean: f64 = square(2).map(|([x, y], weight)| weight * (x * y).abs()).sum::<f64>() / 4.0;
        assert!((mean - third * third).abs() < 1e-15);
        let sum: f64 =
            rule(4).points_on_unit_interval().map(|(x, weight)| weight * x.powi(3)).sum();
        assert!((sum - 0.25).abs() < 1e-15);
    }

    #[test]
    fn rules_integrate_polynomials_exactly() {
        for rule in rules() {
            let degree = i32::try_from(2 * rule.nodes.len() - 2).unwrap();
            let sum: f64 =
                rule.nodes.iter().zip(&rule.weights).map(|(x, w)| w * x.powi(degree)).sum();
            assert!((sum * f64::from(degree + 1) / 2.0 - 1.0).abs() < 1e-13, "{degree} {sum}");
        }
    }
}
