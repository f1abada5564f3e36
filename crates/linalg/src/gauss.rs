//! Gauss–Legendre rules, and the number of points for an integrand with known singularities.

use std::sync::OnceLock;

/// Orders of the cached rules, ascending.
const CACHED_ORDERS: [usize; 12] = [2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 26];

/// A rule on [−1, 1].
#[derive(Debug)]
pub struct Rule {
    pub nodes: Vec<f64>,
    pub weights: Vec<f64>,
    /// (ρ + 1/ρ)/2 of the smallest Bernstein ellipse inside which an integrand must be analytic.
    reach: f64,
}

/// Target relative error of a rule on one piece.
const RULE_ERROR_TOLERANCE: f64 = 1e-14;

/// Number of Newton's iterations for a node: enough for rounding at all orders.
const NEWTON_ITERATIONS: usize = 6;

impl Rule {
    /// Rule of `order` points.
    ///
    /// Two and three points have closed forms; others use Newton's iteration on the Legendre polynomial
    /// (Davis & Rabinowitz 1984, § 2.7).
    pub fn new(order: usize) -> Self {
        match order {
            2 => {
                let node = 1.0 / 3.0_f64.sqrt();
                Self::of_points(vec![-node, node], vec![1.0, 1.0])
            }
            3 => {
                let node = 0.6_f64.sqrt();
                Self::of_points(vec![-node, 0.0, node], vec![5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0])
            }
            _ => Self::by_iteration(order),
        }
    }

    fn of_points(nodes: Vec<f64>, weights: Vec<f64>) -> Self {
        // The error of an order-n rule falls like ρ^(−2n).
        let rho = RULE_ERROR_TOLERANCE.powf(-0.5 / nodes.len() as f64);
        Self { nodes, weights, reach: 0.5 * (rho + 1.0 / rho) }
    }

    fn by_iteration(order: usize) -> Self {
        let count = order as f64;
        let mut nodes = vec![0.0; order];
        let mut weights = vec![0.0; order];
        for i in 0..order {
            let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (count + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..NEWTON_ITERATIONS {
                let mut before = 1.0;
                let mut value = x;
                for k in 2..=order {
                    let next = next_legendre(k, x, [before, value]);
                    before = value;
                    value = next;
                }
                slope = count * (x * value - before) / (x * x - 1.0);
                x -= value / slope;
            }
            nodes[i] = x;
            weights[i] = 2.0 / ((1.0 - x * x) * slope * slope);
        }
        Self::of_points(nodes, weights)
    }
}

/// Legendre polynomial of `degree` at `x` from the two of lower degree.
///
/// k Pₖ = (2k−1) x Pₖ₋₁ − (k−1) Pₖ₋₂.
pub fn next_legendre(degree: usize, x: f64, [before, last]: [f64; 2]) -> f64 {
    let k = degree as f64;
    ((2.0 * k - 1.0) * x * last - (k - 1.0) * before) / k
}

impl Rule {
    /// Nodes with their weights.
    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> + Clone {
        self.nodes.iter().copied().zip(self.weights.iter().copied())
    }

    /// Points and weights on [0, 1].
    pub fn points_on_unit_interval(&self) -> impl Iterator<Item = (f64, f64)> + Clone {
        self.points().map(|(x, weight)| (0.5 * (1.0 + x), 0.5 * weight))
    }
}

/// Points and weights on the square [−1, 1]², `order` by `order`, with `order` from 2 to 8.
pub fn square(order: usize) -> impl Iterator<Item = ([f64; 2], f64)> {
    let line = rule(order).points();
    line.clone().flat_map(move |(x, v)| line.clone().map(move |(y, w)| ([x, y], v * w)))
}

/// Points and weights on the cube [−1, 1]³, with `order` from 2 to 8 points along each side.
pub fn cube(order: usize) -> impl Iterator<Item = ([f64; 3], f64)> {
    square(order)
        .flat_map(move |([x, y], v)| rule(order).points().map(move |(z, w)| ([x, y, z], v * w)))
}

fn rules() -> &'static [Rule] {
    static RULES: OnceLock<Vec<Rule>> = OnceLock::new();
    RULES.get_or_init(|| CACHED_ORDERS.iter().map(|&order| Rule::new(order)).collect())
}

/// Index of the largest rule for a piece; a piece that needs a larger rule is split.
const LARGEST_PIECE_RULE: usize = 10;

/// The rule of `order` points, from 2 to 8.
pub fn rule(order: usize) -> &'static Rule {
    &rules()[order.clamp(2, 8) - 2]
}

/// The rule for polynomials up to degree 51.
pub fn largest() -> &'static Rule {
    &rules()[CACHED_ORDERS.len() - 1]
}

/// The cheapest rule for an integrand analytic inside the ellipse (|z−1| + |z+1|)/2 < `reach`.
///
/// `None` if that rule would be larger than the largest rule for a piece.
pub fn rule_for(reach: f64) -> Option<&'static Rule> {
    rules()[..=LARGEST_PIECE_RULE].iter().find(|rule| rule.reach <= reach)
}

/// Size of the ellipse through a point of the complex plane with foci at an interval's ends.
///
/// (|p − a| + |p − b|)/(b − a) for the point p and the interval [a, b].
pub fn reach(point: [f64; 2], low: f64, high: f64) -> f64 {
    if point[1] == 0.0 {
        // Squares of tiny slownesses underflow to zero; the pieces would then be split endlessly.
        return ((point[0] - low).abs() + (point[0] - high).abs()) / (high - low);
    }
    let square = point[1] * point[1];
    let first = ((point[0] - low).powi(2) + square).sqrt();
    let second = ((point[0] - high).powi(2) + square).sqrt();
    (first + second) / (high - low)
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
