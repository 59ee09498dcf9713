//! A scene on which mutants run, once the shipped kernels agree there.

mod able;
mod part;

use std::collections::{BTreeMap, BTreeSet};

use triptych_gpu::error::GpuError;
use triptych_gpu::kernel::{Fault, Kernels};
use triptych_gpu::raster::Path;
use triptych_gpu::wgsl::Sources;
use triptych_spec::vertex::{SUBPIXEL_BITS, primitives};

use super::{Cell, Mutant};
use crate::observe::{Observed, Spec};
use crate::plan::{DispatchPlan, LdmPlan, Plan, RsmPlan};
use crate::registry::Chain;
use crate::replay::dispatch::{DispatchLeg, DispatchRun};
use crate::replay::gpu::{Adapter, From, GpuLeg};
use crate::replay::grid::{GridLeg, GridRun};
use crate::replay::ldm::{LdmLeg, LdmRun};
use crate::replay::rivals::run_only;
use crate::replay::rows::Rows;
use crate::replay::rsm::{RsmLeg, RsmRun};
use crate::replay::spec::SpecRun;
use crate::replay::vertex::VertexLeg;
use crate::replay::{Extent, layouts, tiles};
use crate::row::{Row, Verdict};
use crate::scene::value::Capacity;
use crate::scene::{Loaded, load_entry};
use part::{Part, differ, touched};

/// A scene with what the spec says of it.
pub(super) struct Ground {
    loaded: Loaded,
    plan: Plan,
    /// By sub-pixel bits.
    specs: BTreeMap<u32, Observed<Spec, SpecRun>>,
    /// Of a scene with a grid.
    grid: Option<Observed<Spec, GridRun>>,
    /// Of a scene of indirect light.
    rsm: Option<(Observed<Spec, RsmRun>, RsmPlan)>,
    /// Of a scene of maps.
    ldm: Option<(Observed<Spec, LdmRun>, LdmPlan)>,
    dispatch: Option<(Observed<Spec, DispatchRun>, DispatchPlan)>,
    /// Where the shipped kernels were seen to agree.
    pub(super) sound: BTreeSet<(String, Setting)>,
}

/// How a leg is run. A mutant is compared at the stages that can see its defect.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Setting {
    path: Path,
    /// What is compared.
    part: Part,
    bindings: Option<u64>,
}

/// A cell, and whether the shipped kernels were asked for it.
pub(super) type Tried = Result<(Cell, Option<Setting>), String>;

impl Ground {
    pub(super) fn load(mutant: &Mutant) -> Result<Self, String> {
        let loaded = load_entry(&mutant.entry(), None).map_err(|e| e.to_string())?;
        let (mut grid, mut rsm, mut ldm, mut dispatch) = (None, None, None, None);
        match loaded.chain() {
            Chain::Frame => {}
            Chain::Rays => grid = Some(Observed::new("spec", GridRun::new(&loaded)?)),
            Chain::Indirect => {
                let run = Observed::new("spec", RsmRun::new(&loaded, true)?);
                rsm = Some((run, RsmPlan::new(&loaded, true)));
            }
            Chain::Maps => {
                let run = Observed::new("spec", LdmRun::new(&loaded, true)?);
                ldm = Some((run, LdmPlan::new(&loaded, true)));
            }
            Chain::Traced => {
                let run = Observed::new("spec", DispatchRun::new(&loaded)?);
                dispatch = Some((run, DispatchPlan::new(&loaded, true)));
            }
        }
        Ok(Self {
            plan: Plan::of(&loaded, true),
            loaded,
            grid,
            rsm,
            ldm,
            dispatch,
            specs: BTreeMap::new(),
            sound: BTreeSet::new(),
        })
    }

    /// Runs the spec on a grid, once.
    pub(super) fn prepare(&mut self, bits: u32) -> Result<(), String> {
        let drawn = self.loaded.chain() == Chain::Frame;
        if drawn && !self.specs.contains_key(&bits) {
            let snapped = primitives(&self.loaded.scene, bits);
            let run = SpecRun::new(&self.loaded.scene, snapped, &self.plan)?;
            self.specs.insert(bits, Observed::new("spec", run));
        }
        Ok(())
    }

    /// Runs a mutant on one path of one adapter; before the first on this scene, the
    /// shipped kernels, or it could die of something else.
    pub(super) fn leg(&self, mutant: &Mutant, adapter: &mut Adapter, path: Path) -> Tried {
        let leg = adapter.label(path);
        if let Some(reason) = self.cannot_run(adapter, path) {
            return Ok((Cell::blank(mutant, leg, reason), None));
        }
        let native = path == Path::Native;
        let sources = mutant.sources(native, || self.twice_the_bound());
        let sources = sources.map_err(|e| e.to_string())?;
        let setting = Setting {
            path,
            part: touched(&sources, native).map_err(|e| e.to_string())?,
            bindings: mutant.bindings,
        };
        if let Some(bytes) = setting.bindings {
            adapter.gpu.restrict_bindings(bytes);
        }
        let cell = self.in_setting(mutant, sources, adapter, setting, leg);
        adapter.gpu.lift_restrictions();
        cell
    }

