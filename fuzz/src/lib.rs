//! What the fuzz targets of `fuzz_targets/` do with arbitrary bytes.
//!
//! ```console
//! $ cargo +nightly fuzz run gif fuzz/corpus/gif tests/golden/frames
//! ```
//!
//! A target takes no notice of files of another kind, so one folder of beginnings serves all.

pub mod targets;
