//! Maps: which keys their lists hold, and what makes none.

use proptest::prelude::*;
use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{LdmError, Maps, RESOLUTION_MAX, layers};
use triptych_spec::raster::{Setup, sample};
use triptych_spec::vertex::Primitives;

use super::{around, direction, empty, maps_of, mesh, quad, sphere, uncropped};
use crate::config;

proptest! {
    #![proptest_config(config(2000))]

    /// A list holds what covers the middle of its pixel, and rises.
    #[test]
    fn lists(
        directions in prop::collection::vec(direction(), 1..3),
        mesh in mesh(),
        resolution in 8..=32_u32,
    ) {
        let maps = uncropped(&directions, &mesh, resolution);
        let layers = layers(&maps, &mesh).unwrap();
        prop_assert_eq!(layers.offsets.len(), maps.pixels as usize + 1);
        prop_assert_eq!(*layers.offsets.last().unwrap() as usize, layers.keys.len());
        for map in &maps.maps {
            let drawn = Primitives {
                samples: triptych_spec::raster::Samples::ONE,
                size: map.size,
                bits: maps.bits,
                snapped: mesh.vertices.iter().map(|v| maps.place(map, *v)).collect(),
                prims: mesh.triangles.clone(),
                source: Vec::new(),
            };
            for y in 0..map.size.height {
                for x in 0..map.size.width {
                    let middle = [sample(x, maps.bits), sample(y, maps.bits)];
                    let key = |prim| {
                        let setup = Setup::new(&drawn, prim)?;
                        let edges = setup.edges(middle);
                        setup.covers(edges).then(|| setup.key(edges))
                    };
                    let all = 0..u32::try_from(mesh.triangles.len()).unwrap();
                    let mut keys: Vec<u32> = all.filter_map(key).collect();
                    keys.sort_unstable();
                    prop_assert_eq!(layers.list(map.first + y * map.size.width + x), &keys[..]);
                }
            }
        }
    }
}

/// What enters a closed mesh leaves it: every list is even, in any direction.
#[test]
fn closed_meshes_have_even_lists() {
    let mesh = sphere([4e6; 3], 17, 11);
    let mut held = 0;
    for frame in 0..3 {
        let maps = maps_of(&mesh, 24, 40, frame);
        let layers = layers(&maps, &mesh).unwrap();
        held += layers.keys.len();
        for list in (0..maps.pixels).map(|pixel| layers.list(pixel)) {
            assert_eq!(list.len() % 2, 0, "{list:?}");
        }
    }
    assert!(held > 50_000, "{held}");
}

/// A map is cropped to the box: a flat scene seen from its side is one row.
#[test]
fn maps_are_cropped() {
    let mut mesh = empty();
    quad(
        &mut mesh,
        [-3_000_000, -3_000_000],
        [3_000_000, 3_000_000],
        5,
    );
    let bounds = around(&mesh.vertices);
    let maps = Maps::new(&[[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], bounds, bounds, 100).unwrap();
    let sizes: Vec<[u32; 2]> = maps
        .maps
        .iter()
        .map(|m| [m.size.width, m.size.height])
        .collect();
    // Its sides are 1 / sqrt(2) of the diagonal, and their ends on borders of pixels or not.
    assert!(
        sizes[0].iter().all(|side| (71..=72).contains(side)),
        "{sizes:?}"
    );
    assert!(sizes[1].contains(&1), "{sizes:?}");
    let layers = layers(&maps, &mesh).unwrap();
    let above = maps.maps[0].size.width * maps.maps[0].size.height;
    let covered = layers.offsets[above as usize];
    assert!((70 * 70..=72 * 72).contains(&covered), "{covered}");
    assert_eq!(
        layers.keys.len(),
        covered as usize,
        "edge-on it covers nothing"
    );
}

#[test]
fn limits_are_named() {
    let bounds = [[-9; 3], [9; 3]];
    let error = |directions: &[[f64; 3]], resolution| {
        Maps::new(directions, bounds, bounds, resolution)
            .unwrap_err()
            .to_string()
    };
    assert!(error(&[], 8).contains("the number of directions is 0"));
    assert!(error(&[[0.0, 0.0, 1.0]], 0).contains("the resolution is 0; 8 to 724"));
    assert!(error(&[[0.0, 0.0, 1.0]], 725).contains("724"));
    let maps = Maps::new(&[[0.0, 0.0, 1.0]], bounds, bounds, 8).unwrap();
    let mesh = Blockers {
        vertices: vec![[0; 3]],
        triangles: vec![[0, 0, 3]],
    };
    assert_eq!(layers(&maps, &mesh), Err(LdmError::Row(3)));
}

/// The corners of the lattice are held, at every resolution.
#[test]
fn the_whole_lattice_fits() {
    let end = triptych_spec::grid::lattice::REACH;
    let bounds = [[-end; 3], [end; 3]];
    let diagonal = [1.0 / 3.0_f64.sqrt(); 3];
    for resolution in [8, 25, 362, 363, RESOLUTION_MAX] {
        let maps = Maps::new(&[diagonal, [0.0, 0.0, 1.0]], bounds, bounds, resolution).unwrap();
        for map in &maps.maps {
            let far = maps.place(map, [end, end, end]);
            let near = maps.place(map, [-end, -end, -end]);
            assert!(far.iter().chain(&near).all(|c| (0..1 << 28).contains(c)));
            // Edge functions fit in 31 bits and a sign: at most the area of what is covered.
            let corners =
                (0..8).map(|n| [0, 1, 2].map(|i| if n >> i & 1 == 0 { -end } else { end }));
            let places: Vec<_> = corners.map(|c| maps.place(map, c)).collect();
            let side = |axis: usize| {
                let along = places.iter().map(|p| i64::from(p[axis]));
                along.clone().max().unwrap() - along.min().unwrap()
            };
            assert!(side(0) * side(1) < 1 << 31, "{} {}", side(0), side(1));
        }
    }
}
