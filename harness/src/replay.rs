//! Replays one scene through all legs and accounts for every difference.

pub mod embree;
pub mod facts;
pub mod gpu;
pub mod pictures;
pub mod rows;
pub mod skips;
pub mod spec;
pub mod vertex;

use std::rc::Rc;

use triptych_gpu::error::GpuError;
use triptych_gpu::raster::Path;
use triptych_spec::scene::Size;
use triptych_spec::vertex::{SUBPIXEL_BITS, primitives};

use crate::cache::{Cache, Unit};
use crate::cause::Cause;
use crate::compare::{Judgement, compare};
use crate::corpus::Entry;
use crate::dump::Dump;
use crate::error::InputError;
use crate::observe::{Analytic, Observed, Spec};
use crate::plan::Plan;
use crate::report::Picture;
use crate::row::{Class, Row};
use crate::scene::value::Capacity;
use crate::scene::{LoadError, Loaded, expect, load_entry};
use facts::Facts;
use gpu::{Adapter, From, GpuLeg, GpuSeen};
use rows::Rows;
use spec::{SpecRun, timed};

/// What to replay, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// Replay on GPUs.
    pub gpu: bool,
    /// Replay through Embree.
    pub embree: bool,
    /// Raster paths.
    pub paths: Vec<Path>,
    /// From which stage on GPU legs use their own results.
    pub from: From,
    /// Leave out what a scene does not need.
    pub skip: bool,
    /// In place of the scenes' own seeds.
    pub seed: Option<u64>,
    /// Write every leg's results here.
    pub dump: Option<Dump>,
    /// Keep the legs' pictures for a report.
    pub pictures: bool,
    /// Where results of legs are kept that need not run again.
    pub cache: Option<Cache>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            gpu: true,
            embree: true,
            paths: vec![Path::Fragment, Path::Compute, Path::Native],
            from: From::default(),
            skip: true,
            seed: None,
            dump: None,
            pictures: false,
            cache: None,
        }
    }
}

/// What came of one scene.
pub struct Outcome {
    /// `family/case`.
    pub name: String,
    /// What the scene is for.
    pub purpose: String,
    /// Size of the target; `None` if the scene was not loaded.
    pub size: Option<Size>,
    /// The comparisons.
    pub rows: Vec<Row>,
    /// First differences, in words.
    pub described: Vec<String>,
    /// Pixels that differ.
    pub marks: Vec<(u32, Cause)>,
    /// What ran.
    pub plan: Option<Plan>,
    /// Milliseconds that skipping saved on a GPU, where measured.
    pub saved_ms: Option<f64>,
    /// What the spec found, for a snapshot.
    pub facts: Option<Facts>,
    /// Pictures of the legs, then maps.
    pub pictures: Vec<Picture>,
    /// What went wrong beside the point, such as a cache that cannot be written.
    pub remarks: Vec<String>,
}

/// Replays a scene.
///
/// # Errors
/// Bad input, in one line. A missing mesh is not one: the scene is skipped.
pub fn replay(
    entry: &Entry,
    adapters: &[Adapter],
    options: &Options,
) -> Result<Outcome, InputError> {
    match load_entry(entry, options.seed) {
        Ok(loaded) => Run::new(&loaded, adapters, options)
            .all()
            .map_err(|e| match e {
                Stop::Input(message) => InputError::new(&entry.path, message),
                Stop::Dump(error) => InputError::new(&entry.path, format!("dump: {error}")),
            }),
        Err(LoadError::Input(error)) => Err(error),
        Err(missing @ LoadError::Missing { .. }) => {
            let mut rows = Rows::new(&entry.name, &entry.family);
            rows.skip("all", "spec", "all legs", Class::Exact, missing.to_string());
            Ok(Outcome::empty(entry, rows))
        }
    }
}

/// Why a replay ends early.
enum Stop {
    /// Bad input.
    Input(String),
    /// A dump that cannot be written.
    Dump(std::io::Error),
}

impl core::convert::From<std::io::Error> for Stop {
    fn from(error: std::io::Error) -> Self {
        Self::Dump(error)
    }
}

impl Outcome {
    fn empty(entry: &Entry, rows: Rows) -> Self {
        Self {
            name: entry.name.clone(),
            purpose: String::new(),
            size: None,
            rows: rows.rows,
            described: rows.described,
            marks: rows.marks,
            plan: None,
            saved_ms: None,
            facts: None,
            pictures: Vec::new(),
            remarks: Vec::new(),
        }
    }
}

