//! A scene at a resolution.

use triptych_gpu::grid::Span;
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::trace::Query;
use triptych_spec::grid::{Blockers, Grid, Membership};

use super::super::counts;
use super::super::legs::{Legs, Station, Taken, order};
use super::super::warm::wake;
use super::super::{Ceilings, Progress, WARM_UP};
use super::asking::Asking;
use super::cpu::{self, Rivals};
use super::gpu::{Work, confirm, set_up};
use super::{RAYS_OF_SOFTWARE, row};
use crate::replay::spec::timed;

/// A scene at a resolution.
pub(super) struct Scene<'a> {
    name: String,
    blockers: &'a Blockers,
    grid: Grid,
    kinds: &'a [Asking],
    rivals: &'a Rivals,
}

/// Who traces rays on the CPU.
#[derive(Clone, Copy, PartialEq)]
enum Who {
    Spec,
    Embree,
    Obvhs,
}

/// Legs on the CPU: names, who, on all threads or on one, and the leg that each is held against.
const ON_CPU: [(&str, Who, bool, Option<usize>); 5] = [
    ("spec, one thread", Who::Spec, false, Some(1)),
    ("embree, one thread", Who::Embree, false, None),
    ("obvhs, one thread", Who::Obvhs, false, Some(1)),
    ("embree, all threads", Who::Embree, true, None),
    ("obvhs, all threads", Who::Obvhs, true, Some(3)),
];

