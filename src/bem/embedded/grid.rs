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
pub(super) struct Grid {
    /// Lengths of the base elements, from the axis to the wall.
    pub(super) base: Vec<f64>,
    /// Intervals of the walls, from the surface down, and the element, from the surface, to which each belongs.
    pub(super) wall: Vec<(Interval, usize)>,
    /// Intervals below the base.
    pub(super) below: Vec<Interval>,
    /// Lengths of the columns beside the wall.
    pub(super) beside: Vec<f64>,
    /// Number of these columns that hold backfill along the walls.
    pub(super) backfilled: usize,
    /// Length of the regular columns that follow.
    pub(super) column: f64,
    /// Longest interval of the regular columns made of several, m.
    pub(super) joined: f64,
}

/// Depth of an interface, and the longest interval above it, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layer {
    pub(super) bottom: f64,
    pub(super) longest: f64,
}

impl Grid {
    /// Grid for base elements between `base` (m from the axis), wall elements between `wall` (m of depth).
    ///
    /// `layers`: interfaces, and last the half-plane with an infinite depth unless `rigid`. `backfill`: width, m.
    pub(super) fn new(
        base: &[f64],
        wall: &[f64],
        layers: &[Layer],
        rigid: bool,
        backfill: f64,
    ) -> Self {
        let lengths = |lines: &[f64]| -> Vec<f64> {
            lines.windows(2).map(|ends| ends[1] - ends[0]).collect()
        };
        let base = lengths(base);
        let half: f64 = base.iter().sum();
        let outermost = base.last().copied().unwrap_or(half);
        let depth = wall.last().copied().unwrap_or(0.0);
        let mut pieces = vec![];
        for (element, ends) in wall.windows(2).enumerate() {
            let mut begin = ends[0];
            while begin < ends[1] {
                let soil = soil_below(layers, begin);
                let end = layers[soil].bottom.min(ends[1]);
                pieces.push((Interval { length: end - begin, soil }, element));
                begin = end;
            }
        }
        let interfaces =
            layers.iter().map(|layer| layer.bottom).filter(|bottom| bottom.is_finite());
        let deepest = interfaces.fold(0.0, f64::max);
        let bottom = if rigid { deepest } else { deepest.max(depth + 0.5 * half) };
        let mut next = lengths(wall).last().copied().unwrap_or(outermost);
        let mut below = vec![];
        let mut begin = depth;
        while begin < bottom {
            let soil = soil_below(layers, begin);
            let Layer { bottom: interface, longest } = layers[soil];
            let end = interface.min(bottom);
            for length in doubled(&mut next, end - begin, longest) {
                below.push(Interval { length, soil });
            }
            begin = end;
        }
        let mut next = outermost;
        let mut beside = vec![];
        let mut backfilled = 0;
        if backfill > 0.0 {
            beside = doubled(&mut next, backfill, f64::INFINITY);
            backfilled = beside.len();
        }
        if backfill < 0.5 * half {
            beside.extend(doubled(&mut next, 0.5 * half - backfill, f64::INFINITY));
        }
        let column = 2.0 * beside.last().copied().unwrap_or(half);
        Self { base, wall: pieces, below, beside, backfilled, column, joined: 0.4 * half }
    }

    /// Longest time in which shear waves of these `speeds` (m/s, of each soil) cross a contact element, s.
    pub(super) fn slowest_crossing(&self, speeds: &[f64]) -> f64 {
        let under = self.below.first().map_or(0, |interval| interval.soil);
        let longest = |lengths: &mut dyn Iterator<Item = f64>| lengths.fold(0.0, f64::max);
        let base = longest(&mut self.base.iter().map(|length| length / speeds[under]));
        longest(&mut self.wall.iter().map(|(own, _)| own.length / speeds[own.soil])).max(base)
    }

    /// Number of wall elements on one side.
    pub(super) fn walls(&self) -> usize {
        self.wall.last().map_or(0, |(_, element)| element + 1)
    }
}

/// The soil just below a depth.
fn soil_below(layers: &[Layer], depth: f64) -> usize {
    layers.iter().position(|layer| layer.bottom > depth).unwrap_or(layers.len() - 1)
}

/// Intervals over a `distance` that begin with `next` and double, at most `longest`.
///
/// `next` becomes the length with which the intervals go on.
fn doubled(next: &mut f64, mut distance: f64, longest: f64) -> Vec<f64> {
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
