//! Links the system's OpenBLAS, which contains BLAS and LAPACK (Debian: `libopenblas-dev`).

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-link-lib=dylib=openblas");
}
