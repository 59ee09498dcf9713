//! Stages as files that others read without us: NumPy arrays, EXR and PNG.
//!
//! `DIR/<scene>/<leg>[@adapter-path]/<stage>/<name>.npy`, row-major and little
//! endian; x right, y down, origin top left. Each leg's folder has a `meta.json`
//! ([`Meta`]). Existing files are replaced.
//!
//! | array | type and shape | content |
//! |---|---|---|
//! | `vertex/snapped` | i32, n × 3 | x and y in sub-pixels, z depth key |
//! | `vertex/prims` | u32, m × 3 | triangles after clipping, rows of `snapped` |
//! | `vertex/source` | u32, m × 2 | instance and source triangle of each |
//! | `abuffer/offsets` | u32, pixels + 1 | where each pixel's list starts, row-major |
//! | `abuffer/depth` | u32, n | depth keys, sorted within each list |
//! | `abuffer/prim` | u32, n | row of `vertex/prims` |
//! | `abuffer/mask` | u32, n | covered samples |
//! | `abuffer/rgba` | f32, n × 4 | linear colour and opacity |
//! | `grid/dims` | u32, 3 | cells along x, y and z |
//! | `grid/boundaries` | i32, dims + 3 | where cells begin and end on x, then y, then z, in lattice steps |
//! | `grid/lattice` | f64, 4 | the point of the world that is 0, and the size of a step |
//! | `grid/triangles` | i32, m × 3 × 3 | corners in lattice steps |
//! | `grid/offsets` | u32, cells + 1 | where each cell's list starts; x runs fastest, then y |
//! | `grid/prims` | u32, n | rows of `grid/triangles`, rising in each list |
//! | `grid/rays` | i32, r × 7 | origin and direction in lattice steps; 1 if it ends at their sum |
//! | `grid/hit` | u32, r × 2 | row of `grid/triangles` that is met: any, closest; 2^32 - 1 for none |
//! | `grid/t` | f64, r | when the closest is met, in lengths of the direction; NaN for none |
//! | `rsm/lattice` | f64, 4 | as `grid/lattice` |
//! | `rsm-F/triangles` | i32, m × 3 × 3 | of frame F, from 1: corners in lattice steps |
//! | `rsm-F/seen_prim`, `map_prim` | u32, h × w | what a pixel sees, or a texel of the light's map: row of `triangles`, 2^32 - 1 for none |
//! | `rsm-F/seen_point`, `map_point` | i32, h × w × 4 | its side, 1 or -1 (0 for none), and the point in lattice steps |
//! | `rsm-F/place` | i32, h × w × 2 | where that point is in the light's map, x and y; -2^31 for nowhere |
//! | `rsm-F/key`, `lit` | u32, h × w | its depth key there; 1 where the light reaches it |
//! | `rsm-F/bits` | u32, h × w × words | of a pixel of buffer B: bit `i` says that texel `i` of its kernel is blocked |
//! | `rsm-F/intensity`, `direct`, `all`, `blocked`, `blurred` | f32, h × w × 3 | linear: the map's, direct light, buffers A and B, B blurred |
//! | `rsm-F/image` | | the picture |
//! | `ldm/lattice` | f64, 4 | as `grid/lattice` |
//! | `ldm/triangles` | i32, m × 3 × 3 | corners of what is in the maps, in lattice steps |
//! | `ldm/pixel`, `ldm/point`, `ldm/normal` | u32, r; i32, r × 3 | of each receiver: row-major pixel, point in steps, normal of length 2^14 |
//! | `ldm/openness` | | what is open, as a grey picture |
//! | `ldm/image` | | the picture by the light of the sky, if there is one |
//! | `ldm-F/directions` | f64, n × 3 | of rotation F, from 1: the maps' unit vectors, to whom each is seen by |
//! | `ldm-F/rows` | i32, n × 3 × 3 | what a point is multiplied by for its column, row and key |
//! | `ldm-F/shifts` | u32, 3 | by how many bits the first two are shifted down, and the third; sub-pixel bits |
//! | `ldm-F/maps` | i32, n × 6 | origin in sub-pixels and keys, columns, rows, number of the first pixel |
//! | `ldm-F/offsets` | u64, pixels + 1 | where each pixel's list starts, map by map |
//! | `ldm-F/depth` | u32, k | depth keys, rising in each list |
//! | `ldm-F/hits` | i32, r × n × 3 | of each receiver in each map: its own key, the key before it and the one behind it; -1 for none. Left out where there are more than 2^24 |
//! | `ldm-F/whole` | u32, r | the sum of the weights of what is open, in 2^-19 |
//! | `dispatch/lattice`, `dispatch/triangles` | | as of a grid |
//! | `dispatch/sums` | u64, h × w × 3 | light of each pixel, in units of 2^-24 |
//! | `dispatch/image` | | the picture |
//! | `dispatch-B/rays` | i32, r × 6 | of rays that have seen B mirrors, from 0, in the leg's order: origin and direction in lattice steps |
//! | `dispatch-B/pixel`, `weight` | u32, r; u32, r × 3 | whose they are, and what part of their light it gets, in 2^-15 |
//! | `dispatch-B/met` | u32, r | row of `dispatch/triangles` that is met first; 2^32 - 1 for none |
//! | `dispatch-B/point` | i32, r × 4 | side, 1 or -1 (0 for none), and the point in lattice steps, off its face |
//! | `dispatch-B/shadows`, `shadow_pixel` | i32, s × 6; u32, s | the same of rays to lamps, which end at origin + direction |
//! | `dispatch-B/light`, `lit` | f32, s × 3; u32, s | what they bring; 1 if they reach their lamps |
//! | `<stage>/<image>` | f32, h × w × 3 | linear colours; also `.exr` and `.png` |

