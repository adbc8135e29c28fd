//! Lets plain `cargo build` link on macOS, where Python's symbols are found at run time only.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
