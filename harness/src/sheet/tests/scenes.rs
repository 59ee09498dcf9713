//! Small scenes, and a GPU leg that saw what the spec did.

use std::time::Duration;

use triptych_gpu::abuffer::{Abuffer, BandResult};
use triptych_gpu::frame::Band;
use triptych_spec::abuffer::{EOL, Lists};
use triptych_spec::matrix::Matrix;
use triptych_spec::scene::{Scene, Size, Triangle, Vertex};
use triptych_spec::vertex::{SUBPIXEL_BITS, primitives};

use crate::plan::Plan;
use crate::replay::gpu::GpuSeen;
use crate::replay::spec::SpecRun;

/// Layers of one opaque and several transparent triangles over all of a target.
pub fn layers(size: [u32; 2], keys: &[(f32, f32)]) -> Scene {
    let [width, height] = size;
    let corner = |x, y, z| Vertex {
        position: [x, y, z],
        instance: 0,
    };
    let at = |z: f32| {
        [
            corner(-1.0, -1.0, z),
            corner(3.0, -1.0, z),
            corner(-1.0, 3.0, z),
        ]
    };
    let face = |i: u32, opacity| Triangle {
        vertices: [0, 1, 2].map(|n| 3 * i + n),
        instance: 0,
        primitive: i,
        colour: [0.3, 0.6, 0.9, opacity],
    };
    let identity = [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| f64::from(u8::from(i == j))));
    Scene {
        samples: triptych_spec::raster::Samples::ONE,
        order: triptych_spec::abuffer::Order::Centroid,
        size: Size { width, height },
        instances: vec![Matrix { rows: identity }],
        vertices: keys.iter().flat_map(|(z, _)| at(*z)).collect(),
        triangles: (0..)
            .zip(keys)
            .map(|(i, (_, opacity))| face(i, *opacity))
            .collect(),
        background: [0.0; 3],
    }
}

/// The spec's results.
pub fn run(scene: &Scene) -> SpecRun {
    let plan = Plan::new(scene, true);
    SpecRun::new(scene, primitives(scene, SUBPIXEL_BITS), &plan).expect("a small scene")
}

/// A GPU leg that saw what the spec did, for a test to spoil.
pub fn seen(run: &SpecRun) -> GpuSeen {
    let size = run.primitives.size;
    let band = BandResult {
        band: Band::whole(size),
        built: run.lists.clone(),
        sorted: Some(linked(run)),
    };
    GpuSeen {
        sorted: Some(run.sorted.clone()),
        abuffer: Abuffer {
            opaque: run.opaque.clone(),
            bands: vec![band],
            ..Abuffer::default()
        },
        time: Duration::ZERO,
    }
}

/// The spec's nodes where they are, linked in sorted order.
fn linked(run: &SpecRun) -> Lists {
    let mut lists = run.lists.clone();
    for pixel in 0..lists.heads.len() {
        let mut next = EOL;
        for f in run.sorted.list(pixel).iter().rev() {
            let address = run.lists.nodes.iter().enumerate();
            let owner = owned(&run.lists, pixel);
            let mut own = address.filter(|(i, n)| n.prim == f.prim && owner.contains(i));
            let (address, _) = own.next().expect("the node is there");
            lists.nodes[address].next = next;
            next = u32::try_from(address).expect("few nodes");
        }
        lists.heads[pixel] = next;
    }
    lists
}

/// The addresses of a pixel's nodes.
fn owned(lists: &Lists, pixel: usize) -> Vec<usize> {
    let mut at = lists.heads[pixel];
    let mut all = Vec::new();
    while at != EOL {
        all.push(at as usize);
        at = lists.nodes[at as usize].next;
    }
    all
}
