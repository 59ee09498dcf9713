// What the stages of the ray tracer are told, and the queues between them (spec/src/dispatch.rs).
// Points and directions are integers of at most 24 bits, as f32, which holds them exactly.
//#import ray
//#import counter

// corner + x right + y down, in units of 2^-7.
struct Plane {
    corner: vec3<i32>,
    right: vec3<i32>,
    down: vec3<i32>,
}

struct Task {
    // Rays of this dispatch.
    items: u32,
    // The first pixel, where rays begin.
    first: u32,
    // Rays that the next queue has room for.
    capacity: u32,
    // How many there are.
    lamps: u32,
    // Most mirrors on the way of a ray.
    depth: u32,
    // Pixels a row of the picture.
    width: u32,
    unused: vec2<u32>,
    // Linear light along rays that meet nothing; the fourth number is not used.
    background: vec4<f32>,
    origin: Plane,
    direction: Plane,
}

@group(0) @binding(0) var<uniform> task: Task;

// A triangle, its plane and its material.
struct Facet {
    a: vec3<f32>,
    // The axis along which the normal is longest, from 1, with the sign of its component; 0
    // without a normal.
    axis: i32,
    b: vec3<f32>,
    c: vec3<f32>,
    // The normal at length 1, or 0.
    unit: vec3<f32>,
    // The normal at length 2^14, in integers.
    coarse: vec3<i32>,
    // Linear.
    colour: vec3<f32>,
    // What it mirrors, in units of 2^-15.
    mirror: vec3<u32>,
}

@group(0) @binding(2) var<storage, read> triangles: array<Facet>;

// What a ray carries: its queue's rays have the rest.
struct Carried {
    // A weight in units of 2^-15, or the bits of light if the ray ends at a lamp.
    parts: vec3<u32>,
    // Its pixel, from bit DEPTH_AT on its depth, and LIGHT if it carries that.
    whose: u32,
}

const DEPTH_AT: u32 = 24u;
const LIGHT: u32 = 0x80000000u;
const WEIGHT_ONE: u32 = 32768u;

// The queue that is worked through.
@group(0) @binding(3) var<storage, read> rays: array<Ray>;
@group(0) @binding(5) var<storage, read> carried: array<Carried>;
@group(0) @binding(6) var<storage, read> hits: array<Hit>;

// The one that is filled.
@group(0) @binding(8) var<storage, read_write> next_rays: array<Ray>;
@group(0) @binding(9) var<storage, read_write> next_carried: array<Carried>;
@group(0) @binding(10) var<storage, read_write> next_hits: array<Hit>;

// A point of a triangle, and from which side it is seen.
struct Surface {
    point: vec3<f32>,
    // Twice the triangle, and 1 if its normal points away from where the ray came from; or NOTHING.
    face: u32,
}

@group(0) @binding(7) var<storage, read_write> surfaces: array<Surface>;

fn pixel_of(carried: Carried) -> u32 {
    return carried.whose & ((1u << DEPTH_AT) - 1u);
}

fn mirrors_of(carried: Carried) -> u32 {
    return (carried.whose & ~LIGHT) >> DEPTH_AT;
}

fn carries_light(carried: Carried) -> bool {
    return (carried.whose & LIGHT) != 0u;
}

// Puts a ray at a place of the next queue, of which a search has seen nothing yet.
fn put(address: u32, ray: Ray, carried: Carried) {
    next_rays[address] = ray;
    next_carried[address] = carried;
    next_hits[address] = Hit(NOTHING, 0.0, FRESH, 0u);
}

// Adds a ray to the next queue, in whatever order invocations come.
fn append(ray: Ray, carried: Carried) {
    let address = claim();
    if address < task.capacity {
        put(address, ray, carried);
    }
}

// 1 or -1: the side from which a face is seen.
fn side_of(face: u32) -> i32 {
    return select(1, -1, (face & 1u) == 1u);
}
