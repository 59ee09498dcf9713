// A ray's way through the cells (Amanatides and Woo 1987): integer cells, and the time of each
// boundary worked out anew. Up to 2^23 in size, boundaries and origins have exact differences;
// their times are off by a division and a product, for which cells are widened.
//#import ray

// Later than anything that a ray meets within the lattice.
const NEVER: f32 = 3.0e38;

struct March {
    cell: vec3<i32>,
    // When the cell is left, on each axis.
    exit: vec3<f32>,
}

// What does not change along a way.
struct Way {
    origin: vec3<f32>,
    inverse: vec3<f32>,
    // -1, 0 or 1.
    step: vec3<i32>,
    // 1 where the far boundary of a cell has the higher number.
    up: vec3<i32>,
}

fn way(ray: Ray) -> Way {
    let moves = ray.direction != vec3(0.0);
    let divisor = select(vec3(1.0), ray.direction, moves);
    let step = vec3<i32>(sign(ray.direction));
    return Way(ray.origin, 1.0 / divisor, step, vec3<i32>(step > vec3(0)));
}

fn crossing(boundary: i32, start: u32, origin: f32, inverse: f32) -> f32 {
    return (boundaries[start + u32(boundary)] - origin) * inverse;
}

// When a cell is left, on each axis.
fn exits(way: Way, cell: vec3<i32>) -> vec3<f32> {
    let at = vec3<u32>(vec3<i32>(starts()) + cell + way.up);
    let far = vec3(boundaries[at.x], boundaries[at.y], boundaries[at.z]);
    return select((far - way.origin) * way.inverse, vec3(NEVER), way.step == vec3(0));
}

// When the first boundary of an axis is crossed; 0 if the ray starts behind it.
fn entry_on(start: u32, count: u32, step: i32, origin: f32, inverse: f32) -> f32 {
    if step == 0 {
        return 0.0;
    }
    return crossing(select(i32(count), 0, step > 0), start, origin, inverse);
}

// The cell of an axis at a time; -1 beside the grid.
fn cell_on(start: u32, count: u32, step: i32, origin: f32, inverse: f32, time: f32) -> i32 {
    if step == 0 {
        let passed = boundaries_up_to(start, count + 1u, origin);
        return select(-1, i32(passed) - 1, passed <= count);
    }
    // The first is passed by the choice of `time`; evaluated again it may come out later.
    var low = 1;
    var high = i32(count) + 1;
    while low < high {
        let middle = (low + high) / 2;
        let boundary = select(i32(count) - middle, middle, step > 0);
        if crossing(boundary, start, origin, inverse) <= time {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    let nth = min(low, i32(count)) - 1;
    return select(i32(count) - 1 - nth, nth, step > 0);
}

// Where the ray enters the grid; a negative component if it does not.
fn entrance(ray: Ray, way: Way) -> vec3<i32> {
    let start = starts();
    var time = entry_on(start.x, cells.x, way.step.x, way.origin.x, way.inverse.x);
    time = max(time, entry_on(start.y, cells.y, way.step.y, way.origin.y, way.inverse.y));
    time = max(time, entry_on(start.z, cells.z, way.step.z, way.origin.z, way.inverse.z));
    time = max(time, 0.0);
    if all(way.step == vec3(0)) || (ray.segment == 1u && time > 1.0) {
        return vec3(-1);
    }
    return vec3(
        cell_on(start.x, cells.x, way.step.x, way.origin.x, way.inverse.x, time),
        cell_on(start.y, cells.y, way.step.y, way.origin.y, way.inverse.y, time),
        cell_on(start.z, cells.z, way.step.z, way.origin.z, way.inverse.z, time),
    );
}

fn inside(cell: vec3<i32>) -> bool {
    return all(cell >= vec3(0)) && all(cell < vec3<i32>(vec3(cells.x, cells.y, cells.z)));
}

// Across the boundary that comes first. Rays of a subgroup that step on different axes would take
// branches one after another, so there are none; a ray that leaves the grid reads any boundary.
fn stepped(way: Way, march: March) -> March {
    let exit = march.exit;
    let on_x = exit.x <= min(exit.y, exit.z);
    let on_y = !on_x && exit.y <= exit.z;
    let axis = vec3(on_x, on_y, !on_x && !on_y);
    let cell = march.cell + select(vec3(0), way.step, axis);
    let far = vec3<i32>(starts()) + cell + way.up;
    let last = i32(cells.x + cells.y + cells.z) + 2;
    let boundary = boundaries[clamp(select(select(far.z, far.y, on_y), far.x, on_x), 0, last)];
    let origin = select(select(way.origin.z, way.origin.y, on_y), way.origin.x, on_x);
    let inverse = select(select(way.inverse.z, way.inverse.y, on_y), way.inverse.x, on_x);
    return March(cell, select(exit, vec3((boundary - origin) * inverse), axis));
}

fn soonest(exit: vec3<f32>) -> f32 {
    return min(exit.x, min(exit.y, exit.z));
}
