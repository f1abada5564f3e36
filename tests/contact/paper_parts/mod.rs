//! GOAL: the parts of the paper are right: thin-layer interface, end-of-step time schemes, flow chart, and their
//! combinations.
//! SCENE: single elements and oscillators; blocks and towers on springs and half-plane.
//! REFERENCE: finite elements, published amplification matrices, and the robust search.

mod combinations;
mod layer;
mod schemes;
mod search;
