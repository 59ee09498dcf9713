//! Sizes, words and white space.

use super::{File, assert_none, files};

const FILE_LINES_MAX: usize = 300;
const FUNCTION_LINES_MAX: usize = 70;
const BYTES_MAX: usize = 400 << 10;

/// What marks work left undone, put together so as not to find itself.
const UNDONE: [&str; 7] = [
    concat!("todo", "!("),
    concat!("unimplemented", "!("),
    concat!("dbg", "!("),
    concat!("FIX", "ME"),
    concat!("XX", "X"),
    concat!("HA", "CK"),
    concat!("#[ign", "ore"),
];

/// Where someone's files lie; system folders are no secret.
const MACHINE: [&str; 4] = [
    concat!("/ho", "me/"),
    concat!("/ro", "ot/"),
    concat!("/wo", "rk/"),
    concat!("/Us", "ers/"),
];

/// Endings of files that are not text.
const BINARY: [&str; 6] = ["png", "gz", "exr", "hdr", "npy", "ico"];

fn code() -> Vec<File> {
    let mut files = files();
    files.retain(|f| ["rs", "wgsl"].contains(&f.extension()));
    files
}

fn text() -> Vec<File> {
    let mut files = files();
    files.retain(|f| !BINARY.contains(&f.extension()));
    files
}

/// `file:line: what` for every line that `wrong` finds fault with.
fn lines(files: &[File], wrong: impl Fn(&File, &str) -> Option<String>) -> Vec<String> {
    let mut violations = Vec::new();
    for file in files {
        for (number, line) in (1..).zip(file.text().split('\n')) {
            let found = wrong(file, line);
            violations.extend(found.map(|w| format!("{}:{number}: {w}", file.name)));
        }
    }
    violations
}

#[test]
fn files_are_short() {
    let long = |f: &File| {
        let lines = f.text().lines().count();
        (lines > FILE_LINES_MAX)
            .then(|| format!("{}: {lines} lines, at most {FILE_LINES_MAX}", f.name))
    };
    let mut files = files();
    files.retain(|f| ["rs", "wgsl", "js", "css"].contains(&f.extension()));
    assert_none(&files.iter().filter_map(long).collect::<Vec<_>>());
}

#[test]
fn files_are_small() {
    let large = |f: &File| {
        let bytes = f.bytes.len();
        (bytes > BYTES_MAX).then(|| format!("{}: {bytes} bytes, at most {BYTES_MAX}", f.name))
    };
    assert_none(&files().iter().filter_map(large).collect::<Vec<_>>());
}

/// The name of the function that begins on a line.
fn function(line: &str) -> Option<&str> {
    let mut words = line.trim_start();
    let before = [
        "pub", "const", "async", "unsafe", "extern", "(crate)", "(super)", "\"C\"",
    ];
    while let Some(rest) = before.iter().find_map(|word| words.strip_prefix(word)) {
        words = rest.trim_start();
    }
    let name = words.strip_prefix("fn ")?;
    name.split(['(', '<']).next()
}

/// Functions with their first line and length. The code is formatted, so that a
/// function ends with the first brace that stands where it began.
fn functions(text: &str) -> Vec<(usize, &str, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut functions = Vec::new();
    for (first, line) in lines.iter().enumerate() {
        let Some(name) = function(line) else {
            continue;
        };
        let indent = &line[..line.len() - line.trim_start().len()];
        let ends = |l: &&str| match l.strip_prefix(indent) {
            Some(rest) => {
                rest.starts_with('}') || (!rest.starts_with(' ') && rest.ends_with(['}', ';']))
            }
            None => false,
        };
        let last = lines[first..].iter().position(ends);
        functions.push((first + 1, name, last.unwrap_or(lines.len() - first) + 1));
    }
    functions
}

#[test]
fn functions_are_short() {
    let (mut violations, mut count) = (Vec::new(), 0);
    for file in code() {
        for (line, name, length) in functions(file.text()) {
            count += 1;
            if length > FUNCTION_LINES_MAX {
                violations.push(format!(
                    "{}:{line}: {name} has {length} lines, at most {FUNCTION_LINES_MAX}",
                    file.name
                ));
            }
        }
    }
    assert!(count > 500, "only {count} functions: not all were found");
    assert_none(&violations);
}

#[test]
fn functions_are_measured() {
    let text = "fn a() {\n    b();\n}\npub const fn c();\nimpl D {\n    pub(crate) fn e(\n        x: u32,\n    ) {\n        f {\n        }\n    }\n}\nfn g() {}\n";
    let expected = [(1, "a", 3), (4, "c", 1), (6, "e", 6), (13, "g", 1)];
    assert_eq!(functions(text), expected);
}

#[test]
fn nothing_is_left_undone() {
    let undone = |_: &File, line: &str| {
        let found = UNDONE.iter().find(|word| line.contains(**word));
        found.map(|word| format!("{word}: do it, or write an issue"))
    };
    let mut files = text();
    files.retain(|f| f.name != "Cargo.lock");
    assert_none(&lines(&files, undone));
}

/// An attribute that silences a lint says why; the lints check it for crates, this
/// for what they do not see.
#[test]
fn silenced_lints_have_reasons() {
    let mut violations = Vec::new();
    let silences = ["#[allow(", "#[expect(", "#![allow(", "#![expect("];
    for file in code() {
        let lines: Vec<&str> = file.text().lines().map(str::trim).collect();
        for (at, line) in lines.iter().enumerate() {
            if !silences.iter().any(|s| line.starts_with(s)) {
                continue;
            }
            let length = lines[at..].iter().position(|l| l.ends_with(")]"));
            let attribute = lines[at..=at + length.unwrap_or(0)].join(" ");
            if !attribute.contains("reason = \"") {
                violations.push(format!("{}:{}: {attribute}: why?", file.name, at + 1));
            }
        }
    }
    assert_none(&violations);
}

#[test]
fn no_machine_is_named() {
    let named = |file: &File, line: &str| {
        let url = (file.is_script() && line.contains("://")).then_some("a URL");
        let path = MACHINE.iter().find(|p| line.contains(**p)).copied();
        path.or(url).map(|what| format!("names {what}"))
    };
    assert_none(&lines(&text(), named));
}

#[test]
fn white_space_is_plain() {
    let mut violations = lines(&text(), |_, line| {
        let trailing = line.ends_with([' ', '\r']);
        let tab = line.contains('\t');
        match (trailing, tab) {
            (true, _) => Some("white space at the end".to_owned()),
            (_, true) => Some("a tab".to_owned()),
            _ => None,
        }
    });
    for file in text() {
        if !file.bytes.is_empty() && (!file.text().ends_with('\n') || file.text().ends_with("\n\n"))
        {
            violations.push(format!(
                "{}: must end with one newline, and be UTF-8",
                file.name
            ));
        }
    }
    assert_none(&violations);
}
