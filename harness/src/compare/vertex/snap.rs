//! Stage `snap` by itself, from the polygons that the device clipped.

use triptych_spec::scene::Scene;
use triptych_spec::vertex::{Polygons, Position, Primitives};

use super::axis::Judge;
use super::polygons::Layout;
use super::positions::exact;
use super::{VertexReport, cracks, each, hold, polygon};

/// Compares what a device made of polygons on a grid of `bits` sub-pixel bits: corners,
/// fans and sources. Triangles without a polygon are not counted. `positions` tell which
/// triangles were cut.
pub fn compare_snap(
    scene: &Scene,
    bits: u32,
    positions: &[Position<f32>],
    polygons: &Polygons<f32>,
    observed: &Primitives,
) -> VertexReport {
    if (observed.size, observed.bits) != (scene.size, bits) {
        let message = format!("grid is {:?}, {} bits", observed.size, observed.bits);
        return VertexReport::malformed(message);
    }
    let layout = match Layout::new(observed, scene.triangles.len()) {
        Ok(layout) => layout,
        Err(message) => return VertexReport::malformed(message),
    };
    let judge = Judge::new(scene.size, bits);
    let words = |corner: &Position<f32>| corner.map(f32::to_bits);
    let (mut report, cut) = each(scene, |row, triangle, part| {
        let (given, seen) = (polygon(polygons, row), layout.polygon(row));
        if given.is_empty() && seen.is_empty() {
            return false;
        }
        part.triangles += 1;
        let must: Vec<_> = given.iter().map(|corner| exact(*corner)).collect();
        let inside = hold(&judge, row, &[must], seen, part);
        let whole = triangle.vertices.map(|v| words(&positions[v as usize]));
        inside && !given.iter().map(words).eq(whole)
    });
    let told = cracks::cracks(scene, &cut, |triangle| {
        let given = polygon(polygons, triangle).iter().map(words);
        given
            .zip(layout.polygon(triangle).iter().copied())
            .collect()
    });
    report.add_cracks(told);
    report
}
