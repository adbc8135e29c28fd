#![no_main]

use prf_fuzz::targets;

libfuzzer_sys::fuzz_target!(|data: &[u8]| targets::picture(targets::WEBP, data));
