//! Wavenumbers of a lattice.

/// Counts of wavenumbers: those with spectra, and their mirror images.
#[derive(Clone, Copy)]
pub(super) struct WaveNumbers {
    /// Number of all wavenumbers.
    pub(super) count: usize,
    /// Number of wavenumbers with spectra, which come first.
    pub(super) with_spectra: usize,
    /// First wavenumber that has an image.
    pub(super) first_mirrored: usize,
}

impl WaveNumbers {
    /// Index of the spectrum of a wavenumber.
    pub(super) fn spectrum(self, wave: usize) -> usize {
        if wave < self.with_spectra {
            wave
        } else {
            wave - self.with_spectra + self.first_mirrored
        }
    }

    /// Ranges of wavenumbers, and the index of the first spectrum of each range.
    pub(super) fn ranges(self) -> [(std::ops::Range<usize>, usize); 2] {
        [(0..self.with_spectra, 0), (self.with_spectra..self.count, self.first_mirrored)]
    }
}
