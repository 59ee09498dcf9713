//! What is no scene, and what scenes there are beyond the usual.

use triptych_spec::bound::{Bounded, Real};
use triptych_spec::camera::{Camera, Projection};
use triptych_spec::grid::lattice::{EXTENT, Lattice};
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::{Blockers, Grid, Membership};
use triptych_spec::rsm::{
    BIAS_MAX, Face, Frame, Gbuffer, Lamp, Light, Model, PLACE_MAX, Parameters, Rsm, RsmError,
    Setting, Surface, View, Viewpoint, place, project,
};
use triptych_spec::scene::Size;
use triptych_spec::vertex::DEPTH_ONE;

use super::{PARAMETERS, rows};

/// A triangle without area has no side, no offset, and no light.
#[test]
fn without_area() {
    let face = Face::new([[0; 3], [5, 5, 5], [7, 7, 7]]);
    assert_eq!(
        (face.normal, face.unit, face.coarse),
        ([0; 3], [0.0; 3], [0; 3])
    );
}

/// What is no model, view or parameter is named.
#[test]
fn limits() {
    let model = |point: [i32; 3], rows: Vec<[u32; 3]>, colours| {
        Model::new(vec![point], rows, colours).map(|_| ())
    };
    let at = [0, EXTENT + 1, 0];
    assert_eq!(model(at, vec![], vec![]), Err(RsmError::Outside(at)));
    let missing = model([0; 3], vec![[0, 0, 1]], vec![[0.0; 3]]);
    assert_eq!(missing, Err(RsmError::Row(1)));
    assert_eq!(
        model([0; 3], rows(0), vec![[0.0; 3]]),
        Err(RsmError::Colours(1, 0))
    );
    let dark = model([0; 3], vec![[0; 3]], vec![[0.0, -1.0, 0.0]]);
    assert_eq!(dark, Err(RsmError::Light(-1.0)));
    let sound = PARAMETERS;
    let eye = Size {
        width: 8,
        height: 8,
    };
    assert_eq!(sound.check(eye), Ok(()));
    for wrong in [
        Parameters {
            radius: 1024,
            ..sound
        },
        Parameters { stride: 0, ..sound },
        Parameters {
            divisor: 65,
            ..sound
        },
        Parameters { blur: 17, ..sound },
        Parameters {
            bias: BIAS_MAX + 1,
            ..sound
        },
        Parameters { clamp: 0, ..sound },
        Parameters { offset: 1, ..sound },
        Parameters {
            edge: 1 << 21,
            ..sound
        },
    ] {
        assert!(
            matches!(wrong.check(eye), Err(RsmError::Limit { .. })),
            "{wrong:?}"
        );
    }
    // 2048 x 2048 pixels of 129 x 129 texels.
    let wide = Parameters {
        radius: 64,
        divisor: 1,
        ..sound
    };
    let large = Size {
        width: 2048,
        height: 2048,
    };
    assert!(matches!(
        wide.check(large),
        Err(RsmError::Limit {
            name: "the number of rays",
            ..
        })
    ));
}

/// A perspective's eye is on the lattice, or there is no view; an orthographic one may be
/// anywhere.
#[test]
fn viewpoints() {
    let lattice = Lattice {
        centre: [0.0; 3],
        exponent: 0,
    };
    let size = Size {
        width: 4,
        height: 4,
    };
    let far = f64::from(1 << 24);
    let camera = |projection| Camera {
        eye: [0.0, 0.0, far],
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        projection,
        near: 1.0,
        far: 2.0 * far,
    };
    // Its eye is snapped before anything is made of it.
    let beside = Camera {
        eye: [0.3, -0.4, 9.2],
        ..camera(Projection::Perspective { fov: 60.0 })
    };
    let snapped = Camera {
        eye: [0.0, 0.0, 9.0],
        ..beside
    };
    let view = |camera| View::new(&camera, &lattice, size).expect("a view");
    assert_eq!(view(beside), view(snapped));
    assert_eq!(project::<f64>(&view(beside), [0, 0, 9]), None, "at the eye");
    assert_eq!(project::<f64>(&view(beside), [2, 2, 10]), None, "behind it");
    let perspective = camera(Projection::Perspective { fov: 60.0 });
    assert_eq!(
        View::new(&perspective, &lattice, size),
        Err(RsmError::TooFar)
    );
    let view = View::new(
        &camera(Projection::Orthographic { height: 2.0 }),
        &lattice,
        size,
    );
    assert_eq!(
        view.map(|v| v.viewpoint),
        Ok(Viewpoint::Far([0, 0, 1 << 23]))
    );
    let none = Camera {
        up: [0.0, 0.0, 1.0],
        ..camera(Projection::Orthographic { height: 2.0 })
    };
    assert!(matches!(
        View::new(&none, &lattice, size),
        Err(RsmError::Camera(_))
    ));
    let empty = Size {
        width: 0,
        height: 4,
    };
    assert!(matches!(
        View::new(&none, &lattice, empty),
        Err(RsmError::Limit { .. })
    ));
}

