//! The name under which programs find the shared library: with the version that promises the same symbols.

fn main() {
    let of = |name| std::env::var(name).unwrap_or_default();
    if of("CARGO_CFG_TARGET_OS") == "linux" {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libmotet.so.{}", of("CARGO_PKG_VERSION_MAJOR"));
    }
    println!("cargo::rerun-if-changed=build.rs");
}
