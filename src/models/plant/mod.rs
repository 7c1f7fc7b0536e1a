//! Rps3Plant.

pub mod table;

pub struct Plant;
