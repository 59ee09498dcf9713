//! The polygons that rows of triangles stand for. Rows come from a device, so
//! nothing about them is taken for granted.

use std::ops::Range;

use triptych_spec::vertex::Primitives;

/// Corners of every source triangle.
pub struct Layout<'p> {
    snapped: &'p [[i32; 3]],
    /// `offsets[t]..offsets[t + 1]`, one entry more than there are triangles.
    offsets: Vec<usize>,
}

impl<'p> Layout<'p> {
    /// Undoes the fans. Fails with the first row that is not the next of a fan, in
    /// order of source triangles.
    pub fn new(primitives: &'p Primitives, triangles: usize) -> Result<Self, String> {
        let Primitives {
            snapped,
            prims,
            source,
            ..
        } = primitives;
        if source.len() != prims.len() {
            return Err(format!(
                "{} triangles, {} sources",
                prims.len(),
                source.len()
            ));
        }
        let mut offsets = vec![0];
        let mut fan = 0..0;
        for (row, (prim, &source)) in prims.iter().zip(source).enumerate() {
            let source = source as usize;
            if source >= triangles || source + 2 < offsets.len() {
                return Err(format!(
                    "row {row}: source triangle {source} is out of order"
                ));
            }
            if source + 2 == offsets.len() {
                fan.end += 1;
            } else {
                fan = fan.end..fan.end + 3;
                // Triangles that were clipped away have no corners.
                offsets.resize(source + 1, fan.start);
                offsets.push(0);
            }
            offsets[source + 1] = fan.end;
            if prim.map(|corner| corner as usize) != next(&fan) || fan.end > snapped.len() {
                return Err(format!("row {row}: corners {prim:?}, not {:?}", next(&fan)));
            }
        }
        if fan.end != snapped.len() {
            return Err(format!("{} corners, {} in fans", snapped.len(), fan.end));
        }
        offsets.resize(triangles + 1, fan.end);
        Ok(Self { snapped, offsets })
    }

    /// The corners of a source triangle, in order.
    pub fn polygon(&self, triangle: usize) -> &'p [[i32; 3]] {
        &self.snapped[self.offsets[triangle]..self.offsets[triangle + 1]]
    }
}

/// The last triangle of a fan.
fn next(fan: &Range<usize>) -> [usize; 3] {
    [fan.start, fan.end - 2, fan.end - 1]
}
