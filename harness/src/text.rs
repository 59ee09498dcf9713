//! Numbers and names as people read them, on the terminal and in the report.

use std::borrow::Cow;

/// Comma-separated values: a line that names the columns, and one for each row.
pub fn csv<const N: usize>(columns: [&str; N], rows: impl Iterator<Item = [String; N]>) -> String {
    let mut text = columns.join(",") + "\n";
    for row in rows {
        text += &(row.join(",") + "\n");
    }
    text
}

/// A count with thousands separators: `1,234,567`.
pub fn count(n: u64) -> String {
    let digits = n.to_string();
    let mut out = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

/// A count in at most six characters: `12.3k`, `1.23M`. Digits are cut off, not
/// rounded, so that it never claims more than was counted.
pub fn compact(n: u64) -> String {
    const UNITS: [(u64, &str); 6] = [
        (1_000_000_000_000_000_000, "E"),
        (1_000_000_000_000_000, "P"),
        (1_000_000_000_000, "T"),
        (1_000_000_000, "G"),
        (1_000_000, "M"),
        (1_000, "k"),
    ];
    let Some(&(unit, name)) = UNITS.iter().find(|(unit, _)| n >= *unit) else {
        return n.to_string();
    };
    let (whole, hundredths) = (n / unit, n % unit / (unit / 100).max(1));
    match whole {
        0..10 => format!("{whole}.{hundredths:02}{name}"),
        10..100 => format!("{whole}.{}{name}", hundredths / 10),
        _ => format!("{whole}{name}"),
    }
}

/// `1 scene`, `2 scenes`: a count and its noun, regular plural.
pub fn plural(n: u64, noun: &str) -> String {
    format!("{} {noun}{}", count(n), if n == 1 { "" } else { "s" })
}

/// A time given in milliseconds, three digits, in the unit that suits it.
pub fn time(ms: f64) -> String {
    let (value, unit) = match ms {
        0.0 => return "0 s".to_owned(),
        _ if ms >= 59_999.5 => {
            let seconds = (ms / 1000.0).round();
            return format!("{} min {} s", (seconds / 60.0).floor(), seconds % 60.0);
        }
        // The limits lie where three digits would round up to a fourth.
        _ if ms >= 999.5 => (ms / 1000.0, "s"),
        _ if ms >= 0.9995 => (ms, "ms"),
        _ => (ms * 1000.0, "µs"),
    };
    format!("{} {unit}", three_digits(value))
}

/// A share in percent: `0 %`, `0.012 %`, `100 %`; what is there but would print
/// as nothing is `<0.001 %`.
pub fn share(part: f64) -> String {
    let percent = part * 100.0;
    match percent {
        0.0 => "0 %".to_owned(),
        _ if percent < 0.001 => "<0.001 %".to_owned(),
        _ if percent < 1.0 => format!("{percent:.3} %"),
        _ => format!("{} %", three_digits(percent)),
    }
}

fn three_digits(value: f64) -> String {
    match value {
        _ if value < 9.995 => format!("{value:.2}"),
        _ if value < 99.95 => format!("{value:.1}"),
        _ => format!("{value:.0}"),
    }
}

/// Bytes as lower-case hexadecimal digits.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

/// Untrusted text on one line: control characters (escape codes, line breaks) and
/// characters that change the direction of writing become U+FFFD.
pub fn clean(text: &str) -> Cow<'_, str> {
    let unsafe_char = |c: char| {
        c.is_control()
            || matches!(
                c,
                '\u{2028}' | '\u{2029}' | '\u{200e}' | '\u{200f}' | '\u{61c}'
            )
            || ('\u{202a}'..='\u{202e}').contains(&c)
            || ('\u{2066}'..='\u{2069}').contains(&c)
    };
    if text.contains(unsafe_char) {
        Cow::Owned(text.replace(unsafe_char, "\u{fffd}"))
    } else {
        Cow::Borrowed(text)
    }
}

/// Untrusted text on one line, as [`clean`], cut off after so many characters.
pub fn cut(text: &str, characters: usize) -> Cow<'_, str> {
    match text.char_indices().nth(characters) {
        None => clean(text),
        Some((end, _)) => Cow::Owned(clean(&text[..end]).into_owned() + "…"),
    }
}

