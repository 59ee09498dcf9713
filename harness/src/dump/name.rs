//! Names of files and folders from names that anyone may have chosen.

use std::fmt::Write;

use sha2::{Digest, Sha256};

/// Longest name of a file; file systems allow 255 bytes, extensions included.
const LENGTH_MAX: usize = 200;

/// A name as one component of a path.
///
/// Letters, digits and `_ @ + = , ( ) -` stay, and so do dots that do not lead;
/// every other byte becomes `%` and two hexadecimal digits, so that different
/// names stay different. What is then too long ends in a hash of the whole; what
/// is empty is `%`.
pub fn component(name: &str) -> String {
    let mut out = String::new();
    for (i, byte) in name.bytes().enumerate() {
        let kept =
            byte.is_ascii_alphanumeric() || b"_@+=,()-".contains(&byte) || (byte == b'.' && i > 0);
        if kept {
            out.push(char::from(byte));
        } else {
            write!(out, "%{byte:02x}").expect("writing to a string cannot fail");
        }
    }
    if out.len() > LENGTH_MAX {
        let hash = Sha256::digest(name.as_bytes());
        out.truncate(LENGTH_MAX - 17);
        out.push('%');
        for byte in &hash[..8] {
            write!(out, "{byte:02x}").expect("writing to a string cannot fail");
        }
    }
    match out.is_empty() {
        true => "%".to_owned(),
        false => out,
    }
}

#[cfg(test)]
mod tests {
    use std::path::{Component, Path};

    use super::*;

    #[test]
    fn ordinary_names_stay() {
        for name in [
            "needle-fan",
            "gpu@llvmpipe-fragment",
            "v1.2_(x)",
            "Bunny,r=3",
        ] {
            assert_eq!(component(name), name);
        }
    }

    #[test]
    fn every_name_is_one_component_of_its_own() {
        let long = "x".repeat(300);
        let longer = "x".repeat(301);
        let names = [
            "", ".", "..", "...", ".hidden", "a/b", "a%2fb", "/", "\\", "a\\b", "a\0b", "c:",
            "a b", "é", "%", &long, &longer,
        ];
        let mut seen = std::collections::BTreeSet::new();
        for name in names {
            let part = component(name);
            let parts: Vec<_> = Path::new(&part).components().collect();
            let normal = matches!(parts[..], [Component::Normal(_)]);
            assert!(normal, "{name:?} becomes {part:?}");
            assert!(part.len() <= LENGTH_MAX, "{part} is too long");
            assert!(!part.contains(['\\', ':', '\0', ' ']), "{part:?}");
            assert!(seen.insert(part), "{name:?} collides");
        }
    }
}
