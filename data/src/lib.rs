#![doc = include_str!("../README.md")]

/// Paths from this folder (`scenes/oh58_4p.toml`) and what the files hold.
pub const FILES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/files.rs"));

/// What the file at `path` from this folder holds; `None` if there is none. In a `const` block a file that is missing
/// is found when the program is compiled.
pub const fn text(path: &str) -> Option<&'static str> {
    let mut k = 0;
    while k < FILES.len() {
        if is_same(FILES[k].0.as_bytes(), path.as_bytes()) {
            return Some(FILES[k].1);
        }
        k += 1;
    }
    None
}

const fn is_same(a: &[u8], b: &[u8]) -> bool {
    let mut k = 0;
    while k < a.len() && k < b.len() && a[k] == b[k] {
        k += 1;
    }
    k == a.len() && k == b.len()
}
