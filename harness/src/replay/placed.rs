//! A loaded scene on a lattice: what is seen and what blocks, of the families that are not
//! rasterised as they are loaded.

use triptych_spec::camera::{Camera, Projection};
use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::{Lattice, LatticeError, Point};
use triptych_spec::matrix::Matrix;
use triptych_spec::rsm::Model;

use crate::dispatch::share;
use crate::scene::Loaded;
use crate::scene::file::MeshEntry;

/// Vertices of a piece of work.
const VERTICES: usize = 1 << 13;

/// What is seen in a frame, and what blocks.
///
/// # Errors
/// What the spec says of corners and colours, in one line.
pub(super) fn parts(
    loaded: &Loaded,
    lattice: &Lattice,
    frame: u32,
) -> Result<(Model, Blockers), String> {
    let points = points(loaded, frame);
    let entries = loaded.entries();
    let of = |is: fn(&MeshEntry) -> bool| {
        let triangles = loaded.scene.triangles.iter();
        triangles.filter(move |t| is(entries[t.instance as usize]))
    };
    let snap = |row: u32| lattice.snap(points[row as usize]).unwrap_or_default();
    let seen = of.clone()(MeshEntry::is_seen);
    let (vertices, triangles) = packed(points.len(), seen.clone().map(|t| t.vertices), snap);
    let colours = seen.map(|t| [t.colour[0], t.colour[1], t.colour[2]]);
    let model = Model::new(vertices, triangles, colours.collect());
    let (vertices, triangles) = packed(
        points.len(),
        of(MeshEntry::does_block).map(|t| t.vertices),
        snap,
    );
    let blockers = Blockers {
        vertices,
        triangles,
    };
    Ok((model.map_err(|e| e.to_string())?, blockers))
}

/// Triangles with only those of so many vertices that they use, in order of first use.
fn packed(
    count: usize,
    triangles: impl Iterator<Item = [u32; 3]>,
    point: impl Fn(u32) -> Point,
) -> (Vec<Point>, Vec<[u32; 3]>) {
    let mut rows = vec![None; count];
    let mut vertices = Vec::new();
    let mut row = |old: u32| {
        *rows[old as usize].get_or_insert_with(|| {
            vertices.push(point(old));
            u32::try_from(vertices.len() - 1).expect("scenes have fewer than 2^32 rows")
        })
    };
    let triangles = triangles.map(|corners| corners.map(&mut row)).collect();
    (vertices, triangles)
}

/// The scene's vertices in world space, in one frame.
fn points(loaded: &Loaded, frame: u32) -> Vec<[f64; 3]> {
    let placed = loaded.world.instances.iter().zip(loaded.entries());
    let worlds: Vec<Matrix> = placed
        .map(|(world, entry)| moved(world, entry, frame))
        .collect();
    share::map(&loaded.scene.vertices, VERTICES, |v| {
        worlds[v.instance as usize].point(v.position.map(f64::from))
    })
}

/// Where a mesh stands in a frame: turned about its own origin, placed, and moved on.
fn moved(world: &Matrix, entry: &MeshEntry, frame: u32) -> Matrix {
    let (motion, times) = (entry.motion(), f64::from(frame));
    let turned = (0..3).fold(Matrix::scale([1.0; 3]), |m, axis| {
        Matrix::rotate(axis, motion.rotate.0[axis] * times).times(&m)
    });
    let on = Matrix::translate(motion.translate.0.map(|c| c * times));
    on.times(world).times(&turned)
}

/// The finest lattice that holds all frames, the eyes of perspectives, and some points more.
///
/// # Errors
/// Coordinates that are not finite, in one line.
pub(super) fn lattice(
    loaded: &Loaded,
    frames: u32,
    cameras: &[&Camera],
    others: &[[f64; 3]],
) -> Result<Lattice, String> {
    let perspective = |c: &&&Camera| matches!(c.projection, Projection::Perspective { .. });
    let eyes = cameras.iter().filter(perspective).map(|c| c.eye);
    let still = loaded.entries().iter().all(|entry| entry.moves.is_none());
    let frames = if still { 1 } else { frames };
    let all = (0..frames).flat_map(|frame| {
        let points = points(loaded, frame);
        let triangles = loaded.scene.triangles.iter();
        triangles.flat_map(move |t| t.vertices.map(|v| points[v as usize]))
    });
    match Lattice::around(all.chain(eyes).chain(others.iter().copied())) {
        Ok(lattice) => Ok(lattice),
        // Nothing is seen, from infinitely far away.
        Err(LatticeError::Empty) => Ok(Lattice {
            centre: [0.0; 3],
            exponent: 0,
        }),
        Err(error) => Err(error.to_string()),
    }
}

/// A length in steps of the lattice, to the nearest.
pub(super) fn steps(lattice: &Lattice, length: f64) -> u64 {
    nearest(libm::scalbn(length, -lattice.exponent))
}

/// The nearest integer, halves up; beyond 64 bits the largest.
pub(super) fn nearest(x: f64) -> u64 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturates, and limits are checked afterwards"
    )]
    let integer = libm::floor(x + 0.5) as u64;
    integer
}
