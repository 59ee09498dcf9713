//! Judgements of the same stage over all frames, or over all rotations.

use std::time::Duration;

use crate::compare::Judgement;
use crate::observe::{Gpu, Observed, Spec};
use crate::replay::rows::Rows;
use crate::row::Class;

/// What became of each stage, and of the parts of it that are judged in another way.
#[derive(Default)]
pub(super) struct Judged {
    kinds: Vec<Kind>,
}

/// A row to be.
struct Kind {
    stage: &'static str,
    class: Class,
    unit: &'static str,
    frames: Vec<Judgement>,
    /// The spec's time and the device's; none for a part that another row times.
    times: Option<[Duration; 2]>,
}

impl Judged {
    /// A frame's judgement of a stage, with the time of the spec and of the device.
    pub(super) fn add(
        &mut self,
        stage: &'static str,
        judgement: Judgement,
        spec: Duration,
        device: Duration,
    ) {
        let kind = self.kind(stage, judgement);
        let [a, b] = kind.times.unwrap_or_default();
        kind.times = Some([a + spec, b + device]);
    }

    /// A frame's judgement of another of a stage's results.
    pub(super) fn part(&mut self, stage: &'static str, judgement: Judgement) {
        self.kind(stage, judgement);
    }

    /// Whether a result is what it may be; if not, the row tells how. One that is sound has its
    /// row where its stage is judged from the spec's input.
    pub(super) fn may_follow(&mut self, stage: &'static str, judgement: Judgement) -> bool {
        let sound = judgement.differ() == 0;
        if !sound {
            // Its errors have another unit than the row's.
            self.part(
                stage,
                Judgement {
                    error: None,
                    error_over_bound: None,
                    ..judgement
                },
            );
        }
        sound
    }

    fn kind(&mut self, stage: &'static str, judgement: Judgement) -> &mut Kind {
        let (class, unit) = (judgement.class, judgement.unit);
        let same = |kind: &Kind| (kind.stage, kind.class, kind.unit) == (stage, class, unit);
        let at = self.kinds.iter().position(same).unwrap_or_else(|| {
            self.kinds.push(Kind {
                stage,
                class,
                unit,
                frames: Vec::new(),
                times: None,
            });
            self.kinds.len() - 1
        });
        let kind = &mut self.kinds[at];
        kind.frames.push(judgement);
        kind
    }

    /// A row for each.
    pub(super) fn rows(self, spec: &str, device: &str, rows: &mut Rows) {
        self.rows_or(None, spec, device, rows);
    }

    /// The same, of stages that a scene may leave nothing to do: they were run, and made nothing, as they
    /// must. Their rows are skipped for this reason.
    pub(super) fn rows_or(self, idle: Option<&str>, spec: &str, device: &str, rows: &mut Rows) {
        for kind in self.kinds {
            // Frames of which there is the same to say have it said once.
            let mut notes: Vec<String> = kind.frames.iter().map(|j| j.note.clone()).collect();
            notes.retain(|note| !note.is_empty());
            notes.dedup();
            let judgement = Judgement::sum(kind.frames);
            // A difference is what there is to say.
            let note = match judgement.described.is_empty() {
                true => notes.join("; "),
                false => String::new(),
            };
            let mut judgement = Judgement { note, ..judgement };
            if judgement.compared == 0 && judgement.differ() == 0 {
                judgement.skipped = judgement.skipped.or_else(|| idle.map(str::to_owned));
            }
            let mut a = Observed::<Spec, _>::new(spec, ());
            let mut b = Observed::<Gpu, _>::new(device, ());
            if let Some([spec, device]) = kind.times {
                (a, b) = (a.taking(spec), b.taking(device));
            }
            rows.add(kind.stage, &a, &b, judgement);
        }
    }
}
