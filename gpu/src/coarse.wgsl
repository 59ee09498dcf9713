// Buffer B's pixels among those of the picture.
//#import surface

@group(0) @binding(6) var<storage, read_write> seen: array<Surface>;

// The picture's pixel that a pixel of buffer B is.
fn fine(column: u32, row: u32) -> u32 {
    return row * parameters.divisor * parameters.width + column * parameters.divisor;
}

// The pixel of buffer B from which a pixel of the picture takes: the nearest of those around it
// that see the same surface, else the nearest; the first of equals.
fn taken_from(surface: Surface, pixel: u32) -> u32 {
    let at = vec2(pixel % parameters.width, pixel / parameters.width);
    let first = at / parameters.divisor;
    let last = min(first + 1u, vec2(parameters.coarse_width, parameters.coarse_height) - 1u);
    var best = 0u;
    var rank = NOTHING;
    for (var y = first.y; y <= last.y; y += 1u) {
        for (var x = first.x; x <= last.x; x += 1u) {
            let other = seen[fine(x, y)];
            let belongs = other.face != NOTHING && same(surface, other);
            let away = vec2<i32>(vec2(x, y) * parameters.divisor) - vec2<i32>(at);
            // Distances are at most 64 along x and y.
            let squared = u32(away.x * away.x + away.y * away.y);
            let this_rank = select(FAR, 0u, belongs) + squared;
            if this_rank < rank {
                rank = this_rank;
                best = y * parameters.coarse_width + x;
            }
        }
    }
    return best;
}

// More than any squared distance to a pixel around.
const FAR: u32 = 65536u;
