// A side of a slice: horizons, and what is between them. Angles count from the direction to the
// viewer, 0 to pi.
//#import screen

// What is looked from.
struct Spot {
    pixel: vec2<u32>,
    point: vec3<f32>,
    // Units: to the viewer, and the normal.
    viewer: vec3<f32>,
    normal: vec3<f32>,
}

// A side of a slice.
struct Side {
    // Unit, at a right angle to the direction to the viewer.
    out: vec3<f32>,
    // Unit, in pixels: what lies in the slice lies along it.
    way: vec2<f32>,
    // The normal's parts along `viewer` and `out`, and their length.
    normal: vec2<f32>,
    length: f32,
}

fn side_of(spot: Spot, out: vec3<f32>) -> Side {
    var way = told.scale * out.xy;
    if told.near == 1u {
        way -= told.scale * (spot.point.xy / spot.point.z) * out.z;
    }
    // Seen edge-on, or from behind by what rounding does.
    let normal = vec2(max(dot(spot.normal, spot.viewer), 0.0), dot(spot.normal, out));
    return Side(out, normalize(way), normal, length(normal));
}

// Pixels to the border of the picture.
fn border(pixel: vec2<u32>, way: vec2<f32>) -> f32 {
    let room = select(vec2<f32>(pixel), vec2<f32>(size() - 1u - pixel), way > vec2(0.0));
    let pixels = room / max(abs(way), vec2(1e-9));
    return min(pixels.x, pixels.y);
}

// Pixels to the farthest that may show what is near enough to block: where the slice's
// tangent to the sphere of that radius goes.
fn reach(spot: Spot, side: Side) -> f32 {
    let whole = border(spot.pixel, side.way);
    if told.most == 0.0 {
        return whole;
    }
    if told.near == 0u {
        return min(whole, told.most * length(told.scale * side.out.xy));
    }
    let sine = told.most / length(spot.point);
    if sine >= 1.0 {
        return whole;
    }
    let ray = sine * side.out - sqrt(1.0 - sine * sine) * spot.viewer;
    if ray.z <= 0.0 {
        return whole;
    }
    let off = told.scale * (ray.xy / ray.z - spot.point.xy / spot.point.z);
    return min(whole, length(off));
}

// How much of what it meets a ray keeps from arriving (spec/src/ldm/occlusion.rs).
fn kept(distance: f32) -> f32 {
    if told.most == 0.0 {
        return 1.0;
    }
    let part = distance / told.most;
    if part >= 1.0 {
        return 0.0;
    }
    var passed = select(0.0, part, told.power > 0u);
    for (var i = 1u; i < told.power; i += 1u) {
        passed *= part;
    }
    return 1.0 - passed;
}

// The angle of a unit vector with y >= 0. An odd polynomial of degree 13 through the Chebyshev
// nodes of atan on 0 to 1, within 2^-20: WGSL promises less of its own.
fn angle(c: f32, s: f32) -> f32 {
    let x = min(s, abs(c)) / max(s, abs(c));
    let y = x * x;
    var a = 0.00764835393;
    a = a * y - 0.0363604315;
    a = a * y + 0.0831264555;
    a = a * y - 0.134478644;
    a = a * y + 0.198720396;
    a = a * y - 0.333256781;
    a = x * (a * y + 0.999999225);
    a = select(a, 1.57079633 - a, s > abs(c));
    return select(a, 3.14159265 - a, c < 0.0);
}

// What a slice's side has between the viewer and an angle t: the integral of
// (normal . direction) sin t, which is (sin t (normal x direction) + t normal.y) / 2.
fn arc(normal: vec2<f32>, c: f32, s: f32) -> f32 {
    return 0.5 * (s * (s * normal.x - c * normal.y) + angle(c, s) * normal.y);
}

// Cosine and sine of where a sample stands; cosine -1 if it is below the tangent plane. Pixels
// are beside the slice a little, so their height over that plane is kept, which is what makes
// planes open; it stands for two angles, and beyond the normal the plain one is taken.
fn standing(spot: Spot, side: Side, off: vec3<f32>, distance: f32) -> vec2<f32> {
    let height = dot(spot.normal, off);
    if height <= 0.0 {
        return vec2(-1.0, 0.0);
    }
    let unit = side.normal / side.length;
    let plain = min(dot(spot.viewer, off) / distance, 1.0);
    if unit.y > 0.0 && plain > unit.x {
        return vec2(plain, sqrt(1.0 - plain * plain));
    }
    let c = min(height / (distance * side.length), 1.0);
    let s = sqrt(1.0 - c * c);
    let turned = vec2(unit.x * c - unit.y * s, unit.y * c + unit.x * s);
    return select(turned, vec2(1.0, 0.0), turned.y < 0.0);
}

// What a side blocks. Each sample that raises the horizon blocks what it
// raises it by, as far as its own distance lets it: that is where rays between the old
// horizon and the new one end, as nothing nearer stopped them. Some may end nearer, at what is
// hidden behind the sample, or go on behind it: of that a height field knows nothing.
fn walk(spot: Spot, side: Side, jitter: f32) -> f32 {
    var horizon = -side.normal.y / side.length;
    var above = arc(side.normal, horizon, side.normal.x / side.length);
    var blocked = 0.0;
    let far = reach(spot, side);
    if far < 1.0 {
        return blocked;
    }
    for (var i = 0u; i < told.steps; i += 1u) {
        // Denser where things are near; never the pixel itself.
        let part = (f32(i) + jitter) / f32(told.steps);
        let pixels = 1.0 + (far - 1.0) * part * part;
        let there = floor(vec2<f32>(spot.pixel) + 0.5 + pixels * side.way);
        let pixel = vec2<u32>(clamp(there, vec2(0.0), vec2<f32>(size() - 1u)));
        let level = min(max(firstLeadingBit(u32(pixels)), told.detail) - told.detail, LEVELS - 1u);
        let texel = pixel >> vec2(level);
        let depth = depths[first(level) + texel.y * levelled(told.width, level) + texel.x];
        if depth >= NOWHERE {
            continue;
        }
        let off = point(chosen(texel, level), depth) - spot.point;
        let distance = length(off);
        let keeps = kept(distance);
        let at = standing(spot, side, off, distance);
        if keeps > 0.0 && at.x > horizon {
            let below = arc(side.normal, at.x, at.y);
            blocked += keeps * (above - below);
            above = below;
            horizon = at.x;
        }
    }
    return blocked;
}
