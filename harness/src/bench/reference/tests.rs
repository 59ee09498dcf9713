use triptych_spec::abuffer::{EOL, Node};

use super::*;
use crate::corpus;
use crate::scene::load;

#[test]
fn all_layers_are_always_among_them() {
    assert_eq!(layers(None, 1), [1]);
    assert_eq!(layers(None, 8), [1, 2, 4, 8]);
    assert_eq!(layers(None, 13), [1, 2, 4, 8, 13]);
    assert_eq!(layers(Some(&[20, 3, 3]), 13), [3, 13]);
    assert_eq!(layers(Some(&[0, 2]), 13), [0, 2, 13]);
}

/// Sorted lists with links, those of a whole target.
fn linked(sorted: &Sorted) -> Lists {
    let last = |at: u32| sorted.offsets.contains(&(at + 1));
    let node = |(at, f): (u32, &raster::Fragment)| Node {
        key: f.key,
        next: if last(at) { EOL } else { at + 1 },
        prim: f.prim,
        mask: f.mask,
    };
    let nodes: Vec<Node> = (0..).zip(&sorted.fragments).map(node).collect();
    let ends = sorted.offsets.windows(2);
    let count = u32::try_from(nodes.len()).expect("a small scene");
    Lists {
        heads: ends.map(|e| if e[0] < e[1] { e[0] } else { EOL }).collect(),
        colours: vec![[0.0; 4]; nodes.len()],
        nodes,
        attempts: count,
        capacity: count,
    }
}

/// Of a scene with too many fragments rows are compared, to the same verdicts: what is right is
/// right, in whatever bands it comes, and a pixel or a list that is wrong is found.
#[test]
fn rows_are_compared_of_more_than_is_held() {
    let file = corpus::root().join("abuffer/mixed/scene.toml");
    let loaded = load(&file).unwrap_or_else(|e| panic!("{e}"));
    let (scene, plan) = (&loaded.scene, Plan::new(&loaded.scene, true));
    let key = (8, Samples::ONE);
    let mut whole = Grid::new(scene, &plan, key).unwrap();
    let mut rows = Grid::holding(1000, scene, &plan, key).unwrap();
    for grid in [&mut whole, &mut rows] {
        grid.draw(scene, Some(&[1]));
    }
    assert!(whole.whole().is_some() && rows.whole().is_none());
    assert_eq!(
        rows.rows_compared(),
        scene.size.height,
        "it is small: all of them"
    );
    assert_eq!(rows.rows, whole.rows);
    assert_eq!(rows.counts, whole.counts);
    assert!(rows.opaque() == whole.opaque(), "surfaces of all rows");
    let run = whole.whole().unwrap();
    let image: Vec<_> = whole.pieces[0].exact.value.clone();
    #[expect(clippy::cast_possible_truncation, reason = "as a device has it")]
    let picture: Vec<[f32; 3]> = image.iter().map(|p| p.map(|c| c.value as f32)).collect();
    let width = scene.size.width;
    let lower = Band {
        first: 7,
        rows: scene.size.height - 7,
    };
    let lists = linked(&run.sorted);
    let in_band = Lists {
        heads: lists.heads[(7 * width) as usize..].to_vec(),
        ..lists.clone()
    };
    let middle = (scene.size.height / 2 * width + width / 2) as usize;
    assert_ne!(lists.heads[middle], EOL, "a list in the middle");
    for grid in [&whole, &rows] {
        assert_eq!(grid.wrong("leg", 6, "sort", &picture), None);
        assert!(grid.sorted("leg", lower, in_band.clone()).is_ok());
        let mut other = picture.clone();
        other[middle][1] += 0.01;
        let words = grid.wrong("leg", 6, "sort", &other).expect("it is seen");
        assert!(words.contains("1 of "), "{words}");
        assert!(
            grid.wrong("leg", 1, "sort", &picture).is_some(),
            "one layer is another"
        );
        let mut other = in_band.clone();
        other.heads[middle - (7 * width) as usize] = EOL;
        assert!(grid.sorted("leg", lower, other).is_err(), "a list is lost");
        let error = grid.error(&picture);
        assert!(error.psnr.is_some_and(|psnr| psnr > 100.0), "{error:?}");
    }
    assert_eq!(rows.error_of_spec(1), whole.error_of_spec(1));
}
