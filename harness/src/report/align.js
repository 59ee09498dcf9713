// Lists next to each other: entries of one triangle stand in one row, and what differs
// from the spec's list is named.

// Indices of a longest rising run among numbers: entries outside it stand elsewhere.
function rising(numbers) {
  const ends = [];
  const before = numbers.map(() => -1);
  numbers.forEach((n, i) => {
    let [place, beyond] = [0, ends.length];
    while (place < beyond) {
      const middle = (place + beyond) >> 1;
      if (numbers[ends[middle]] < n) place = middle + 1;
      else beyond = middle;
    }
    before[i] = place > 0 ? ends[place - 1] : -1;
    ends[place] = i;
  });
  const kept = new Set();
  for (let i = ends.at(-1) ?? -1; i >= 0; i = before[i]) kept.add(i);
  return kept;
}

// What of an entry is not the spec's, in words; `judged` is false for Embree's hits that
// nobody may hold against it.
function compareEntry(must, entry, isGpu) {
  if (!isGpu) return hitState(must, entry);
  const words = [];
  if (must.key !== entry.key) words.push(`key ${entry.key > must.key ? "+" : "−"}${Math.abs(entry.key - must.key)}`);
  if (must.mask !== entry.mask) words.push("mask");
  if (must.kind !== entry.kind) words.push("kind");
  if (must.colour.some((c, i) => !Object.is(c, entry.colour[i]))) words.push("colour");
  return { entry, words: words.length ? `differs: ${words.join(", ")}` : "", bad: words.length > 0 };
}

function hitState(must, entry) {
  const { kind } = entry;
  if (kind === KIND.MISSED) return { entry: null, words: "missing", bad: true };
  if (kind === KIND.MISSED_UNJUDGED) return { entry: null, words: "missing, not judged", bad: false };
  if (kind === KIND.INVENTED) return { entry, words: "extra", bad: true };
  if (kind === KIND.DEPTH) return { entry, words: "depth outside the bound", bad: true };
  if (kind === KIND.EDGE) return { entry, words: "edge: not judged", bad: false };
  if (kind === KIND.UNRESOLVED) return { entry, words: "unresolved: not judged", bad: false };
  return { entry, words: must ? "" : "behind the surface", bad: false };
}

function extraState(entry, isGpu) {
  if (!isGpu) return hitState(null, entry);
  if (entry.kind === KIND.ASTRAY) return { entry, words: `link leads to address ${entry.key}`, bad: true };
  return { entry, words: "extra", bad: true };
}

// Puts a leg's list beside the rows; `column` is where.
function place(rows, list, column, isGpu) {
  const open = new Map();
  rows.forEach((row) => {
    if (!row.must) return;
    if (!open.has(row.must.prim)) open.set(row.must.prim, []);
    open.get(row.must.prim).push(row);
  });
  const order = new Map(rows.map((row, i) => [row, i]));
  const matched = [];
  const extras = new Map();
  let last = null;
  for (const entry of list) {
    const row = entry.kind === KIND.ASTRAY ? null : open.get(entry.prim)?.shift();
    if (row) {
      row.cells[column] = compareEntry(row.must, entry, isGpu);
      matched.push(row);
      last = row;
    } else {
      const row = { must: null, cells: [] };
      row.cells[column] = extraState(entry, isGpu);
      if (!extras.has(last)) extras.set(last, []);
      extras.get(last).push(row);
    }
  }
  const kept = rising(matched.map((row) => order.get(row)));
  matched.forEach((row, i) => {
    const cell = row.cells[column];
    if (!isGpu || kept.has(i)) return;
    row.cells[column] = { ...cell, words: [cell.words, "order"].filter(Boolean).join("; "), bad: true };
  });
  for (const left of [...open.values()].flat()) {
    left.cells[column] = isGpu ? { entry: null, words: "missing", bad: true } : { entry: null, words: "", bad: false };
  }
  return [...(extras.get(null) ?? []), ...rows.flatMap((row) => [row, ...(extras.get(row) ?? [])])];
}

// Rows of the spec's list with the lists of the others beside it; a list that is not
// known is null, and has no cells.
function align(must, lists) {
  let rows = must.map((entry) => ({ must: entry, cells: [] }));
  lists.forEach(({ list, isGpu }, column) => {
    if (list) rows = place(rows, list, column, isGpu);
  });
  for (const row of rows) row.bad = row.cells.some((cell) => cell?.bad);
  return rows;
}
