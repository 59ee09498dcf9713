// A pixel's list as it is shown, and entries of the longest. Imported where `shown` can be.
//#import jagged
//#import shown

// An entry of one of the longest lists.
struct Deep {
    at: u32,
    start: u32,
    end: u32,
}

// Of the longest lists there are `items`; there may be more workgroups than they need.
fn long_entry(group: u32, lane: u32) -> Deep {
    if group / tiled.groups >= tiled.items {
        return Deep(0u, 0u, 0u);
    }
    let list = longest.lists[group / tiled.groups];
    let run = run_at(list / WORKGROUP, list % WORKGROUP);
    let at = run.start + group % tiled.groups * WORKGROUP + lane;
    return Deep(at, run.start, run.start + run.length);
}

// A pixel, its list, and what lies behind.
struct Own {
    pixel: u32,
    run: Run,
    behind: Behind,
}

fn pixel_at(tile: u32, lane: u32) -> Own {
    if !has_lists(tile) {
        return Own(NOWHERE, Run(0u, 0u, 0u, true), 0u);
    }
    let pixel = pixel_of(tile, lane);
    if pixel == NOWHERE {
        return Own(NOWHERE, Run(0u, 0u, 0u, true), 0u);
    }
    return Own(pixel, run_at(tile, lane), behind_at(pixel));
}

fn entry_of(run: Run, i: u32, length: u32) -> Listed {
    if i >= length {
        return LAST;
    }
    return listed[slot(run, i)];
}

// A list in order, four entries at a time, so that they are on their way at once. What nothing is seen
// through ends it.
fn shaded(own: Own) -> Seen {
    let length = min(own.run.length, tiled.layers);
    var seen = unseen();
    for (var i = 0u; i < length && !is_covered_up(seen); i += 4u) {
        let a = entry_of(own.run, i, length);
        let b = entry_of(own.run, i + 1u, length);
        let c = entry_of(own.run, i + 2u, length);
        let d = entry_of(own.run, i + 3u, length);
        seen = over_before(seen, a, own.behind);
        seen = over_before(seen, b, own.behind);
        seen = over_before(seen, c, own.behind);
        seen = over_before(seen, d, own.behind);
    }
    return seen;
}

fn over_before(seen: Seen, entry: Listed, behind: Behind) -> Seen {
    if is_hidden(entry.x, behind) {
        return seen;
    }
    return over(seen, entry, behind);
}
