// What the sheets of a scene hold of a pixel, and the table of it.

// The sheet of a GPU leg that is shown: the one that was chosen, else the first that
// differs at this pixel, else the first.
async function legAt(viewer, pixel) {
  const legs = viewer.sheets.filter((sheet) => sheet.against);
  if (viewer.leg) return viewer.leg;
  for (const sheet of legs) {
    if ((await sheet.load()).has(pixel)) return sheet;
  }
  return legs[0];
}

// The spec's list and a GPU leg's; null where they are not in this file.
async function pairAt(viewer, leg, pixel) {
  const own = leg && (await leg.load()).get(pixel);
  if (own) return { must: own[0], list: own[1] };
  const isBase = (sheet) => !sheet.against && sheet.leg === (leg?.against ?? "spec") && (!leg || sheet.bits === leg.bits);
  const base = viewer.sheets.find(isBase);
  const must = base && ((await base.load()).get(pixel)?.[0] ?? (isHeld(base, viewer.at) ? [] : null));
  return { must: must ?? null, list: leg ? (must ?? null) : null, base };
}

// Embree's hits along a pixel's ray. It may have a sheet of what differs beside that of
// every so many pixels.
async function hitsAt(viewer, pixel) {
  const sheets = viewer.sheets.filter((sheet) => sheet.leg === "embree");
  for (const embree of sheets) {
    const hits = (await embree.load()).get(pixel)?.[0];
    if (hits) return { embree, hits };
  }
  const empty = sheets.find((sheet) => isHeld(sheet, viewer.at));
  return { embree: empty ?? sheets[0], hits: empty ? [] : null };
}

// What is known of a leg whose list is not in its own sheet.
function equalNote(leg, has) {
  if (!has) return "";
  if (leg.leftOut > 0) return `Equal to the spec's, or one of ${leg.leftOut} pixels that differ and were left out to keep the file small.`;
  return "Equal to the spec's, bit for bit.";
}

async function legChoice(viewer, leg, pixel) {
  const legs = viewer.sheets.filter((sheet) => sheet.against);
  const options = [];
  for (const sheet of legs) {
    const differs = (await sheet.load()).has(pixel) ? " ≠" : "";
    options.push(make("option", { selected: sheet === leg }, sheet.leg.replace(/^gpu@/, "") + differs));
  }
  const choice = make("select", { className: "leg", ariaLabel: "GPU leg", title: leg.leg }, ...options);
  choice.addEventListener("change", () => {
    viewer.leg = legs[choice.selectedIndex];
    viewer.look();
  });
  return choice;
}

// The picture of a leg, to look at through a loupe.
function pictureOf(viewer, label) {
  const at = viewer.titles.findIndex((titles) => titles.includes(label));
  return viewer.figures[at]?.querySelector("img");
}

function heading(viewer, title, label, notes) {
  const head = make("th", { scope: "col" }, title);
  const image = label && pictureOf(viewer, label);
  if (image?.complete) head.append(loupe(image, viewer.at, viewer.size));
  for (const note of notes.filter(Boolean)) head.append(make("span", { className: "note" }, note));
  return head;
}

// Where the nearest pixel is whose list is in the file.
function leftOut(viewer, sheet) {
  const { stride } = sheet;
  const near = viewer.at.map((n) => Math.floor(n / stride) * stride);
  const go = make("button", { type: "button", onclick: () => viewer.lookAt(near) }, `Go to column ${near[0]}, row ${near[1]}`);
  const words = `The spec's list of this pixel was left out to keep the file small: each ${stride}th column and row is held, and what differs. --dump writes all. `;
  return make("p", { className: "skipped" }, words, go);
}

async function listsOf(viewer) {
  const [x, y] = viewer.at;
  const pixel = y * viewer.size[0] + x;
  const leg = await legAt(viewer, pixel);
  const { embree, hits } = await hitsAt(viewer, pixel);
  const { must, list, base } = await pairAt(viewer, leg, pixel);
  if (!must && base) return leftOut(viewer, base);
  if (!must) return make("p", { className: "skipped" }, "There are no lists of this scene in this file.");
  const rows = align(must, [{ list, isGpu: true }, { list: hits ?? null, isGpu: false }]);
  const isOwn = leg && (await leg.load()).has(pixel);
  const bad = rows.filter((row) => row.bad).length;
  const verdict = bad ? `${bad} of ${rows.length} entries differ` : "no entry differs";
  const caption = make("caption", { className: bad ? "diverge" : "" }, `Pixel at column ${x}, row ${y}: ${verdict}`);
  const count = (entries) => (entries ? `${entries.length} entries` : "");
  const grid = leg ? `grid of 1/${2 ** leg.bits} pixel` : "";
  const head = make(
    "tr",
    {},
    make("th", { scope: "col" }, "#"),
    heading(viewer, leg?.against || "spec", "spec", [count(must), grid]),
    heading(viewer, leg ? await legChoice(viewer, leg, pixel) : "no GPU leg", leg?.leg, leg ? [count(list), isOwn ? leg.note : equalNote(leg, list)] : []),
    heading(viewer, embree ? "embree" : "no Embree", "embree", embree ? [hits ? count(hits.filter((h) => h.kind < KIND.MISSED)) : `Left out to keep the file small: each ${embree.stride}th column and row is held.`] : []),
  );
  const table = make("table", { className: "threes" }, caption, make("thead", {}, head), bodyOf(rows, false, () => all()));
  const all = () => table.querySelector("tbody").replaceWith(bodyOf(rows, true, () => {}));
  return table;
}
