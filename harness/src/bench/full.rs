//! Scenes of nothing but fragments: how fast lists are made and blended, and in how many bands.

use super::paper::Scene;

/// 64 layers over every pixel of 1280 x 720; the same of 640 x 360 with all but eight behind a wall,
/// where these are not stored and where they are; and 2^30 fragments: more than a replay holds, and
/// more than a board binds at once.
pub const SCENES: [Scene; 4] = [
    Scene {
        name: "full/layers",
        text: include_str!("full/layers.toml"),
        layers: &[8],
        samples: &[],
        rivals: false,
        boards: false,
        skip: true,
    },
    Scene {
        name: "full/wall",
        text: include_str!("full/wall.toml"),
        layers: &[],
        samples: &[],
        rivals: false,
        boards: false,
        skip: true,
    },
    Scene {
        name: "full/wall-stored",
        text: include_str!("full/wall.toml"),
        layers: &[],
        samples: &[],
        rivals: false,
        boards: false,
        skip: false,
    },
    Scene {
        name: "full/many",
        text: include_str!("full/many.toml"),
        layers: &[8],
        samples: &[],
        rivals: false,
        // A software driver has seconds for each hundredth of it.
        boards: true,
        skip: true,
    },
];

#[cfg(test)]
mod tests {
    use triptych_spec::raster::count;
    use triptych_spec::vertex::primitives;

    use super::SCENES;
    use crate::bench::counts::Counts;
    use crate::plan::Plan;

    #[test]
    fn targets_are_full() {
        let wall = 65 * 640 * 360;
        for (scene, must) in SCENES.iter().zip([64 * 1280 * 720, wall, wall, 1 << 30]) {
            let loaded = scene.load().unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(count(&primitives(&loaded.scene, 8)), must, "{}", scene.name);
        }
    }

    /// Eight layers are in lists, or all; eight are seen.
    #[test]
    fn a_wall_hides_all_but_eight() {
        for (scene, stored) in [(&SCENES[1], 8), (&SCENES[2], 64)] {
            let loaded = scene.load().unwrap_or_else(|error| panic!("{error}"));
            let plan = Plan::new(&loaded.scene, scene.skip);
            let counted = Counts::counted(&loaded.scene, &primitives(&loaded.scene, 8), &plan);
            let counts = counted.unwrap_or_else(|error| panic!("{error}")).counts;
            let all = counts.shown(counts.longest());
            let pixels = 640 * 360;
            assert_eq!(
                [counts.fragments, all],
                [stored * pixels, 8 * pixels],
                "{}",
                scene.name
            );
        }
    }
}
