//! What the comparison of rays with Embree amounts to.

use std::fmt;

use crate::cause::Cause;
use crate::compare::{DESCRIBED_MAX, Judgement};
use crate::row::Class;
use crate::text::share;

/// Result of one comparison. Counts are of rays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RayVote {
    /// All rays.
    pub rays: u64,
    /// Those that do not move: they meet nothing by rule, and Embree is not asked.
    pub still: u64,
    /// Rays in class edge.
    pub edge: u64,
    /// Those of them where Embree says what the spec does.
    pub agreed_in_edge: u64,
    /// Rays of which Embree says what it must not.
    pub disagree: u64,
    /// Times compared.
    pub times: u64,
    /// Largest error of a time within its bound, in lengths of the direction.
    pub error: f64,
    /// Largest error of a time over its bound; infinite if it is no number.
    pub error_over_bound: f64,
    /// Class edge of each kind of rays, where kinds were told apart; none that has no ray.
    pub kinds: Vec<OfKind>,
    /// The first disagreements, by ray.
    pub first: Vec<RayDisagreement>,
}

/// How many rays of a kind are in class edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OfKind {
    /// The kind.
    pub name: &'static str,
    /// Rays that Embree was asked about.
    pub asked: u64,
    /// Those of them in class edge.
    pub edge: u64,
}

/// A ray of which Embree says what it must not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayDisagreement {
    /// Its number.
    pub ray: usize,
    /// What is wrong.
    pub conflict: RayConflict,
}

/// In what Embree and the grid disagree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RayConflict {
    /// A triangle is met inside, and nothing reported.
    Missed {
        /// The triangle.
        prim: u32,
    },
    /// Something is reported, and nothing met.
    Invented,
    /// What is reported is not met.
    Wrong {
        /// The triangle.
        prim: u32,
    },
    /// A triangle is met inside, but no cell on the way lists it.
    Unlisted {
        /// The triangle.
        prim: u32,
    },
    /// What is reported lies behind something that is met inside, or the end of the ray.
    Late {
        /// The triangle.
        prim: u32,
        /// Embree's time.
        embree: f32,
        /// The latest that it may be.
        limit: f64,
    },
    /// The triangle may be right, but its time is not.
    Time {
        /// The triangle.
        prim: u32,
        /// The exact time.
        t: f64,
        /// Largest distance that the bound allows.
        bound: f64,
        /// Embree's time.
        embree: f32,
    },
}

impl RayVote {
    /// Notes a ray in class edge.
    pub(super) fn edge(&mut self, agree: bool) {
        self.edge += 1;
        self.agreed_in_edge += u64::from(agree);
    }

    /// Counts a disagreement.
    pub(super) fn differs(&mut self, disagreement: RayDisagreement) {
        self.disagree += 1;
        self.keep(disagreement);
    }

    fn keep(&mut self, disagreement: RayDisagreement) {
        if self.first.len() < DESCRIBED_MAX {
            self.first.push(disagreement);
        }
    }

    /// Adds the rays that follow.
    pub fn add(&mut self, next: Self) {
        self.rays += next.rays;
        self.still += next.still;
        self.edge += next.edge;
        self.agreed_in_edge += next.agreed_in_edge;
        self.disagree += next.disagree;
        self.times += next.times;
        self.error = self.error.max(next.error);
        self.error_over_bound = self.error_over_bound.max(next.error_over_bound);
        self.kinds.extend(next.kinds);
        for disagreement in next.first {
            self.keep(disagreement);
        }
    }

    /// Adds the rays that follow, which are all of a kind and counted from 0.
    pub(crate) fn add_kind(&mut self, name: &'static str, mut next: Self, before: usize) {
        let (asked, edge) = (next.rays - next.still, next.edge);
        if asked > 0 {
            next.kinds.push(OfKind { name, asked, edge });
        }
        next.first.iter_mut().for_each(|first| first.ray += before);
        self.add(next);
    }

    /// As a row has it; `edge_budget` is the largest share that may be in class edge. A vote
    /// alone cannot say who errs.
    pub fn judgement(&self, edge_budget: Option<f64>) -> Judgement {
        let asked = self.rays - self.still;
        let cause = (self.disagree > 0).then_some((Cause::OracleDisagreement, self.disagree));
        let mut judgement = Judgement {
            compared: asked,
            causes: cause.into_iter().collect(),
            admitted: self.edge,
            admitted_budget: edge_budget,
            error: (self.times > 0).then_some(self.error),
            error_over_bound: (self.times > 0).then_some(self.error_over_bound),
            described: self.first.iter().map(ToString::to_string).collect(),
            note: self.to_string(),
            ..Judgement::new(Class::Vote, "rays")
        };
        if self.disagree == 0 && asked == self.edge {
            let reason = match asked {
                0 if self.rays == 0 => "no ray is asked for".to_owned(),
                0 => "no ray moves".to_owned(),
                _ => format!("all {asked} rays are in class edge"),
            };
            judgement.skipped = Some(reason);
        }
        judgement
    }
}

impl fmt::Display for RayVote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} of {} rays in class edge ({} agree), {} times, error over bound {:.3}",
            self.edge, self.rays, self.agreed_in_edge, self.times, self.error_over_bound,
        )?;
        let of_kind = |kind: &OfKind| {
            let part = kind.edge as f64 / kind.asked as f64;
            format!("{} {}", kind.name, share(part))
        };
        let kinds: Vec<String> = self.kinds.iter().map(of_kind).collect();
        if !kinds.is_empty() {
            write!(f, "; edge: {}", kinds.join(", "))?;
        }
        match self.first.first() {
            Some(first) => write!(f, "; {} disagree, first: {first}", self.disagree),
            None => Ok(()),
        }
    }
}

impl fmt::Display for RayDisagreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "ray {}: ", self.ray)?;
        match self.conflict {
            RayConflict::Missed { prim } => {
                write!(f, "meets triangle {prim}, but Embree reports nothing")
            }
            RayConflict::Invented => write!(f, "meets nothing, but Embree reports something"),
            RayConflict::Wrong { prim } => {
                write!(f, "Embree reports triangle {prim}, which it passes by")
            }
            RayConflict::Unlisted { prim } => {
                write!(f, "meets triangle {prim}, which no cell on the way lists")
            }
            RayConflict::Late {
                prim,
                embree,
                limit,
            } => write!(
                f,
                "Embree reports triangle {prim} at {embree}, but must meet one by {limit}"
            ),
            RayConflict::Time {
                prim,
                t,
                bound,
                embree,
            } => write!(
                f,
                "triangle {prim} at {t}, Embree {embree}, bound {bound:.3e}"
            ),
        }
    }
}
