//! Lines of the mesh around a trench, the same for all Laplace variables.

/// Extent of the near field beside the walls and below the base.
///
/// In half widths of the trench.
const NEAR_FIELD_RATIO: f64 = 0.5;
/// Longest joined interval of the regular columns, in half widths.
const MAX_JOINED_RATIO: f64 = 0.4;
/// Longest last interval, relative to the regular length.
///
/// A short remainder joins its neighbour.
const MAX_LAST_INTERVAL_RATIO: f64 = 1.5;

/// Interval between two horizontal lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    /// Length, m.
    pub(super) length: f64,
    /// Index of the soil, from the surface down.
    pub(super) soil_index: usize,
}

/// Interval of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WallInterval {
    pub(super) interval: Interval,
    /// Index of the wall element that contains the interval, from the surface down.
    pub(super) element: usize,
}

/// Right half of a trench and of the near field around the trench, m.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TrenchGrid {
    /// Lengths of the base elements, from the axis to the wall.
    pub(super) base_lengths: Vec<f64>,
    /// Intervals of the wall, from the surface down.
    pub(super) wall_intervals: Vec<WallInterval>,
    /// Intervals below the base.
    pub(super) lower_intervals: Vec<Interval>,
    /// Widths of the columns beside the wall.
    pub(super) column_widths: Vec<f64>,
    /// Number of these columns that contain backfill along the wall.
    pub(super) backfilled_column_count: usize,
    /// Width of each regular column, beyond the columns beside the wall.
    pub(super) regular_column_width: f64,
    /// Longest interval of the regular columns that joins several intervals, m.
    pub(super) max_joined_length: f64,
}

/// Soil layer of the mesh.
#[derive(Debug, Clone, Copy)]
pub(super) struct GridLayer {
    /// Depth of its lower interface, m.
    pub(super) bottom: f64,
    /// Longest interval in it, m.
    pub(super) max_interval: f64,
}

impl TrenchGrid {
    /// Grid for the elements of a base and a wall.
    ///
    /// `base_ends`: ends of the base elements, m from the axis. `wall_ends`: depths of the ends of the wall elements, m.
    /// `layers`: the last is the half-plane, with an infinite depth, unless the bedrock `is_rigid`. `backfill_width`, m.
    pub(super) fn new(
        base_ends: &[f64],
        wall_ends: &[f64],
        layers: &[GridLayer],
        is_rigid: bool,
        backfill_width: f64,
    ) -> Self {
        let base_lengths = lengths(base_ends);
        let half_width: f64 = base_lengths.iter().sum();
        let outermost_length = base_lengths.last().copied().unwrap_or(half_width);
        let lowest_length = lengths(wall_ends).last().copied().unwrap_or(outermost_length);
        let depth = wall_ends.last().copied().unwrap_or(0.0);
        let interfaces =
            layers.iter().map(|layer| layer.bottom).filter(|bottom| bottom.is_finite());
        let deepest_interface = interfaces.fold(0.0, f64::max);
        let bottom = if is_rigid {
            deepest_interface
        } else {
            deepest_interface.max(depth + NEAR_FIELD_RATIO * half_width)
        };
        let mut next_width = outermost_length;
        let mut column_widths = vec![];
        let mut backfilled_column_count = 0;
        if backfill_width > 0.0 {
            column_widths = doubling_lengths(&mut next_width, backfill_width, f64::INFINITY);
            backfilled_column_count = column_widths.len();
        }
        if backfill_width < NEAR_FIELD_RATIO * half_width {
            let distance = NEAR_FIELD_RATIO * half_width - backfill_width;
            column_widths.extend(doubling_lengths(&mut next_width, distance, f64::INFINITY));
        }
        let regular_column_width = 2.0 * column_widths.last().copied().unwrap_or(half_width);
        Self {
            base_lengths,
            wall_intervals: wall_intervals(wall_ends, layers),
            lower_intervals: lower_intervals(depth, bottom, lowest_length, layers),
            column_widths,
            backfilled_column_count,
            regular_column_width,
            max_joined_length: MAX_JOINED_RATIO * half_width,
        }
    }

    /// Longest time in which shear waves cross a contact element, s.
    ///
    /// `speeds`: of shear waves in each soil, m/s.
    pub(super) fn max_crossing_time(&self, speeds: &[f64]) -> f64 {
        let soil_under_base = self.lower_intervals.first().map_or(0, |lower| lower.soil_index);
        let base_times = self.base_lengths.iter().map(|length| length / speeds[soil_under_base]);
        let wall_times = self
            .wall_intervals
            .iter()
            .map(|wall| wall.interval.length / speeds[wall.interval.soil_index]);
        base_times.chain(wall_times).fold(0.0, f64::max)
    }

    /// Number of wall elements on one side.
    pub(super) fn wall_element_count(&self) -> usize {
        self.wall_intervals.last().map_or(0, |wall| wall.element + 1)
    }
}

/// Wall elements divided at the interfaces, from the surface down.
fn wall_intervals(wall_ends: &[f64], layers: &[GridLayer]) -> Vec<WallInterval> {
    let mut intervals = vec![];
    for (element, ends) in wall_ends.windows(2).enumerate() {
        let mut begin = ends[0];
        while begin < ends[1] {
            let soil_index = soil_below(layers, begin);
            let end = layers[soil_index].bottom.min(ends[1]);
            let interval = Interval { length: end - begin, soil_index };
            intervals.push(WallInterval { interval, element });
            begin = end;
        }
    }
    intervals
}

/// Intervals from the base at `depth` to the depth `bottom`, m.
///
/// Their lengths double from `first_length` on, up to the longest interval of each layer.
fn lower_intervals(
    depth: f64,
    bottom: f64,
    first_length: f64,
    layers: &[GridLayer],
) -> Vec<Interval> {
    let mut intervals = vec![];
    let mut next_length = first_length;
    let mut begin = depth;
    while begin < bottom {
        let soil_index = soil_below(layers, begin);
        let layer = layers[soil_index];
        let end = layer.bottom.min(bottom);
        for length in doubling_lengths(&mut next_length, end - begin, layer.max_interval) {
            intervals.push(Interval { length, soil_index });
        }
        begin = end;
    }
    intervals
}

/// Distances between neighbouring lines.
fn lengths(lines: &[f64]) -> Vec<f64> {
    lines.windows(2).map(|ends| ends[1] - ends[0]).collect()
}

/// Index of the soil just below a depth.
fn soil_below(layers: &[GridLayer], depth: f64) -> usize {
    layers.iter().position(|layer| layer.bottom > depth).unwrap_or(layers.len() - 1)
}

/// Intervals over a `distance` that begin with `next_length` and double, up to `max_length`.
///
/// Overwrites `next_length` with the length that continues the series.
fn doubling_lengths(next_length: &mut f64, mut distance: f64, max_length: f64) -> Vec<f64> {
    let mut lengths = vec![];
    while distance > 0.0 {
        let length = next_length.min(max_length);
        *next_length = 2.0 * length;
        if distance <= MAX_LAST_INTERVAL_RATIO * length {
            lengths.push(distance);
            break;
        }
        lengths.push(length);
        distance -= length;
    }
    lengths
}