/// One scene under way.
struct Run<'a> {
    loaded: &'a Loaded,
    adapters: &'a [Adapter],
    options: &'a Options,
    plan: Plan,
    /// The spec's results on the grid that was asked for last.
    spec: Option<Rc<Observed<Spec, SpecRun>>>,
    rows: Rows,
    pictures: Vec<Picture>,
    saved_ms: Option<f64>,
    facts: Option<Facts>,
    remarks: Vec<String>,
}

impl<'a> Run<'a> {
    fn new(loaded: &'a Loaded, adapters: &'a [Adapter], options: &'a Options) -> Self {
        Self {
            loaded,
            adapters,
            options,
            plan: Plan::new(&loaded.scene, options.skip),
            spec: None,
            rows: Rows::new(&loaded.name, &loaded.family),
            pictures: Vec::new(),
            saved_ms: None,
            facts: None,
            remarks: Vec::new(),
        }
    }

    fn all(mut self) -> Result<Outcome, Stop> {
        self.unit(&["spec"], Self::spec_alone)?;
        if self.options.embree {
            self.unit(&["embree"], Self::embree)?;
        }
        if self.options.gpu {
            self.gpu()?;
        }
        let causes = pictures::causes(self.spec.as_deref(), &self.rows.marks);
        self.pictures
            .extend(causes.filter(|_| self.options.pictures));
        self.rows.rows.sort_by_key(column);
        Ok(Outcome {
            name: self.loaded.name.clone(),
            purpose: self.loaded.file.purpose.0.clone(),
            size: Some(self.loaded.scene.size),
            rows: self.rows.rows,
            described: self.rows.described,
            marks: self.rows.marks,
            plan: Some(self.plan),
            saved_ms: self.saved_ms,
            facts: self.facts,
            pictures: self.pictures,
            remarks: self.remarks,
        })
    }

    /// Does a piece of work, or takes its result from the cache. `inputs` are what it
    /// depends on beside the scene, the options and the code.
    fn unit(
        &mut self,
        inputs: &[&str],
        work: impl FnOnce(&mut Self) -> Result<(), Stop>,
    ) -> Result<(), Stop> {
        let Some(cache) = self
            .options
            .cache
            .as_ref()
            .filter(|_| self.options.dump.is_none())
        else {
            return work(self);
        };
        let Options {
            from,
            skip,
            paths,
            pictures,
            ..
        } = self.options;
        let options = format!("{from:?} {skip} {paths:?} {pictures}");
        let mut all = vec![
            self.loaded.name.as_str(),
            &self.loaded.stats.sha256,
            &options,
        ];
        all.extend(inputs);
        let key = cache.key(&all);
        if let Some(unit) = cache.get(&key) {
            self.rows.rows.extend(unit.rows);
            self.pictures.extend(unit.pictures);
            self.saved_ms = self.saved_ms.or(unit.saved_ms);
            return Ok(());
        }
        let (rows, pictures) = (self.rows.rows.len(), self.pictures.len());
        let saved_ms = self.saved_ms.take();
        work(self)?;
        let unit = Unit {
            rows: self.rows.rows[rows..].to_vec(),
            pictures: self.pictures[pictures..].to_vec(),
            saved_ms: self.saved_ms,
        };
        self.saved_ms = self.saved_ms.or(saved_ms);
        if let Err(error) = cache.put(&key, &unit) {
            self.remarks.push(format!("cache: {error}"));
        }
        Ok(())
    }

    /// The spec's results on a grid, computed when first asked for. Only the last
    /// grid's are held: they are large.
    fn spec(&mut self, bits: u32) -> Result<Rc<Observed<Spec, SpecRun>>, Stop> {
        if let Some(spec) = self
            .spec
            .as_ref()
            .filter(|s| s.value.primitives.bits == bits)
        {
            return Ok(spec.clone());
        }
        self.spec = None;
        let scene = &self.loaded.scene;
        let (primitives, vertex) = timed(|| primitives(scene, bits));
        let mut run = SpecRun::new(scene, primitives, &self.plan).map_err(Stop::Input)?;
        run.times.vertex = vertex;
        let spec = Rc::new(Observed::new("spec", run));
        self.spec = Some(spec.clone());
        Ok(spec)
    }

    /// What needs no other leg.
    fn spec_alone(&mut self) -> Result<(), Stop> {
        let spec = self.spec(SUBPIXEL_BITS)?;
        self.analytic(&spec);
        self.facts = Some(Facts::new(self.loaded, &spec.value, &self.plan));
        if self.options.pictures {
            self.pictures.extend(pictures::spec(&spec.value));
        }
        self.dump_spec(&spec).map_err(Stop::Dump)
    }

