//! A GPU leg: one adapter, one path, every stage from equal inputs.

use std::ops::ControlFlow;
use std::time::Duration;

use triptych_gpu::abuffer::{self, Abuffer, Given};
use triptych_gpu::context::{Gpu, adapters, short_name};
use triptych_gpu::error::GpuError;
use triptych_gpu::frame::Band;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::{self, Path, Rasterizer};
use triptych_gpu::wgsl::Sources;
use triptych_spec::abuffer::{Lists, Sorted};
use triptych_spec::scene::Scene;

use super::rows::Rows;
use super::spec::SpecRun;
use crate::calibrate::{Grid, calibrate};
use crate::compare::fragments::Rule;
use crate::compare::lists::{Expected, certify, compare_overflowed};
use crate::compare::{self, Judgement, compare};
use crate::observe::{self, Observed};
use crate::plan::Plan;
use crate::row::Class;

/// A device, its kernels, and its driver's sub-pixel grid.
pub struct Adapter {
    /// The device.
    pub gpu: Gpu,
    /// Kernels in baseline WGSL.
    pub kernels: Kernels,
    /// Kernels that use 64-bit integers, where the adapter has them.
    pub native: Option<Kernels>,
    /// What calibration found.
    pub grid: Grid,
}

impl Adapter {
    /// Opens and calibrates the adapters whose name contains one of `wanted` (all,
    /// if that is empty), in order of name. Adapters of the GL back end are taken
    /// only if asked for: naga's GLSL has no sample masks.
    ///
    /// # Errors
    /// The first adapter that cannot be opened.
    pub fn open_all(wanted: &[String]) -> Result<Vec<Self>, GpuError> {
        let asked = |name: &str| {
            wanted
                .iter()
                .any(|w| name.to_lowercase().contains(&w.to_lowercase()))
        };
        let backends = if wanted.iter().any(|w| w.to_lowercase().ends_with("gl")) {
            wgpu::Backends::all()
        } else {
            wgpu::Backends::all() - wgpu::Backends::GL
        };
        let mut found: Vec<_> = adapters(backends)
            .into_iter()
            .map(|a| (short_name(&a.get_info()), a))
            .filter(|(name, _)| wanted.is_empty() || asked(name))
            .collect();
        found.sort_by(|a, b| a.0.cmp(&b.0));
        found.dedup_by(|a, b| a.0 == b.0);
        found
            .iter()
            .map(|(_, adapter)| Self::open(adapter))
            .collect()
    }

    /// Opens and calibrates one adapter.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn open(adapter: &wgpu::Adapter) -> Result<Self, GpuError> {
        let gpu = Gpu::open(adapter)?;
        let kernels = Kernels::new(Sources::shipped(false));
        let native = gpu
            .has_int64()
            .then(|| Kernels::new(Sources::shipped(true)));
        let grid = calibrate(&gpu, &kernels)?;
        Ok(Self {
            gpu,
            kernels,
            native,
            grid,
        })
    }

    /// The grid on which a path works: compute kernels take any.
    pub fn bits(&self, path: Path) -> u32 {
        match path {
            Path::Compute | Path::Native => triptych_spec::vertex::SUBPIXEL_BITS,
            Path::Fragment => self.grid.bits(),
        }
    }
}

/// From which stage on the GPU's own results are used; before it, the spec's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum From {
    /// The GPU's own vertices.
    Transform,
    /// The spec's triangles.
    #[default]
    Cover,
    /// The spec's unsorted lists.
    Sort,
    /// The spec's sorted lists.
    Resolve,
}

/// One GPU leg of one scene.
pub struct GpuLeg<'a> {
    /// The adapter.
    pub adapter: &'a Adapter,
    /// Who decides coverage.
    pub path: Path,
    /// The scene.
    pub scene: &'a Scene,
    /// The spec's results from the same triangles.
    pub spec: &'a Observed<observe::Spec, SpecRun>,
    /// What runs.
    pub plan: &'a Plan,
    /// Nodes of the first attempt.
    pub capacity: Option<u32>,
    /// Where the GPU takes over.
    pub from: From,
}

