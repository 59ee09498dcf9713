//! All three stages at once, from the scene to the grid: what the comparisons of the
//! stages make superfluous, and what they are held against.

use super::*;
use crate::compare::vertex::axis::Judge;
use crate::compare::vertex::polygons::Layout;
use crate::compare::vertex::{cracks, each, hold};

/// Holds triangles on the grid against the scene itself.
pub fn whole(scene: &Scene, bits: u32, observed: &Primitives) -> VertexReport {
    if (observed.size, observed.bits) != (scene.size, bits) {
        return VertexReport::malformed("another grid".into());
    }
    let layout = match Layout::new(observed, scene.triangles.len()) {
        Ok(layout) => layout,
        Err(message) => return VertexReport::malformed(message),
    };
    let positions: Vec<Position<Bounded>> = vertex::transform(scene);
    let planes = Plane::all(scene.size);
    let corners = |vertices: [u32; 3]| vertices.map(|v| positions[v as usize]);
    let judge = Judge::new(scene.size, bits);
    let (mut report, cut) = each(scene, |row, triangle, part| {
        part.triangles += 1;
        let corners = corners(triangle.vertices);
        let Some(outcomes) = outcomes(&planes, corners) else {
            part.undecided += 1;
            part.admitted += 1;
            return false;
        };
        let is_cut = matches!(outcomes.as_slice(), [one] if one != &corners);
        hold(&judge, row, &outcomes, layout.polygon(row), part) && is_cut
    });
    let told = cracks::cracks(scene, &cut, |triangle| {
        let corners = corners(scene.triangles[triangle].vertices);
        let must = clip_triangle(&planes, corners, |_, plain| plain).into_iter();
        let must = must.map(|corner| corner.map(|n| [n.value, n.bound].map(f64::to_bits)));
        must.zip(layout.polygon(triangle).iter().copied()).collect()
    });
    report.add_cracks(told);
    report
}

/// What the stages admit one by one, from the device's own results, is admitted from the
/// scene to the grid, whatever the kernels do; so nothing is lost without that
/// comparison.
#[test]
fn what_every_stage_admits_the_whole_admits() {
    let sound = ("sound", "row.w;", "row.w;");
    for gpu in devices() {
        for (what, find, replace) in [sound].into_iter().chain(DEFECTS).chain(TRANSFORM) {
            let kernels = Kernels::new(patched(find, replace));
            let mut admitted = 0;
            for (name, scene) in random() {
                let run = run(&gpu, &kernels, &scene, BITS, Given::Nothing, true);
                let run = run.expect("the scene is small");
                let stages = Judged::new(&scene, &run);
                if stages.diverging().is_empty() {
                    let whole = whole(&scene, BITS, &run.primitives);
                    let at = format!("{what}, {name} on {}", gpu.name);
                    assert!(whole.differing == 0, "{at}: {:?}", whole.told);
                    assert!(whole.malformed.is_none(), "{at}: {:?}", whole.malformed);
                    admitted += 1;
                }
            }
            assert!(what != sound.0 || admitted == random().len(), "{admitted}");
        }
    }
}