mod dispatch;
mod grid;
mod ldm;
mod name;
mod rsm;
mod stages;

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use npyz::WriterBuilder;
use serde::{Deserialize, Serialize};
use triptych_spec::scene::Size;

use crate::picture;
pub use dispatch::BounceArrays;
pub use grid::{GridArrays, GridHit};
pub use ldm::{MapArrays, TurnArrays};
use name::component;
pub use rsm::{FrameArrays, FrameShape};

/// The folder of a dump.
#[derive(Clone, Debug)]
pub struct Dump {
    dir: PathBuf,
}

/// The folder of one leg of one scene.
#[derive(Clone, Debug)]
pub struct LegDump {
    dir: PathBuf,
}

/// What the arrays do not say themselves; `meta.json` in each leg's folder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Meta {
    /// The scene's name as it is; the folder's may be escaped.
    pub scene: String,
    /// The leg's label as it is.
    pub leg: String,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Sub-pixel bits of `vertex/snapped`.
    pub subpixel_bits: u32,
    /// Where the samples lie in a pixel, in pixels from its top left; bit `i` of a
    /// mask belongs to entry `i`.
    pub sample_positions: Vec<[f64; 2]>,
    /// Name to version of what made the dump.
    pub versions: BTreeMap<String, String>,
}

impl Dump {
    /// A dump into a folder, which is made when something is written.
    pub fn new(dir: impl AsRef<Path>) -> Self {
        Self {
            dir: dir.as_ref().to_owned(),
        }
    }

    /// The folder for a leg of a scene, such as `gpu@llvmpipe/fragment` of
    /// `abuffer/needle-fan`. A path of an adapter is joined to it with a hyphen;
    /// whatever else could lead elsewhere is escaped.
    pub fn leg(&self, scene: &str, leg: &str) -> LegDump {
        let mut dir = self.dir.clone();
        dir.extend(scene.split('/').map(component));
        dir.push(component(&leg.replace('/', "-")));
        LegDump { dir }
    }
}

impl LegDump {
    /// The leg's folder.
    pub fn path(&self) -> &Path {
        &self.dir
    }

    /// Writes `meta.json`.
    ///
    /// # Errors
    ///
    /// If the file cannot be written; like all others here, naming it.
    pub fn meta(&self, meta: &Meta) -> io::Result<()> {
        let path = self.dir.join("meta.json");
        let text = serde_json::to_string_pretty(meta)?;
        create(&path, |_| fs::write(&path, text + "\n"))
    }

