//! Lets `prf` find libtorch from wherever it is started.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // Set by torch-sys, which is a dependency with the feature `train` alone.
    if let Ok(folder) = std::env::var("DEP_TCH_LIBTORCH_LIB") {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{folder}");
    }
}
