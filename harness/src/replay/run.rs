//! One scene under way.

use std::collections::BTreeSet;
use std::sync::Arc;

use triptych_spec::scene::Size;
use triptych_spec::vertex::SUBPIXEL_BITS;

use super::dispatch::DispatchRun;
use super::facts::Facts;
use super::gpu::Adapter;
use super::grid::GridRun;
use super::lanes::{Shared, Task};
use super::ldm::LdmRun;
use super::rows::Rows;
use super::rsm::RsmRun;
use super::spec::SpecRun;
use super::stop::Stop;
use super::worst::{Errors, Worst};
use super::{Options, Outcome, embree, pictures, shown};
use crate::cache::{Unit, Uses};
use crate::compare::{Judgement, compare};
use crate::observe::{Analytic, Observed, Spec};
use crate::plan::{Plan, passes};
use crate::registry::Chain;
use crate::report::Picture;
use crate::row::{Class, Row};
use crate::scene::{Loaded, expect};
use crate::sheet::{self, Rays, Sheet};

/// One scene under way.
pub(super) struct Run<'a> {
    pub(super) loaded: &'a Loaded,
    pub(super) adapters: &'a [Adapter],
    pub(super) options: &'a Options,
    pub(super) plan: Plan,
    /// The spec's results on the grid that was asked for last.
    pub(super) spec: Option<Arc<Observed<Spec, SpecRun>>>,
    /// The spec's results of a scene with a grid.
    pub(super) grid: Option<Arc<Observed<Spec, GridRun>>>,
    /// The spec's results of a scene with indirect light.
    pub(super) rsm: Option<Arc<Observed<Spec, RsmRun>>>,
    /// The spec's results of a scene with maps.
    pub(super) ldm: Option<Arc<Observed<Spec, LdmRun>>>,
    /// The spec's results of a scene with rays in queues.
    pub(super) dispatch: Option<Arc<Observed<Spec, DispatchRun>>>,
    /// The same, of all lanes.
    pub(super) shared: Arc<Shared>,
    pub(super) rows: Rows,
    pub(super) pictures: Vec<Picture>,
    pub(super) sheets: Vec<Sheet>,
    pub(super) errors: Errors,
    /// The first pixels at which Embree disagrees.
    pub(super) unlike: BTreeSet<u32>,
    pub(super) saved: Vec<(String, f64)>,
    pub(super) facts: Option<Facts>,
    pub(super) remarks: Vec<String>,
}

impl<'a> Run<'a> {
    pub(super) fn new(loaded: &'a Loaded, adapters: &'a [Adapter], options: &'a Options) -> Self {
        Self {
            loaded,
            adapters,
            options,
            plan: Plan::of(loaded, options.skip),
            spec: None,
            grid: None,
            rsm: None,
            ldm: None,
            dispatch: None,
            shared: Arc::default(),
            rows: Rows::new(&loaded.name, &loaded.family),
            pictures: Vec::new(),
            sheets: Vec::new(),
            errors: Errors::default(),
            unlike: BTreeSet::new(),
            saved: Vec::new(),
            facts: None,
            remarks: loaded.stats.remarks(),
        }
    }

    pub(super) fn all(mut self) -> Result<Outcome, Stop> {
        let chain = self.loaded.chain();
        match chain {
            Chain::Frame => self.frame()?,
            Chain::Rays => self.grid()?,
            Chain::Indirect => self.rsm()?,
            Chain::Maps => self.ldm()?,
            Chain::Traced => self.dispatch()?,
        }
        if self.rows.rows.is_empty() {
            let reason = "no other leg was asked for".to_owned();
            self.rows.skip("all", "spec", "none", Class::Exact, reason);
        }
        let spots = &self.rows.spots;
        let causes = match (&self.rsm, &self.ldm, &self.dispatch) {
            (Some(spec), ..) => spec.value.causes(spots),
            (_, Some(spec), _) => spec.value.causes(spots),
            (.., Some(spec)) => spec.value.causes(spots),
            (None, None, None) => pictures::causes(self.spec.as_deref(), spots),
        };
        self.pictures
            .extend(causes.filter(|_| self.options.pictures));
        let width = self.loaded.scene.size.width;
        let worst = Worst::of(&self.rows, &self.errors, width);
        // Lists are what is looked at, which other scenes have none of, and those of a ray.
        let one = self.loaded.scene.samples.count() == 1;
        if self.options.pictures && self.options.embree && chain == Chain::Frame && one {
            self.look_again(&worst)?;
        }
        self.rows.rows.sort_by_key(Row::column);
        Ok(Outcome {
            name: self.loaded.name.clone(),
            purpose: self.loaded.file.purpose.0.clone(),
            size: self.seen_size(),
            rows: self.rows.rows,
            described: self.rows.described,
            worst,
            passes: passes(self.loaded, self.options.skip),
            saved: self.saved,
            facts: self.facts,
            pictures: self.pictures,
            sheets: shown::once(self.sheets),
            remarks: self.remarks,
        })
    }

