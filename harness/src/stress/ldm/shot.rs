//! A step's scene, as files.

use std::path::{Path, PathBuf};

use super::super::shot::{Vertex, mesh};
use crate::error::InputError;

/// What a step's scene is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct LdmShot {
    /// What the step is, in words.
    pub purpose: String,
    /// Width and height of the picture: whoever asks is a pixel of it.
    pub size: [u32; 2],
    /// The camera's eye.
    pub eye: Vertex,
    /// What it looks at.
    pub target: Vertex,
    /// `fov = 40` or `height = 2`.
    pub projection: String,
    /// Distances of the clip planes.
    pub planes: [f64; 2],
    /// Triangles that are seen, rounded to `f32` where the scene is loaded.
    pub seen: Vec<[Vertex; 3]>,
    /// Such that block and are not seen: nobody asks from them.
    pub hidden: Vec<[Vertex; 3]>,
    /// Directions of the set.
    pub directions: u32,
    /// Pixels of a map across what blocks.
    pub resolution: u32,
    /// From where on nothing blocks; everything does without.
    pub far: Option<f64>,
    /// What is known of the scene beforehand.
    pub form: Form,
    /// A part of what the scene must be refused with; it must not be without.
    pub refused: Option<&'static str>,
}

/// What is known of a scene, and so of what is open in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Nothing.
    Any,
    /// The same as all others of its kind but for a power of two, so all that is open is.
    Alike,
    /// Flat or convex: nothing is in the way of any point.
    Convex,
    /// A plane that is seen, and over a part of it a sheet that is not, parallel to it.
    Sheets,
}

impl Default for LdmShot {
    fn default() -> Self {
        Self {
            purpose: String::new(),
            size: [16, 16],
            eye: [2.0, 2.6, 3.4],
            target: [0.0; 3],
            projection: "fov = 36".to_owned(),
            planes: [0.5, 20.0],
            seen: Vec::new(),
            hidden: Vec::new(),
            directions: 48,
            resolution: 64,
            far: None,
            form: Form::Any,
            refused: None,
        }
    }
}

impl LdmShot {
    /// Writes scene and meshes into a folder, which is made if absent; gives the scene's
    /// path.
    ///
    /// # Errors
    /// What keeps a file from being written.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, InputError> {
        let path = folder.join("scene.toml");
        let fail = |e: std::io::Error| InputError::new(folder, format!("cannot be written: {e}"));
        std::fs::create_dir_all(folder).map_err(fail)?;
        for (name, triangles) in self.meshes() {
            std::fs::write(folder.join(name), mesh(triangles)).map_err(fail)?;
        }
        std::fs::write(&path, self.scene()).map_err(fail)?;
        Ok(path)
    }

    /// The meshes that there are, seen ones first.
    fn meshes(&self) -> impl Iterator<Item = (&'static str, &[[Vertex; 3]])> {
        let all = [("seen.obj", &self.seen), ("hidden.obj", &self.hidden)];
        let all = all
            .into_iter()
            .filter(|(_, triangles)| !triangles.is_empty());
        all.map(|(name, triangles)| (name, triangles.as_slice()))
    }

    /// The scene.toml. All of Embree's pairs may be in class edge: many are made to be.
    pub fn scene(&self) -> String {
        let mut text = format!(
            "purpose = \"{}\"\nsize = {:?}\n\n[camera]\neye = {:?}\ntarget = {:?}\n{}\nnear = {:?}\n\
             far = {:?}\n",
            self.purpose,
            self.size,
            self.eye,
            self.target,
            self.projection,
            self.planes[0],
            self.planes[1],
        );
        for (name, _) in self.meshes() {
            let seen = if name == "hidden.obj" {
                "seen = false\n"
            } else {
                ""
            };
            text += &format!("\n[[mesh]]\nfile = \"{name}\"\n{seen}");
        }
        text += &format!(
            "\n[ldm]\ndirections = {}\nresolution = {}\n",
            self.directions, self.resolution
        );
        if let Some(far) = self.far {
            text += &format!("far = {far:?}\npower = 2\n");
        }
        text + "sky.gradient = { zenith = [1.2, 1.6, 2.4], nadir = [0.3, 0.2, 0.1] }\n\n[budget]\nedge = 1.0\n"
    }
}