/// What a leg saw, for pictures, dumps and further comparisons.
pub struct GpuSeen {
    /// Lists, surfaces, picture.
    pub abuffer: Abuffer,
    /// The sorted lists of the whole target, if sound.
    pub sorted: Option<Sorted>,
    /// Time of all stages on the device.
    pub time: Duration,
}

impl GpuLeg<'_> {
    /// `gpu@adapter/path`.
    pub fn label(&self) -> String {
        format!("gpu@{}/{}", self.adapter.gpu.name, self.path.name())
    }

    /// Runs every stage and adds a row for each.
    ///
    /// On a driver whose sub-pixel grid is unknown, only its coverage is compared,
    /// by a band: what follows from other coverage has no exact answer.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn run(&self, rows: &mut Rows) -> Result<Observed<observe::Gpu, GpuSeen>, GpuError> {
        let rasterizer = self.rasterizer()?;
        self.cover(&rasterizer, rows)?;
        if self.by_band() {
            for stage in ["opaque", "build", "sort", "resolve"] {
                let reason = "the driver's sub-pixel grid is unknown".to_owned();
                rows.skip(stage, &self.spec.label, &self.label(), Class::Exact, reason);
            }
            return Ok(Observed::new(self.label(), self.abuffer(&rasterizer)?));
        }
        let seen = Observed::new(self.label(), self.abuffer(&rasterizer)?);
        self.judge_opaque(&seen, rows);
        self.judge_lists(&seen, rows);
        self.judge_sort(&seen, rows);
        self.judge_resolve(&seen, rows);
        Ok(seen)
    }

    /// Runs the A-buffer without comparing it.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn abuffer(&self, rasterizer: &Rasterizer<'_>) -> Result<GpuSeen, GpuError> {
        let spec = &self.spec.value;
        let given = match self.from {
            From::Transform | From::Cover => None,
            From::Sort => Some((&spec.lists, false)),
            From::Resolve => Some((&spec.lists, true)),
        };
        let relinked = given.filter(|g| g.1).map(|_| relink(spec));
        let options = abuffer::Options {
            given: given.map(|(lists, sorted)| Given {
                opaque: &spec.opaque,
                lists: relinked.as_ref().unwrap_or(lists),
                sorted,
            }),
            capacity: self.capacity,
            opaque: self.plan.opaque,
            lists: self.plan.lists,
            depth_test: self.plan.depth_test,
            background: self.scene.background,
        };
        let inspect = |_: Band, lists: &Lists| {
            if certify(lists).faults.is_empty() {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        };
        let abuffer = abuffer::run(rasterizer, options, |prim| spec.is_opaque(prim), inspect)?;
        let t = abuffer.times;
        let time = t.opaque + t.build + t.sort + t.resolve;
        Ok(GpuSeen {
            sorted: join(&abuffer, self.scene.size.width),
            abuffer,
            time,
        })
    }

    /// The triangles on the device.
    ///
    /// # Errors
    /// More triangles than the adapter can bind.
    pub fn rasterizer(&self) -> Result<Rasterizer<'_>, GpuError> {
        let Adapter {
            gpu,
            kernels,
            native,
            ..
        } = self.adapter;
        let kernels = native
            .as_ref()
            .filter(|_| self.path == Path::Native)
            .unwrap_or(kernels);
        let spec = &self.spec.value;
        Rasterizer::new(gpu, kernels, self.path, &spec.primitives, &spec.faces)
    }

    fn cover(&self, rasterizer: &Rasterizer<'_>, rows: &mut Rows) -> Result<(), GpuError> {
        let needed = self.by_band() && self.from <= From::Cover;
        if let Some(reason) = self.plan.skipped("cover").filter(|_| !needed) {
            rows.skip(
                "cover",
                &self.spec.label,
                &self.label(),
                Class::Exact,
                reason,
            );
            return Ok(());
        }
        let covered = raster::cover(rasterizer)?;
        let spec = self
            .spec
            .map(|s| &s.cover)
            .taking(self.spec.value.times.cover);
        let seen =
            Observed::<observe::Gpu, _>::new(self.label(), covered.fragments).taking(covered.time);
        let rule = self.rule();
        let judgement = compare(&spec, &seen, |a, b| {
            compare::fragments::compare(a, b, self.scene.size, &rule)
        });
        rows.add("cover", &spec, &seen, judgement);
        Ok(())
    }

    fn by_band(&self) -> bool {
        self.path == Path::Fragment && self.adapter.grid == Grid::Unknown
    }

    fn rule(&self) -> Rule<'_> {
        if self.by_band() {
            Rule::Band(&self.spec.value.primitives)
        } else {
            Rule::Exact
        }
    }

    fn judge_opaque(&self, seen: &Observed<observe::Gpu, GpuSeen>, rows: &mut Rows) {
        if let Some(reason) = self.reason_not_run("opaque", From::Cover) {
            rows.skip(
                "opaque",
                &self.spec.label,
                &seen.label,
                Class::Exact,
                reason,
            );
            return;
        }
        let spec = self
            .spec
            .map(|s| &s.opaque)
            .taking(self.spec.value.times.opaque);
        let times = seen.value.abuffer.times;
        let gpu = seen.map(|s| &s.abuffer.opaque).taking(times.opaque);
        let width = self.scene.size.width;
        let judgement = compare(&spec, &gpu, |a, b| compare::opaque::compare(a, b, width));
        rows.add("opaque", &spec, &gpu, judgement);
    }

    fn judge_lists(&self, seen: &Observed<observe::Gpu, GpuSeen>, rows: &mut Rows) {
        if let Some(reason) = self.reason_not_run("build", From::Cover) {
            rows.skip(
                "build",
                &self.spec.label,
                &seen.label,
                Class::Structure,
                reason,
            );
            return;
        }
        let spec = self
            .spec
            .map(|s| &s.sorted)
            .taking(self.spec.value.times.build);
        let gpu = seen
            .map(|s| &s.abuffer)
            .taking(seen.value.abuffer.times.build);
        if !gpu.value.overflowed.is_empty() {
            let judgement = compare(&spec, &gpu, |spec, gpu| {
                let judge = |(band, lists): &(Band, Lists)| {
                    compare_overflowed(&self.expected(spec, *band), lists)
                };
                Judgement::sum(gpu.overflowed.iter().map(judge))
            });
            rows.add("overflow", &spec, &gpu, judgement);
        }
        let judgement = compare(&spec, &gpu, |spec, gpu| {
            let judge = |b: &abuffer::BandResult| {
                compare::lists::compare(&self.expected(spec, b.band), &b.built)
            };
            Judgement::sum(gpu.bands.iter().map(judge))
        });
        rows.add("build", &spec, &gpu, judgement);
    }

    fn judge_sort(&self, seen: &Observed<observe::Gpu, GpuSeen>, rows: &mut Rows) {
        if let Some(reason) = self.reason_not_run("sort", From::Sort) {
            rows.skip("sort", &self.spec.label, &seen.label, Class::Tie, reason);
            return;
        }
        if seen.value.abuffer.bands.iter().any(|b| b.sorted.is_none()) {
            let reason = "the lists are damaged, see build".to_owned();
            rows.skip("sort", &self.spec.label, &seen.label, Class::Tie, reason);
            return;
        }
        // From equal inputs: the spec sorts what this leg built.
        let sorted = |b: &abuffer::BandResult| triptych_spec::abuffer::sort(&b.built);
        let must: Vec<Sorted> = seen.value.abuffer.bands.iter().map(sorted).collect();
        let spec = self.spec.derive(must).taking(self.spec.value.times.sort);
        let gpu = seen
            .map(|s| &s.abuffer.bands)
            .taking(seen.value.abuffer.times.sort);
        let width = self.scene.size.width;
        let judgement = compare(&spec, &gpu, |must, bands| {
            Judgement::sum(must.iter().zip(bands.iter()).map(|(must, band)| {
                let flat = band.sorted.as_ref().and_then(compare::order::flatten);
                compare::order::compare(must, flat.as_ref(), width)
            }))
        });
        rows.add("sort", &spec, &gpu, judgement);
    }

    fn judge_resolve(&self, seen: &Observed<observe::Gpu, GpuSeen>, rows: &mut Rows) {
        let Some(sorted) = &seen.value.sorted else {
            let reason = "the lists are damaged, see build".to_owned();
            rows.skip(
                "resolve",
                &self.spec.label,
                &seen.label,
                Class::Interval,
                reason,
            );
            return;
        };
        // From equal inputs: the spec blends what this leg sorted.
        let spec = &self.spec.value;
        let abuffer = &seen.value.abuffer;
        let must = if *sorted == spec.sorted && abuffer.opaque == spec.opaque {
            spec.image.clone()
        } else {
            let prims = &spec.primitives;
            triptych_spec::abuffer::resolve(self.scene, prims, &abuffer.opaque, sorted)
        };
        let spec = self.spec.derive(must).taking(spec.times.resolve);
        let gpu = seen.map(|s| &s.abuffer.image).taking(abuffer.times.resolve);
        let width = self.scene.size.width;
        let judgement = compare(&spec, &gpu, |a, b| compare::image::compare(a, b, width));
        rows.add("resolve", &spec, &gpu, judgement);
    }

    /// Why a stage has nothing of its own to compare: the plan leaves it out, or the
    /// spec's result stands in for it.
    fn reason_not_run(&self, stage: &str, first: From) -> Option<String> {
        let given = self.from > first;
        self.plan
            .skipped(stage)
            .or(given.then(|| "the spec's result is used (--gpu-from)".into()))
    }

    /// What the spec says about a band.
    pub fn expected<'e>(&'e self, sorted: &'e Sorted, band: Band) -> Expected<'e> {
        let width = self.scene.size.width;
        let faces = &self.spec.value.faces;
        Expected {
            sorted,
            first_pixel: band.first * width,
            faces,
            width,
        }
    }
}

