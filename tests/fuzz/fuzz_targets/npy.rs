#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| gridel_tests::fuzz::npy(data));
