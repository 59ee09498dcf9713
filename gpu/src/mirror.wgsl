// What glossy surfaces mirror, in the nearest direction that there is. Twin: spec/src/ldm/mirror.rs.
//#import opened

struct Mirrored {
    // Radiance of the sky; 0 if anything is hit.
    light: vec3<f32>,
    // The number of the map, or NOTHING.
    map: u32,
    // 1 for the opposite of the map's direction.
    side: u32,
    // The receiver's own key there, and the nearest one in that direction, or NOTHING.
    key: i32,
    hit: u32,
    unused: u32,
}

// What has been found so far; map is NOTHING at first.
@group(0) @binding(19) var<storage, read_write> mirrored: array<Mirrored>;

// Of each receiver the unit vector to the eye, at length 2^14; the fourth number is not used.
@group(0) @binding(20) var<storage, read> views: array<vec4<i32>>;

// How near a direction is to the mirror direction, on the side that the weight says: below 2^58 in
// size. `facing` is normal . view, `square` normal . normal.
fn nearness(map: Map, normal: vec3<i32>, view: vec3<i32>, weight: i32, facing: i32, square: i32) -> Wide {
    let along_normal = wide_mul(2 * facing, along(normal, map.towards));
    let along_view = wide_mul(square, along(view, map.towards));
    if weight < 0 {
        return wide_sub(along_view, along_normal);
    }
    return wide_sub(along_normal, along_view);
}

// A receiver, and all maps of the dispatch.
fn add_mirror(i: u32) {
    let receiver = receivers[i];
    let normal = receiver.normal;
    let view = views[i].xyz;
    if all(view == vec3(0)) {
        return;
    }
    let facing = along(normal, view);
    let square = along(normal, normal);
    let before = mirrored[i].map;
    var best = before;
    var most = wide(0);
    if before != NOTHING {
        let map = maps[before];
        most = nearness(map, normal, view, weight_of(map, normal), facing, square);
    }
    for (var at = told.first_map; at < told.first_map + told.maps; at += 1u) {
        let map = maps[at];
        let weight = weight_of(map, normal);
        if weight == 0 {
            continue;
        }
        let near = nearness(map, normal, view, weight, facing, square);
        // Of equals the first stays.
        if best == NOTHING || wide_negative(wide_sub(most, near)) {
            best = at;
            most = near;
        }
    }
    if best == before {
        return;
    }
    // Its lists are those of the dispatch.
    let map = maps[best];
    let weight = weight_of(map, normal);
    let seen = seen_by(map, receiver, weight);
    let side = u32(weight < 0);
    var light = vec3(0.0);
    if seen.hit == NOTHING {
        light = skies[best][side].xyz;
    }
    mirrored[i] = Mirrored(light, best, side, seen.key, seen.hit, 0u);
}
