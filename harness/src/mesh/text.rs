//! Lines and words of text files of unknown origin.

use std::borrow::Cow;

/// Characters of a value that an error shows.
const SHOWN: usize = 40;

/// Most bytes of a name.
const NAME_MAX: usize = 1 << 10;

/// A value as an error shows it: printable, and not too long.
pub(super) fn quote(word: &[u8]) -> String {
    // A character has up to four bytes.
    let start = &word[..word.len().min(4 * SHOWN + 4)];
    let text = String::from_utf8_lossy(start);
    let shown: String = text
        .chars()
        .take(SHOWN)
        .flat_map(char::escape_debug)
        .collect();
    let more = if text.chars().nth(SHOWN).is_some() {
        "..."
    } else {
        ""
    };
    format!("`{shown}{more}`")
}

/// Lines that end in LF, CR LF or CR alone, with their numbers from 1. A
/// byte-order mark is left out.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    let mut rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut number = 0;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        number += 1;
        let end = rest.iter().position(|b| matches!(b, b'\n' | b'\r'));
        let Some(end) = end else {
            return Some((number, std::mem::take(&mut rest)));
        };
        let line = &rest[..end];
        let width = if rest[end..].starts_with(b"\r\n") {
            2
        } else {
            1
        };
        rest = &rest[end + width..];
        Some((number, line))
    })
}

/// A statement of an OBJ or MTL file: comment removed, continued lines joined.
pub(super) struct Statement<'a> {
    /// Number of its first line.
    pub(super) line: usize,
    /// The statement's text.
    pub(super) text: Cow<'a, [u8]>,
}

/// The statements of an OBJ or MTL file.
///
/// A backslash at the end of a line continues it, except in a comment: Windows
/// paths in comments end in one, and the next line must not vanish.
pub(super) fn statements(bytes: &[u8]) -> impl Iterator<Item = Statement<'_>> {
    let mut lines = lines(bytes);
    std::iter::from_fn(move || {
        let (line, first) = lines.next()?;
        let Some(start) = continued(first) else {
            let text = without_comment(first).into();
            return Some(Statement { line, text });
        };
        let mut text = start.to_vec();
        for (_, next) in lines.by_ref() {
            text.push(b' ');
            let Some(more) = continued(next) else {
                text.extend_from_slice(without_comment(next));
                break;
            };
            text.extend_from_slice(more);
        }
        let text = text.into();
        Some(Statement { line, text })
    })
}

/// What stands before the backslash of a line that goes on.
fn continued(line: &[u8]) -> Option<&[u8]> {
    if without_comment(line).len() < line.len() {
        return None;
    }
    line.trim_ascii_end().strip_suffix(b"\\")
}

/// A comment starts with a `#` after white space or at the start; a name may hold
/// one further in. After a number anything would be an error, so there any `#`
/// starts a comment.
fn without_comment(line: &[u8]) -> &[u8] {
    let numbers = matches!(
        line.trim_ascii_start(),
        [b'v' | b'f' | b'l' | b'p', b' ' | b'\t', ..]
            | [b'v', b't' | b'n' | b'p', b' ' | b'\t', ..]
    );
    let starts =
        |at: usize| line[at] == b'#' && (numbers || at == 0 || line[at - 1].is_ascii_whitespace());
    match (0..line.len()).find(|at| starts(*at)) {
        Some(at) => &line[..at],
        None => line,
    }
}

/// Refuses bytes that no text holds, where `expected` is.
pub(super) fn check_text(text: &[u8], expected: &str) -> Result<(), String> {
    // Vertical tab is blank to many a reader, if not to Rust.
    let is_blank = |byte: u8| byte.is_ascii_whitespace() || byte == 0x0b;
    match text.iter().find(|b| b.is_ascii_control() && !is_blank(**b)) {
        None => Ok(()),
        Some(byte) => Err(format!(
            "byte {byte:#04x} is not text; {expected} is expected"
        )),
    }
}

/// The words of a statement.
pub(super) fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(u8::is_ascii_whitespace)
        .filter(|w| !w.is_empty())
}

/// What follows the first word, trimmed: a name that may hold blanks.
pub(super) fn name(text: &[u8]) -> Result<String, String> {
    let text = text.trim_ascii();
    let word = text.iter().position(u8::is_ascii_whitespace);
    let name = word.map_or(&[][..], |at| &text[at..]).trim_ascii();
    match name.len() > NAME_MAX {
        false => Ok(String::from_utf8_lossy(name).into_owned()),
        true => Err(format!(
            "{} has {} bytes; names have at most {NAME_MAX}",
            quote(name),
            name.len()
        )),
    }
}

/// A finite `f32`, or what is wrong with the word.
pub(super) fn number(word: &[u8]) -> Result<f32, String> {
    let parsed = std::str::from_utf8(word)
        .ok()
        .and_then(|w| w.parse::<f32>().ok());
    match parsed {
        Some(x) if x.is_finite() => Ok(x),
        Some(_) => Err(format!("{} is not finite", quote(word))),
        None => Err(format!("{} is not a number", quote(word))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joined(text: &[u8]) -> Vec<(usize, String)> {
        let show = |s: Statement| (s.line, String::from_utf8_lossy(&s.text).trim().to_owned());
        statements(text)
            .map(show)
            .filter(|(_, t)| !t.is_empty())
            .collect()
    }

    #[test]
    fn statements_keep_the_numbers_of_their_lines() {
        let text = b"\xef\xbb\xbfa\r\n\rb \\\nc\\\r\nd # e\n# f\\\ng#h i\nv 1#2\n";
        let expected = [(1, "a"), (3, "b  c d"), (7, "g#h i"), (8, "v 1")];
        let expected = expected.map(|(line, text)| (line, text.to_owned()));
        assert_eq!(joined(text), expected, "line ends, continuations, comments");
    }

    #[test]
    fn shown_values_are_short_and_printable() {
        assert_eq!(
            quote(b"a\tb\x1b"),
            "`a\\tb\\u{1b}`",
            "control characters are escaped"
        );
        let long = quote(&[b'x'; 1000]);
        assert_eq!(long.len(), SHOWN + 5, "{long}");
    }
}
