//! Transforms along the surface of coefficients in plan, by their symmetry.

use crate::error::Result;
use crate::geometry::{Lattice, SERIES};
use crate::history::convolution_weights::ConvolutionWeights;
use crate::linalg::{add_combined_rows, next_smooth_even};

/// Number of lags evaluated together.
pub(super) const CHUNK: usize = 512;

/// Number of wavenumbers of a lattice in plan: all, and only those with spectra.
pub(crate) fn waves_in_plan(lattice: &Lattice) -> [usize; 2] {
    let [along, across] = lattice.counts.map(|count| next_smooth_even(2 * count - 1));
    [across, across / 2 + 1].map(|rows| (along / 2 + 1) * rows)
}

/// Does [`ElementGrid::coefficients`](super::element_grid::ElementGrid::coefficients) in plan, by products with cosines and sines
/// along x and y.
pub(super) fn coefficients_in_plan(
    lattice: &Lattice,
    lengths: [usize; 2],
    kernel: &dyn ConvolutionWeights,
    count: usize,
    mut accept: impl FnMut(usize, usize, &[f64]) -> Result<()>,
) -> Result<()> {
    let [columns, rows] = lattice.counts;
    let own = lengths.map(|length| length / 2 + 1);
    let waves = [0, 1].map(|axis| cosines_and_sines(lattice.counts[axis], lengths[axis]));
    let most = CHUNK.min(count);
    let mut tables = [(); SERIES].map(|()| vec![0.0; columns * rows * most]);
    let mut lags = [(); SERIES].map(|()| vec![0.0; most]);
    let mut values = vec![0.0; own[0] * own[1]];
    let [mut along, mut both] = [own[0] * rows, own[0] * own[1]].map(|n| vec![0.0; n * most]);
    for begin in (0..count).step_by(CHUNK) {
        let width = CHUNK.min(count - begin);
        let skip = usize::from(begin == 0);
        for offset in (0..columns).flat_map(|i| (0..rows).map(move |j| [i, j])) {
            let (class, terms) = lattice.terms(offset.map(usize::cast_signed));
            let slices = lags.each_mut().map(|lags| &mut lags[skip..width]);
            kernel.coefficients_in_plan(class, begin + skip + 1, slices)?;
            let [[zz, zx, zy], [_, xx, xy], [_, _, yy]] = terms;
            for (table, (kind, _)) in tables.iter_mut().zip([zz, xx, yy, xy, zx, zy]) {
                let place = (offset[0] * rows + offset[1]) * width;
                table[place..place + width].copy_from_slice(&lags[kind][..width]);
            }
        }
        for (kind, table) in tables.iter().enumerate() {
            let odd = [matches!(kind, 3 | 4), matches!(kind, 3 | 5)];
            let [x, y] = [0, 1].map(|axis| &waves[axis][usize::from(odd[axis])]);
            let (along, both) =
                (&mut along[..own[0] * rows * width], &mut both[..own[0] * own[1] * width]);
            along.fill(0.0);
            both.fill(0.0);
            add_combined_rows(x, &table[..columns * rows * width], rows * width, 1.0, along);
            // A kind that is odd along both axes has the factor i².
            let sign = if odd == [true; 2] { -1.0 } else { 1.0 };
            let parts = along.chunks_exact(rows * width);
            for (part, sums) in parts.zip(both.chunks_exact_mut(own[1] * width)) {
                add_combined_rows(y, part, width, sign, sums);
            }
            for d in skip..width {
                for (wave, value) in values.iter_mut().enumerate() {
                    let [row, column] = [wave / own[0], wave % own[0]];
                    *value = both[(column * own[1] + row) * width + d];
                }
                accept(kind, begin + d, &values)?;
            }
        }
    }
    Ok(())
}

/// Factors of each offset and wavenumber: the sum over both signs of the offset, of an even and of an odd function.
///
/// The sum of the odd function is divided by i.
fn cosines_and_sines(offsets: usize, length: usize) -> [Vec<f64>; 2] {
    let turn = std::f64::consts::TAU / length as f64;
    let angle = |offset: usize, k: usize| turn * (offset * k % length) as f64;
    let even = |offset, k| if offset == 0 { 1.0 } else { 2.0 * angle(offset, k).cos() };
    let odd = |offset, k| if offset == 0 { 0.0 } else { -2.0 * angle(offset, k).sin() };
    let all = |wave: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        let places = (0..offsets).flat_map(|offset| (0..=length / 2).map(move |k| (offset, k)));
        places.map(|(offset, k)| wave(offset, k)).collect()
    };
    [all(&even), all(&odd)]
}
