//! A scene at a resolution.

use triptych_gpu::grid::Span;
use triptych_gpu::kernel::Kernels;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::trace::{Closest, Query, trace};
use triptych_spec::grid::{Blockers, Grid, Membership};

use super::super::counts;
use super::super::legs::{Legs, Station, Taken, order};
use super::super::warm::wake;
use super::super::{Ceilings, Progress, Spread, WARM_UP};
use super::gpu::{Work, set_up};
use super::run::Options;
use super::{RAYS_OF_CPU, cpu, row};
use crate::compare::grid::Asked;
use crate::rays::{Kind, Source, view};
use crate::replay::spec::timed;

/// A scene at a resolution.
pub(super) struct Scene<'a> {
    name: String,
    blockers: &'a Blockers,
    grid: Grid,
    kinds: Vec<Asking>,
}

/// Rays of a kind, and the spec's answers to the first of them.
struct Asking {
    kind: &'static str,
    rays: Vec<Ray>,
    answers: Vec<Option<Closest>>,
}

impl<'a> Scene<'a> {
    pub(super) fn new(
        name: &str,
        blockers: &'a Blockers,
        scale: f64,
        seed: u64,
        options: &Options,
    ) -> Result<Self, String> {
        let own = Grid::build(blockers, Resolution::FromScene, Membership::Box);
        let own = own.map_err(|e| e.to_string())?;
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
        let mut source = Source::new(blockers, &grid, seed);
        let mut kinds = Vec::new();
        for kind in [Kind::Random, Kind::Aimed] {
            let rays: Vec<Ray> = (0..options.rays).map(|_| source.next(kind)).collect();
            kinds.push((kind.name(), rays));
        }
        kinds.push(("view", view(&grid, options.rays)));
        let answered = |(kind, rays): (&'static str, Vec<Ray>)| {
            let answers = trace(&grid, blockers, &rays[..rays.len().min(RAYS_OF_CPU)]);
            Asking {
                kind,
                rays,
                answers,
            }
        };
        let kinds = kinds.into_iter().map(answered).collect();
        let cells = grid.axes.each_ref().map(|axis| axis.cells().to_string());
        Ok(Self {
            name: format!("{name} {}", cells.join("x")),
            blockers,
            grid,
            kinds,
        })
    }