    fn in_setting(
        &self,
        mutant: &Mutant,
        sources: Sources,
        adapter: &mut Adapter,
        setting: Setting,
        leg: String,
    ) -> Tried {
        let new = !self.sound.contains(&(adapter.gpu.name.clone(), setting));
        if new {
            let rows = self.rows(adapter, setting, setting.part.files());
            let rows = rows.map_err(|e| e.to_string())?;
            let is = |verdict| rows.iter().any(|r| r.verdict() == verdict);
            if is(Verdict::Diverge) || !is(Verdict::Agree) {
                return Err(format!(
                    "{leg}: the shipped kernels do not agree on {}",
                    mutant.scene
                ));
            }
        }
        let rows = self.mutated(adapter, setting, sources, mutant.fault());
        let rows = rows.map_err(|e| e.to_string())?;
        let cell = Cell::of(mutant, leg, &rows)?;
        Ok((cell, new.then_some(setting)))
    }

    /// Runs a leg with other kernels.
    fn mutated(
        &self,
        adapter: &mut Adapter,
        setting: Setting,
        sources: Sources,
        fault: Option<Fault>,
    ) -> Result<Vec<Row>, GpuError> {
        let native = setting.path == Path::Native;
        let files: Vec<&'static str> = differ(&sources, native, setting.part.files())?.collect();
        let mutated = kernels(adapter, setting.path).mutated(sources, fault)?;
        let shipped = std::mem::replace(kernels(adapter, setting.path), mutated);
        let rows = self.rows(adapter, setting, &files);
        *kernels(adapter, setting.path) = shipped;
        rows
    }

    /// The rows of a leg: of these programs alone, if one runs without another.
    fn rows(
        &self,
        adapter: &Adapter,
        setting: Setting,
        files: &[&'static str],
    ) -> Result<Vec<Row>, GpuError> {
        let path = setting.path;
        let Loaded {
            name, family, file, ..
        } = &self.loaded;
        let mut rows = Rows::new(name, family);
        if let (Some(spec), Some(section)) = (&self.grid, file.grid) {
            let capacity = section.capacity;
            let leg = GridLeg::new(adapter, path, spec, capacity);
            return leg.each(&mut rows).map(|()| rows.rows);
        }
        if let Some((spec, plan)) = &self.rsm {
            let leg = RsmLeg::new(adapter, path, spec, &plan.passes);
            return leg.each(&mut rows).map(|()| rows.rows);
        }
        if let Some((spec, plan)) = &self.ldm {
            let leg = LdmLeg::new(adapter, path, spec, &plan.passes);
            // Points that a device sees by itself have no stage of this family.
            return stages_or_whole(&leg, rows, LdmLeg::each, LdmLeg::end_to_end);
        }
        if let Some((spec, plan)) = &self.dispatch {
            let leg = DispatchLeg::new(adapter, path, spec, &plan.passes);
            // What searches answer in their exact form is told by the stage; what queues are without the
            // host's reading them, only by the whole.
            return stages_or_whole(&leg, rows, DispatchLeg::each, DispatchLeg::end_to_end);
        }
        self.frame(adapter, setting, files, &mut rows)?;
        Ok(rows.rows)
    }

    /// The same of a scene of triangles alone.
    fn frame(
        &self,
        adapter: &Adapter,
        setting: Setting,
        files: &[&'static str],
        rows: &mut Rows,
    ) -> Result<(), GpuError> {
        let Setting { path, part, .. } = setting;
        let (scene, file) = (&self.loaded.scene, &self.loaded.file);
        let spec = &self.specs[&adapter.bits(path)];
        if part == Part::Vertex {
            let leg = VertexLeg {
                adapter,
                path,
                scene,
                spec,
                from: From::default(),
                budget: Some(file.budget.vertex.0),
            };
            return leg.run(Some(rows)).map(drop);
        }
        let leg = GpuLeg {
            adapter,
            path,
            scene,
            spec,
            plan: &self.plan,
            capacity: match file.abuffer.capacity {
                Capacity::All => None,
                stated => Some(stated.nodes(spec.value.lists.attempts)),
            },
            from: From::default(),
        };
        match part {
            Part::Rivals => run_only(files, &leg, Extent::All, rows),
            Part::Tiles => tiles::run_only(files, &leg, Extent::All, rows),
            Part::Layouts => layouts::run_only(files, &leg, Extent::All, rows),
            _ => leg.run(rows).map(drop),
        }
    }

    /// The least share of a colour by which every colour of a pixel with layers differs
    /// by twice its own bound.
    fn twice_the_bound(&self) -> f64 {
        let Some(run) = self.specs.get(&SUBPIXEL_BITS).map(|spec| &spec.value) else {
            return f64::NAN;
        };
        let lists = run.sorted.offsets.windows(2);
        let layered = run
            .image
            .iter()
            .zip(lists)
            .filter(|(_, list)| list[0] < list[1]);
        let shares = layered.flat_map(|(pixel, _)| pixel.map(|c| c.bound / c.value));
        2.0 * shares.fold(0.0, f64::max)
    }
}

/// The rows of all stages, and those of the whole if no stage shows anything: it would show again.
fn stages_or_whole<L, T>(
    leg: &L,
    mut rows: Rows,
    each: impl Fn(&L, &mut Rows) -> Result<(), GpuError>,
    whole: impl Fn(&L, &mut Rows) -> Result<T, GpuError>,
) -> Result<Vec<Row>, GpuError> {
    each(leg, &mut rows)?;
    if rows.rows.iter().all(|row| row.differ == 0) {
        whole(leg, &mut rows)?;
    }
    Ok(rows.rows)
}

fn kernels(adapter: &mut Adapter, path: Path) -> &mut Kernels {
    let Adapter {
        kernels, native, ..
    } = adapter;
    native
        .as_mut()
        .filter(|_| path == Path::Native)
        .unwrap_or(kernels)
}
