//! A frame in bands of rows.
//!
//! Positions are integers of the sub-pixel grid, and a band's triangles move by whole pixels: coverage, keys
//! and colours are what they were. Which bands there are depends on the picture alone.

use triptych_spec::abuffer::{NOTHING, Opaque};
use triptych_spec::bound::Bounded;
use triptych_spec::raster::{self, Fragment, Span};
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use crate::dispatch::share;

/// Fragments from which on a frame is taken apart.
pub(super) const FRAGMENTS: u64 = 1 << 14;

/// Bands of a frame.
const BANDS: u32 = 16;

/// Triangles that are looked at together.
const TRIANGLES: usize = 1 << 13;

/// Rows of a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rows {
    /// The first.
    pub first: u32,
    /// How many.
    pub count: u32,
}

impl Rows {
    /// Whether any is among others.
    fn meets(self, others: &Span) -> bool {
        self.first < others.end && others.start < self.first + self.count
    }
}

/// The rows of a frame's bands.
pub(super) fn bands(size: Size, fragments: u64) -> Vec<Rows> {
    let count = match fragments >= FRAGMENTS {
        true => size.height.div_ceil(BANDS),
        false => size.height,
    };
    let firsts = (0..size.height).step_by(count.max(1) as usize);
    let band = |first| Rows {
        first,
        count: count.min(size.height - first),
    };
    firsts.map(band).collect()
}

/// How many fragments there are.
pub fn fragments(primitives: &Primitives) -> u64 {
    let runs = share::each(primitives.prims.len().div_ceil(TRIANGLES), |number| {
        let end = primitives.prims.len().min((number + 1) * TRIANGLES);
        raster::count_run(primitives, number * TRIANGLES..end)
    });
    runs.iter().sum()
}

/// The triangles as they lie in a target of these rows alone.
pub fn of_rows(primitives: &Primitives, rows: Rows) -> Primitives {
    let prims = primitives.prims.clone();
    let source = primitives.source.clone();
    let snapped = primitives.snapped.iter();
    let snapped = snapped.map(|corner| moved(corner, rows, primitives.bits));
    Primitives {
        size: Size {
            height: rows.count,
            ..primitives.size
        },
        bits: primitives.bits,
        samples: primitives.samples,
        snapped: snapped.collect(),
        prims,
        source,
    }
}

fn moved([x, y, key]: &[i32; 3], rows: Rows, bits: u32) -> [i32; 3] {
    [*x, *y - (rows.first << bits).cast_signed(), *key]
}

/// Some rows of a frame, and the triangles that may cover something there.
pub(super) struct Band {
    rows: Rows,
    /// The triangles as they lie in a target of these rows alone.
    pub(super) primitives: Primitives,
    /// Which they are of all triangles, rising.
    prims: Vec<u32>,
}

/// What comes of each band, of as many bands as so many fragments are worth; `None` if that is one.
pub(super) fn each<R: Send>(
    primitives: &Primitives,
    fragments: u64,
    of: impl Fn(&Band) -> R + Sync,
) -> Option<Vec<R>> {
    let bands = bands(primitives.size, fragments);
    if bands.len() <= 1 {
        return None;
    }
    let between = share::runs(primitives.prims.len(), TRIANGLES, |run| {
        let prims = run.map(|prim| u32::try_from(prim).expect("fewer than 2^32 triangles"));
        prims
            .map(|prim| raster::rows_between(primitives, prim))
            .collect()
    });
    Some(share::map(&bands, 1, |rows| {
        of(&Band::new(primitives, *rows, &between))
    }))
}

impl Band {
    /// `between` has the rows that each triangle lies in.
    fn new(primitives: &Primitives, rows: Rows, between: &[Span]) -> Self {
        let own = (0..).zip(between).filter(|(_, own)| rows.meets(own));
        let prims: Vec<u32> = own.map(|(prim, _)| prim).collect();
        let corner = |row: &u32| moved(&primitives.snapped[*row as usize], rows, primitives.bits);
        let corners = |prim: &u32| primitives.prims[*prim as usize].map(|row| corner(&row));
        let triangles = 0..u32::try_from(prims.len()).expect("fewer than 2^32 triangles");
        Self {
            rows,
            primitives: Primitives {
                size: Size {
                    height: rows.count,
                    ..primitives.size
                },
                bits: primitives.bits,
                samples: primitives.samples,
                snapped: prims.iter().flat_map(corners).collect(),
                prims: triangles.map(|n| [3 * n, 3 * n + 1, 3 * n + 2]).collect(),
                source: prims
                    .iter()
                    .map(|p| primitives.source[*p as usize])
                    .collect(),
            },
            prims,
        }
    }

    /// A triangle's row in the frame.
    pub(super) fn prim(&self, own: u32) -> u32 {
        self.prims[own as usize]
    }

    /// A fragment as the frame has it.
    pub(super) fn shown(&self, own: Fragment) -> Fragment {
        Fragment {
            pixel: own.pixel + self.rows.first * self.primitives.size.width,
            prim: self.prim(own.prim),
            ..own
        }
    }

    /// Surfaces of the band as the frame has them.
    pub(super) fn shown_surfaces(&self, mut own: Opaque) -> Opaque {
        let surfaces = own.prim.iter_mut().filter(|prim| **prim != NOTHING);
        surfaces.for_each(|prim| *prim = self.prim(*prim));
        own
    }

    /// The frame's surfaces in these rows, as the band has them.
    fn surfaces(&self, opaque: &Opaque) -> Opaque {
        let wide = self.primitives.size.width * self.primitives.samples.count();
        let range = self.rows.first * wide..(self.rows.first + self.rows.count) * wide;
        let range = range.start as usize..range.end as usize;
        let own = |prim: &u32| match *prim {
            NOTHING => NOTHING,
            prim => {
                let own = self.prims.partition_point(|p| *p < prim);
                debug_assert_eq!(
                    self.prims.get(own),
                    Some(&prim),
                    "a surface lies in its triangle's rows"
                );
                u32::try_from(own).expect("fewer than 2^32 triangles")
            }
        };
        Opaque {
            key: opaque.key[range.clone()].to_vec(),
            prim: opaque.prim[range].iter().map(own).collect(),
        }
    }
}

/// A picture, band by band.
pub fn picture(
    primitives: &Primitives,
    opaque: &Opaque,
    of: impl Fn(&Primitives, &Opaque) -> Vec<[Bounded; 3]> + Sync,
) -> Vec<[Bounded; 3]> {
    let all = fragments(primitives);
    let band = |band: &Band| of(&band.primitives, &band.surfaces(opaque));
    match each(primitives, all, band) {
        Some(pictures) => pictures.concat(),
        None => of(primitives, opaque),
    }
}
