//! The half-plane: kernels, convolution histories and passivity.

mod history;
mod history_exponentials;
mod history_fft;
mod kernels;
mod passivity;
#[path = "../support/mod.rs"]
mod support;
