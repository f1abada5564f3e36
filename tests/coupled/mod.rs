//! Structure, ground and contact stepped together.

mod checkpoint;
mod conditioning;
mod conveniences;
mod coordinates;
mod earth_pressure;
mod embedded;
mod embedded_frames;
mod embedded_layers;
mod embedded_rest;
mod embedded_scenes;
mod energy_balance;
mod forms;
mod interaction;
mod layered;
mod layered_scenes;
mod loads;
mod passive_schemes;
mod preload_of_soft_structures;
mod push_over;
mod reduced;
mod runs;
mod soil_column;
mod static_loads;
mod sweep;
mod travel;
mod wave_passage;
