//! A step's scene, as files.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::corpus;
use crate::error::InputError;

/// A corner in world space.
pub type Vertex = [f64; 3];

/// Opacities of the surfaces that triangles take in turn.
const OPACITIES: [f64; 4] = [0.3, 0.6, 0.9, 1.0];

/// A mesh of `corpus/meshes.lock`, where it was fetched: cheap, and not made by us.
const REAL: &str = "teapot.obj";

/// Share of Embree's pairs that may be in class edge, or unresolved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge(pub f64);

/// What a step's scene is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// What the step is, in words.
    pub purpose: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The camera's eye.
    pub eye: Vertex,
    /// What it looks at.
    pub target: Vertex,
    /// `fov = 40` or `height = 2`.
    pub projection: String,
    /// Distances of the clip planes.
    pub planes: [f64; 2],
    /// Triangles, rounded to `f32` where the scene is loaded.
    pub triangles: Vec<[Vertex; 3]>,
    /// Opacities of the triangles, in turn.
    pub opacities: Vec<f64>,
    /// Where a real mesh is wanted: the factor that places it.
    pub real: Option<f64>,
    /// Share of vertices or triangles that may go unjudged.
    pub unjudged: f64,
    /// Share of Embree's pairs that may.
    pub edge: Edge,
}

impl Default for Shot {
    fn default() -> Self {
        Self {
            purpose: String::new(),
            size: [96, 64],
            eye: [0.3, 0.4, 4.0],
            target: [0.0; 3],
            projection: "fov = 40".to_owned(),
            planes: [3.5, 5.0],
            triangles: Vec::new(),
            opacities: OPACITIES.to_vec(),
            real: None,
            unjudged: 0.01,
            edge: Edge(1.0),
        }
    }
}

impl Shot {
    /// Writes scene and mesh into a folder, which is made if absent; gives the scene's
    /// path.
    ///
    /// # Errors
    /// What keeps a file from being written.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, InputError> {
        let path = folder.join("scene.toml");
        let fail = |e: std::io::Error| InputError::new(folder, format!("cannot be written: {e}"));
        std::fs::create_dir_all(folder).map_err(fail)?;
        std::fs::write(folder.join("mesh.obj"), self.mesh()).map_err(fail)?;
        std::fs::write(&path, self.scene()).map_err(fail)?;
        Ok(path)
    }

    /// The scene.toml.
    pub fn scene(&self) -> String {
        let Self { size, planes, .. } = self;
        let mut text = format!(
            "purpose = \"{}\"\nsize = {size:?}\nbackground = [0.1, 0.2, 0.3]\n\n[camera]\n\
             eye = {:?}\ntarget = {:?}\n{}\nnear = {:?}\nfar = {:?}\n",
            self.purpose, self.eye, self.target, self.projection, planes[0], planes[1],
        );
        for (number, opacity) in self.opacities.iter().enumerate() {
            // Colours that differ by surface, and are no short binary fractions.
            let colour = [0.3, 0.55, 0.8].map(|c| c / (1.0 + number as f64 / 3.0));
            text += &format!(
                "\n[[material]]\nname = \"s{number}\"\ncolour = {colour:?}\nopacity = {opacity:?}\n"
            );
        }
        let names: Vec<String> = (0..self.opacities.len().min(self.triangles.len()))
            .map(|n| format!("s{n} = \"s{n}\""))
            .collect();
        text += &format!(
            "\n[[mesh]]\nfile = \"mesh.obj\"\nmaterials = {{ {} }}\n",
            names.join(", ")
        );
        if let Some(factor) = self.real.filter(|_| has_real()) {
            text += &format!(
                "\n[[mesh]]\npackage = \"{REAL}\"\nmaterial = \"s0\"\nscale = {factor:?}\n\
                 rotate = [20, 30, 0]\n"
            );
        }
        text += &format!(
            "\n[budget]\nvertex = {:?}\nedge = {:?}\n",
            self.unjudged, self.edge.0
        );
        text
    }

    /// The mesh as OBJ.
    pub fn mesh(&self) -> String {
        let mut text = String::new();
        for (number, corners) in self.triangles.iter().enumerate() {
            let surface = number % self.opacities.len();
            for [x, y, z] in corners {
                writeln!(text, "v {x:e} {y:e} {z:e}").expect("memory takes all");
            }
            writeln!(text, "usemtl s{surface}\nf -3 -2 -1").expect("memory takes all");
        }
        text
    }
}

/// Triangles as OBJ, each with corners of its own.
pub(super) fn mesh(triangles: &[[Vertex; 3]]) -> String {
    let mut text = String::new();
    for corners in triangles {
        for [x, y, z] in corners {
            writeln!(text, "v {x:e} {y:e} {z:e}").expect("memory takes all");
        }
        text += "f -3 -2 -1\n";
    }
    text
}

/// Whether the real mesh was fetched.
pub fn has_real() -> bool {
    corpus::meshes().join(REAL).is_file()
}