/// The spec's lists with links in sorted order.
fn relink(spec: &SpecRun) -> Lists {
    use triptych_spec::abuffer::{EOL, Node};
    let (sorted, faces) = (&spec.sorted, &spec.faces);
    let mut lists = Lists {
        heads: Vec::with_capacity(spec.lists.heads.len()),
        nodes: Vec::with_capacity(sorted.fragments.len()),
        colours: sorted
            .fragments
            .iter()
            .map(|f| faces[f.prim as usize])
            .collect(),
        ..spec.lists.clone()
    };
    for range in sorted.offsets.windows(2) {
        lists
            .heads
            .push(if range[0] < range[1] { range[0] } else { EOL });
        for address in range[0]..range[1] {
            let f = sorted.fragments[address as usize];
            let next = if address + 1 < range[1] {
                address + 1
            } else {
                EOL
            };
            lists.nodes.push(Node {
                key: f.key,
                next,
                prim: f.prim,
                mask: f.mask,
            });
        }
    }
    lists
}

/// The bands' sorted lists as one, with pixels counted from the target's first.
fn join(abuffer: &Abuffer, width: u32) -> Option<Sorted> {
    let mut all = Sorted {
        offsets: vec![0],
        fragments: Vec::new(),
    };
    for band in &abuffer.bands {
        let flat = compare::order::flatten(band.sorted.as_ref()?)?;
        let start = *all.offsets.last()?;
        all.offsets
            .extend(flat.offsets[1..].iter().map(|o| start + o));
        let first = band.band.first * width;
        all.fragments
            .extend(flat.fragments.into_iter().map(|mut f| {
                f.pixel += first;
                f
            }));
    }
    Some(all)
}
