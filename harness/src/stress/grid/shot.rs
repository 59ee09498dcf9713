//! A step's scene, as files, and the rays that no file can ask for.

use std::path::{Path, PathBuf};

use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::{Blockers, Grid};

use super::super::shot::{Vertex, mesh};
use super::near;
use crate::error::InputError;

/// What a step's scene is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct GridShot {
    /// What the step is, in words.
    pub purpose: String,
    /// Triangles, rounded to `f32` where the scene is loaded.
    pub triangles: Vec<[Vertex; 3]>,
    /// Cells along each axis; from the scene without.
    pub cells: Option<[u32; 3]>,
    /// Whether cells list only triangles that touch them.
    pub overlap: bool,
    /// Rays of each of the six kinds.
    pub rays: u32,
    /// Rays beside these.
    pub own: Own,
    /// A part of what the scene must be refused with; it must not be without.
    pub refused: Option<&'static str>,
}

/// Rays that a step has beside those of its scene's kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Own {
    /// None.
    None,
    /// Such that start or pass at 2^-k of the lattice's size from faces, edges and corners of
    /// cells and triangles.
    Near(u32),
    /// Such of so many lattice steps, segments and rays without end.
    Long(i32),
}

impl Own {
    /// Draws them, alike on every machine.
    pub fn rays(self, grid: &Grid, blockers: &Blockers) -> Vec<Ray> {
        match self {
            Self::None => Vec::new(),
            Self::Near(k) => near::near(grid, blockers, k),
            Self::Long(steps) => near::long(blockers, steps),
        }
    }
}

impl Default for GridShot {
    fn default() -> Self {
        Self {
            purpose: String::new(),
            triangles: Vec::new(),
            cells: None,
            overlap: false,
            rays: 400,
            own: Own::None,
            refused: None,
        }
    }
}

impl GridShot {
    /// Writes scene and mesh into a folder, which is made if absent; gives the scene's
    /// path.
    ///
    /// # Errors
    /// What keeps a file from being written.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, InputError> {
        let path = folder.join("scene.toml");
        let fail = |e: std::io::Error| InputError::new(folder, format!("cannot be written: {e}"));
        std::fs::create_dir_all(folder).map_err(fail)?;
        std::fs::write(folder.join("mesh.obj"), mesh(&self.triangles)).map_err(fail)?;
        std::fs::write(&path, self.scene()).map_err(fail)?;
        Ok(path)
    }

    /// The scene.toml. All rays may be in class edge: many are drawn to be.
    pub fn scene(&self) -> String {
        let mut text = format!("purpose = \"{}\"\nsize = [64, 64]\n", self.purpose);
        match self.triangles.is_empty() {
            true => text += "mesh = []\n",
            false => text += "\n[[mesh]]\nfile = \"mesh.obj\"\n",
        }
        text += "\n[grid]\n";
        if let Some(cells) = self.cells {
            text += &format!("resolution = {cells:?}\n");
        }
        if self.overlap {
            text += "overlap = true\n";
        }
        let kinds = ["random", "aimed", "edge", "vertex", "grazing", "cell"];
        let kinds = kinds.map(|kind| format!("{kind} = {}", self.rays));
        text + &format!(
            "rays = {{ {} }}\n\n[budget]\nedge = 1.0\n",
            kinds.join(", ")
        )
    }
}
