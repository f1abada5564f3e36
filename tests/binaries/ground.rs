//! Tests of grounds: convolution weights, histories, layers, mats, trenches and the full plane.

#[path = "../full_plane/mod.rs"]
mod full_plane;
#[path = "../ground/mod.rs"]
mod ground;
