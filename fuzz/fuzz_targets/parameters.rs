#![no_main]

mod report;

libfuzzer_sys::fuzz_target!(init: report::at_exit(), |data: &[u8]| {
    rps3_fuzz::parameters(data);
});
