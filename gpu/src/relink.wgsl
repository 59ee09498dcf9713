// Linked lists put in order by relinking: runs of 1, 2, 4, … nodes are merged, so that lists of any
// length are sorted in place, in n log n steps.
// Imported where there are nodes with an order, `before`, and links: `next_of` and `set_next`.

// End of a list, and an empty list's head.
const EOL: u32 = 0xffffffffu;

// Where a pixel's sort or resolve stands between two dispatches.
struct Progress {
    merged: u32,        // first node of what the pass has merged
    tail: u32,          // its last node
    left: u32,          // next node of the left run; of the list, in resolve
    right: u32,         // next node of the right run
    left_size: u32,     // nodes that the left run has left
    right_size: u32,    // at most so many in the right run
    run: u32,           // nodes in a run of this pass; 0: not begun
    state: u32,
}

// A dispatch follows a list for so many steps, and the next one goes on. Drivers
// end what takes too long: llvmpipe leaves every loop of an invocation after 65,535
// iterations in all, GPUs reset after some seconds.
const STEPS: u32 = 16384u;

const FIND: u32 = 0u;       // looking for the end of the left run
const MERGE: u32 = 1u;      // taking the smaller of two
const DONE: u32 = 2u;
const SEVERAL: u32 = 4u;    // flag: this pass has merged more than one pair

// A list, from its head or from where it stands, after so many steps.
fn relinked(given: Progress, head: u32) -> Progress {
    var p = given;
    if p.run == 0u {
        p = begin(head);
    }
    for (var i = 0u; i < STEPS && p.state != DONE; i += 1u) {
        if (p.state & MERGE) == 0u {
            find_step(&p);
        } else {
            merge_step(&p);
        }
    }
    return p;
}

// The first pass over a list; done at once if there is nothing to sort.
fn begin(head: u32) -> Progress {
    var sorted = head == EOL;
    if !sorted {
        sorted = next_of(head) == EOL;
    }
    if sorted {
        return Progress(head, EOL, EOL, EOL, 0u, 0u, 1u, DONE);
    }
    return Progress(EOL, EOL, head, head, 0u, 0u, 1u, FIND);
}

// One step of `right` past the left run.
fn find_step(p: ptr<function, Progress>) {
    if (*p).left_size < (*p).run && (*p).right != EOL {
        (*p).right = next_of((*p).right);
        (*p).left_size += 1u;
    } else {
        (*p).right_size = (*p).run;
        (*p).state |= MERGE;
    }
}

// Takes a node of the left or right run, or goes on to the next pair.
fn merge_step(p: ptr<function, Progress>) {
    let no_right = (*p).right_size == 0u || (*p).right == EOL;
    if (*p).left_size == 0u && no_right {
        next_pair(p);
        return;
    }
    var take_right = (*p).left_size == 0u;
    if !take_right && !no_right {
        take_right = before((*p).right, (*p).left);
    }
    var taken = (*p).left;
    if take_right {
        taken = (*p).right;
        (*p).right = next_of(taken);
        (*p).right_size -= 1u;
    } else {
        (*p).left = next_of(taken);
        (*p).left_size -= 1u;
    }
    if (*p).tail == EOL {
        (*p).merged = taken;
    } else {
        set_next((*p).tail, taken);
    }
    (*p).tail = taken;
}

// The next pair of runs; after the last, the next pass; after one pair in all, done.
fn next_pair(p: ptr<function, Progress>) {
    if (*p).right != EOL {
        (*p).left = (*p).right;
        (*p).left_size = 0u;
        (*p).state = FIND | SEVERAL;
        return;
    }
    set_next((*p).tail, EOL);
    if ((*p).state & SEVERAL) == 0u {
        (*p).state = DONE;
        return;
    }
    let head = (*p).merged;
    *p = Progress(EOL, EOL, head, head, 0u, 0u, 2u * (*p).run, FIND);
}
