//! Rps3Controller.

pub mod table;

pub struct Controller;
