// Dispatch: rays as tasks in a queue, and the ray tracer that they feed (Nunes and Santos,
// "Workload Distribution for Ray Tracing in Multi-Core Systems"). Twin: spec/src/dispatch.rs.
//
// A queue holds the rays of a bounce, in whatever order they came. What they meet is found by
// `trace` (grid_exact.wgsl); then they are located, ask for shadow rays, and are reflected into
// the next queue. What is written is read in later passes; within one, invocations meet in atomics only.
//#import item
//#import task
//#import located
//#import lit
//#import mirrored
//#import units

// Workgroups of a dispatch of a queue's rays, in x, y and z, and how many rays those are.
@group(0) @binding(12) var<storage, read_write> arguments: array<u32>;

// Most workgroups of a row.
const ROW: u32 = 65535u;

// Rounded to the nearest integer, halves up; sums may wrap around on the way.
fn at(plane: Plane, x: u32, y: u32) -> vec3<f32> {
    let sum = plane.corner + plane.right * i32(x) + plane.down * i32(y);
    return vec3<f32>((sum + 64) >> vec3(7u));
}

// One pixel.
@compute @workgroup_size(64)
fn primary(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = item(id, groups);
    if i >= task.items || i >= task.capacity {
        return;
    }
    let pixel = task.first + i;
    let x = pixel % task.width;
    let y = pixel / task.width;
    let ray = Ray(at(task.origin, x, y), 0u, at(task.direction, x, y), pixel);
    put(i, ray, Carried(vec3(WEIGHT_ONE), pixel));
}

// How many rays a queue holds, for the passes that go through it; the first invocation alone.
@compute @workgroup_size(64)
fn intersect_queue(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x > 0u {
        return;
    }
    let count = min(atomicLoad(&counter), task.capacity);
    let groups = (count + WORKGROUP - 1u) / WORKGROUP;
    arguments[0] = min(groups, ROW);
    arguments[1] = (groups + ROW - 1u) / ROW;
    arguments[2] = 1u;
    arguments[3] = count;
}

// One ray that asks for the nearest triangle.
@compute @workgroup_size(64)
fn locate(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = item(id, groups);
    if i >= task.items {
        return;
    }
    surfaces[i] = Surface(vec3(0.0), NOTHING);
    if hits[i].prim != NOTHING {
        surfaces[i] = located(rays[i], hits[i].prim);
    }
}

// The same: rays to the lamps that could light the point.
@compute @workgroup_size(64)
fn light(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = item(id, groups);
    if i >= task.items || surfaces[i].face == NOTHING {
        return;
    }
    let surface = surfaces[i];
    let seen_by = carried[i];
    for (var number = 0u; number < min(task.lamps, LAMPS_MAX); number += 1u) {
        let lamp = lamps[number];
        if could_light(surface, seen_by.parts, lamp) {
            let light = bitcast<vec3<u32>>(lit(surface, seen_by.parts, lamp));
            let ray = Ray(surface.point, 1u, lamp.position - surface.point, pixel_of(seen_by));
            append(ray, Carried(light, seen_by.whose | LIGHT));
        }
    }
}

// The same: the ray into its mirror direction, unless rounding has turned that into the face.
@compute @workgroup_size(64)
fn reflect(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = item(id, groups);
    if i >= task.items || surfaces[i].face == NOTHING {
        return;
    }
    let surface = surfaces[i];
    let seen_by = carried[i];
    let weight = weighted(seen_by.parts, triangles[surface.face / 2u].mirror);
    if mirrors_of(seen_by) >= task.depth || all(weight == vec3(0u)) {
        return;
    }
    let coarse = triangles[surface.face / 2u].coarse;
    let direction = vec3<f32>(mirrored(coarse, vec3<i32>(rays[i].direction)));
    if sign_towards(surface.face, direction) > 0 {
        let ray = Ray(surface.point, 0u, direction, pixel_of(seen_by));
        append(ray, Carried(weight, seen_by.whose + (1u << DEPTH_AT)));
    }
}

// One ray, of either kind: what it brings to its pixel if it meets nothing.
@compute @workgroup_size(64)
fn deposit(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = item(id, groups);
    if i >= task.items || hits[i].prim != NOTHING {
        return;
    }
    let brings = carried[i];
    let place = 6u * pixel_of(brings);
    for (var channel = 0u; channel < 3u; channel += 1u) {
        var amount = units_behind(task.background[channel], brings.parts[channel]);
        if carries_light(brings) {
            amount = units(bitcast<f32>(brings.parts[channel]));
        }
        deposited(place + 2u * channel, amount);
    }
}
