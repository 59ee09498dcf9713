//! Some maps as clouds of points over the scene (the paper's Figure 3): each key is put back
//! where it was seen.

use triptych_spec::ldm::{Map, Maps};
use triptych_spec::rsm::{Gbuffer, View, gbuffer, project};
use triptych_spec::scene::Size;
use triptych_spec::vertex::DEPTH_ONE;

use super::setup::off_faces;
use super::spec::{LdmRun, LdmTurn};
use crate::picture;
use crate::replay::exposure::single;
use crate::report::Picture;
use crate::scene::Loaded;
use crate::vector::{cross, dot, normalize};

/// How many maps are shown.
const MAPS: usize = 4;

/// A picture whose longer side is shorter is drawn larger here: points need room between them.
const SIDE: u32 = 480;

/// One of each map; people with any colour vision tell them apart (Okabe and Ito 2008).
const COLOURS: [[f64; 3]; MAPS] = [
    [0.79, 0.34, 0.0],
    [0.09, 0.46, 0.81],
    [0.0, 0.34, 0.17],
    [0.87, 0.78, 0.05],
];

/// How far behind what is seen a point is still shown, in depth keys: those of the surface itself
/// are on both sides of it.
const BEHIND: f64 = DEPTH_ONE as f64 / 256.0;

/// The cloud of a few maps of the first rotation; `None` where nothing is in them.
pub(super) fn picture(loaded: &Loaded, run: &LdmRun) -> Option<Picture> {
    let turn = run.turns.first().filter(|t| !t.layers.keys.is_empty())?;
    let size = run.setup.eye.size;
    let factor = (SIDE / size.width.max(size.height)).max(1);
    let large = Size {
        width: size.width * factor,
        height: size.height * factor,
    };
    // Neither side exceeds the limit, and the view is one already.
    let view = View::new(&loaded.world.camera, &run.setup.lattice, large).ok()?;
    let seen = gbuffer(&run.setup.model, &view, &off_faces(2));
    let mut pixels = shaded(run, &view, &seen);
    let count = turn.maps.maps.len();
    let shown = MAPS.min(count);
    let mut points = 0;
    for (at, colour) in (0..shown).zip(COLOURS) {
        let number = (2 * at + 1) * count / (2 * shown);
        points += cloud(turn, number, &view, &seen, |pixel| pixels[pixel] = colour);
    }
    Some(Picture {
        title: "maps as points".into(),
        caption: format!(
            "What {shown} of {count} maps hold, each in a colour of its own: {points} points that are \
             not behind what is seen."
        ),
        image: picture::linear(large, &single(&pixels)),
    })
}

/// The scene, each face in one shade, brighter the more it is turned to the viewer.
fn shaded(run: &LdmRun, view: &View, seen: &Gbuffer) -> Vec<[f64; 3]> {
    let background = run.background.map(f64::from);
    let shade = |surface: &Option<triptych_spec::rsm::Surface>| {
        let Some(surface) = surface else {
            return background;
        };
        let normal = normalize(run.setup.model.face(surface.triangle).coarse.map(f64::from));
        let towards = normalize(view.viewpoint.from(surface.point).map(f64::from));
        let shade = 0.15 + 0.25 * dot(normal, towards).abs();
        let colour = run.setup.model.colours[surface.triangle as usize];
        colour.map(|c| f64::from(c) * shade)
    };
    seen.surfaces.iter().map(shade).collect()
}

/// Draws the points of a map, and says how many are seen.
fn cloud(
    turn: &LdmTurn,
    number: usize,
    view: &View,
    seen: &Gbuffer,
    mut draw: impl FnMut(usize),
) -> u64 {
    let (maps, map) = (&turn.maps, &turn.maps.maps[number]);
    let mut points = 0;
    for pixel in 0..map.size.width * map.size.height {
        for key in turn.layers.list(map.first + pixel) {
            let at = [pixel % map.size.width, pixel / map.size.width];
            let point = point(maps, map, at, *key);
            let Some([x, y, depth]) = project::<f64>(view, point) else {
                continue;
            };
            let size = view.size;
            let within = |c: f64, end: u32| (0.0..f64::from(end)).contains(&c);
            if !(within(x, size.width) && within(y, size.height)) {
                continue;
            }
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "within the picture"
            )]
            let at = y as usize * size.width as usize + x as usize;
            if depth <= f64::from(seen.keys[at]) + BEHIND {
                points += 1;
                // Two by two pixels, or they are lost in the picture.
                let width = size.width as usize;
                let right = at + usize::from(!(at + 1).is_multiple_of(width));
                let below = |at: usize| Some(at + width).filter(|at| *at < seen.keys.len());
                let all = [Some(at), Some(right), below(at), below(right)];
                all.into_iter().flatten().for_each(&mut draw);
            }
        }
    }
    points
}

/// The point of the lattice that is seen in the middle of a pixel, with this key.
fn point(maps: &Maps, map: &Map, pixel: [u32; 2], key: u32) -> [i32; 3] {
    let half = f64::from(1_u32 << (maps.bits - 1));
    let middle = pixel.map(|c| f64::from(c << maps.bits) + half);
    let place = [middle[0], middle[1], f64::from(key)];
    let shifts = [maps.shifts[0], maps.shifts[0], maps.shifts[1]];
    let aims = [0, 1, 2].map(|i| {
        let from = place[i] + f64::from(map.origin[i]);
        libm::scalbn(from, shifts[i].cast_signed())
    });
    let [a, b, c] = map.rows.map(|row| row.map(f64::from));
    let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
    let volume = dot(a, bc);
    [0, 1, 2].map(|i| {
        let c = (aims[0] * bc[i] + aims[1] * ca[i] + aims[2] * ab[i]) / volume;
        #[expect(clippy::cast_possible_truncation, reason = "saturates, for showing")]
        let c = libm::rint(c) as i32;
        c
    })
}
