// The table of three lists: spec, a GPU leg, Embree.

// Rows shown at once; a list may have twenty thousand.
const ROWS_MAX = 200;
// Rows shown around one that differs.
const AROUND = 8;

// An element with properties and children; text is text, never markup.
function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name in element) element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

// A linear component as a display shows it.
function shown(linear) {
  const c = Math.min(Math.max(linear, 0), 1);
  return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
}

function swatch(colour) {
  const [r, g, b] = colour.slice(0, 3).map(shown);
  const title = `linear ${colour.map((c) => Number(c.toPrecision(7))).join(", ")}`;
  const element = make("span", { className: "swatch", title });
  element.style.background = `rgb(${r}, ${g}, ${b})`;
  return element;
}

function entryCell(entry) {
  const cell = make("div", { className: "entry" });
  if (entry.kind === KIND.ASTRAY) {
    cell.append(make("span", { className: "key" }, "…"));
    return cell;
  }
  const depth = (entry.key / 0x7fffffff).toFixed(6);
  const mask = entry.kind === KIND.OPAQUE ? "opaque" : entry.mask ? `mask ${entry.mask}` : "";
  const source = entry.source < 0xffffffff ? `triangle ${entry.source} of instance ${entry.instance}` : "no such triangle";
  cell.append(
    swatch(entry.colour),
    make("b", { title: source }, `prim ${entry.prim}`),
    make("span", { className: "key", title: "depth key" }, `key ${entry.key}`),
    ...[depth, mask, `α ${Number(entry.colour[3].toPrecision(2))}`].filter(Boolean).map((words) => make("span", { className: "rest" }, words)),
  );
  return cell;
}

function cellOf(cell) {
  const element = make("td", { className: cell?.bad ? "wrong" : "" });
  if (!cell) return element;
  element.append(cell.entry ? entryCell(cell.entry) : make("span", { className: "none" }, "—"));
  if (cell.words) element.append(make("span", { className: cell.bad ? "what" : "what soft" }, cell.words));
  return element;
}

function rowOf(row, number, isFirst) {
  const element = make("tr", { className: row.bad ? "bad" : "" });
  const mark = isFirst ? "▶ " : "";
  element.append(make("th", { scope: "row" }, mark + number));
  const must = row.must ? { entry: row.must, words: "", bad: false } : { entry: null, words: "", bad: false };
  element.append(cellOf(must), ...[0, 1].map((column) => cellOf(row.cells[column])));
  if (isFirst) element.classList.add("first");
  return element;
}

// Which rows are shown: all of a short list; else the first ones, and those around
// what differs.
function chosen(rows, all) {
  const near = new Set();
  rows.forEach((row, i) => {
    if (row.bad) for (let j = i - AROUND; j <= i + AROUND; j++) near.add(j);
  });
  const few = all || rows.length <= ROWS_MAX;
  let count = 0;
  return rows.map((_, i) => few || ((i < AROUND || near.has(i)) && count++ < ROWS_MAX));
}

function bodyOf(rows, all, again) {
  const body = make("tbody");
  const shows = chosen(rows, all);
  const first = rows.findIndex((row) => row.bad);
  let hidden = 0;
  const gap = () => {
    if (hidden === 0) return;
    const button = make("button", { type: "button", onclick: again }, `show all ${rows.length} entries`);
    body.append(make("tr", { className: "gap" }, make("td", { colSpan: 4 }, `${hidden} entries are not shown: `, button)));
    hidden = 0;
  };
  rows.forEach((row, i) => {
    if (!shows[i]) {
      hidden += 1;
      return;
    }
    gap();
    body.append(rowOf(row, i, i === first));
  });
  gap();
  if (rows.length === 0) body.append(make("tr", {}, make("td", { colSpan: 4 }, "No leg has anything at this pixel.")));
  return body;
}

// A small piece of a picture around a pixel, enlarged.
function loupe(image, [x, y], [width, height]) {
  const SIDE = 9;
  const canvas = make("canvas", { width: 90, height: 90, className: "loupe", role: "img", ariaLabel: "Pixels around it" });
  const context = canvas.getContext("2d");
  context.imageSmoothingEnabled = false;
  const [sx, sy] = [image.naturalWidth / width, image.naturalHeight / height];
  context.drawImage(image, (x - (SIDE - 1) / 2) * sx, (y - (SIDE - 1) / 2) * sy, SIDE * sx, SIDE * sy, 0, 0, 90, 90);
  context.strokeStyle = "#fff";
  context.strokeRect(40.5, 40.5, 9, 9);
  context.strokeStyle = "#000";
  context.strokeRect(39.5, 39.5, 11, 11);
  return canvas;
}
