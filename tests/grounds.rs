//! Tests of grounds: convolution weights, histories, layers, mats, trenches and the full plane.

mod full_plane;
mod ground;
