//! Results as JSON lines: one [`Row`] per line, and a [`Summary`] to end with.
//!
//! Each line is an object whose `type` is `row` or `summary`; the other fields are
//! those of [`Row`] and [`Summary`]. A run of mutants has `mutant` and `mutants`, with
//! the fields of [`Cell`] and [`Matrix`]. A reader tolerates fields that it does not
//! know and names those that it misses. A summary must agree with the rows since
//! the summary before it, so that neither a run that was cut off nor a file that
//! lost lines merges into something that looks complete; whole files may be
//! concatenated.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::InputError;
use crate::mutants::{Cell, Matrix};
use crate::row::{Row, Summary};

/// Longest line that is read, in bytes; a row is below 2 KiB.
pub const LINE_MAX: usize = 1 << 20;

#[derive(Serialize)]
#[serde(tag = "type", rename_all = "kebab-case")]
enum LineOut<'a> {
    Row(&'a Row),
    Summary(&'a Summary),
    Mutant(&'a Cell),
    Mutants(&'a Matrix),
}

#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "kebab-case")]
enum LineIn {
    Row(Box<Row>),
    Summary(Summary),
    Mutant(Box<Cell>),
    Mutants(Matrix),
}

/// Writes rows as they come.
pub struct Writer<W: Write> {
    out: W,
    rows: Vec<Row>,
}

impl Writer<BufWriter<File>> {
    /// A writer to a new file; its folder is made if absent.
    pub fn create(path: &Path) -> io::Result<Self> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        Ok(Self::new(BufWriter::new(File::create(path)?)))
    }
}

impl<W: Write> Writer<W> {
    /// A writer to anything.
    pub fn new(out: W) -> Self {
        Self {
            out,
            rows: Vec::new(),
        }
    }

    /// Writes the rows of a scene and hands them on, so that what a run found
    /// before it died can be read.
    pub fn rows(&mut self, rows: &[Row]) -> io::Result<()> {
        for row in rows {
            self.line(&LineOut::Row(row))?;
        }
        self.rows.extend_from_slice(rows);
        self.out.flush()
    }

    /// Writes the summary of all rows written. `seconds` is the run's wall time.
    pub fn finish(mut self, seconds: f64) -> io::Result<Summary> {
        let summary = Summary::of(&self.rows, seconds);
        self.line(&LineOut::Summary(&summary))?;
        self.out.flush()?;
        Ok(summary)
    }

    fn line(&mut self, line: &LineOut<'_>) -> io::Result<()> {
        let mut text = serde_json::to_vec(line)?;
        text.push(b'\n');
        self.out.write_all(&text)
    }
}

/// A run of mutants.
#[derive(Clone, Debug, PartialEq)]
pub struct MutantRun {
    /// What it came to.
    pub matrix: Matrix,
    /// Each mutant on each leg.
    pub cells: Vec<Cell>,
}

/// Writes a run of mutants to a new file; its folder is made if absent.
pub fn write_mutants(path: &Path, run: &MutantRun) -> io::Result<()> {
    let mut writer = Writer::create(path)?;
    for cell in &run.cells {
        writer.line(&LineOut::Mutant(cell))?;
    }
    writer.line(&LineOut::Mutants(&run.matrix))?;
    writer.out.flush()
}

/// The rows of several runs, in the order of the files.
#[derive(Clone, Debug, PartialEq)]
pub struct Merged {
    /// All rows.
    pub rows: Vec<Row>,
    /// Recomputed from the rows; `seconds` is the sum over the runs, which may
    /// have run side by side.
    pub summary: Summary,
    /// Runs of mutants.
    pub mutants: Vec<MutantRun>,
}

/// Reads the JSON lines of several runs: shards of one, or several machines'.
pub fn read(paths: &[impl AsRef<Path>]) -> Result<Merged, InputError> {
    let (mut read, mut seconds) = (Lines::default(), 0.0);
    for (at, path) in paths.iter().enumerate() {
        let path = path.as_ref();
        let fail = |message: String| InputError::new(path, message);
        // Its rows would count twice.
        if paths[..at].iter().any(|before| before.as_ref() == path) {
            return Err(fail("is named twice".into()));
        }
        // Asked before opening: opening a pipe would wait for its other end.
        let metadata = path.metadata().map_err(|e| fail(e.to_string()))?;
        if !metadata.is_file() {
            return Err(fail("is not a regular file".into()));
        }
        let file = File::open(path).map_err(|e| fail(e.to_string()))?;
        seconds += read_run(path, BufReader::new(file), &mut read)?;
    }
    Ok(read.merged(seconds))
}

/// Reads what one file holds; `path` is what errors name.
///
/// # Errors
/// As [`read`], for one file.
pub fn read_from(path: &Path, input: impl BufRead) -> Result<Merged, InputError> {
    let mut read = Lines::default();
    let seconds = read_run(path, input, &mut read)?;
    Ok(read.merged(seconds))
}

/// What lines amount to so far.
#[derive(Default)]
struct Lines {
    rows: Vec<Row>,
    mutants: Vec<MutantRun>,
    /// Rows before this one are vouched for by a summary.
    checked: usize,
    /// Cells that no matrix has vouched for yet.
    cells: Vec<Cell>,
    /// Whether the last line was one that vouches.
    complete: bool,
}

impl Lines {
    /// Takes the next line; gives the wall time of a run that it ends.
    fn take(&mut self, line: LineIn) -> Result<f64, String> {
        self.complete = matches!(line, LineIn::Summary(_) | LineIn::Mutants(_));
        match line {
            LineIn::Row(row) => self.rows.push(*row),
            LineIn::Mutant(cell) => self.cells.push(*cell),
            LineIn::Summary(summary) => {
                check(&summary, &self.rows[self.checked..])?;
                self.checked = self.rows.len();
                return Ok(summary.seconds);
            }
            LineIn::Mutants(matrix) => {
                let cells = std::mem::take(&mut self.cells);
                check_mutants(&matrix, &cells)?;
                self.mutants.push(MutantRun { matrix, cells });
            }
        }
        Ok(0.0)
    }

    fn merged(self, seconds: f64) -> Merged {
        Merged {
            summary: Summary::of(&self.rows, seconds),
            rows: self.rows,
            mutants: self.mutants,
        }
    }

    fn is_complete(&self) -> bool {
        self.complete && self.cells.is_empty() && self.checked == self.rows.len()
    }
}

/// Takes the lines of one file and returns the wall time of its replays.
fn read_run(path: &Path, mut input: impl BufRead, lines: &mut Lines) -> Result<f64, InputError> {
    let mut seconds = 0.0;
    lines.complete = false;
    let mut line = Vec::new();
    for number in 1.. {
        line.clear();
        let mut limited = input.by_ref().take(LINE_MAX as u64 + 1);
        let length = limited
            .read_until(b'\n', &mut line)
            .map_err(|e| InputError::at(path, number, e.to_string()))?;
        if length == 0 {
            break;
        }
        if length > LINE_MAX {
            let message = format!("a line of more than {LINE_MAX} bytes; a row is below 2 KiB");
            return Err(InputError::at(path, number, message));
        }
        let text = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&line);
        let text = text.trim_ascii();
        if text.is_empty() {
            continue;
        }
        let parsed = serde_json::from_slice(text).map_err(|e| explain(&e));
        seconds += parsed
            .and_then(|line| lines.take(line))
            .map_err(|message| InputError::at(path, number, message))?;
    }
    if lines.is_complete() {
        Ok(seconds)
    } else {
        let message = "ends without a summary line: the run was cut off, or this is no result \
                       of `triptych replay --json`";
        Err(InputError::new(path, message))
    }
}

/// A matrix must say what its cells say.
fn check_mutants(matrix: &Matrix, cells: &[Cell]) -> Result<(), String> {
    let actual = Matrix::of(cells, matrix.seconds, matrix.date.clone());
    let counts = |m: &Matrix| [m.mutants, m.killed, m.absent, m.cells];
    match counts(matrix) == counts(&actual) {
        true => Ok(()),
        false => Err(
            "the summary of the mutants is not what the lines above it amount to: \
                      lines were lost, added or changed"
                .into(),
        ),
    }
}

/// A summary must say what its rows say.
fn check(summary: &Summary, rows: &[Row]) -> Result<(), String> {
    let actual = Summary::of(rows, summary.seconds);
    let fields = [
        ("scenes", summary.scenes, actual.scenes),
        ("compared", summary.compared, actual.compared),
        ("unexplained", summary.unexplained, actual.unexplained),
        ("skipped", summary.skipped, actual.skipped),
        ("diverging", summary.diverging, actual.diverging),
    ];
    for (name, said, found) in fields {
        if said != found {
            return Err(format!(
                "the summary says `{name}` {said}, the rows above it amount to {found}: \
                 lines were lost, added or changed"
            ));
        }
    }
    if summary.seconds.is_finite() && summary.seconds >= 0.0 {
        Ok(())
    } else {
        Err(format!("`seconds` is {}, not a time", summary.seconds))
    }
}

/// The parser's message without its own line number, which is always 1.
fn explain(error: &serde_json::Error) -> String {
    let message = error.to_string();
    let (what, place) = match message.rsplit_once(" at line ") {
        Some((what, _)) if error.column() > 0 => (what, format!(", column {}", error.column())),
        Some((what, _)) => (what, String::new()),
        None => (message.as_str(), String::new()),
    };
    format!("not a result line{place}: {what}")
}

#[cfg(test)]
mod tests;
