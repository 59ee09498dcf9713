//! A scene of layered depth maps: the arrays that it leaves behind.

use super::Place;
use super::results::npy;

const SCENE: &str = r#"
purpose = "a box over a floor, under a sky"
size = [24, 16]
[camera]
eye = [2.4, 2.6, 4.6]
target = [-0.2, 0.55, 0]
fov = 36
near = 0.5
far = 20
[[mesh]]
generate.faces = { vertices = [[-1.5, 0, -2], [2, 0, -2], [2, 0, 2], [-1.5, 0, 2]], faces = [[0, 1, 2, 3]] }
[[mesh]]
generate.box = { size = [0.8, 0.8, 0.8] }
translate = [-0.6, 0.5, 0]
[ldm]
directions = 10
rotations = 2
resolution = 12
sky.constant = [1, 1, 1]
"#;

/// What each array holds agrees with what the others say.
#[test]
fn maps_are_dumped_by_the_spec() {
    let place = Place::new("dump-ldm");
    place.write("corpus/ldm/box/scene.toml", SCENE);
    place
        .run(&[
            "replay", "--leg", "spec", "--leg", "embree", "--dump", "out",
        ])
        .expect(0);
    let array = |name: &str| npy(&place.root.join(format!("out/ldm/box/spec/{name}.npy")));
    let words = |name: &str| {
        let (_, bytes) = array(name);
        let words = bytes.chunks_exact(4);
        words
            .map(|w| u32::from_le_bytes(w.try_into().expect("four bytes")))
            .collect::<Vec<u32>>()
    };
    let receivers = words("ldm/pixel").len();
    assert!((100..24 * 16).contains(&receivers), "{receivers}");
    assert!(array("ldm/triangles").0.contains("(14, 3, 3, )"));
    assert!(array("ldm/openness").0.contains("(16, 24, 3, )"));
    assert!(array("ldm/image").0.contains("(16, 24, 3, )"));
    for rotation in ["ldm-1", "ldm-2"] {
        assert!(
            array(&format!("{rotation}/directions"))
                .0
                .contains("(10, 3, )")
        );
        let offsets = array(&format!("{rotation}/offsets"));
        assert!(offsets.0.contains("<u8"), "{}", offsets.0);
        let offsets: Vec<u64> = (offsets.1.chunks_exact(8))
            .map(|w| u64::from_le_bytes(w.try_into().expect("eight bytes")))
            .collect();
        let keys = words(&format!("{rotation}/depth"));
        assert_eq!(offsets.last(), Some(&(keys.len() as u64)));
        assert!(
            offsets.is_sorted() && keys.len() > 200,
            "{} keys",
            keys.len()
        );
        // Columns times rows of the last map, after the pixels before it.
        let last: Vec<u32> = words(&format!("{rotation}/maps")).split_off(6 * 9);
        let pixels = u64::from(last[3] * last[4] + last[5]);
        assert_eq!(offsets.len() as u64, pixels + 1);
        let hits = words(&format!("{rotation}/hits"));
        assert_eq!(hits.len(), receivers * 10 * 3);
        let found = hits.chunks_exact(3).filter(|h| h[1] != u32::MAX).count();
        assert!(
            found > 0
                && hits
                    .chunks_exact(3)
                    .all(|h| h[1] == u32::MAX || h[1] < h[0])
        );
        assert_eq!(words(&format!("{rotation}/whole")).len(), receivers);
    }
    assert_ne!(
        array("ldm-1/rows"),
        array("ldm-2/rows"),
        "the second is turned"
    );
}

/// Surfaces are all behind the camera: there is nothing to do, and every leg says so of every stage.
#[test]
fn where_nobody_asks_every_leg_says_so() {
    let place = Place::new("ldm-nobody");
    let away = SCENE.replace("target = [-0.2, 0.55, 0]", "target = [5, 4.6, 9.2]");
    place.write("corpus/ldm/away/scene.toml", &away);
    // Nothing is compared, which is no success.
    let ran = place.run(&["replay", "--leg", "gpu"]).expect(2);
    let reason = "  nobody asks: no pixel sees anything";
    let mut counts = ran
        .stdout
        .lines()
        .filter_map(|line| line.strip_suffix(reason));
    let count = counts.find_map(|count| count.trim().parse::<usize>().ok());
    // Layers, chain, neighbours, occlusion and environment on each leg, of which there are three
    // with two drivers.
    let each = count.is_some_and(|count| count >= 5 && count % 5 == 0);
    assert!(each, "{}", ran.stdout);
}
