// Stages that ask the lists: what receivers find before and behind them, what of their directions
// is open, and the light that comes from there.
//#import receiver

struct Hits {
    // The receiver's own key.
    key: i32,
    // The nearest ones before and behind it, or NOTHING.
    before: u32,
    behind: u32,
}

// For each map of the dispatch, of every receiver.
@group(0) @binding(14) var<storage, read_write> hits: array<Hits>;

struct Open {
    whole: u32,
    part: f32,
}

@group(0) @binding(15) var<storage, read_write> opened: array<Open>;

// Radiance from each map's direction, and from the opposite one; the fourth numbers of these and
// of light are not used.
@group(0) @binding(16) var<storage, read> skies: array<array<vec4<f32>, 2>>;

@group(0) @binding(17) var<storage, read_write> light: array<vec4<f32>>;

// A receiver in a map.
fn find_neighbours(i: u32) {
    let found = neighbours_of(maps[told.first_map + i / told.items], receivers[i % told.items]);
    var own = Hits(found.key, NOTHING, NOTHING);
    if found.before > found.start {
        own.before = listed[found.before - 1u];
    }
    if found.behind < found.end {
        own.behind = listed[found.behind];
    }
    hits[i] = own;
}

// What a hit so many keys away lets pass.
fn passed(keys: u32) -> f32 {
    let part = f32(keys) / f32(told.most);
    var all = part;
    for (var i = 1u; i < told.power; i += 1u) {
        all *= part;
    }
    return all;
}

// A receiver, and all maps of the dispatch.
fn add_open(i: u32) {
    let receiver = receivers[i];
    var sum = opened[i];
    for (var at = told.first_map; at < told.first_map + told.maps; at += 1u) {
        let map = maps[at];
        let weight = weight_of(map, receiver.normal);
        if weight == 0 {
            continue;
        }
        let size = u32(abs(weight));
        if told.most == 0u {
            sum.whole += select(size, 0u, is_blocked(map, receiver, weight));
            continue;
        }
        let seen = seen_by(map, receiver, weight);
        let keys = u32(abs(i32(seen.hit) - seen.key));
        if seen.hit == NOTHING || keys >= told.most {
            sum.whole += size;
        } else if told.power > 0u {
            sum.part += f32(size) * passed(keys);
        }
    }
    opened[i] = sum;
}

// The same.
fn add_light(i: u32) {
    let receiver = receivers[i];
    var sum = light[i];
    for (var at = told.first_map; at < told.first_map + told.maps; at += 1u) {
        let map = maps[at];
        let weight = weight_of(map, receiver.normal);
        if weight != 0 && !is_blocked(map, receiver, weight) {
            sum += f32(abs(weight)) * skies[at][u32(weight < 0)];
        }
    }
    light[i] = sum;
}
