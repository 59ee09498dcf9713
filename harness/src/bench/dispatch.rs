//! Work queues and the ray tracer that they feed, measured as Nunes and Santos did (section 5).
//!
//! A frame is a picture of the scene: its primary rays are made, dealt, traced, shaded and summed up,
//! with all that they shoot. A run is so many frames by one crew, whose threads live as long as it
//! does; frames per second are those of a run. Each round runs every method with every number of
//! threads once, every other round backwards. Speed-up is relative to the *sequential version* of
//! the same round: one thread on a queue that nobody shares. What threads do with their time is looked
//! at in runs of their own, as looking at the clock takes time. No rate counts of which the last picture was not
//! the spec's to the bit; sums of floats under a spin lock, and Embree's decisions, are held to how far they may be off.

mod board;
mod claims;
mod csv;
mod identical;
mod method;
mod page;
mod plots;
mod run;
mod scene;
#[cfg(test)]
mod tests;

use std::cmp::Ordering;
use std::num::NonZeroU32;

use super::{Machine, Spread};
use crate::corpus::Entry;

pub use csv::csv;
pub use identical::{Found, identical};
pub use method::Method;
pub use page::{lines, page};
pub use plots::plots;
pub use run::run;

/// What is measured if nothing is asked for: stand-ins for the paper's conference room and office, its
/// bunny, and a picture for which work cannot be dealt evenly beforehand (claim N27).
pub const SCENES: [&str; 4] = [
    "dispatch/conference",
    "dispatch/office",
    "dispatch/bunny",
    "dispatch/uneven",
];

/// What is measured, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scenes.
    pub scenes: Vec<Entry>,
    /// Pixels a side of square pictures; others keep theirs.
    pub side: u32,
    /// Frames of a run.
    pub frames: u32,
    /// Runs that count.
    pub runs: u32,
    /// Numbers of threads, rising.
    pub threads: Vec<usize>,
    /// Only the paper's queues, with both endings.
    pub papers: bool,
    /// Today, year-month-day.
    pub date: String,
}

impl Options {
    /// Pixels a side, as in the paper.
    pub const SIDE: u32 = 300;
    /// Frames of a run: a tenth of the paper's, whose 200 take hours.
    pub const FRAMES: NonZeroU32 = NonZeroU32::new(20).expect("more than none");
    /// Runs, as in the paper.
    pub const RUNS: NonZeroU32 = NonZeroU32::new(3).expect("more than none");

    /// From one thread to twice as many as there are cores: all up to 4, then half as many again,
    /// in turn with powers of two.
    pub fn threads(cores: usize) -> Vec<usize> {
        let most = 2 * cores.max(1);
        let steps = (1..).map(|power| 1_usize << power);
        let steps = steps.flat_map(|step| [step, step + step / 2]);
        let mut all: Vec<usize> = steps.take_while(|n| *n <= most).collect();
        all.extend([1, cores.max(1), most]);
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// A run of the benchmark.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// When, year-month-day.
    pub date: String,
    /// Where.
    pub machine: Machine,
    /// Frames of a run.
    pub frames: u32,
    /// Runs that count.
    pub runs: u32,
    /// Adapters, by the numbers of [`Method::Board`].
    pub boards: Vec<String>,
    /// Scene by scene, method by method, with rising numbers of threads.
    pub rows: Vec<Row>,
    /// What was not measured, and why.
    pub remarks: Vec<String>,
}

/// Frames per second whose medians differ by less are taken for the same, and so are those of settings whose
/// runs overlap.
const SAME: f64 = 0.05;

/// A method with so many threads on a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// `family/case`.
    pub scene: String,
    /// Columns and rows.
    pub size: [u32; 2],
    /// Triangles.
    pub triangles: u64,
    /// Rays of a frame.
    pub rays: u64,
    /// How tasks are distributed, and what traces them.
    pub method: Method,
    /// Threads; 0 on a board.
    pub threads: usize,
    /// Frames per second of the runs.
    pub fps: Spread,
    /// The same over the sequential version's of the same round.
    pub speed_up: Spread,
    /// What threads did with their time, where that was looked at.
    pub spent: Option<Spent>,
}

/// What threads did with their time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spent {
    /// Milliseconds that a thread was idle in a frame, on average (the paper's Figure 6).
    pub idle: f64,
    /// Milliseconds within the queue's operations in a frame, all threads together (Figure 7).
    pub access: f64,
}

impl Row {
    /// Rays per second, by the median run.
    pub fn rays_per_second(&self) -> f64 {
        self.rays as f64 * self.fps.median
    }

    /// Whether it has more frames a second than another, or fewer; `None` if runs of both differ by more,
    /// or medians by less than [`SAME`].
    fn beside(&self, other: &Self) -> Option<Ordering> {
        let (own, other) = (self.fps, other.fps);
        if own.min > other.max && own.median > (1.0 + SAME) * other.median {
            Some(Ordering::Greater)
        } else if own.max < other.min && own.median < (1.0 - SAME) * other.median {
            Some(Ordering::Less)
        } else {
            None
        }
    }
}

impl Measured {
    /// A word for a method; a board's is its name.
    pub fn name(&self, method: Method) -> &str {
        match method {
            Method::Board(number) => self.boards.get(number).map_or("", String::as_str),
            _ => method.name(),
        }
    }

    /// The scenes, in the order of the rows.
    pub fn scenes(&self) -> Vec<&str> {
        let mut scenes: Vec<&str> = Vec::new();
        for row in &self.rows {
            if !scenes.contains(&row.scene.as_str()) {
                scenes.push(&row.scene);
            }
        }
        scenes
    }

    /// A scene's row of a method with so many threads.
    pub fn row(&self, scene: &str, method: Method, threads: usize) -> Option<&Row> {
        let is =
            |row: &&Row| (row.scene.as_str(), row.method, row.threads) == (scene, method, threads);
        self.rows.iter().find(is)
    }

    /// Numbers of threads that anything was measured with, rising.
    pub fn threads(&self) -> Vec<usize> {
        let mut all: Vec<usize> = self.rows.iter().map(|row| row.threads).collect();
        all.retain(|threads| *threads > 0);
        all.sort_unstable();
        all.dedup();
        all
    }

    /// What names of files begin with.
    pub fn stem(&self) -> String {
        format!("dispatch-{}-{}", self.date, self.machine.slug)
    }
}