    /// Holds the spec against what the scene's author worked out by hand.
    fn analytic(&mut self, spec: &Observed<Spec, SpecRun>) {
        let stated = &self.loaded.file.expect;
        let count = stated.stated();
        if count == 0 {
            return;
        }
        let analytic = Observed::<Analytic, _>::new("closed form", stated);
        let judgement = compare(spec, &analytic, |spec, stated| {
            let SpecRun {
                primitives,
                opaque,
                sorted,
                ..
            } = spec;
            let scene = &self.loaded.scene;
            let wrong = expect::check(stated, scene, primitives, opaque, sorted);
            let mut judgement = Judgement::exact("statements", count, wrong.len() as u64);
            judgement.described = wrong;
            judgement
        });
        self.rows.add("expect", spec, &analytic, judgement);
    }

    fn embree(&mut self) -> Result<(), Stop> {
        let spec = self.spec(SUBPIXEL_BITS)?;
        // A bare mesh states no budget: its share is printed, not judged.
        let stated = &self.loaded.file.budget;
        let budget = (!self.loaded.bare).then_some(stated.edge.0);
        let seen = embree::run(&spec, budget, &mut self.rows);
        if let Some(seen) = seen.filter(|_| self.options.pictures) {
            let pixels = embree::picture(&self.loaded.scene, &spec.value, &seen);
            self.pictures
                .push(pictures::leg("embree", self.loaded.scene.size, &pixels));
        }
        Ok(())
    }

    /// Every adapter and path; legs that share a sub-pixel grid follow each other.
    fn gpu(&mut self) -> Result<(), Stop> {
        if self.adapters.is_empty() {
            let reason = "no adapter; `triptych doctor` says what is missing".to_owned();
            self.rows.skip("all", "spec", "gpu", Class::Exact, reason);
            return Ok(());
        }
        let legs = self
            .adapters
            .iter()
            .flat_map(|adapter| self.options.paths.iter().map(move |path| (adapter, *path)));
        let mut legs: Vec<(&Adapter, Path)> = legs.collect();
        legs.sort_by_key(|(adapter, path)| std::cmp::Reverse(adapter.bits(*path)));
        for (adapter, path) in legs {
            let wgpu::AdapterInfo {
                name,
                driver,
                driver_info,
                ..
            } = &adapter.gpu.info;
            let bits = adapter.bits(path).to_string();
            let measures = self.measures_skips(adapter, path).to_string();
            let grid = format!("{:?}", adapter.grid);
            let inputs = [
                name,
                driver,
                driver_info,
                path.name(),
                &bits,
                &grid,
                &measures,
            ];
            self.unit(&inputs, |run| run.leg(adapter, path))?;
        }
        Ok(())
    }

    fn leg(&mut self, adapter: &Adapter, path: Path) -> Result<(), Stop> {
        if path == Path::Native && adapter.native.is_none() {
            let label = format!("gpu@{}/{}", adapter.gpu.name, path.name());
            let reason = "no 64-bit integers: compute takes its place".to_owned();
            self.rows.skip("leg", "spec", &label, Class::Exact, reason);
            return Ok(());
        }
        let spec = self.spec(adapter.bits(path))?;
        let label = format!("gpu@{}/{}", adapter.gpu.name, path.name());
        match self.leg_or_error(&spec, adapter, path) {
            Ok(stop) => stop,
            Err(error @ GpuError::Limit { .. }) => {
                self.rows
                    .skip("leg", "spec", &label, Class::Exact, error.to_string());
                Ok(())
            }
            Err(error) => {
                let cause = match error {
                    GpuError::Lost { .. } => Some(Cause::DeviceLost),
                    GpuError::Endless { .. } => Some(Cause::Cycle),
                    _ => None,
                };
                self.rows
                    .fail("leg", "spec", &label, cause, error.to_string());
                Ok(())
            }
        }
    }

