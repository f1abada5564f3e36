//! Hysteretic springs, yielding storeys and base isolators.

mod building;
#[path = "../support/curvature.rs"]
mod curvature;
mod laws;
mod p_delta;
mod refused;