    /// The size of the pictures: the target's, but those of a grid have one of their own.
    fn seen_size(&self) -> Option<Size> {
        let first = self.pictures.first();
        match self.loaded.file.grid {
            None => Some(self.loaded.scene.size),
            Some(_) => first.map(|Picture { image, .. }| Size {
                width: image.width,
                height: image.height,
            }),
        }
    }

    /// Triangles to a picture.
    fn frame(&mut self) -> Result<(), Stop> {
        self.unit(Uses::Nothing, &["spec"], Self::spec_alone)?;
        let mut tasks = Vec::new();
        if self.options.embree {
            tasks.push(Task::apart(|run| {
                run.unit(Uses::Embree, &["embree"], Self::embree)
            }));
            tasks.push(Task::apart(|run| {
                run.unit(Uses::Embree, &["embree", embree::WORLD], Self::world)
            }));
        }
        if self.options.gpu {
            tasks.extend(self.on_adapters(Self::leg));
        }
        self.side_by_side(tasks)
    }

    /// Does a piece of work, or takes its result from the cache. `uses` and `inputs` are
    /// what it depends on beside the scene, the options and this binary.
    pub(super) fn unit(
        &mut self,
        uses: Uses<'_>,
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
            vertex,
            world,
            rivals,
            skip,
            paths,
            pictures,
            ..
        } = self.options;
        let options =
            format!("{from:?} {vertex:?} {world:?} {rivals:?} {skip} {paths:?} {pictures}");
        let mut all = vec![
            self.loaded.name.as_str(),
            &self.loaded.stats.sha256,
            &options,
        ];
        all.extend(inputs);
        let Some(key) = cache.key(uses, &all) else {
            return work(self);
        };
        if let Some(unit) = cache.get(&key) {
            self.rows.rows.extend(unit.rows);
            self.pictures.extend(unit.pictures);
            self.sheets.extend(unit.sheets);
            self.saved.extend(unit.saved);
            return Ok(());
        }
        let (rows, pictures) = (self.rows.rows.len(), self.pictures.len());
        let (saved, sheets) = (self.saved.len(), self.sheets.len());
        work(self)?;
        let unit = Unit {
            rows: self.rows.rows[rows..].to_vec(),
            pictures: self.pictures[pictures..].to_vec(),
            sheets: self.sheets[sheets..].to_vec(),
            saved: self.saved[saved..].to_vec(),
        };
        if let Err(error) = cache.put(&key, &unit) {
            self.remarks.push(format!("cache: {error}"));
        }
        Ok(())
    }

    /// What needs no other leg.
    fn spec_alone(&mut self) -> Result<(), Stop> {
        let spec = self.spec(SUBPIXEL_BITS)?;
        self.analytic(&spec);
        self.facts = Some(Facts::new(self.loaded, &spec.value, &self.plan.passes));
        if self.options.pictures {
            self.pictures.extend(pictures::spec(&spec.value));
            self.sheets
                .push(sheet::spec(&self.loaded.scene, &spec.value, &spec.label));
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
        let budget = (!self.loaded.bare).then(|| stated.edge());
        if self.loaded.scene.samples.count() > 1 {
            let (scene, shown) = (&self.loaded.scene, self.options.pictures);
            let picture = embree::run_samples(scene, &spec, budget, shown, &mut self.rows);
            if let Some(picture) = picture {
                self.shown("embree", &spec.value, &picture);
            }
            return Ok(());
        }
        let seen = embree::run(&spec, budget, &mut self.rows);
        if let Some((embree, unlike)) = seen.filter(|_| self.options.pictures) {
            let (scene, spec) = (&self.loaded.scene, &spec.value);
            let seen = match embree::look(scene, spec, &embree) {
                Ok(seen) => seen,
                Err(error) => {
                    let words = error.to_string();
                    self.rows.fail("cover", "spec", "embree", None, words);
                    return Ok(());
                }
            };
            self.shown("embree", spec, &seen.picture);
            let rays = Rays::new(scene, spec, &embree);
            self.sheets.push(rays.sheet(&seen));
            self.unlike = unlike;
        }
        Ok(())
    }

    fn world(&mut self) -> Result<(), Stop> {
        let spec = self.spec(SUBPIXEL_BITS)?;
        embree::run_world(self.loaded, self.options.world, &spec, &mut self.rows);
        Ok(())
    }
}
