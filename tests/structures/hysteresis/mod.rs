//! Hysteretic springs, yielding storeys and base isolators.

mod building;
mod laws;
mod p_delta;
mod refused;
