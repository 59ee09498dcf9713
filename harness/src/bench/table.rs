//! Rows as tables: on the terminal, and as cells for others.

use super::error::decibels;
use super::{Bench, Ceilings, Row, Spread, paper};
use crate::text::{clean, share};

/// The columns, of which the first is a name.
pub const COLUMNS: [&str; 12] = [
    "leg",
    "layers",
    "method",
    "time, ms",
    "from vertices",
    "of all",
    "PSNR, dB",
    "largest",
    "memory",
    "B/fragment",
    "fragments/s",
    "of bound",
];

/// A row's cells.
pub fn cells(row: &Row) -> [String; COLUMNS.len()] {
    let layers = match (row.method.has_layers(), row.all) {
        (false, _) => "–".to_owned(),
        (true, true) => format!("{} (all)", row.layers),
        (true, false) => row.layers.to_string(),
    };
    [
        clean(&row.leg).into_owned(),
        layers,
        row.method.name().to_owned(),
        spread(row.time, 1.0, 2),
        row.frame
            .map_or_else(|| "–".to_owned(), |frame| format!("{:.2}", frame.median)),
        spread(row.ratio, 1.0, 2),
        decibels(row.psnr),
        match row.largest {
            0.0 => "0".to_owned(),
            largest => format!("{largest:.1e}"),
        },
        match row.bands {
            1 => mebibytes(row.memory),
            bands => format!("{}, {bands} bands", mebibytes(row.memory)),
        },
        row.of_fragment
            .map_or_else(|| "–".to_owned(), |bytes| bytes.to_string()),
        format!("{:.1} M", row.fragments_per_second * 1e-6),
        format!("{} {}", share(row.fraction), row.bound),
    ]
}

/// Bytes in MiB.
pub(super) fn mebibytes(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}

/// `median [min, max]`.
pub(super) fn spread(of: Spread, scale: f64, digits: usize) -> String {
    let [median, min, max] = [of.median, of.min, of.max].map(|v| v * scale);
    format!("{median:.digits$} [{min:.digits$}, {max:.digits$}]")
}

/// A ceiling in words.
pub fn ceiling(ceilings: &Ceilings) -> String {
    let name = match ceilings.name.as_str() {
        "spec" => "one core".into(),
        name => clean(name),
    };
    let bytes = spread(ceilings.bytes, 1e-9, 1);
    match ceilings.atomics {
        Some(atomics) => {
            let atomics = spread(atomics, 1e-9, 3);
            format!("{name}: copies {bytes} GB/s, atomics of lists {atomics} G/s")
        }
        None => format!("{name}: copies {bytes} GB/s"),
    }
}

/// What there is to say of a scene above its rows.
pub fn heading(bench: &Bench, scene: &str) -> String {
    let row = bench.rows.iter().find(|row| row.scene == scene);
    let facts = row.map(|row| {
        let [width, height] = row.size;
        let (fragments, longest) = (crate::text::count(row.fragments), row.longest);
        format!(": {width} x {height}, {fragments} fragments in lists of up to {longest}")
    });
    format!("{}{}", clean(scene), facts.unwrap_or_default())
}

/// Lines for a terminal: the ceilings, of each scene the faster method of each leg
/// and number of layers with all other techniques, and then the paper's tables.
pub fn lines(bench: &Bench) -> Vec<String> {
    let mut lines: Vec<String> = bench.ceilings.iter().map(ceiling).collect();
    for scene in bench.scenes() {
        lines.push(String::new());
        lines.push(heading(bench, scene));
        let rows = bench.shown().filter(|row| row.scene == scene);
        let mut table = vec![COLUMNS.map(str::to_owned)];
        table.extend(rows.map(cells));
        lines.extend(aligned(&table, 1));
    }
    for section in paper::sections(bench) {
        lines.extend([String::new(), section.heading]);
        let mut table = vec![section.columns];
        table.extend(section.rows);
        lines.extend(aligned(&table, section.names));
    }
    lines
}

/// A table in columns as wide as their cells; the first `names` are words, the others
/// numbers.
pub(super) fn aligned<T: AsRef<[String]>>(
    table: &[T],
    names: usize,
) -> impl Iterator<Item = String> {
    let width = |column: usize| {
        let cells = table
            .iter()
            .map(|cells| cells.as_ref()[column].chars().count());
        cells.max().unwrap_or(0)
    };
    let columns = table.first().map_or(0, |cells| cells.as_ref().len());
    let widths: Vec<usize> = (0..columns).map(width).collect();
    table.iter().map(move |cells| {
        let mut line = String::new();
        for (column, (cell, width)) in cells.as_ref().iter().zip(&widths).enumerate() {
            line += &match column < names {
                true => format!("  {cell:<width$}"),
                false => format!("  {cell:>width$}"),
            };
        }
        line
    })
}