    pub(super) fn measure(
        &self,
        stations: &[Station<'_>],
        ceilings: &[Ceilings],
        legs: &mut Legs,
        progress: &Progress,
    ) {
        progress.begin(&self.name, 2 + u32::try_from(self.kinds.len()).unwrap_or(0));
        self.builds(legs);
        progress.step();
        for (at, asking) in self.kinds.iter().enumerate() {
            let Asking {
                kind,
                rays,
                answers,
            } = asking;
            self.on_cpu(kind, &rays[..answers.len()], legs);
            let asked = Asked {
                blockers: self.blockers,
                rays: &rays[..answers.len()],
                answers,
            };
            for station in stations {
                // A software driver is no faster than a CPU.
                let software = station.adapter.gpu.info.device_type == wgpu::DeviceType::Cpu;
                let work = Work {
                    blockers: self.blockers,
                    grid: &self.grid,
                    rays: if software { asked.rays } else { rays },
                    asked,
                };
                let label = format!("gpu@{}", station.adapter.gpu.name);
                match self.on_gpu(station, &work, kind, at == 0, legs) {
                    Ok(Some(build)) => {
                        let name = &station.adapter.gpu.name;
                        let own = ceilings.iter().find(|c| c.name == *name);
                        legs.remarks
                            .extend(own.map(|c| self.bound(&label, build, c)));
                    }
                    Ok(None) => {}
                    Err(why) => {
                        let name = &self.name;
                        legs.remarks
                            .push(format!("not measured: {label}: {name}, {kind}: {why}"));
                    }
                }
            }
            progress.step();
        }
    }

    /// What bounds a build: corners are read twice, offsets and counts pass several times,
    /// entries are written once; each entry takes an atomic to be counted and one to be placed.
    fn bound(&self, label: &str, seconds: f64, ceilings: &Ceilings) -> String {
        let (entries, cells) = (self.grid.prims.len() as u64, self.grid.offsets.len() as u64);
        let work = counts::Work {
            bytes: 2 * 36 * self.blockers.triangles.len() as u64 + 4 * 7 * cells + 4 * 3 * entries,
            atomics: 2 * entries,
        };
        let (bound, least) = ceilings.bound(work);
        format!(
            "{label}: {}: a build of {entries} entries is at {:.1} % of what its {bound} allow",
            self.name,
            100.0 * least / seconds
        )
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
        let rows = taken.iter().enumerate().map(|(at, own)| {
            let against = (at != 1).then_some(&taken[1]);
            row(own, &self.name, "build", against)
        });
        legs.rows.extend(rows);
    }

    /// Rays of a kind on one thread and on all.
    fn on_cpu(&self, kind: &str, rays: &[Ray], legs: &mut Legs) {
        let embree = match cpu::embree(self.blockers) {
            Ok(scene) => scene,
            Err(error) => {
                legs.remarks.push(format!("not measured: embree: {error}"));
                return;
            }
        };
        let obvhs = cpu::Obvhs::new(self.blockers);
        for (query, name) in [(Query::Any, "any"), (Query::Closest, "closest")] {
            let names = [
                "spec, one thread",
                "embree, one thread",
                "obvhs, one thread",
                "embree, all threads",
                "obvhs, all threads",
            ];
            let mut taken = names.map(|name| Taken::new(name, "host", rays.len() as u64));
            for round in 0..WARM_UP + legs.runs {
                for at in order(round, names.len()) {
                    let threads = at >= 3;
                    let of_spec = |ray: &Ray| cpu::of_spec(&self.grid, self.blockers, query, ray);
                    let of_embree = |ray: &Ray| cpu::of_embree(&embree, query, ray);
                    let of_obvhs = |ray: &Ray| obvhs.meets(query, ray);
                    let (met, time) = match at {
                        0 => timed(|| cpu::count(rays, threads, of_spec)),
                        1 | 3 => timed(|| cpu::count(rays, threads, of_embree)),
                        _ => timed(|| cpu::count(rays, threads, of_obvhs)),
                    };
                    std::hint::black_box(met);
                    if round >= WARM_UP {
                        taken[at].seconds.push(time.as_secs_f64());
                    }
                }
            }
            let rows = taken.iter().enumerate().map(|(at, own)| {
                let against = [Some(1), None, Some(1), None, Some(3)][at];
                row(
                    own,
                    &self.name,
                    &format!("{name} {kind}"),
                    against.map(|at| &taken[at]),
                )
            });
            legs.rows.extend(rows);
        }
    }

    /// An adapter; the median seconds of a build, if it is to be noted.
    fn on_gpu(
        &self,
        station: &Station<'_>,
        work: &Work<'_>,
        kind: &str,
        build: bool,
        legs: &mut Legs,
    ) -> Result<Option<f64>, String> {
        let gpu = &station.adapter.gpu;
        let checked: &Kernels = &station.adapter.kernels;
        let (ready, timer) = set_up(gpu, checked, &station.kernels, &station.clock, work)?;
        let items = [
            self.blockers.triangles.len(),
            work.rays.len(),
            work.rays.len(),
        ];
        let clock = station.clock_name();
        let label = format!("gpu@{}", gpu.name);
        let mut taken = items.map(|items| Taken::new(label.as_str(), clock, items as u64));
        for round in 0..WARM_UP + legs.runs {
            if gpu.info.device_type != wgpu::DeviceType::Cpu {
                wake(|| ready.time(&timer).map(drop)).map_err(|e| e.to_string())?;
            }
            let seconds = ready.time(&timer).map_err(|e| e.to_string())?;
            if round >= WARM_UP {
                for (taken, seconds) in taken.iter_mut().zip(seconds) {
                    taken.seconds.push(seconds);
                }
            }
        }
        for (span, own) in Span::ALL.into_iter().zip(&taken) {
            let what = match span {
                Span::Build if build => "build".to_owned(),
                Span::Build => continue,
                Span::Any => format!("any {kind}"),
                Span::Closest => format!("closest {kind}"),
            };
            legs.rows.push(row(own, &self.name, &what, None));
        }
        let median = Spread::of(taken[0].seconds.iter().copied()).median;
        Ok(build.then_some(median))
    }
}
