//! Meshes: loading files that nobody vouches for.
//!
//! Whatever a file holds, loading returns a mesh whose coordinates are finite and
//! whose indices are in range, or one [`InputError`] with file, line and value. It
//! never panics, and memory stays proportional to the file's size, which is
//! limited by [`BYTES_MAX`].

mod hair;
pub mod lock;
mod mtl;
mod obj;
mod ply;
mod read;
mod text;

use std::path::Path;

use crate::error::InputError;
use crate::text::plural;

pub use hair::{LAYOUT_MAX, layout_of, load as load_hair};
pub use read::{BYTES_MAX, Intake};

/// Most triangles of a mesh and of a scene. A triangle costs a leg up to about
/// 500 bytes at once (three vertices, clipped corners in `f64`, rows), so this
/// many cost 2 GiB; the largest mesh of the corpus has 2.7 million.
pub const TRIANGLES_MAX: u64 = 1 << 22;

/// Most vertices of a mesh and of a scene: three for each triangle.
pub const VERTICES_MAX: u64 = 3 * TRIANGLES_MAX;

/// Most materials of a mesh and of its libraries.
pub const MATERIALS_MAX: u64 = 1 << 16;

/// Triangles as loaded, in object space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Finite positions.
    pub positions: Vec<[f32; 3]>,
    /// Corners as indices into `positions`, in file order.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle its row of `materials`.
    pub material: Vec<u32>,
    /// Materials by the file's names. Row 0 stands for triangles without one.
    pub materials: Vec<Named>,
    /// What was left out, and remarks.
    pub notes: Notes,
}

/// A material that a mesh names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Named {
    /// The name; empty in row 0.
    pub name: String,
    /// Reflectance and opacity, if a material library defines them.
    pub defined: Option<([f64; 3], f64)>,
}

/// What loading left out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Notes {
    /// Lines, and faces of two corners.
    pub lines: u64,
    /// Points, and faces of one corner.
    pub points: u64,
    /// One line each: what is missing or was not understood, and did not matter.
    pub warnings: Vec<String>,
}

impl Notes {
    /// Most warnings that are shown; the others are counted.
    const SHOWN: usize = 3;

    /// All of it in one line; `None` if nothing was left out.
    pub fn line(&self) -> Option<String> {
        let counts = [(self.lines, "line"), (self.points, "point")];
        let counts = counts.into_iter().filter(|(n, _)| *n > 0);
        let counts: Vec<String> = counts.map(|(n, what)| plural(n, what)).collect();
        let mut parts = Vec::new();
        if !counts.is_empty() {
            parts.push(format!("{} ignored", counts.join(" and ")));
        }
        let shown = self.warnings.len().min(Self::SHOWN);
        parts.extend_from_slice(&self.warnings[..shown]);
        if let others @ 1.. = self.warnings.len() - shown {
            parts.push(plural(others as u64, "more warning"));
        }
        (!parts.is_empty()).then(|| parts.join("; "))
    }
}

impl Mesh {
    /// A mesh without materials.
    pub fn of_triangles(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        Self {
            material: vec![0; triangles.len()],
            materials: vec![Named::default()],
            positions,
            triangles,
            notes: Notes::default(),
        }
    }

    /// Triangles that repeat a vertex, or whose area is zero in `f64`.
    pub fn degenerate(&self) -> u64 {
        let flat = |t: &&[u32; 3]| {
            let [a, b, c] = t.map(|v| self.positions[v as usize].map(f64::from));
            let (ab, ac) = (crate::vector::sub(b, a), crate::vector::sub(c, a));
            crate::vector::cross(ab, ac) == [0.0; 3]
        };
        self.triangles.iter().filter(flat).count() as u64
    }
}

/// Loads an `.obj` or `.ply`, with or without `.gz`, whose bytes `intake` has read. It
/// reads material libraries too.
///
/// # Errors
/// Whatever is wrong with the file, with its line and value.
pub fn load(intake: &mut Intake, path: &Path, bytes: Vec<u8>) -> Result<Mesh, InputError> {
    let name = path.to_string_lossy().to_lowercase();
    let name = name.strip_suffix(".gz").unwrap_or(&name);
    if name.ends_with(".obj") {
        let text = intake.unpack(path, bytes)?;
        obj::load(intake, path, &text)
    } else if name.ends_with(".ply") {
        ply::load(path, &intake.unpack(path, bytes)?)
    } else {
        let message = "is no mesh by its name: .obj and .ply are read, and .gz of either";
        Err(InputError::new(path, message))
    }
}

/// Why a mesh of so many triangles and vertices is refused, if it is.
fn too_large(triangles: u64, vertices: u64) -> Option<String> {
    let refuse = |what: &str, n: u64, limit: u64| {
        (n > limit).then(|| format!("{n} {what} exceed the limit of {limit}"))
    };
    refuse("triangles", triangles, TRIANGLES_MAX)
        .or_else(|| refuse("vertices", vertices, VERTICES_MAX))
}
