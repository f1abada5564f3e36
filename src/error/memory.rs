//! Sizes that would not fit into memory.

/// A size for which more memory would be needed than is allowed: by [`memory_limit`](crate::memory_limit) for what is
/// given, by [`with_history_memory`](crate::bem::KernelGround::with_history_memory) for a convolution history. Nothing was
/// allocated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{quantity}: {asked} would take about {} of memory, but at most {} are allowed \
     ({remedy})",
    bytes(*.needed), bytes(*.limit)
)]
pub struct MemoryError {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// How many of it were asked for.
    pub asked: f64,
    /// Memory that they would take, estimated, bytes.
    pub needed: f64,
    /// The limit, bytes.
    pub limit: f64,
    /// Ways out.
    pub remedy: &'static str,
}

fn bytes(number: f64) -> String {
    match number {
        few if few < 1e9 => format!("{:.0} MB", few / 1e6),
        many if many < 1e15 => format!("{:.1} GB", many / 1e9),
        endless => format!("{:.0e} GB", endless / 1e9),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_told_in_their_units() {
        let text = |needed: f64| {
            let limit = 2.0_f64.powi(32);
            MemoryError { quantity: "rows", asked: 1e5, needed, limit, remedy: "less" }.to_string()
        };
        assert_eq!(
            text(4.84e9),
            "rows: 100000 would take about 4.8 GB of memory, but at most 4.3 GB are allowed \
             (less)"
        );
        assert!(text(2e6).contains("about 2 MB of") && text(2e30).contains("about 2e21 GB of"));
        assert!(text(f64::INFINITY).contains("about inf GB of"));
    }
}
