// Cells of the grid, and which triangles each lists. Coordinates are integers of the lattice
// (spec/src/grid/lattice.rs), as f32, which holds them exactly; comparing them is exact too.

struct Cells {
    // Cells along each axis.
    x: u32,
    y: u32,
    z: u32,
    // Whether cells that a triangle's box touches, but the triangle does not, drop it.
    overlap: u32,
    // Triangles, chunks, cells, bricks, entries or rays of this dispatch.
    items: u32,
    // Chunks of large boxes that there is room for.
    chunks: u32,
    // Entries that there is room for.
    capacity: u32,
    // Entries that are in order already, in a row.
    run: u32,
    // 1 if the first triangle that blocks a ray ends its search, 0 for the nearest.
    any: u32,
    unused: vec3<u32>,
}

@group(0) @binding(0) var<uniform> cells: Cells;

// Boundaries on x, then y, then z; one more on each axis than cells.
@group(0) @binding(1) var<storage, read> boundaries: array<f32>;

// Three for each triangle; the fourth numbers are not used.
@group(0) @binding(2) var<storage, read> corners: array<vec4<f32>>;

// How far, in lattice steps, cells are widened (spec/src/grid/axis.rs).
const WIDENED: f32 = 8.0;

// What an invocation does at most within a dispatch: llvmpipe leaves every loop after 65,535
// iterations, GPUs reset after seconds.
const STEPS: u32 = 16384u;

// Set by what needs another dispatch, to how large that is where it matters.
@group(0) @binding(3) var<storage, read_write> unfinished: atomic<u32>;

// Where each axis' boundaries start.
fn starts() -> vec3<u32> {
    return vec3(0u, cells.x + 1u, cells.x + cells.y + 2u);
}

fn number(cell: vec3<u32>) -> u32 {
    return cell.x + cells.x * (cell.y + cells.y * cell.z);
}

fn corner(triangle: u32, i: u32) -> vec3<f32> {
    return corners[3u * triangle + i].xyz;
}

// How many of `count` boundaries from `start` are below a coordinate, or at it.
fn boundaries_up_to(start: u32, count: u32, coordinate: f32) -> u32 {
    var low = 0u;
    var high = count;
    while low < high {
        let middle = (low + high) / 2u;
        if boundaries[start + middle] <= coordinate {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

// The cells that a box touches.
struct Touched {
    first: vec3<u32>,
    size: vec3<u32>,
}

// Cell i is touched if low <= boundary(i + 1) + WIDENED and high >= boundary(i) - WIDENED.
// All are integers: `below low - WIDENED` is `up to low - WIDENED - 1`.
fn touched_on(start: u32, count: u32, low: f32, high: f32) -> vec2<u32> {
    let first = boundaries_up_to(start + 1u, count, low - WIDENED - 1.0);
    let end = boundaries_up_to(start, count, high + WIDENED);
    return vec2(first, end - first);
}

fn touched(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> Touched {
    let low = min(a, min(b, c));
    let high = max(a, max(b, c));
    let start = starts();
    let x = touched_on(start.x, cells.x, low.x, high.x);
    let y = touched_on(start.y, cells.y, low.y, high.y);
    let z = touched_on(start.z, cells.z, low.z, high.z);
    return Touched(vec3(x.x, y.x, z.x), vec3(x.y, y.y, z.y));
}
