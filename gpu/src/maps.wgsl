// The maps of a set of directions: what kernels are told of them, and where points are in them.
// Twins: spec/src/ldm/map.rs, and `Told` in ldm.rs.
//#import wide

struct Told {
    // Sub-pixel bits.
    bits: u32,
    // By how much dot products with a map's first two rows are shifted down, 29 to 44.
    shift: u32,
    // Keys of half a pixel at a slope of one, and the bits that were shifted out.
    half: u32,
    half_shift: u32,
    // Maps of this dispatch.
    first_map: u32,
    maps: u32,
    // The first pixel, of all maps', that the batch's lists begin with.
    first_pixel: u32,
    // Lists of the batch.
    pixels: u32,
    triangles: u32,
    // Pixels, keys or receivers of this dispatch.
    items: u32,
    // Rows of each map that are drawn.
    first_row: u32,
    rows: u32,
    // Keys that there is room for.
    capacity: u32,
    // Keys that are in order already, in a row.
    run: u32,
    // Keys from which on nothing blocks, and the power of what a hit lets pass; 0: all hits block.
    most: u32,
    power: u32,
    // The lowest corner of the box that is drawn.
    low_x: i32,
    low_y: i32,
    low_z: i32,
    // The longest side of a small triangle's box on the lattice.
    small: i32,
    // How many triangles are large.
    larges: u32,
}

@group(0) @binding(0) var<uniform> told: Told;

// What is multiplied by a point for its column, row and key.
struct Map {
    columns: vec3<i32>,
    // Pixels a row.
    width: u32,
    rows: vec3<i32>,
    height: u32,
    depths: vec3<i32>,
    // Its first pixel among those of all maps.
    first: u32,
    // Unit vectors along columns, rows and to the viewer, at length 2^14, and the origin of
    // each in sub-pixels and keys.
    across: vec3<i32>,
    left: i32,
    down: vec3<i32>,
    top: i32,
    towards: vec3<i32>,
    nearest: i32,
    // The first two rows in sub-pixels, in f32, and where the lowest corner of what is drawn is.
    about_columns: vec3<f32>,
    about_left: f32,
    about_rows: vec3<f32>,
    about_top: f32,
}

@group(0) @binding(1) var<storage, read> maps: array<Map>;

// Set by what needs another pass, to how large that is.
@group(0) @binding(3) var<storage, read_write> unfinished: atomic<u32>;

const DEPTH_SHIFT: u32 = 27u;

// A dot product, below 2^54, shifted down; halves are rounded up.
fn shifted(row: vec3<i32>, point: vec3<i32>, shift: u32) -> i32 {
    let dot = wide_add(wide_mul(row.x, point.x), wide_add(wide_mul(row.y, point.y), wide_mul(row.z, point.z)));
    return (wide_floor(dot, shift - 1u) + 1) >> 1u;
}

fn column_and_row(map: Map, point: vec3<i32>) -> vec2<i32> {
    return vec2(
        shifted(map.columns, point, told.shift) - map.left,
        shifted(map.rows, point, told.shift) - map.top,
    );
}

fn key_of(map: Map, point: vec3<i32>) -> i32 {
    return shifted(map.depths, point, DEPTH_SHIFT) - map.nearest;
}
