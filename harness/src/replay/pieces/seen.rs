//! What pixels see of a model: triangles in bands of rows, points in runs of pixels.

use triptych_spec::abuffer::{Opaque, opaque};
use triptych_spec::rsm::{Gbuffer, Model, Parameters, Points, Surface, View};
use triptych_spec::scene::Scene;
use triptych_spec::vertex::{Primitives, SUBPIXEL_BITS};

use super::bands::{self, Band, fragments};
use super::primitives;
use crate::dispatch::share;

/// Pixels of a piece of work.
const PIXELS: usize = 1 << 10;

/// How many fragments a view has of a model.
pub fn fragments_of(model: &Model, view: &View) -> u64 {
    fragments(&primitives(&view.scene(model), SUBPIXEL_BITS).0)
}

/// Stage `gbuffer`.
pub fn gbuffer(model: &Model, view: &View, parameters: &Parameters) -> Gbuffer {
    let scene = view.scene(model);
    let (primitives, _) = primitives(&scene, SUBPIXEL_BITS);
    let nearest = nearest(&scene, &primitives);
    let points = Points::new(model, view, parameters);
    let pixels = share::runs(nearest.prim.len(), PIXELS, |run| {
        let pixel = |at: usize| points.pixel(at, &primitives, nearest.prim[at]);
        run.map(pixel).collect()
    });
    let (surfaces, stray): (Vec<Option<Surface>>, _) = pixels.into_iter().unzip();
    Gbuffer {
        size: view.size,
        keys: nearest.key,
        surfaces,
        stray,
    }
}

/// The nearest triangle of each pixel.
fn nearest(scene: &Scene, primitives: &Primitives) -> Opaque {
    // About: counting the fragments would take as long as covering them.
    let fragments = (primitives.prims.len() + primitives.size.pixels()) as u64;
    let of = |band: &Band| band.shown_surfaces(opaque(scene, &band.primitives));
    let Some(each) = bands::each(primitives, fragments, of) else {
        return opaque(scene, primitives);
    };
    let (keys, prims): (Vec<_>, Vec<_>) = each.into_iter().map(|o| (o.key, o.prim)).unzip();
    Opaque {
        key: keys.concat(),
        prim: prims.concat(),
    }
}

#[cfg(test)]
mod tests {
    use triptych_spec::rsm;

    use super::{fragments_of, gbuffer};
    use crate::corpus;
    use crate::dispatch::share::with_threads;
    use crate::replay::pieces::bands::FRAGMENTS;
    use crate::replay::rsm::Setup;
    use crate::scene::load;

    #[test]
    fn pieces_together_are_the_whole() {
        let file = corpus::root().join("rsm/bunny/scene.toml");
        let loaded = load(&file).unwrap_or_else(|e| panic!("{e}"));
        let setup = Setup::new(&loaded).expect("within the limits");
        let model = setup.parts(&loaded, 0).expect("within the limits").model;
        for view in [&setup.eye, &setup.lamp.view] {
            let whole = rsm::gbuffer(&model, view, &setup.parameters);
            assert!(whole.surfaces.iter().any(Option::is_some), "seen at all");
            let about = (model.triangles.len() + view.size.pixels()) as u64;
            assert!(about >= FRAGMENTS, "taken apart");
            for threads in [1, 3] {
                with_threads(threads, || {
                    let made = gbuffer(&model, view, &setup.parameters);
                    assert_eq!(made, whole, "{threads} threads");
                    let snapped = super::primitives(&view.scene(&model), 8).0;
                    let fragments = triptych_spec::raster::count(&snapped);
                    assert_eq!(fragments_of(&model, view), fragments, "{threads} threads");
                });
            }
        }
    }
}
