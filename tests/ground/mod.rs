//! GOAL: half-plane and layered ground: kernels, convolution histories, passivity, site response.
//! SCENE: strips, mats and trenches on half-planes and layers.
//! REFERENCE: tables of other programs, closed forms, direct sums.

mod embedded;
mod embedded_waves;
mod embedded_weights;
mod equivalent_linear;
mod equivalent_linear_refusals;
mod equivalent_linear_theory;
mod full_plane_kernels;
mod history;
mod history_exponentials;
mod history_fft;
mod inclined_sh_waves;
mod inclined_wave_reference;
mod inclined_wave_refusals;
mod inclined_waves;
mod kernels;
mod layered_coefficients;
mod layered_files;
mod layered_impedances;
mod layered_passivity;
mod observers;
mod passivity;
mod plan_cells;
mod plan_faces;
mod plan_ground;
mod plan_impedances;
mod plan_outlines;
mod plan_unions;
mod site_observers;
mod site_response;
mod site_round_trip;
mod trench_motion_in_layers;
