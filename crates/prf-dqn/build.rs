//! Lets the tests and benches of this crate find libtorch.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // Set by torch-sys.
    if let Ok(folder) = std::env::var("DEP_TCH_LIBTORCH_LIB") {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{folder}");
    }
}
