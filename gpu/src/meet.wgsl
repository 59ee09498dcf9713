// Where a ray meets a triangle: the same answer as the spec's integers.
//#import volume

const MISSED: i32 = -1;
const OPEN: i32 = 0;
const MET: i32 = 1;

struct Meeting {
    // MISSED, OPEN or MET.
    verdict: i32,
    // When, if it is met and the nearest is asked for.
    time: f32,
}

// How good a volume must be for a time: its error is then 2^-10 of it at most.
const FOR_TIME: f32 = 1024.0;

// What f32 can tell for certain (volume.wgsl): OPEN where an error could decide, which `meets`
// then settles.
//
// The ray passes all three edges on one side, and is within its own ends. The sides have one
// bound for their errors, of the largest of all factors.
fn glance(ray: Ray, triangle: u32) -> Meeting {
    let a = corner(triangle, 0u) - ray.origin;
    let b = corner(triangle, 1u) - ray.origin;
    let c = corner(triangle, 2u) - ray.origin;
    let e = b - a;
    let f = c - b;
    let g = c - a;
    let of_c = dot(e, cross(ray.direction, a));
    let of_a = dot(f, cross(ray.direction, b));
    let of_b = -dot(g, cross(ray.direction, c));
    let edge = max(sum_norm(e), max(sum_norm(f), sum_norm(g)));
    let reach = largest(max(abs(a), max(abs(b), abs(c))));
    let side_error = VOLUME_ERROR * edge * largest(ray.direction) * reach;
    let least = min(of_c, min(of_a, of_b));
    let most = max(of_c, max(of_a, of_b));
    if least < -side_error && most > side_error {
        return Meeting(MISSED, 0.0);
    }
    if least <= side_error && most >= -side_error {
        return Meeting(OPEN, 0.0);
    }
    let facing = sign(most);
    let normal = cross(e, g);
    let error = VOLUME_ERROR * largest(e) * largest(g);
    let height = dot(a, normal);
    let height_error = error * sum_norm(a);
    if height * facing < -height_error {
        return Meeting(MISSED, 0.0);
    }
    var is_open = abs(height) <= height_error;
    if ray.segment == 1u {
        let rest = a - ray.direction;
        let beyond = dot(rest, normal) * facing;
        let beyond_error = error * sum_norm(rest);
        if beyond > beyond_error {
            return Meeting(MISSED, 0.0);
        }
        is_open = is_open || beyond >= -beyond_error;
    }
    if cells.any == 1u {
        return Meeting(select(MET, OPEN, is_open), 0.0);
    }
    let slope = dot(ray.direction, normal);
    is_open = is_open || abs(height) <= FOR_TIME * height_error
        || abs(slope) <= FOR_TIME * error * sum_norm(ray.direction);
    return Meeting(select(MET, OPEN, is_open), height / slope);
}

// The same in exact signs: a ray meets what it passes on an edge, so neighbours leave no gap, and
// no order of corners matters. Volumes come one after another, for their integers are long.
fn meets(ray: Ray, triangle: u32) -> Meeting {
    let a = corner(triangle, 0u) - ray.origin;
    let b = corner(triangle, 1u) - ray.origin;
    let c = corner(triangle, 2u) - ray.origin;
    var least = 1;
    var most = -1;
    var height = 0.0;
    for (var i = 0; i < 6; i += 1) {
        let next = volume(nth(i, ray, a, b, c));
        // The sides sum up to direction . normal.
        let facing = sign(least + most);
        if i < 3 {
            least = min(least, next.sign);
            most = max(most, next.sign);
            if least < 0 && most > 0 {
                return Meeting(MISSED, 0.0);
            }
        } else if i == 3 {
            height = next.value;
            if facing == 0 || next.sign * facing < 0 {
                return Meeting(MISSED, 0.0);
            }
        } else if i == 4 {
            if ray.segment == 1u && next.sign * facing > 0 {
                return Meeting(MISSED, 0.0);
            }
        } else {
            return Meeting(MET, height / next.value);
        }
    }
    return Meeting(MISSED, 0.0);
}

// The sides of the three edges, the start, the end, and direction . normal.
fn nth(i: i32, ray: Ray, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> Factors {
    switch i {
        case 0: {
            return Factors(b - a, ray.direction, a, 1.0);
        }
        case 1: {
            return Factors(c - b, ray.direction, b, 1.0);
        }
        case 2: {
            return Factors(a - c, ray.direction, c, 1.0);
        }
        case 3: {
            return Factors(a, b - a, c - a, FOR_TIME);
        }
        case 4: {
            let rest = select(vec3(0.0), a - ray.direction, ray.segment == 1u);
            return Factors(rest, b - a, c - a, 1.0);
        }
        default: {
            return Factors(ray.direction, b - a, c - a, FOR_TIME);
        }
    }
}
