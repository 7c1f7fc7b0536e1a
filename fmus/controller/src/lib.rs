//! The Rps3Controller FMU: the C functions of FMI 2.0 over [`rps3::models::Controller`].
#![allow(non_snake_case)]

rps3::export_fmu!(rps3::models::Controller);
