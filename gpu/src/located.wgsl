// The point of a triangle that a ray meets (spec/src/dispatch/locate.rs).
//#import task
//#import long

// By how many steps a point is moved off its face.
const OFFSET: f32 = 2.0;

// A coordinate is the origin's and floor((2 d num + den) / (2 den)) more, for a direction d of at
// most 2^24 and num / den the time of the meeting. It leads from one point of the lattice to another,
// so it is at most 2^24, too.
//
// With U = 2^-23: num and den in f32 are off by 3 U each, their quotient by 2.5 U more, the product
// by 1: d num / den is estimated within 9.6 U of at most 2^24, 20 steps. What remains is then below
// 22 times 2 den, 2^82, and 96 bits hold it whatever was lost above them. Its own quotient is off by
// 8.6 U of 22 before it is rounded down, so by 1 step at most afterwards.
fn stepped_by(direction: i32, num: Long, den: Long, time: f32) -> i32 {
    let twice = long_add(den, den);
    let first = i32(f32(direction) * time);
    var rest = long_add(long_times(long_add(num, num), direction), den);
    rest = long_sub(rest, long_times(twice, first));
    var size = long_to_f32(long_size(rest)) / long_to_f32(twice);
    size = select(size, -size, long_negative(rest));
    // Kept where it belongs, so that what is damaged leads to a point, too.
    let second = i32(floor(clamp(size, -64.0, 64.0)));
    rest = long_sub(rest, long_times(twice, second));
    var steps = first + second;
    if long_negative(rest) {
        steps -= 1;
    } else if !long_less(rest, twice) {
        steps += 1;
    }
    return steps;
}

// Along the longest component of the normal, to the side that is seen.
fn moved_off(triangle: Facet, side: i32, point: vec3<f32>) -> vec3<f32> {
    let way = f32(sign(triangle.axis) * side) * OFFSET;
    let axis = abs(triangle.axis);
    return point + select(vec3(0.0), vec3(way), vec3(axis == 1, axis == 2, axis == 3));
}

fn located(ray: Ray, prim: u32) -> Surface {
    let triangle = triangles[prim];
    let e = vec3<i32>(triangle.b - triangle.a);
    let f = vec3<i32>(triangle.c - triangle.a);
    let direction = vec3<i32>(ray.direction);
    let facing = long_volume(direction, e, f);
    let height = long_volume(vec3<i32>(triangle.a - ray.origin), e, f);
    // Where it is met, both have one sign.
    let num = long_size(height);
    let den = long_size(facing);
    let time = long_to_f32(num) / long_to_f32(den);
    let steps = vec3(
        stepped_by(direction.x, num, den, time),
        stepped_by(direction.y, num, den, time),
        stepped_by(direction.z, num, den, time),
    );
    let is_behind = !long_negative(facing);
    let side = select(1, -1, is_behind);
    let point = ray.origin + vec3<f32>(steps);
    return Surface(moved_off(triangle, side, point), 2u * prim + u32(is_behind));
}
