// Compute path: a walk over the pixels of one row of which one triangle covers a sample; where the
// row is long, over every `stride`th of them.
//
//     var walk = start(item);
//     while advance(&walk) { … walk.fragment … }

//#import triangle
//#import stride

struct Walk {
    setup: Setup,
    x: u32,         // next column to look at
    end: u32,       // one past the last
    stride: u32,    // from one column to the next
    pixel: u32,     // of column 0, within the band
    ea: Wide,       // edge values at sample 0 of column x, less the least of a covered sample
    eb: Wide,
    ec: Wide,
    da: Wide,       // their change per stride
    db: Wide,
    dc: Wide,
    fragment: Fragment,
}

// The triangle that an item stands for a walk over: the last of the batch with at most `item`
// walks before it.
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

// First row of the band of which a sample lies at or below the triangle's top.
fn first_row(s: Setup) -> u32 {
    let top = min(s.a.y, min(s.b.y, s.c.y));
    var lowest = sample_place(0u).y;
    for (var i = 1u; i < frame.samples; i += 1u) {
        lowest = max(lowest, sample_place(i).y);
    }
    // ceil((top - lowest) / 2^bits); the shift of a negative number rounds down.
    let row = -((lowest - top) >> frame.bits);
    return u32(clamp(row, i32(frame.first_row), i32(frame.first_row + frame.rows)));
}

fn start(item: u32) -> Walk {
    let at = find(item);
    let prim = work[at].x;
    let s = prepare(prim);
    let height = max(s.a.y, max(s.b.y, s.c.y)) - min(s.a.y, min(s.b.y, s.c.y));
    let stride = stride_of(s.area, height);
    let own = item - work[at].y;
    let y = first_row(s) + own / stride;
    let origin = sample_at(0u, y, 0u);
    var walk: Walk;
    walk.setup = s;
    walk.pixel = (y - frame.first_row) * frame.width;
    walk.fragment.prim = prim;
    let ea = wide_sub(edge(s.b, s.c, origin), wide(least(s.b, s.c)));
    let eb = wide_sub(edge(s.c, s.a, origin), wide(least(s.c, s.a)));
    let ec = wide_sub(edge(s.a, s.b, origin), wide(least(s.a, s.b)));
    var span = vec2(0.0, f32(frame.width));
    span = narrow(span, widened(ea, s.b, s.c), s.c.y - s.b.y);
    span = narrow(span, widened(eb, s.c, s.a), s.a.y - s.c.y);
    span = narrow(span, widened(ec, s.a, s.b), s.b.y - s.a.y);
    // Those that share a row part its columns by their numbers, wherever each has it begin.
    let begin = u32(clamp(span.x, 0.0, f32(frame.width)));
    walk.x = begin + ((own - begin) & (stride - 1u));
    walk.stride = stride;
    walk.end = select(u32(clamp(span.y, 0.0, f32(frame.width))), 0u, s.empty);
    let da = step_of(s.b, s.c);
    let db = step_of(s.c, s.a);
    let dc = step_of(s.a, s.b);
    walk.ea = wide_add(ea, wide_scale(da, walk.x));
    walk.eb = wide_add(eb, wide_scale(db, walk.x));
    walk.ec = wide_add(ec, wide_scale(dc, walk.x));
    walk.da = wide_scale(da, stride);
    walk.db = wide_scale(db, stride);
    walk.dc = wide_scale(dc, stride);
    return walk;
}

// Change of an edge function from one column to the next.
fn step_of(a: vec3<i32>, b: vec3<i32>) -> Wide {
    return wide_shift(wide(a.y - b.y), frame.bits);
}

// Change of an edge function from sample 0 of a pixel to another. Edges are below 2^20 and
// samples less than 2^8 sub-pixels apart, so it is below 2^29.
fn shift_of(a: vec3<i32>, b: vec3<i32>, s: u32) -> i32 {
    let by = sample_place(s) - sample_place(0u);
    return (b.x - a.x) * by.y - (b.y - a.y) * by.x;
}

// The value at whichever sample of the pixel has the largest: a row's span must have every
// pixel of which any sample is covered.
fn widened(value: Wide, a: vec3<i32>, b: vec3<i32>) -> Wide {
    var most = 0;
    for (var i = 1u; i < frame.samples; i += 1u) {
        most = max(most, shift_of(a, b, i));
    }
    return wide_add(value, wide(most));
}

// The samples that are covered at a pixel with these values, less the least, at sample 0.
fn mask_of(s: Setup, ea: Wide, eb: Wide, ec: Wide) -> u32 {
    var mask = u32(!(wide_negative(ea) || wide_negative(eb) || wide_negative(ec)));
    for (var i = 1u; i < frame.samples; i += 1u) {
        let out = wide_negative(wide_add(ea, wide(shift_of(s.b, s.c, i))))
            || wide_negative(wide_add(eb, wide(shift_of(s.c, s.a, i))))
            || wide_negative(wide_add(ec, wide(shift_of(s.a, s.b, i))));
        mask |= select(1u << i, 0u, out);
    }
    return mask;
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

// Moves on to the next covered pixel of the walk; false at the end of the row.
fn advance(walk: ptr<function, Walk>) -> bool {
    while (*walk).x < (*walk).end {
        let x = (*walk).x;
        let ea = (*walk).ea;
        let eb = (*walk).eb;
        let ec = (*walk).ec;
        (*walk).x = x + (*walk).stride;
        (*walk).ea = wide_add(ea, (*walk).da);
        (*walk).eb = wide_add(eb, (*walk).db);
        (*walk).ec = wide_add(ec, (*walk).dc);
        let s = (*walk).setup;
        let mask = mask_of(s, ea, eb, ec);
        if mask != 0u {
            let lowest = firstTrailingBit(mask);
            (*walk).fragment.mask = mask;
            (*walk).fragment.pixel = (*walk).pixel + x;
            (*walk).fragment.key = depth_key(
                depths(s),
                s.area,
                wide_add(ea, wide(least(s.b, s.c) + shift_of(s.b, s.c, lowest))),
                wide_add(eb, wide(least(s.c, s.a) + shift_of(s.c, s.a, lowest))),
                wide_add(ec, wide(least(s.a, s.b) + shift_of(s.a, s.b, lowest))),
            );
            return true;
        }
    }
    return false;
}
