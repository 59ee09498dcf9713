// Ambient occlusion from what one eye sees: horizons of slices through each pixel's view ray
// (Bavoil, Sainz and Dimitrov 2008), weighted by the cosine and integrated in closed form
// (Jimenez, Wu, Pesce and Jarabo 2016). What is behind a pixel counts as solid.
//#import item
//#import slice

// Pixels of a tile along x and y, no two of which have the same slices.
const TURNED: u32 = 4u;

// One texel of any level.
@compute @workgroup_size(64)
fn prepare(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let at = item(id, groups);
    if at >= told.items {
        return;
    }
    var level = 0u;
    while level + 1u < LEVELS && at >= first(level + 1u) {
        level += 1u;
    }
    let row = levelled(told.width, level);
    let own = at - first(level);
    let pixel = chosen(vec2(own % row, own / row), level);
    let surface = seen[pixel.y * told.width + pixel.x];
    pyramid[at] = select(surface.w, NOWHERE, is_nothing(surface));
}

// One pixel.
@compute @workgroup_size(64)
fn horizons(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let at = item(id, groups);
    if at >= told.items {
        return;
    }
    let surface = seen[at];
    if is_nothing(surface) {
        opened[at] = 1.0;
        return;
    }
    let pixel = vec2(at % told.width, at / told.width);
    let here = point(pixel, surface.w);
    var ahead = vec3(0.0, 0.0, 1.0);
    if told.near == 1u {
        ahead = normalize(here);
    }
    let spot = Spot(pixel, here, -ahead, surface.xyz);
    // At right angles to `ahead`, whose z is positive (Duff et al. 2017).
    let a = 1.0 / (1.0 + ahead.z);
    let right = vec3(1.0 - ahead.x * ahead.x * a, -ahead.x * ahead.y * a, -ahead.x);
    let down = vec3(-ahead.x * ahead.y * a, 1.0 - ahead.y * ahead.y * a, -ahead.y);
    let own = (pixel.y % TURNED * TURNED + pixel.x % TURNED) * told.slices;
    var blocked = 0.0;
    for (var slice = 0u; slice < told.slices; slice += 1u) {
        let turn = turns[own + slice];
        let out = turn.x * right + turn.y * down;
        let side = side_of(spot, out);
        // One that the normal stands on has nothing.
        if side.length > 1e-6 {
            blocked += walk(spot, side, turn.z);
            blocked += walk(spot, side_of(spot, -out), turn.z);
        }
    }
    // Off all that is open, not a sum of what is: a few slices of an open hemisphere have not
    // exactly all of it. So a mean over slices is what more of them find, and planes are open.
    opened[at] = 1.0 - blocked / f32(told.slices);
}

// How far two points of a surface may be off each other's planes, over their distance. Of planes
// at an angle t one point is off by sin(t / 2) at least, so those beyond 29 degrees never mix.
const CREASE: f32 = 0.25;

// One pixel: the mean of those around it on the same surface. Over five pixels with half weights
// at the ends, each of a tile's pixels counts alike.
@compute @workgroup_size(64)
fn denoise(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let at = item(id, groups);
    if at >= told.items {
        return;
    }
    let surface = seen[at];
    if is_nothing(surface) {
        opened[at] = 1.0;
        return;
    }
    let pixel = vec2<i32>(vec2(at % told.width, at / told.width));
    let here = point(vec2<u32>(pixel), surface.w);
    // Of differences, so that a constant stays what it is.
    let own = rough[at];
    var sum = 0.0;
    var total = 0.0;
    for (var y = -2; y <= 2; y += 1) {
        for (var x = -2; x <= 2; x += 1) {
            let there = pixel + vec2(x, y);
            if any(there < vec2(0)) || any(there >= vec2<i32>(size())) {
                continue;
            }
            let number = u32(there.y) * told.width + u32(there.x);
            let other = seen[number];
            if is_nothing(other) {
                continue;
            }
            let ends = select(1.0, 0.5, abs(x) == 2) * select(1.0, 0.5, abs(y) == 2);
            let weight = ends * alike(surface, other, point(vec2<u32>(there), other.w) - here);
            sum += weight * (rough[number] - own);
            total += weight;
        }
    }
    opened[at] = own + sum / total;
}

// 1 in each other's planes, 0 across an edge.
fn alike(a: vec4<f32>, b: vec4<f32>, off: vec3<f32>) -> f32 {
    let far = length(off);
    if far == 0.0 {
        return 1.0;
    }
    let apart = max(abs(dot(a.xyz, off)), abs(dot(b.xyz, off))) / far;
    let facing = dot(a.xyz, b.xyz) > 0.0;
    return select(0.0, max(1.0 - apart / CREASE, 0.0), facing);
}
