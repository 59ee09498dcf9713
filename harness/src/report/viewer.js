// Looks into one scene: two pictures with a slider between them, a cursor on a pixel,
// and the lists of that pixel.

const viewers = new Map();

class Viewer {
  constructor(scene) {
    this.scene = scene;
    this.root = scene.querySelector(".viewer");
    this.size = [Number(this.root.dataset.width), Number(this.root.dataset.height)];
    this.part = (name) => this.root.querySelector(`.${name}`);
    this.figures = [...scene.querySelectorAll("figure[data-titles]")];
    // No title holds a line break.
    this.titles = this.figures.map((figure) => figure.dataset.titles.split("\n"));
    this.sheets = [...this.root.querySelectorAll("template.sheet")].map(sheetOf);
    this.at = this.firstPixel();
    this.zoom = 1;
    this.leg = null;
    this.isOpen = false;
    this.root.hidden = false;
    this.choices();
    this.listen();
    this.show();
    this.fit();
  }

  // The worst pixel, or the middle of the picture.
  firstPixel() {
    const worst = this.scene.querySelector("[data-at]");
    return worst ? worst.dataset.at.split(",").map(Number) : this.size.map((side) => side >> 1);
  }

  // A picture on each side: the spec, and the first leg that differs, or what the spec's
  // own shadows change, or the first leg.
  choices() {
    for (const side of ["left", "right"]) {
      this.part(side).append(...this.titles.map((titles, i) => make("option", { value: i }, titles.join(", "))));
    }
    const DIFFERENCE = "difference of ";
    const differs = this.titles.flat().find((title) => title.startsWith(`${DIFFERENCE}gpu`));
    const leg = differs?.slice(DIFFERENCE.length);
    const find = (test) => Math.max(0, this.titles.findIndex((titles) => titles.some(test)));
    this.part("left").value = find((title) => title === "spec");
    const unshadowed = "without indirect shadows";
    const lit = !leg && this.titles.flat().includes(unshadowed) ? unshadowed : leg;
    this.part("right").value = find((title) => (lit ? title === lit : title !== "spec"));
  }

  listen() {
    const stage = this.part("stage");
    for (const side of ["left", "right"]) this.part(side).addEventListener("change", () => this.show());
    this.part("swap").addEventListener("click", () => this.swap());
    this.part("split").addEventListener("input", () => this.cut());
    this.part("in").addEventListener("click", () => this.scale(2));
    this.part("out").addEventListener("click", () => this.scale(1 / 2));
    this.part("canvas").addEventListener("click", (event) => this.click(event));
    this.part("look").addEventListener("click", () => this.lookAt(this.at));
    for (const axis of ["column", "row"]) {
      this.part(axis).addEventListener("change", () => this.move([this.part("column").valueAsNumber || 0, this.part("row").valueAsNumber || 0]));
    }
    stage.addEventListener("keydown", (event) => this.key(event));
    for (const shot of this.scene.querySelectorAll(".shot")) {
      shot.append(make("span", { className: "cursor" }));
      shot.addEventListener("click", (event) => this.click(event));
    }
    for (const place of this.scene.querySelectorAll(".pixel")) {
      const at = place.dataset.at.split(",").map(Number);
      const open = () => this.lookAt(at);
      place.replaceWith(make("button", { type: "button", className: "pixel", onclick: open, "data-at": place.dataset.at }, place.textContent));
    }
    addEventListener("resize", () => this.fit());
  }

  image(side) {
    return this.figures[this.part(side).value]?.querySelector("img");
  }

  show() {
    const [under, over] = [this.part("under"), this.part("over")];
    for (const [picture, side] of [[over, "left"], [under, "right"]]) {
      const from = this.image(side);
      if (!from) continue;
      picture.src = from.src;
      picture.alt = from.alt;
    }
    this.cut();
  }

  swap() {
    const [left, right] = [this.part("left"), this.part("right")];
    [left.value, right.value] = [right.value, left.value];
    this.show();
  }

  cut() {
    this.part("canvas").style.setProperty("--cut", `${this.part("split").value / 10}%`);
  }