    fn leg_or_error(
        &mut self,
        spec: &Observed<Spec, SpecRun>,
        adapter: &Adapter,
        path: Path,
    ) -> Result<Result<(), Stop>, GpuError> {
        let (scene, plan) = (&self.loaded.scene, self.plan.clone());
        let own = self.vertices(spec, adapter, path)?;
        // End to end, the later stages of both legs start from the GPU's vertices.
        let moved = match own {
            Some(primitives) => match SpecRun::new(scene, primitives, &self.plan) {
                Ok(run) => Some(Observed::new("spec", run)),
                Err(message) => return Ok(Err(Stop::Input(message))),
            },
            None => None,
        };
        let from_own = self.options.from == From::Transform;
        let leg = GpuLeg {
            adapter,
            path,
            scene,
            spec: moved.as_ref().filter(|_| from_own).unwrap_or(spec),
            plan: &plan,
            capacity: self.capacity(&spec.value),
            from: self.options.from,
        };
        let seen = leg.run(&mut self.rows)?;
        if let Some(moved) = moved.as_ref().filter(|_| !from_own) {
            vertex::end_to_end(&GpuLeg { spec: moved, ..leg }, spec, &mut self.rows)?;
        }
        if self.options.skip && self.measures_skips(adapter, path) {
            self.saved_ms = skips::run(&leg, &seen, &mut self.rows)?;
        }
        if self.options.pictures && seen.value.sorted.is_some() {
            let image = &seen.value.abuffer.image;
            self.pictures
                .push(pictures::leg(&seen.label, scene.size, image));
        }
        Ok(self.dump_gpu(&leg.spec.value, &seen).map_err(Stop::Dump))
    }

    /// The GPU's own vertex stage, compared with the spec's. It is the same for both
    /// paths, so it is judged on the compute path, which takes the finest grid; its
    /// triangles are given back where they are wanted and differ.
    fn vertices(
        &mut self,
        spec: &Observed<Spec, SpecRun>,
        adapter: &Adapter,
        path: Path,
    ) -> Result<Option<triptych_spec::vertex::Primitives>, GpuError> {
        let only_path = self.options.paths.len() == 1;
        let judged = path == Path::Compute || only_path;
        if !judged && self.options.from != From::Transform {
            return Ok(None);
        }
        vertex::run(
            &self.loaded.scene,
            spec,
            adapter,
            path,
            judged.then_some(&mut self.rows),
        )
    }

    /// Skipping is measured once a scene, on the last adapter's compute path.
    fn measures_skips(&self, adapter: &Adapter, path: Path) -> bool {
        let last = self
            .adapters
            .last()
            .is_some_and(|a| std::ptr::eq(a, adapter));
        let wanted = self
            .options
            .paths
            .iter()
            .filter(|p| **p != Path::Native)
            .max();
        last && wanted == Some(&path) && self.options.from == From::Cover
    }

    fn capacity(&self, spec: &SpecRun) -> Option<u32> {
        match self.loaded.file.abuffer.capacity {
            Capacity::All => None,
            stated => Some(stated.nodes(spec.lists.attempts)),
        }
    }

    fn dump_spec(&self, spec: &Observed<Spec, SpecRun>) -> std::io::Result<()> {
        let Some(dump) = &self.options.dump else {
            return Ok(());
        };
        let leg = dump.leg(&self.loaded.name, &spec.label);
        let SpecRun {
            primitives, sorted, ..
        } = &spec.value;
        leg.meta(&facts::meta(self.loaded, &spec.label, primitives.bits))?;
        leg.primitives(primitives, &self.loaded.scene)?;
        leg.sorted(&self.loaded.scene, primitives, sorted)?;
        leg.image("resolve", "image", primitives.size, &spec.value.picture())
    }

    fn dump_gpu(
        &self,
        spec: &SpecRun,
        seen: &Observed<crate::observe::Gpu, GpuSeen>,
    ) -> std::io::Result<()> {
        let Some(dump) = &self.options.dump else {
            return Ok(());
        };
        let leg = dump.leg(&self.loaded.name, &seen.label);
        leg.meta(&facts::meta(self.loaded, &seen.label, spec.primitives.bits))?;
        leg.primitives(&spec.primitives, &self.loaded.scene)?;
        if let Some(sorted) = &seen.value.sorted {
            leg.sorted(&self.loaded.scene, &spec.primitives, sorted)?;
            let size = spec.primitives.size;
            leg.image("resolve", "image", size, &seen.value.abuffer.image)?;
        }
        Ok(())
    }
}

/// Where a row stands: closed form, Embree, then GPU legs by name.
fn column(row: &Row) -> (u8, String) {
    let rank = match row.b.as_str() {
        "closed form" => 0,
        "embree" => 1,
        leg if row.a == "spec" && leg.starts_with("gpu") => 2,
        _ => 3,
    };
    (rank, row.b.clone())
}
