//! Where mutants run: devices, and scenes on which the shipped kernels agree.

use std::collections::BTreeMap;
use std::panic::resume_unwind;
use std::thread::ScopedJoinHandle;

use super::ground::{Ground, Tried};
use super::{Cell, Mutant};
use crate::replay::gpu::Adapter;

/// Devices, and the scenes that mutants ran on.
pub struct Lab {
    adapters: Vec<Adapter>,
    grounds: BTreeMap<String, Ground>,
}

impl Lab {
    /// A lab with these devices.
    pub fn new(adapters: Vec<Adapter>) -> Self {
        Self {
            adapters,
            grounds: BTreeMap::new(),
        }
    }

    /// Whether every device still works.
    pub fn is_well(&self) -> bool {
        self.adapters.iter().all(|a| a.gpu.check().is_ok())
    }

    /// Names of the adapters.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.adapters.iter().map(|a| a.gpu.name.as_str())
    }

    /// Runs a mutant on every adapter, side by side, and each of its paths.
    ///
    /// # Errors
    /// What keeps a leg from a result, or shipped kernels that do not agree.
    pub fn run(&mut self, mutant: &Mutant) -> Result<Vec<Cell>, String> {
        if let Some(reason) = &mutant.absent {
            return Ok(vec![Cell::blank(mutant, String::new(), reason.clone())]);
        }
        let ground = match self.grounds.remove(&mutant.scene) {
            Some(ground) => ground,
            None => Ground::load(mutant)?,
        };
        let ground = self.grounds.entry(mutant.scene.clone()).or_insert(ground);
        for adapter in &self.adapters {
            for path in mutant.paths() {
                ground.prepare(adapter.bits(path))?;
            }
        }
        let shared = &*ground;
        let each = |adapter: &mut Adapter| -> Vec<Tried> {
            let mut tried = Vec::new();
            for path in mutant.paths() {
                tried.push(shared.leg(mutant, adapter, path));
            }
            tried
        };
        let tried: Vec<Vec<Tried>> = std::thread::scope(|scope| {
            let each = &each;
            let run = |adapter| scope.spawn(move || each(adapter));
            let threads: Vec<_> = self.adapters.iter_mut().map(run).collect();
            let join = |thread: ScopedJoinHandle<'_, Vec<Tried>>| {
                thread.join().unwrap_or_else(|panic| resume_unwind(panic))
            };
            threads.into_iter().map(join).collect()
        });
        let mut cells = Vec::new();
        for (adapter, tried) in self.adapters.iter().zip(tried) {
            for tried in tried {
                let (cell, agreed) = tried.map_err(|e| format!("{}: {e}", mutant.name))?;
                ground
                    .sound
                    .extend(agreed.map(|setting| (adapter.gpu.name.clone(), setting)));
                cells.push(cell);
            }
        }
        Ok(cells)
    }
}
