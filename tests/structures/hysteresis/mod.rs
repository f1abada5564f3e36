//! GOAL: hysteretic springs, yielding storeys and base isolators.
//! SCENE: the laws alone, and buildings in the coupled integrator.
//! REFERENCE: differential equations, energies, closed-form loops.

mod biaxial;
mod biaxial_springs;
mod building;
mod damping;
mod laws;
mod p_delta;
mod pendulum;
mod refused;
mod stiff_sliders;
