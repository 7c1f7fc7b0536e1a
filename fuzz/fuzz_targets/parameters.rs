#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    rps3_fuzz::parameters(data);
});
