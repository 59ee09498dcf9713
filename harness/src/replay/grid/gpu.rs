//! A GPU leg of a grid: every stage from the spec's input, then all from its own.

use triptych_gpu::error::GpuError;
use triptych_gpu::grid::{Device, Stages};
use triptych_gpu::raster::Path;
use triptych_spec::grid::Membership;
use triptych_spec::grid::trace::Query;

use super::spec::GridRun;
use crate::compare::grid::{self as judge, Asked, Runs};
use crate::compare::{Judgement, compare};
use crate::observe::{Gpu, Observed, Spec};
use crate::replay::gpu::Adapter;
use crate::replay::rows::Rows;
use crate::row::Class;
use crate::scene::value::Capacity;

/// Why lists of a device are not followed.
pub(super) const DAMAGED: &str = "the device's own lists are damaged: see the stages before";

/// One GPU leg of one scene.
pub struct GridLeg<'a> {
    adapter: &'a Adapter,
    /// With words or with native integers.
    path: Path,
    pub(super) spec: &'a Observed<Spec, GridRun>,
    /// Entries of the first attempt.
    capacity: Capacity,
}

impl<'a> GridLeg<'a> {
    /// A leg that has not run.
    pub fn new(
        adapter: &'a Adapter,
        path: Path,
        spec: &'a Observed<Spec, GridRun>,
        capacity: Capacity,
    ) -> Self {
        Self {
            adapter,
            path,
            spec,
            capacity,
        }
    }