/// Places go on beyond the map's border, to both sides; keys end at the planes.
#[test]
fn beyond_the_map() {
    let lattice = Lattice {
        centre: [0.0; 3],
        exponent: 0,
    };
    let camera = Camera {
        eye: [0.0; 3],
        target: [0.0, 0.0, -1.0],
        up: [0.0, 1.0, 0.0],
        projection: Projection::Orthographic { height: 4.0 },
        near: 16.0,
        far: 32.0,
    };
    let view = View::new(
        &camera,
        &lattice,
        Size {
            width: 4,
            height: 4,
        },
    )
    .expect("a view");
    let seen = |point| Gbuffer {
        size: Size {
            width: 1,
            height: 1,
        },
        keys: vec![0],
        surfaces: vec![Some(Surface {
            triangle: 0,
            side: 1,
            point,
        })],
        stray: vec![[0; 3]],
    };
    let placed = |point| place(&view, &seen(point))[0].map(|p| (p.texel, p.key));
    let one = u32::try_from(DEPTH_ONE).expect("positive");
    assert_eq!(placed([0, 0, -24]), Some(([2, 2], one / 2)));
    assert_eq!(placed([-7, 9, -15]), Some(([-5, -7], 0)));
    assert_eq!(placed([1 << 23, -EXTENT, -33]), Some(([PLACE_MAX; 2], one)));
}

/// Light that is too bright for `f32` is as bright as it can say, so that no difference of
/// two infinities comes of it.
#[test]
fn too_bright() {
    let size = Size {
        width: 1,
        height: 1,
    };
    let surface = Surface {
        triangle: 0,
        side: 1,
        point: [0; 3],
    };
    let seen = Gbuffer {
        size,
        keys: vec![0],
        surfaces: vec![Some(surface)],
        stray: vec![[0; 3]],
    };
    let bright = [1e60, 1.5, 1e39].map(Bounded::exact);
    let rsm = Rsm {
        seen,
        intensity: vec![bright],
    };
    let intensity = [f32::MAX, 1.5, f32::MAX];
    assert_eq!(rsm.lights(), [Some(Light { surface, intensity })]);
}

/// Nothing to see is a frame as well.
#[test]
fn empty() {
    let model = Model::new(vec![], vec![], vec![]).expect("a model");
    let lattice = Lattice {
        centre: [0.0; 3],
        exponent: 0,
    };
    let camera = Camera {
        eye: [0.0, 0.0, 9.0],
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        projection: Projection::Perspective { fov: 60.0 },
        near: 1.0,
        far: 99.0,
    };
    let view = View::new(
        &camera,
        &lattice,
        Size {
            width: 3,
            height: 2,
        },
    )
    .expect("a view");
    let lamp = Lamp::new(view, [1.0; 3], 1).expect("a lamp");
    let blockers = Blockers::default();
    let grid = Grid::build(&blockers, Resolution::FromScene, Membership::Box).expect("empty");
    let setting = Setting {
        model: &model,
        eye: &view,
        lamp: &lamp,
        blockers: &blockers,
        grid: &grid,
        parameters: PARAMETERS,
        background: [0.5; 3],
    };
    let frame = Frame::render(&setting).expect("a frame");
    assert!(frame.picture.iter().flatten().all(|c| c.value == 0.5));
    let wrong = Setting {
        parameters: Parameters {
            offset: 0,
            ..PARAMETERS
        },
        ..setting
    };
    assert!(Frame::render(&wrong).is_err());
}
