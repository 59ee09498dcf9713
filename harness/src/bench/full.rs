//! Scenes of nothing but fragments: how fast lists are made and blended, and in how many bands.

use super::paper::Scene;

/// 64 layers over every pixel of 1280 x 720, and 2^30 fragments: more than a replay holds, and more
/// than a board binds at once.
pub const SCENES: [Scene; 2] = [
    Scene {
        name: "full/layers",
        text: include_str!("full/layers.toml"),
        layers: &[8],
        samples: &[],
        rivals: false,
        boards: false,
    },
    Scene {
        name: "full/many",
        text: include_str!("full/many.toml"),
        layers: &[8],
        samples: &[],
        rivals: false,
        // A software driver has seconds for each hundredth of it.
        boards: true,
    },
];

#[cfg(test)]
mod tests {
    use triptych_spec::raster::count;
    use triptych_spec::vertex::primitives;

    use super::SCENES;

    #[test]
    fn targets_are_full() {
        for (scene, must) in SCENES.iter().zip([64 * 1280 * 720, 1 << 30]) {
            let loaded = scene.load().unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(count(&primitives(&loaded.scene, 8)), must, "{}", scene.name);
        }
    }
}
