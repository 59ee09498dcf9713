// What is before and behind a point in a map. Twins: spec/src/ldm/neighbours.rs, and
// `weight` in spec/src/ldm/occlusion.rs.
//#import maps
//#import word
//#import runs

struct Receiver {
    // On the lattice, and how far it may be from its surface.
    point: vec3<i32>,
    off: u32,
    // At length 2^14, to the side that is seen; 0 of a point on no surface.
    normal: vec3<i32>,
    unused: u32,
}

@group(0) @binding(9) var<storage, read> receivers: array<Receiver>;

const NOTHING: u32 = 0xffffffffu;

// How far dot products of two vectors of 2^14 are off, see the twin.
const OFF: u32 = 28380u;

// 256 times the largest slope that is told apart.
const STEEPEST: u32 = 256u * 127u;

// Bits of the weight of a direction straight ahead.
const WEIGHT_BITS: u32 = 19u;
const PLANE_BITS: u32 = 14u;

// At most 2^28 and a little.
fn along(a: vec3<i32>, b: vec3<i32>) -> i32 {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// The cosine between a map's direction and a normal; negative if the surface faces away.
fn weight_of(map: Map, normal: vec3<i32>) -> i32 {
    let cosine = along(map.towards, normal);
    let size = abs(cosine) >> (2u * PLANE_BITS - WEIGHT_BITS);
    return select(size, -size, cosine < 0);
}

// How far the keys of a point's own surface may be from its own.
fn own_band(map: Map, receiver: Receiver) -> i32 {
    let moved = receiver.off * 14u;
    if all(receiver.normal == vec3(0)) {
        return i32(moved) + 3;
    }
    let rise = u32(abs(along(map.across, receiver.normal)) + abs(along(map.down, receiver.normal)));
    let numerator = (rise + 2u * OFF + 255u) / 256u;
    let facing = u32(abs(along(map.towards, receiver.normal)));
    let denominator = (max(facing, OFF) - OFF) / 256u;
    var slope = STEEPEST;
    if denominator > 0u {
        slope = min((256u * numerator + denominator - 1u) / denominator, STEEPEST);
    }
    let within_pixel = min((slope * told.half) >> (8u - told.half_shift), 1u << 30u);
    let aside = moved * (slope >> 8u) + ((moved * (slope & 255u)) >> 8u);
    return i32(moved + within_pixel + aside) + 5;
}

// The keys of a point's pixel that are not its own: `start` to `before` are before it, `behind`
// to `end` behind it.
struct Neighbours {
    key: i32,
    start: u32,
    before: u32,
    behind: u32,
    end: u32,
}

// The run of the pixel where a point is; empty beside the map.
fn run_at(map: Map, point: vec3<i32>) -> vec2<u32> {
    let pixel = column_and_row(map, point) >> vec2(told.bits);
    let is_in = all(pixel >= vec2(0)) && all(pixel < vec2<i32>(vec2(map.width, map.height)));
    if !is_in {
        return vec2(0u);
    }
    let number = map.first - told.first_pixel + u32(pixel.y) * map.width + u32(pixel.x);
    return vec2(offsets[number], offsets[number + 1u]);
}

// The first place of a run from which on keys are above a limit.
fn first_above(run: vec2<u32>, limit: i32) -> u32 {
    var low = run.x;
    var high = run.y;
    while low < high {
        let middle = (low + high) / 2u;
        if i32(listed[middle]) <= limit {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

fn neighbours_of(map: Map, receiver: Receiver) -> Neighbours {
    let run = run_at(map, receiver.point);
    let key = key_of(map, receiver.point);
    if run.x == run.y {
        return Neighbours(key, run.x, run.x, run.y, run.y);
    }
    let band = own_band(map, receiver);
    return Neighbours(key, run.x, first_above(run, key - band - 1), first_above(run, key + band), run.y);
}

// What blocks a direction: the nearest key on the side that the weight says, or NOTHING, and the
// point's own key.
struct Seen {
    key: i32,
    hit: u32,
}

fn seen_by(map: Map, receiver: Receiver, weight: i32) -> Seen {
    let found = neighbours_of(map, receiver);
    if weight >= 0 && found.before > found.start {
        return Seen(found.key, listed[found.before - 1u]);
    }
    if weight < 0 && found.behind < found.end {
        return Seen(found.key, listed[found.behind]);
    }
    return Seen(found.key, NOTHING);
}

// Whether anything does: the ends of a run say so.
fn is_blocked(map: Map, receiver: Receiver, weight: i32) -> bool {
    let run = run_at(map, receiver.point);
    if run.x == run.y {
        return false;
    }
    let key = key_of(map, receiver.point);
    let band = own_band(map, receiver);
    if weight >= 0 {
        return i32(listed[run.x]) < key - band;
    }
    return i32(listed[run.y - 1u]) > key + band;
}
