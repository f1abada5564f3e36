//! GOAL: the paper's parts: thin-layer interface, end-of-step time schemes, the flow chart, and all
//! of them together.
//! SCENE: single elements and oscillators; blocks and towers on springs and half-plane.
//! REFERENCE: finite elements, published amplification matrices, and the robust search.

mod combinations;
mod layer;
mod schemes;
mod search;
