//! Wavenumbers of a lattice.

/// Numbers of wavenumbers; some have spectra, and the others are mirror images.
#[derive(Clone, Copy)]
pub(super) struct WaveNumbers {
    /// Number of all wavenumbers.
    pub(super) all: usize,
    /// Number of wavenumbers with spectra, which come first.
    pub(super) own: usize,
    /// First wavenumber that has an image.
    pub(super) first: usize,
}

impl WaveNumbers {
    /// Place of the spectrum of a wavenumber.
    pub(super) fn spectrum(self, wave: usize) -> usize {
        if wave < self.own { wave } else { wave - self.own + self.first }
    }

    /// Ranges of wavenumbers, and the place of the first spectrum of each range.
    pub(super) fn runs(self) -> [(std::ops::Range<usize>, usize); 2] {
        [(0..self.own, 0), (self.own..self.all, self.first)]
    }
}