    /// Adds a row for each stage from the spec's input, and one for all of them end to end.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn run(&self, rows: &mut Rows) -> Result<(), GpuError> {
        self.each(rows)?;
        self.end_to_end(rows)
    }

    /// Adds a row for each stage from the spec's input.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn each(&self, rows: &mut Rows) -> Result<(), GpuError> {
        let mut stages = self.stages()?;
        match self.spec.value.membership {
            Membership::Box => self.lists(&mut stages, rows)?,
            Membership::Overlap => self.fewer_lists(&mut stages, rows)?,
        }
        self.linked(&mut stages, rows)?;
        let spec = &self.spec.value;
        stages.give_offsets(&spec.grid.offsets)?;
        stages.give_prims(&spec.grid.prims)?;
        for query in [Query::Any, Query::Closest] {
            let judgement = self.traced(&mut stages, query)?;
            let times = spec.times.trace;
            let seen = self.seen((), &stages);
            rows.add(
                "trace",
                &self.spec.map(|_| ()).taking(times),
                &seen,
                judgement,
            );
        }
        Ok(())
    }

    pub(super) fn stages(&self) -> Result<Stages<'_>, GpuError> {
        let spec = &self.spec.value;
        let device = Device::new(
            &self.adapter.gpu,
            self.adapter.kernels(self.path),
            &spec.blockers,
            &spec.grid.axes,
            spec.membership,
        )?;
        Stages::new(device)
    }

    pub(super) fn label(&self) -> String {
        self.adapter.label(self.path)
    }

    fn seen<T>(&self, value: T, stages: &Stages<'_>) -> Observed<Gpu, T> {
        Observed::new(self.label(), value).taking(stages.time)
    }

    /// How many entries a device's own offsets make room for; `None` if they do not rise, or
    /// lead beyond what boxes touch.
    pub(super) fn entries_of(&self, offsets: &[u32]) -> Option<u32> {
        let most = self.spec.value.box_runs().prims.len();
        let last = offsets.last().copied().unwrap_or(0);
        (offsets.is_sorted() && last as usize <= most).then_some(last)
    }

    /// Lists by boxes, equal to the bit.
    fn lists(&self, stages: &mut Stages<'_>, rows: &mut Rows) -> Result<(), GpuError> {
        let spec = &self.spec.value;
        let seen = stages.count()?;
        let seen = self.seen(seen, stages);
        let counts = self.spec.map(|s| &s.counts).taking(spec.times.count);
        let judgement = compare(&counts, &seen, |a, b| judge::counts(a, b));
        rows.add("count", &counts, &seen, judgement);

        stages.give_counts(&spec.counts)?;
        let seen = stages.scan()?;
        let seen = self.seen(seen, stages);
        let offsets = self.spec.map(|s| &s.grid.offsets).taking(spec.times.scan);
        let judgement = compare(&offsets, &seen, |a, b| judge::offsets(a, b));
        rows.add("scan", &offsets, &seen, judgement);

        let runs = self.spec.map(GridRun::runs).taking(spec.times.fill);
        stages.give_offsets(&spec.grid.offsets)?;
        if self.capacity != Capacity::All {
            let capacity = self.capacity.nodes(spec.entries());
            let seen = stages.fill(spec.entries(), capacity)?;
            let seen = self.seen(seen, stages);
            let mut judgement = compare(&runs, &seen, |a, b| judge::overflowed(*a, b));
            judgement.note = format!("fill: room for {capacity} of {}", spec.entries());
            rows.add("overflow", &runs, &seen, judgement);
            stages.give_counts(&spec.counts)?;
        }
        let seen = stages.fill(spec.entries(), spec.entries())?;
        let seen = self.seen(seen, stages);
        let judgement = compare(&runs, &seen, |a, b| judge::entries(*a, b));
        rows.add("fill", &runs, &seen, judgement);
        Ok(())
    }

    /// Lists without triangles that miss the cell, which a kernel may not always prove: from
    /// its own counts, between the spec's lists and those of boxes.
    fn fewer_lists(&self, stages: &mut Stages<'_>, rows: &mut Rows) -> Result<(), GpuError> {
        let spec = &self.spec.value;
        let counts = stages.count()?;
        let seen = self.seen(counts, stages);
        let between = self
            .spec
            .map(|s| (&s.counts, s.box_runs()))
            .taking(spec.times.count);
        let judgement = compare(&between, &seen, |(least, most), seen| {
            judge::counts_within(least, seen, *most)
        });
        rows.add("count", &between, &seen, judgement);

        let own = triptych_spec::grid::scan(&seen.value);
        let own = self.spec.derive(own.unwrap_or_default());
        let counts = seen.value;
        let seen = stages.scan()?;
        let seen = self.seen(seen, stages);
        let judgement = compare(&own, &seen, |a, b| judge::offsets(a, b));
        rows.add("scan", &own, &seen, judgement);

        let offsets = seen.value;
        let Some(entries) = self.entries_of(&offsets) else {
            let (label, reason) = (self.label(), DAMAGED.to_owned());
            rows.skip("fill", "spec", &label, Class::Decision, reason);
            return Ok(());
        };
        let filled = stages.fill(entries, entries)?;
        let seen = self.seen(filled, stages);
        if self.capacity != Capacity::All {
            stages.give_counts(&counts)?;
            self.fewer_overflowed(stages, rows, [&offsets, &seen.value])?;
        }
        let bounds = self
            .spec
            .map(|s| (s.runs(), s.box_runs()))
            .taking(spec.times.fill);
        let judgement = compare(&bounds, &seen, |(least, most), prims| {
            let seen = Runs {
                offsets: &offsets,
                prims,
            };
            judge::within(*least, seen, *most)
        });
        rows.add("fill", &bounds, &seen, judgement);
        Ok(())
    }

    /// An attempt without room for all, against the lists that the device fills with room: which
    /// they are to be is judged of those. Counts are given.
    fn fewer_overflowed(
        &self,
        stages: &mut Stages<'_>,
        rows: &mut Rows,
        [offsets, prims]: [&[u32]; 2],
    ) -> Result<(), GpuError> {
        let entries = u32::try_from(prims.len()).expect("at most ENTRIES_MAX");
        let capacity = self.capacity.nodes(entries);
        let seen = stages.fill(entries, capacity)?;
        let seen = self.seen(seen, stages);
        let own = self.spec.derive(Runs { offsets, prims });
        let mut judgement = compare(&own, &seen, |a, b| judge::overflowed(*a, b));
        judgement.note = format!("fill: room for {capacity} of {entries}");
        rows.add("overflow", &own, &seen, judgement);
        Ok(())
    }

    /// The paper's lists: with room for all, and where the scene says so without.
    fn linked(&self, stages: &mut Stages<'_>, rows: &mut Rows) -> Result<(), GpuError> {
        let spec = &self.spec.value;
        let runs = self.spec.map(GridRun::runs);
        let needed = spec.box_runs().prims.len();
        let needed = u32::try_from(needed).expect("at most ENTRIES_MAX");
        let first = self.capacity.nodes(spec.entries());
        let attempts = [(first, "overflow"), (needed, "link")];
        for (capacity, stage) in attempts {
            if stage == "overflow" && self.capacity == Capacity::All {
                continue;
            }
            let linked = stages.link(capacity)?;
            let seen = self.seen(linked, stages);
            let most = spec.box_runs();
            let judgement = compare(&runs, &seen, |runs, linked| {
                judge::linked(*runs, most, linked)
            });
            rows.add(stage, &runs, &seen, judgement);
        }
        Ok(())
    }

    pub(super) fn traced(
        &self,
        stages: &mut Stages<'_>,
        query: Query,
    ) -> Result<Judgement, GpuError> {
        let hits = stages.trace(&self.spec.value.rays, query)?;
        let seen = self.seen(hits, stages);
        Ok(compare(self.spec, &seen, |spec, hits| {
            let asked = Asked {
                blockers: &spec.blockers,
                rays: &spec.rays,
                answers: &spec.answers,
            };
            match query {
                Query::Any => judge::any(asked, hits),
                Query::Closest => judge::closest(asked, hits),
            }
        }))
    }
}
