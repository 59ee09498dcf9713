//! Strands of hair in Embree's scene format: an .xml that says where in a raw
//! .bin.gz the data lie. Each strand becomes a prism of three sides.

use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use super::{Intake, Mesh, too_large};
use crate::error::InputError;
use crate::vector::{add, cross, normalize, scale, sub};

/// Largest layout in bytes.
pub const LAYOUT_MAX: u64 = 1 << 16;

/// An array in the .bin: byte offset and number of items.
#[derive(Clone, Copy)]
struct Extent {
    at: u64,
    count: u64,
}

/// `NAME.xml` beside `NAME.bin.gz`.
pub fn layout_of(path: &Path) -> PathBuf {
    let stem = path.to_string_lossy();
    let stem = stem.strip_suffix(".bin.gz").unwrap_or(&stem);
    PathBuf::from(format!("{stem}.xml"))
}

/// Loads `NAME.bin.gz`, whose layout `NAME.xml` beside it gives: `indices` (u32,
/// little-endian), each the first point of a segment that ends in the next point,
/// and `positions` (x, y, z, radius in f32). Every `stride`th strand is kept.
///
/// # Errors
/// A layout that does not fit the data, or data out of range.
pub fn load(
    intake: &mut Intake,
    path: &Path,
    bytes: Vec<u8>,
    stride: NonZeroU32,
) -> Result<Mesh, InputError> {
    let bytes = intake.unpack(path, bytes)?;
    let (indices, positions) = layout(intake, &layout_of(path))?;
    let error = |message: String| InputError::new(path, message);
    let indices = array::<4>(&bytes, indices).map_err(error)?;
    let positions = array::<16>(&bytes, positions).map_err(error)?;
    if let Some(bad) = positions
        .iter()
        .position(|p| !point(p).iter().all(|x| x.is_finite()))
    {
        let message = format!("point {bad} is not finite: {:?}", point(&positions[bad]));
        return Err(error(message));
    }
    // A segment has two points.
    let last = positions.len().saturating_sub(1);
    let first = |b: &[u8; 4]| u32::from_le_bytes(*b);
    if let Some(bad) = indices.iter().position(|b| first(b) as usize >= last) {
        let (index, count) = (first(&indices[bad]), positions.len());
        let message = format!("segment {bad} starts at point {index} of {count}");
        return Err(error(message));
    }
    let strands = || {
        let strands = indices.chunk_by(|a, b| first(a).checked_add(1) == Some(first(b)));
        strands.step_by(stride.get() as usize)
    };
    let (strand_count, segments) = strands().fold((0, 0), |(strands, segments), strand| {
        (strands + 1, segments + strand.len() as u64)
    });
    if let Some(message) = too_large(6 * segments, 3 * (segments + strand_count)) {
        return Err(error(message));
    }
    let mut mesh = Mesh::of_triangles(Vec::new(), Vec::new());
    for strand in strands() {
        let start = first(&strand[0]) as usize;
        let points: Vec<[f32; 4]> = positions[start..=start + strand.len()]
            .iter()
            .map(point)
            .collect();
        prism(&mut mesh, &points);
    }
    mesh.material = vec![0; mesh.triangles.len()];
    if mesh.triangles.is_empty() {
        return Err(error("no triangles: no strand has a segment".to_owned()));
    }
    Ok(mesh)
}

fn point(bytes: &[u8; 16]) -> [f32; 4] {
    let (words, _) = bytes.as_chunks::<4>();
    [0, 1, 2, 3].map(|i| f32::from_le_bytes(words[i]))
}

/// Three vertices around every point of a strand, six triangles for every segment.
fn prism(mesh: &mut Mesh, points: &[[f32; 4]]) {
    let first = row(mesh.positions.len());
    let at = |i: usize| [0, 1, 2].map(|axis| f64::from(points[i][axis]));
    for (i, point) in points.iter().enumerate() {
        let along = sub(at((i + 1).min(points.len() - 1)), at(i.saturating_sub(1)));
        let (side, up) = frame(along);
        for (cos, sin) in CORNERS {
            let r = f64::from(point[3]);
            let corner = add(at(i), add(scale(side, r * cos), scale(up, r * sin)));
            mesh.positions.push(corner.map(single));
        }
    }
    for segment in 0..row(points.len() - 1) {
        let (here, next) = (first + 3 * segment, first + 3 * segment + 3);
        for corner in 0..3 {
            let other = (corner + 1) % 3;
            mesh.triangles
                .push([here + corner, here + other, next + other]);
            mesh.triangles
                .push([here + corner, next + other, next + corner]);
        }
    }
}

/// Cosine and sine of 0, 120 and 240 degrees.
const CORNERS: [(f64, f64); 3] = [
    (1.0, 0.0),
    (-0.5, 0.866_025_403_784_438_6),
    (-0.5, -0.866_025_403_784_438_6),
];

/// Two unit vectors across a direction.
fn frame(along: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let along = normalize(along);
    // The axis along which the strand runs least is far from parallel to it.
    let axis = (0..3).min_by(|a, b| along[*a].abs().total_cmp(&along[*b].abs()));
    let mut other = [0.0; 3];
    other[axis.unwrap_or(0)] = 1.0;
    let side = normalize(cross(along, other));
    (side, cross(along, side))
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to f32; saturated, so that a huge radius stays finite"
)]
fn single(x: f64) -> f32 {
    (x as f32).clamp(f32::MIN, f32::MAX)
}

fn row(n: usize) -> u32 {
    u32::try_from(n).expect("bounded by too_large")
}

/// The items of an array, if the file holds them all.
fn array<const N: usize>(bytes: &[u8], extent: Extent) -> Result<&[[u8; N]], String> {
    let end = extent
        .count
        .checked_mul(N as u64)
        .and_then(|n| n.checked_add(extent.at));
    let range = end.and_then(|end| {
        let range = usize::try_from(extent.at).ok()?..usize::try_from(end).ok()?;
        bytes.get(range)
    });
    match range {
        Some(range) => Ok(range.as_chunks::<N>().0),
        None => Err(format!(
            "{} items of {N} bytes at byte {} do not fit into {} bytes",
            extent.count,
            extent.at,
            bytes.len()
        )),
    }
}

/// Where `<indices ofs="" size=""/>` and `<positions ofs="" size=""/>` say the
/// data are.
fn layout(intake: &mut Intake, path: &Path) -> Result<(Extent, Extent), InputError> {
    let bytes = intake.read(path, LAYOUT_MAX)?;
    let text = String::from_utf8_lossy(&bytes);
    let extent = |tag: &str| {
        let start = text.find(&format!("<{tag} "))?;
        let body = &text[start..start + text[start..].find('>')?];
        let attribute = |name: &str| {
            let value = body.split_once(&format!(" {name}=\""))?.1;
            value.split_once('"')?.0.parse().ok()
        };
        Some(Extent {
            at: attribute("ofs")?,
            count: attribute("size")?,
        })
    };
    let need = |tag: &str| {
        let message = || format!("needs <{tag} ofs=\"BYTES\" size=\"COUNT\"/>");
        extent(tag).ok_or_else(|| InputError::new(path, message()))
    };
    Ok((need("indices")?, need("positions")?))
}
