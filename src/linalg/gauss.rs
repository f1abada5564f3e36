//! Gauss–Legendre rules, and the number of points for an integrand with known singularities.

use std::sync::OnceLock;

/// Orders kept, ascending.
const ORDERS: [usize; 12] = [2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 26];

/// A rule on [−1, 1].
#[derive(Debug)]
pub(crate) struct Rule {
    pub(crate) nodes: Vec<f64>,
    pub(crate) weights: Vec<f64>,
    /// (ρ + 1/ρ)/2 of the smallest Bernstein ellipse inside which an integrand must be analytic.
    reach: f64,
}

/// Target relative error on one piece.
const TOLERANCE: f64 = 1e-14;

impl Rule {
    /// Rule of `order` points.
    ///
    /// Two and three points have closed forms; others use Newton's iteration on the Legendre polynomial
    /// (Davis & Rabinowitz 1984, § 2.7).
    pub(crate) fn new(order: usize) -> Self {
        let [third, far] = [1.0 / 3.0_f64.sqrt(), 0.6_f64.sqrt()];
        let (nodes, weights) = match order {
            2 => (vec![-third, third], vec![1.0, 1.0]),
            3 => (vec![-far, 0.0, far], vec![5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0]),
            _ => Self::by_iteration(order),
        };
        // The error of an order-n rule falls like ρ^(−2n).
        let rho = TOLERANCE.powf(-0.5 / order as f64);
        Self { nodes, weights, reach: 0.5 * (rho + 1.0 / rho) }
    }

    fn by_iteration(order: usize) -> (Vec<f64>, Vec<f64>) {
        let count = order as f64;
        let (mut nodes, mut weights) = (vec![0.0; order], vec![0.0; order]);
        for i in 0..order {
            let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (count + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..6 {
                let (mut before, mut value) = (1.0, x);
                for k in 2..=order {
                    (before, value) = (value, next_legendre(k, x, [before, value]));
                }
                slope = count * (x * value - before) / (x * x - 1.0);
                x -= value / slope;
            }
            nodes[i] = x;
            weights[i] = 2.0 / ((1.0 - x * x) * slope * slope);
        }
        (nodes, weights)
    }
}

/// Legendre polynomial of `degree` at `x` from the two polynomials of lower degree:
/// k Pₖ = (2k−1) x Pₖ₋₁ − (k−1) Pₖ₋₂.
pub(crate) fn next_legendre(degree: usize, x: f64, [before, last]: [f64; 2]) -> f64 {
    let k = degree as f64;
    ((2.0 * k - 1.0) * x * last - (k - 1.0) * before) / k
}

impl Rule {
    /// Nodes with their weights.
    pub(crate) fn points(&self) -> impl Iterator<Item = (f64, f64)> + Clone {
        self.nodes.iter().copied().zip(self.weights.iter().copied())
    }

    /// Points and weights on [0, 1].
    pub(crate) fn points_on_unit_interval(&self) -> impl Iterator<Item = (f64, f64)> + Clone {
        self.points().map(|(x, weight)| (0.5 * (1.0 + x), 0.5 * weight))
    }
}

/// Points and weights on the square [−1, 1]², `order` by `order`, with `order` from 2 to 8.
pub(crate) fn square(order: usize) -> impl Iterator<Item = ([f64; 2], f64)> {
    let line = rule(order).points();
    line.clone().flat_map(move |(x, v)| line.clone().map(move |(y, w)| ([x, y], v * w)))
}

/// Points and weights on the cube [−1, 1]³, with `order` from 2 to 8 points along each side.
pub(crate) fn cube(order: usize) -> impl Iterator<Item = ([f64; 3], f64)> {
    square(order)
        .flat_map(move |([x, y], v)| rule(order).points().map(move |(z, w)| ([x, y, z], v * w)))
}

fn rules() -> &'static [Rule] {
    static RULES: OnceLock<Vec<Rule>> = OnceLock::new();
    RULES.get_or_init(|| ORDERS.iter().map(|&order| Rule::new(order)).collect())
}

/// Largest rule used on a piece before it is split.
const LARGEST: usize = 10;

/// The rule of `order` points, from 2 to 8.
pub(crate) fn rule(order: usize) -> &'static Rule {
    &rules()[order.clamp(2, 8) - 2]
}

/// The rule for polynomials up to degree 51.
pub(crate) fn largest() -> &'static Rule {
    &rules()[ORDERS.len() - 1]
}

/// The cheapest rule for an integrand analytic inside the ellipse (|z−1| + |z+1|)/2 < `reach`.
///
/// `None` if that rule would be larger than the largest rule for a piece.
pub(crate) fn rule_for(reach: f64) -> Option<&'static Rule> {
    rules()[..=LARGEST].iter().find(|rule| rule.reach <= reach)
}

/// (|p − a| + |p − b|)/(b − a) of a point p in the complex plane and the interval [a, b].
pub(crate) fn reach(point: [f64; 2], low: f64, high: f64) -> f64 {
    if point[1] == 0.0 {
        // Squares of tiny slownesses would underflow to zero, and pieces would be split without end.
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
        let cubic = |(x, weight): (f64, f64)| weight * x.powi(3);
        let sum: f64 = rule(4).points_on_unit_interval().map(cubic).sum();
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
