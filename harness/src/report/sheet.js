"use strict";
// Sheets: the lists of pixels, unpacked. The format stands in harness/src/sheet/pack.rs.

const KIND = { LISTED: 0, OPAQUE: 1, ASTRAY: 2, EDGE: 3, UNRESOLVED: 4, INVENTED: 5, DEPTH: 6, MISSED: 7, MISSED_UNJUDGED: 8 };

// The bytes of a zlib stream in base64.
async function inflate(base64) {
  const packed = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Reads numbers in LEB128. Bitwise operators would cut them off at 32 bits.
function reader(bytes) {
  let at = 0;
  const number = () => {
    let n = 0;
    for (let unit = 1; ; unit *= 128) {
      if (at >= bytes.length) throw new Error("the lists end too early");
      const byte = bytes[at++];
      n += (byte % 128) * unit;
      if (byte < 128) return n;
    }
  };
  const signed = () => {
    const n = number();
    return n % 2 ? -(n + 1) / 2 : n / 2;
  };
  const take = (length) => bytes.subarray(at, (at += length));
  return { number, signed, take };
}

function colours(planes, count) {
  const bytes = new DataView(new ArrayBuffer(16));
  return Array.from({ length: count }, (_, i) => {
    for (let component = 0; component < 4; component++) {
      for (let byte = 0; byte < 4; byte++) {
        bytes.setUint8(4 * component + byte, planes[(4 * byte + component) * count + i]);
      }
    }
    return [0, 4, 8, 12].map((offset) => bytes.getFloat32(offset, true));
  });
}

function readTriangles({ number, signed, take }, count) {
  const each = (read) => Array.from({ length: count }, read);
  let prim = 0;
  let source = 0;
  const prims = each(() => (prim += number()));
  const instances = each(number);
  const sources = each(() => (source += signed()));
  const shades = colours(take(16 * count), count);
  return prims.map((row, i) => ({ prim: row, instance: instances[i], source: sources[i], colour: shades[i] }));
}

// Pixel number to its lists: one, or the spec's and the leg's.
async function unpack(base64) {
  const from = reader(await inflate(base64));
  const [count, pixels, lists] = [from.number(), from.number(), from.number()];
  const triangles = readTriangles(from, count);
  let pixel = 0;
  const numbers = Array.from({ length: pixels }, () => (pixel += from.number()));
  const lengths = Array.from({ length: pixels * lists }, from.number);
  const all = lengths.map((length) => Array.from({ length }, () => ({ ...triangles[from.number()] })));
  for (const list of all) {
    let key = 0;
    for (const entry of list) entry.key = key += from.signed();
  }
  for (const entry of all.flat()) {
    const mark = from.number();
    entry.kind = mark % 16;
    entry.mask = Math.floor(mark / 16);
  }
  return new Map(numbers.map((n, i) => [n, all.slice(i * lists, (i + 1) * lists)]));
}

// A sheet of the page: what its attributes say, and the lists when asked for. `sheets`
// are those of the scene, as one may have its lists in another.
function sheetOf(template, _, sheets) {
  const { leg, against, bits, stride, leftOut, note, like } = template.dataset;
  let lists = null;
  const base64 = (like ? sheets[like] : template).content.textContent;
  const load = () => (lists ??= base64 ? unpack(base64) : Promise.resolve(new Map()));
  return { leg, against, bits, stride: Number(stride), leftOut: Number(leftOut), note, load };
}

// Whether a pixel without lists in a sheet is known to be empty.
function isHeld(sheet, [x, y]) {
  return sheet.stride > 0 && x % sheet.stride === 0 && y % sheet.stride === 0;
}