    /// Writes 32-bit unsigned integers.
    ///
    /// # Errors
    ///
    /// If the shape does not hold as many, or the file cannot be written.
    pub fn u32(&self, stage: &str, name: &str, shape: &[usize], data: &[u32]) -> io::Result<()> {
        self.array(stage, name, shape, data)
    }

    /// Writes 64-bit unsigned integers.
    ///
    /// # Errors
    ///
    /// As [`Self::u32`].
    pub fn u64(&self, stage: &str, name: &str, shape: &[usize], data: &[u64]) -> io::Result<()> {
        self.array(stage, name, shape, data)
    }

    /// Writes 32-bit signed integers.
    ///
    /// # Errors
    ///
    /// As [`Self::u32`].
    pub fn i32(&self, stage: &str, name: &str, shape: &[usize], data: &[i32]) -> io::Result<()> {
        self.array(stage, name, shape, data)
    }

    /// Writes 32-bit floats.
    ///
    /// # Errors
    ///
    /// As [`Self::u32`].
    pub fn f32(&self, stage: &str, name: &str, shape: &[usize], data: &[f32]) -> io::Result<()> {
        self.array(stage, name, shape, data)
    }

    /// Writes 64-bit floats.
    ///
    /// # Errors
    ///
    /// As [`Self::u32`].
    pub fn f64(&self, stage: &str, name: &str, shape: &[usize], data: &[f64]) -> io::Result<()> {
        self.array(stage, name, shape, data)
    }

    /// Writes linear colours as an array, as EXR (32-bit float, lossless) and as
    /// PNG (8-bit sRGB, full size, see [`picture::srgb`]).
    ///
    /// # Errors
    ///
    /// If there is not one colour per pixel, or a file cannot be written.
    pub fn image(
        &self,
        stage: &str,
        name: &str,
        size: Size,
        pixels: &[[f32; 3]],
    ) -> io::Result<()> {
        let [width, height] = [size.width, size.height].map(|n| n as usize);
        let flat = pixels.as_flattened();
        self.f32(stage, name, &[height, width, 3], flat)?;
        let path = self.file(stage, name, "exr");
        create(&path, |_| {
            exr::prelude::write_rgb_file(&path, width, height, |x, y| {
                let [r, g, b] = pixels[y * width + x];
                (r, g, b)
            })
            .map_err(io::Error::other)
        })?;
        let rgb = flat.iter().map(|&c| picture::srgb(f64::from(c))).collect();
        let png = picture::png(size.width, size.height, rgb);
        let path = self.file(stage, name, "png");
        create(&path, |_| fs::write(&path, png))
    }

    fn array<T: npyz::AutoSerialize + Copy>(
        &self,
        stage: &str,
        name: &str,
        shape: &[usize],
        data: &[T],
    ) -> io::Result<()> {
        let path = self.file(stage, name, "npy");
        let holds = shape.iter().try_fold(1, |n: usize, &m| n.checked_mul(m));
        if holds != Some(data.len()) {
            let message = format!(
                "{}: shape {shape:?} for {} numbers",
                path.display(),
                data.len()
            );
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        }
        let shape: Vec<u64> = shape.iter().map(|&n| n as u64).collect();
        create(&path, |file| {
            let mut buffer = BufWriter::new(file()?);
            let mut writer = npyz::WriteOptions::new()
                .default_dtype()
                .shape(&shape)
                .writer(&mut buffer)
                .begin_nd()?;
            writer.extend(data.iter().copied())?;
            writer.finish()?;
            // Dropping the buffer would swallow a full disk.
            buffer.flush()
        })
    }

    fn file(&self, stage: &str, name: &str, extension: &str) -> PathBuf {
        let name = format!("{}.{extension}", component(name));
        self.dir.join(component(stage)).join(name)
    }
}

/// Makes a file and its folder; an error names the file.
fn create(
    path: &Path,
    write: impl FnOnce(&dyn Fn() -> io::Result<File>) -> io::Result<()>,
) -> io::Result<()> {
    let folder = path.parent().expect("a file in a folder");
    fs::create_dir_all(folder)
        .and_then(|()| write(&|| File::create(path)))
        .map_err(|e| io::Error::new(e.kind(), format!("{}: {e}", path.display())))
}

#[cfg(test)]
mod tests;