/// A cell of comma-separated values (RFC 4180).
pub fn quoted(cell: &str) -> Cow<'_, str> {
    match cell.contains([',', '"', '\n', '\r']) {
        true => Cow::Owned(format!("\"{}\"", cell.replace('"', "\"\""))),
        false => Cow::Borrowed(cell),
    }
}

/// Untrusted text in a line or a cell of Markdown, as [`clean`], that marks nothing up.
pub fn markdown(untrusted: &str) -> String {
    let mut text = String::new();
    for c in clean(untrusted).chars() {
        if "|\\`*<>[]&".contains(c) {
            text.push('\\');
        }
        text.push(c);
    }
    text
}

/// A word of a POSIX shell's command line.
pub fn shell_word(word: &str) -> Cow<'_, str> {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_./@%+=:,-".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        Cow::Borrowed(word)
    } else {
        Cow::Owned(format!("'{}'", word.replace('\'', r"'\''")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_grouped_by_three() {
        let grouped = [0, 7, 999, 1_000, 12_345, 1_234_567].map(count);
        assert_eq!(grouped, ["0", "7", "999", "1,000", "12,345", "1,234,567"]);
        assert_eq!(count(u64::MAX), "18,446,744,073,709,551,615", "largest");
    }

    #[test]
    fn compact_counts_never_claim_more_than_there_is() {
        let cases = [
            (0, "0"),
            (999, "999"),
            (1_000, "1.00k"),
            (9_999, "9.99k"),
            (12_399, "12.3k"),
            (999_999, "999k"),
            (1_999_999, "1.99M"),
            (u64::MAX, "18.4E"),
        ];
        for (n, text) in cases {
            assert_eq!(compact(n), text, "{n}");
            assert!(compact(n).len() <= 6, "{n} is too wide");
        }
    }

    #[test]
    fn times_have_three_digits_and_a_unit() {
        let cases = [
            (0.0, "0 s"),
            (1e-4, "0.10 µs"),
            (0.0123, "12.3 µs"),
            (0.9994, "999 µs"),
            (0.9996, "1.00 ms"),
            (9.996, "10.0 ms"),
            (123.4, "123 ms"),
            (999.7, "1.00 s"),
            (59_940.0, "59.9 s"),
            (59_999.9, "1 min 0 s"),
            (192_000.0, "3 min 12 s"),
        ];
        for (ms, text) in cases {
            assert_eq!(time(ms), text, "{ms} ms");
        }
    }

    #[test]
    fn a_small_share_is_not_nothing() {
        let shares = [0.0, 1e-9, 0.000_009, 0.000_12, 0.001, 0.05, 1.0].map(share);
        let expected = [
            "0 %", "<0.001 %", "<0.001 %", "0.012 %", "0.100 %", "5.00 %", "100 %",
        ];
        assert_eq!(shares, expected);
    }

    #[test]
    fn escape_codes_and_direction_marks_do_not_get_through() {
        let hostile = "a\x1b[31mb\nc\u{202e}d\u{9b}e";
        assert_eq!(clean(hostile), "a\u{fffd}[31mb\u{fffd}c\u{fffd}d\u{fffd}e");
        assert_eq!(clean("Größe ✓"), "Größe ✓", "ordinary text stays");
    }

    #[test]
    fn cells_hold_what_would_end_them() {
        assert_eq!(quoted("abuffer/a b"), "abuffer/a b");
        assert_eq!(quoted("a,\"b\"\n"), "\"a,\"\"b\"\"\n\"");
        assert_eq!(
            markdown("a|b<c>&\n`[d]"),
            "a\\|b\\<c\\>\\&\u{fffd}\\`\\[d\\]"
        );
        assert_eq!(markdown("1/256, snake_case"), "1/256, snake_case");
    }

    #[test]
    fn shell_words_are_quoted_where_they_must_be() {
        assert_eq!(shell_word("abuffer/needle-fan"), "abuffer/needle-fan");
        assert_eq!(shell_word("a b'c; rm -rf"), r"'a b'\''c; rm -rf'");
        assert_eq!(shell_word(""), "''");
    }
}
