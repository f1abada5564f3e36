//! Lines of the mesh around a trench: fixed for all Laplace variables.

/// Interval between two horizontal lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    pub(super) length: f64,
    /// Number of the soil, from the surface down.
    pub(super) soil: usize,
}

/// Right half of a trench and of the near field around it, in m from its axis and the surface.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TrenchGrid {
    /// Lengths of the base elements, from the axis to the wall.
    pub(super) base: Vec<f64>,
    /// Intervals of the walls, from the surface down, and the element, from the surface, to which each belongs.
    pub(super) wall: Vec<(Interval, usize)>,
    /// Intervals below the base.
    pub(super) below: Vec<Interval>,
    /// Lengths of the columns beside the wall.
    pub(super) beside: Vec<f64>,
    /// Number of these columns that contain backfill along the walls.
    pub(super) backfilled: usize,
    /// Length of the regular columns that follow.
    pub(super) column: f64,
    /// Longest interval of the regular columns that consists of several, m.
    pub(super) max_joined_length: f64,
}

/// Depth of an interface, and the longest interval above it, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct GridLayer {
    pub(super) bottom: f64,
    pub(super) longest: f64,
}

impl TrenchGrid {
    /// Grid for base elements between `base` (m from the axis), wall elements between `wall` (m of depth).
    ///
    /// `layers`: interfaces, and last the half-plane with an infinite depth unless `rigid`. `backfill`: width, m.
    pub(super) fn new(
        base: &[f64],
        wall: &[f64],
        layers: &[GridLayer],
        rigid: bool,
        backfill: f64,
    ) -> Self {
        let base = lengths(base);
        let half_width: f64 = base.iter().sum();
        let outermost = base.last().copied().unwrap_or(half_width);
        let depth = wall.last().copied().unwrap_or(0.0);
        let mut wall_intervals = vec![];
        for (element, ends) in wall.windows(2).enumerate() {
            let mut begin = ends[0];
            while begin < ends[1] {
                let soil = soil_below(layers, begin);
                let end = layers[soil].bottom.min(ends[1]);
                wall_intervals.push((Interval { length: end - begin, soil }, element));
                begin = end;
            }
        }
        let interfaces =
            layers.iter().map(|layer| layer.bottom).filter(|bottom| bottom.is_finite());
        let deepest = interfaces.fold(0.0, f64::max);
        let bottom = if rigid { deepest } else { deepest.max(depth + 0.5 * half_width) };
        let mut next = lengths(wall).last().copied().unwrap_or(outermost);
        let mut below = vec![];
        let mut begin = depth;
        while begin < bottom {
            let soil = soil_below(layers, begin);
            let GridLayer { bottom: interface, longest } = layers[soil];
            let end = interface.min(bottom);
            for length in doubling_lengths(&mut next, end - begin, longest) {
                below.push(Interval { length, soil });
            }
            begin = end;
        }
        let mut next = outermost;
        let mut beside = vec![];
        let mut backfilled = 0;
        if backfill > 0.0 {
            beside = doubling_lengths(&mut next, backfill, f64::INFINITY);
            backfilled = beside.len();
        }
        if backfill < 0.5 * half_width {
            let distance = 0.5 * half_width - backfill;
            beside.extend(doubling_lengths(&mut next, distance, f64::INFINITY));
        }
        let column = 2.0 * beside.last().copied().unwrap_or(half_width);
        let max_joined_length = 0.4 * half_width;
        Self { base, wall: wall_intervals, below, beside, backfilled, column, max_joined_length }
    }

    /// Longest time in which shear waves of these `speeds` (m/s, of each soil) cross a contact element, s.
    pub(super) fn slowest_crossing(&self, speeds: &[f64]) -> f64 {
        let soil_under_base = self.below.first().map_or(0, |interval| interval.soil);
        let base_times = self.base.iter().map(|length| length / speeds[soil_under_base]);
        let wall_times =
            self.wall.iter().map(|(interval, _)| interval.length / speeds[interval.soil]);
        base_times.chain(wall_times).fold(0.0, f64::max)
    }

    /// Number of wall elements on one side.
    pub(super) fn walls(&self) -> usize {
        self.wall.last().map_or(0, |(_, element)| element + 1)
    }
}

/// Distances between neighbouring lines.
fn lengths(lines: &[f64]) -> Vec<f64> {
    lines.windows(2).map(|ends| ends[1] - ends[0]).collect()
}

/// The soil just below a depth.
fn soil_below(layers: &[GridLayer], depth: f64) -> usize {
    layers.iter().position(|layer| layer.bottom > depth).unwrap_or(layers.len() - 1)
}

/// Intervals over a `distance` that begin with `next` and double, at most `longest`.
///
/// `next` becomes the length with which the intervals continue.
fn doubling_lengths(next: &mut f64, mut distance: f64, longest: f64) -> Vec<f64> {
    let mut lengths = vec![];
    while distance > 0.0 {
        let length = next.min(longest);
        *next = 2.0 * length;
        if distance <= 1.5 * length {
            lengths.push(distance);
            break;
        }
        lengths.push(length);
        distance -= length;
    }
    lengths
}
