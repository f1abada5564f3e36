//! Structures: finite elements, hysteresis, matrices, groups.

mod elements;
mod fem;
mod flexible_base;
mod group;
mod group_on_springs;
mod matrices;
mod portal;

/// ∂²f/∂uᵢ∂uⱼ at u = 0, by central differences of this step.
fn curvature<const N: usize>(f: impl Fn(&[f64; N]) -> f64, [i, j]: [usize; 2], step: f64) -> f64 {
    let value_at = |a: f64, b: f64| {
        let mut u = [0.0; N];
        u[i] += a * step;
        u[j] += b * step;
        f(&u)
    };
    (value_at(1.0, 1.0) - value_at(1.0, -1.0) - value_at(-1.0, 1.0) + value_at(-1.0, -1.0))
        / (4.0 * step * step)
}
