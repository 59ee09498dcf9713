// Through the cells of triangles' boxes: one invocation goes through a small box, a workgroup
// through each chunk of a large one, in a later pass. So no invocation has much to do, however
// large a triangle is among small ones.
//#import item
//#import cells
//#import overlap

// Boxes of up to so many cells are small.
const SMALL: u32 = 64u;

// Cells of a chunk. A grid has 2^24 at most, so a box has STEPS chunks at most.
const CHUNK: u32 = 1024u;

struct Chunk {
    triangle: u32,
    // Its first cell, of those that the box touches.
    first: u32,
}

// Of all large boxes, in whatever order invocations come; `unfinished` counts them.
@group(0) @binding(15) var<storage, read_write> chunks: array<Chunk>;

// A way through touched cells, x fastest.
struct Sweep {
    triangle: u32,
    a: vec3<f32>,
    b: vec3<f32>,
    c: vec3<f32>,
    touched: Touched,
    at: vec3<u32>,
    // From a cell to the next one that is looked at: like `at`, so many along each axis.
    stride: vec3<u32>,
    // Cells that are still to be looked at.
    left: u32,
}

fn all_of(triangle: u32) -> Sweep {
    let a = corner(triangle, 0u);
    let b = corner(triangle, 1u);
    let c = corner(triangle, 2u);
    let touched = touched(a, b, c);
    let total = touched.size.x * touched.size.y * touched.size.z;
    return Sweep(triangle, a, b, c, touched, vec3(0u), vec3(1u, 0u, 0u), total);
}

// All cells of a small box, none of a large one, which is cut into chunks.
fn sweep(triangle: u32) -> Sweep {
    var sweep = all_of(triangle);
    if sweep.left > SMALL {
        cut(triangle, sweep.left);
        sweep.left = 0u;
    }
    return sweep;
}

// All boxes together have 2^26 cells at most (ENTRIES_MAX of the spec), so their chunks can be
// counted.
fn cut(triangle: u32, total: u32) {
    let count = (total + CHUNK - 1u) / CHUNK;
    let start = atomicAdd(&unfinished, count);
    for (var i = 0u; i < count && start + i < cells.chunks; i += 1u) {
        chunks[start + i] = Chunk(triangle, i * CHUNK);
    }
}

// An invocation's cells of a chunk: neighbours look at neighbours.
fn share(chunk: Chunk, lane: u32) -> Sweep {
    var sweep = all_of(chunk.triangle);
    let first = chunk.first + lane;
    let end = max(first, min(chunk.first + CHUNK, sweep.left));
    sweep.at = digits(first, sweep.touched.size);
    sweep.stride = digits(WORKGROUP, sweep.touched.size);
    sweep.left = (end - first + WORKGROUP - 1u) / WORKGROUP;
    return sweep;
}

fn digits(number: u32, size: vec3<u32>) -> vec3<u32> {
    return vec3(number % size.x, number / size.x % size.y, number / (size.x * size.y));
}

fn here(sweep: Sweep) -> vec3<u32> {
    return sweep.touched.first + sweep.at;
}

// Digits of both are below the size, so each axis carries one at most.
fn onward(given: Sweep) -> Sweep {
    var sweep = given;
    sweep.left -= 1u;
    sweep.at += sweep.stride;
    if sweep.at.x >= sweep.touched.size.x {
        sweep.at.x -= sweep.touched.size.x;
        sweep.at.y += 1u;
    }
    if sweep.at.y >= sweep.touched.size.y {
        sweep.at.y -= sweep.touched.size.y;
        sweep.at.z += 1u;
    }
    return sweep;
}

// Whether the cell where it stands lists the triangle.
fn lists(sweep: Sweep) -> bool {
    return cells.overlap == 0u || overlaps(here(sweep), sweep.a, sweep.b, sweep.c);
}
