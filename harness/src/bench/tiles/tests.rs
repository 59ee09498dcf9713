use triptych_gpu::context::{Gpu, adapters};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::Path;
use triptych_gpu::timer::Clock;
use triptych_gpu::wgsl::Sources;
use triptych_spec::raster::Samples;

use super::*;
use crate::corpus;
use crate::plan::Plan;
use crate::scene::load;

/// Sets up tiles of a scene that is compared in rows, or as a whole; gives the numbers of bands.
fn made(gpu: &Gpu, sources: Sources, most: u64, budget: u64) -> Vec<Result<usize, String>> {
    let file = corpus::root().join("abuffer/hidden/scene.toml");
    let loaded = load(&file).unwrap_or_else(|e| panic!("{e}"));
    let (scene, plan) = (&loaded.scene, Plan::new(&loaded.scene, true));
    let mut grid = Grid::holding(most, scene, &plan, (8, Samples::ONE)).expect("a small scene");
    grid.draw(scene, Some(&[1]));
    assert_eq!(grid.whole().is_some(), most == u64::MAX);
    let kernels = Kernels::new(sources);
    let (prims, faces) = (&grid.primitives, &grid.faces);
    let rasterizer = Rasterizer::new(gpu, &kernels, Path::Compute, prims, faces);
    let start = Start {
        label: "leg".to_owned(),
        rasterizer: &rasterizer.expect("a small scene"),
        grid: &grid,
        scene,
        options: plan.abuffer(scene),
        clock: &Clock::Host("a test".to_owned()),
        budget,
        runs: 1,
    };
    let tiles = Method::BY_TILES.map(|method| match ByTiles::new(method, &start) {
        Ok(tiles) => Ok(tiles.timed.bands()),
        Err(Refusal::Wrong(words) | Refusal::Skipped(words)) => Err(words),
    });
    tiles.to_vec()
}

/// Tiles of more fragments than are held are compared in rows, to the same verdicts, and made in bands: what
/// ships is right, and lists in another order are refused, of which pictures of one colour say nothing.
#[test]
fn tiles_of_more_than_is_held_are_compared_in_rows() {
    let device = adapters(wgpu::Backends::VULKAN).into_iter().next();
    let device = device.expect("no adapter: `./x setup` installs two");
    let gpu = Gpu::open(&device).expect("a device");
    let ships = Sources::shipped(false);
    for most in [u64::MAX, 100] {
        for made in made(&gpu, ships.clone(), most, 100_000) {
            assert!(made.as_ref().is_ok_and(|bands| *bands > 1), "{made:?}");
        }
        // The last triangle comes first, and what is no fragment last as before.
        let backwards = "return (a.y ^ 0x3fffffffu) < (b.y ^ 0x3fffffffu);";
        let order = "return a.x < b.x || (a.x == b.x && a.y < b.y);";
        let backwards = ships.patched("entry", order, backwards).expect("once");
        let [tiles, linked, _] = &made(&gpu, backwards, most, u64::MAX)[..] else {
            unreachable!("three of them");
        };
        for made in [tiles, linked] {
            let words = made.as_ref().expect_err("it is seen");
            assert!(words.starts_with("leg, sorted lists"), "{words}");
        }
    }
}