impl<'a> Scene<'a> {
    /// `scale`: cells along each axis over those of `own`, the scene's grid.
    pub(super) fn new(
        name: &str,
        (blockers, own): (&'a Blockers, &Grid),
        scale: f64,
        kinds: &'a [Asking],
        rivals: &'a Rivals,
    ) -> Result<Self, String> {
        let cells = own.axes.each_ref().map(|axis| {
            let cells = (f64::from(axis.cells()) * scale).round().clamp(1.0, 1024.0);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "clamped"
            )]
            let cells = cells as u32;
            cells
        });
        let grid = Grid::build(blockers, Resolution::Given(cells), Membership::Box);
        let grid = grid.map_err(|e| e.to_string())?;
        let cells = grid.axes.each_ref().map(|axis| axis.cells().to_string());
        Ok(Self {
            name: format!("{name} {}", cells.join("x")),
            blockers,
            grid,
            kinds,
            rivals,
        })
    }

    pub(super) fn measure(
        &self,
        stations: &[Station<'_>],
        ceilings: &[Ceilings],
        legs: &mut Legs,
        progress: &Progress,
    ) {
        let kinds = u32::try_from(self.kinds.len()).unwrap_or(0);
        let stops = u32::try_from(stations.len()).unwrap_or(0) + 1;
        progress.begin(&self.name, 1 + kinds * stops);
        self.builds(legs);
        progress.step();
        for (at, asking) in self.kinds.iter().enumerate() {
            for query in [Query::Any, Query::Closest] {
                self.on_cpu(asking, query, legs);
            }
            progress.step();
            for station in stations {
                let name = &station.adapter.gpu.name;
                let own = ceilings.iter().find(|c| c.name == *name);
                if let Err(why) = self.on_gpu(station, own, asking, at == 0, legs) {
                    let (scene, kind) = (&self.name, asking.kind);
                    legs.remarks
                        .push(format!("not measured: gpu@{name}: {scene}, {kind}: {why}"));
                }
                progress.step();
            }
        }
    }

    /// What a build must move: corners are read twice, offsets and counts pass several times,
    /// entries are written once; each entry takes an atomic to be counted and one to be placed.
    fn of_build(&self) -> counts::Work {
        let (entries, cells) = (self.grid.prims.len() as u64, self.grid.offsets.len() as u64);
        counts::Work {
            bytes: 2 * 36 * self.blockers.triangles.len() as u64 + 4 * 7 * cells + 4 * 3 * entries,
            atomics: 2 * entries,
        }
    }

    /// Builds of grid and trees.
    fn builds(&self, legs: &mut Legs) {
        let triangles = self.blockers.triangles.len() as u64;
        let names = ["spec", "embree, one thread", "obvhs, one thread"];
        let mut taken = names.map(|name| Taken::new(name, "host", triangles));
        let cells = self.grid.axes.each_ref().map(|axis| axis.cells());
        for round in 0..WARM_UP.min(1) + legs.runs {
            for at in order(round, names.len()) {
                let time = match at {
                    0 => {
                        let build = || {
                            Grid::build(self.blockers, Resolution::Given(cells), Membership::Box)
                        };
                        timed(build).1
                    }
                    1 => timed(|| cpu::embree(self.blockers)).1,
                    _ => timed(|| cpu::Obvhs::new(self.blockers)).1,
                };
                if round >= WARM_UP.min(1) {
                    taken[at].seconds.push(time.as_secs_f64());
                }
            }
        }
        for (who, own) in [Who::Spec, Who::Embree, Who::Obvhs]
            .into_iter()
            .zip(&mut taken)
        {
            own.more.memory = Some(self.bytes(who));
        }
        let rows = taken.iter().enumerate().map(|(at, own)| {
            let against = (at != 1).then_some(&taken[1]);
            row(own, &self.name, "build", against)
        });
        legs.rows.extend(rows);
    }

    fn bytes(&self, who: Who) -> u64 {
        match who {
            Who::Spec => cpu::bytes(&self.grid, self.blockers),
            Who::Embree => self.rivals.embree.bytes(),
            Who::Obvhs => self.rivals.obvhs.bytes(),
        }
    }

    /// Rays of a kind on one thread and on all. A rival that is too unlike the spec is left out.
    fn on_cpu(&self, asking: &Asking, query: Query, legs: &mut Legs) {
        let compared = asking.rivals(query);
        let Rivals { embree, obvhs } = self.rivals;
        let is_in = |who: Who| match who {
            Who::Spec => true,
            Who::Embree => compared.refused[0].is_none(),
            Who::Obvhs => compared.refused[1].is_none(),
        };
        let mut taken = ON_CPU.map(|(name, who, ..)| {
            let rays = asking.on_cpu(who == Who::Spec).len() as u64;
            Taken::new(name, "host", rays)
        });
        for round in 0..WARM_UP + legs.runs {
            for at in order(round, ON_CPU.len()).filter(|at| is_in(ON_CPU[*at].1)) {
                let (_, who, threads, _) = ON_CPU[at];
                let rays = asking.on_cpu(who == Who::Spec);
                let (grid, blockers) = (&self.grid, self.blockers);
                let (met, time) = timed(|| match who {
                    Who::Spec => cpu::count(rays, threads, |ray| {
                        cpu::of_spec(grid, blockers, query, ray)
                    }),
                    Who::Embree => cpu::count(rays, threads, |ray| {
                        cpu::of_embree(embree, query, ray).is_some()
                    }),
                    Who::Obvhs => {
                        cpu::count(rays, threads, |ray| obvhs.meets(query, ray).is_some())
                    }
                });
                std::hint::black_box(met);
                if round >= WARM_UP {
                    taken[at].seconds.push(time.as_secs_f64());
                }
            }
        }
        let asked = asking.on_cpu(false).len() as u64;
        for ((_, who, ..), own) in ON_CPU.into_iter().zip(&mut taken) {
            own.more.memory = Some(self.bytes(who));
            own.more.unlike = match who {
                Who::Spec => None,
                Who::Embree => Some([compared.unlike[0], asked]),
                Who::Obvhs => Some([compared.unlike[1], asked]),
            };
        }
        let what = format!("{} {}", name(query), asking.kind);
        for ((_, who, _, against), own) in ON_CPU.iter().zip(&taken) {
            if is_in(*who) {
                let against = against.filter(|at| is_in(ON_CPU[*at].1));
                let against = against.map(|at| &taken[at]);
                legs.rows.push(row(own, &self.name, &what, against));
            }
        }
    }

    /// An adapter; `build`: its builds are noted as well.
    fn on_gpu(
        &self,
        station: &Station<'_>,
        ceilings: Option<&Ceilings>,
        asking: &Asking,
        build: bool,
        legs: &mut Legs,
    ) -> Result<(), String> {
        let gpu = &station.adapter.gpu;
        // A software driver is no faster than a CPU.
        let software = gpu.info.device_type == wgpu::DeviceType::Cpu;
        let most = if software {
            RAYS_OF_SOFTWARE
        } else {
            usize::MAX
        };
        let work = Work {
            blockers: self.blockers,
            grid: &self.grid,
            asked: asking.asked(self.blockers, most),
        };
        let spans = if build {
            &Span::ALL[..]
        } else {
            &Span::ALL[1..]
        };
        let kernels = [&station.adapter.kernels, &station.kernels];
        let (ready, timer) = set_up(gpu, kernels, &station.clock, &work, spans)?;
        let rays = work.asked.rays.len() as u64;
        let label = format!("gpu@{}", gpu.name);
        let of = |span: &Span| {
            let items = match span {
                Span::Build => self.blockers.triangles.len() as u64,
                Span::Any | Span::Closest => rays,
            };
            Taken::new(label.as_str(), station.clock_name(), items)
        };
        let mut taken: Vec<Taken> = spans.iter().map(of).collect();
        for round in 0..WARM_UP + legs.runs {
            if !software {
                wake(|| ready.time(spans, &timer).map(drop)).map_err(|e| e.to_string())?;
            }
            let seconds = ready.time(spans, &timer).map_err(|e| e.to_string())?;
            if round >= WARM_UP {
                for (taken, seconds) in taken.iter_mut().zip(seconds) {
                    taken.seconds.push(seconds);
                }
            }
        }
        confirm(&ready, &work)?;
        for (span, own) in spans.iter().zip(&mut taken) {
            let of_query = |query| (format!("{} {}", name(query), asking.kind), of_rays(rays));
            let (what, least) = match span {
                Span::Build => ("build".to_owned(), self.of_build()),
                Span::Any => of_query(Query::Any),
                Span::Closest => of_query(Query::Closest),
            };
            own.more.memory = Some(ready.bytes(*span));
            own.more.unlike = (*span != Span::Build).then_some([0, rays]);
            own.more.bound = ceilings.map(|ceilings| {
                let (bound, seconds) = ceilings.bound(least);
                (bound, seconds / own.median())
            });
            legs.rows.push(row(own, &self.name, &what, None));
        }
        Ok(())
    }
}

/// What a search must move: each ray is read, its hit read and written. Of the grid nothing is
/// counted, as a cache may hold it.
fn of_rays(rays: u64) -> counts::Work {
    counts::Work {
        bytes: (32 + 2 * 16) * rays,
        atomics: 0,
    }
}

/// How rays are traced, as rows say it.
pub(super) fn name(query: Query) -> &'static str {
    match query {
        Query::Any => "any",
        Query::Closest => "closest",
    }
}