  // As wide as there is room, but no higher than most of the window.
  fit() {
    const [width, height] = this.size;
    const room = this.part("room").clientWidth;
    if (room === 0) return;
    this.width = Math.max(1, Math.min(room, (innerHeight * 0.62 * width) / height));
    this.resize();
  }

  scale(by) {
    this.zoom = Math.min(Math.max(this.zoom * by, 1), 64);
    this.resize();
  }

  resize() {
    const [canvas, stage] = [this.part("canvas"), this.part("stage")];
    this.part("split").style.width = `${this.width}px`;
    canvas.style.width = `${this.width * this.zoom}px`;
    canvas.style.aspectRatio = `${this.size[0]} / ${this.size[1]}`;
    this.part("factor").value = `${this.zoom}×`;
    this.mark();
    const middle = (i, inner, outer) => ((this.at[i] + 0.5) / this.size[i]) * inner - outer / 2;
    stage.scrollLeft = middle(0, canvas.clientWidth, stage.clientWidth);
    stage.scrollTop = middle(1, canvas.clientHeight, stage.clientHeight);
  }

  // Puts every cursor on the pixel.
  mark() {
    const [x, y] = this.at;
    const [width, height] = this.size;
    for (const cursor of this.scene.querySelectorAll(".cursor")) {
      cursor.style.left = `${(100 * x) / width}%`;
      cursor.style.top = `${(100 * y) / height}%`;
      cursor.style.width = `${100 / width}%`;
      cursor.style.height = `${100 / height}%`;
    }
    this.part("column").value = x;
    this.part("row").value = y;
    this.part("here").textContent = `Column ${x}, row ${y}`;
  }

  move(at) {
    this.at = at.map((n, i) => Math.min(Math.max(Math.trunc(n), 0), this.size[i] - 1));
    this.mark();
    this.follow();
    if (this.isOpen) this.look();
  }

  // Scrolls the stage as far as needed to see the cursor.
  follow() {
    const stage = this.part("stage");
    const [box, cursor] = [stage, this.part("canvas").querySelector(".cursor")].map((e) => e.getBoundingClientRect());
    stage.scrollLeft += Math.min(0, cursor.left - box.left) + Math.max(0, cursor.right - box.right);
    stage.scrollTop += Math.min(0, cursor.top - box.top) + Math.max(0, cursor.bottom - box.bottom);
  }

  click(event) {
    const box = event.currentTarget.getBoundingClientRect();
    const along = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    this.lookAt(along.map((part, i) => part * this.size[i]));
  }

  // Moves to a pixel and shows its lists, if there are any, which come into sight.
  async lookAt(at) {
    this.isOpen = false;
    this.move(at);
    if (this.sheets.length === 0) return;
    await this.look();
    this.part("lists").scrollIntoView({ block: "nearest" });
  }

  key(event) {
    const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const step = steps[event.key];
    if (step && !event.ctrlKey && !event.altKey && !event.metaKey) {
      const by = event.shiftKey ? 10 : 1;
      this.move(this.at.map((n, i) => n + by * step[i]));
    } else if (event.key === "Enter") {
      this.lookAt(this.at);
    } else {
      return;
    }
    event.preventDefault();
  }

  // The next of the worst pixels, or the one before.
  worst(by) {
    const places = [...this.scene.querySelectorAll(".pixel")].map((place) => place.dataset.at.split(",").map(Number));
    if (places.length === 0) return;
    const now = places.findIndex((at) => at.every((n, i) => n === this.at[i]));
    this.lookAt(places[(Math.max(now, by > 0 ? -1 : 0) + by + places.length) % places.length]);
  }

  async look() {
    this.isOpen = true;
    const ticket = (this.ticket = {});
    try {
      const table = await listsOf(this);
      // Who has moved on meanwhile waits for another table.
      if (ticket === this.ticket) this.part("lists").replaceChildren(table);
    } catch (error) {
      this.part("lists").replaceChildren(make("p", { className: "diverge" }, `The lists cannot be read: ${error.message}`));
    }
  }
}

function openViewer(scene) {
  if (!viewers.has(scene) && scene.querySelector(".viewer")) viewers.set(scene, new Viewer(scene));
  return viewers.get(scene);
}
