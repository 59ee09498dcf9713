// Compute path: a walk over the covered pixels of one row of one triangle.
//
//     var walk = start(item);
//     while advance(&walk) { … walk.fragment … }

//#import triangle

struct Walk {
    setup: Setup,
    x: u32,         // next column to look at
    end: u32,       // one past the last
    pixel: u32,     // of column 0, within the band
    ea: Wide,       // edge values at column x, less the least of a covered sample
    eb: Wide,
    ec: Wide,
    da: Wide,       // their change per column
    db: Wide,
    dc: Wide,
    fragment: Fragment,
}

// The row of a triangle that an item stands for: the last triangle of the batch
// with at most `item` rows before it.
fn find(item: u32) -> u32 {
    var low = frame.work_first;
    var high = frame.work_first + frame.work_count;
    while low + 1u < high {
        let middle = (low + high) / 2u;
        if work[middle].y <= item {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// First row of the band whose samples lie at or below the triangle's top.
fn first_row(s: Setup) -> u32 {
    let top = min(s.a.y, min(s.b.y, s.c.y));
    let half = i32(1u << (frame.bits - 1u));
    // ceil((top - half) / 2^bits); the shift of a negative number rounds down.
    let row = -((half - top) >> frame.bits);
    return u32(clamp(row, i32(frame.first_row), i32(frame.first_row + frame.rows)));
}

fn start(item: u32) -> Walk {
    let at = find(item);
    let prim = work[at].x;
    let s = prepare(prim);
    let y = first_row(s) + item - work[at].y;
    let origin = vec2(sample_at(0u), sample_at(y));
    var walk: Walk;
    walk.setup = s;
    walk.pixel = (y - frame.first_row) * frame.width;
    walk.fragment.prim = prim;
    walk.fragment.mask = 1u;
    walk.da = step_of(s.b, s.c);
    walk.db = step_of(s.c, s.a);
    walk.dc = step_of(s.a, s.b);
    let ea = wide_sub(edge(s.b, s.c, origin), wide(least(s.b, s.c)));
    let eb = wide_sub(edge(s.c, s.a, origin), wide(least(s.c, s.a)));
    let ec = wide_sub(edge(s.a, s.b, origin), wide(least(s.a, s.b)));
    var span = vec2(0.0, f32(frame.width));
    span = narrow(span, ea, s.c.y - s.b.y);
    span = narrow(span, eb, s.a.y - s.c.y);
    span = narrow(span, ec, s.b.y - s.a.y);
    walk.x = u32(clamp(span.x, 0.0, f32(frame.width)));
    walk.end = select(u32(clamp(span.y, 0.0, f32(frame.width))), 0u, s.empty);
    walk.ea = wide_add(ea, wide_scale(walk.da, walk.x));
    walk.eb = wide_add(eb, wide_scale(walk.db, walk.x));
    walk.ec = wide_add(ec, wide_scale(walk.dc, walk.x));
    return walk;
}

// Change of an edge function from one column to the next.
fn step_of(a: vec3<i32>, b: vec3<i32>) -> Wide {
    return wide_shift(wide(a.y - b.y), frame.bits);
}

// Cuts a span of columns to where value - x * fall * 2^bits may be >= 0. It only
// saves looking at columns: the exact test decides. The estimate is off by under
// 7 U of itself, less than 0.002 columns anywhere on a target of 2048, and a sum
// with it by less than 0.0003: MARGIN is more than both. Ends of spans are rounded
// down.
const MARGIN: f32 = 1.0 / 256.0;

fn narrow(span: vec2<f32>, value: Wide, fall: i32) -> vec2<f32> {
    let negative = wide_negative(value);
    if fall == 0 {
        return select(span, vec2(0.0, 0.0), negative);
    }
    let size = wide_to_f32(select_wide(value, wide_sub(wide(0), value), negative));
    let column = select(size, -size, negative) / (f32(fall) * f32(1u << frame.bits));
    if fall > 0 {
        return vec2(span.x, min(span.y, column + (1.0 + MARGIN)));
    }
    return vec2(max(span.x, column + (1.0 - MARGIN)), span.y);
}

fn select_wide(a: Wide, b: Wide, condition: bool) -> Wide {
    if condition {
        return b;
    }
    return a;
}

// Moves on to the next covered pixel; false at the end of the row.
fn advance(walk: ptr<function, Walk>) -> bool {
    while (*walk).x < (*walk).end {
        let x = (*walk).x;
        let ea = (*walk).ea;
        let eb = (*walk).eb;
        let ec = (*walk).ec;
        (*walk).x = x + 1u;
        (*walk).ea = wide_add(ea, (*walk).da);
        (*walk).eb = wide_add(eb, (*walk).db);
        (*walk).ec = wide_add(ec, (*walk).dc);
        if !(wide_negative(ea) || wide_negative(eb) || wide_negative(ec)) {
            let s = (*walk).setup;
            (*walk).fragment.pixel = (*walk).pixel + x;
            (*walk).fragment.key = depth_key(
                depths(s),
                s.area,
                wide_add(ea, wide(least(s.b, s.c))),
                wide_add(eb, wide(least(s.c, s.a))),
                wide_add(ec, wide(least(s.a, s.b))),
            );
            return true;
        }
    }
    return false;
}
