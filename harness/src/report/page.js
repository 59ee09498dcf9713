// Filters scenes, opens what a link leads to, copies commands, listens to keys. The page
// is complete without any script.

const form = document.getElementById("filter");
const lines = [...document.querySelectorAll("[data-verdict]")];
const scenes = [...document.querySelectorAll("details.scene")];
const help = document.getElementById("keys");

function filter() {
  const verdict = form.elements.verdict.value;
  const name = form.elements.name.value.trim().toLowerCase();
  let shown = 0;
  for (const line of lines) {
    const { verdict: own, name: ownName } = line.dataset;
    line.hidden = (verdict && own !== verdict) || !ownName.toLowerCase().includes(name);
    if (!line.hidden && line.tagName === "TR") shown += 1;
  }
  form.elements.shown.value = `${shown} of ${scenes.length} shown`;
}

// Opens a scene and brings it to the top.
function openScene(scene) {
  scene.hidden = false;
  scene.open = true;
  openViewer(scene);
  scene.scrollIntoView();
  scene.querySelector("summary").focus({ preventScroll: true });
}

function openTarget() {
  const target = document.getElementById(location.hash.slice(1));
  if (target instanceof HTMLDetailsElement) openScene(target);
}

form.hidden = false;
form.addEventListener("input", filter);
form.addEventListener("submit", (event) => event.preventDefault());
filter();

for (const scene of scenes) {
  if (scene.open) openViewer(scene);
  scene.addEventListener("toggle", () => scene.open && openViewer(scene)?.fit());
}

// A page from a file may not use the clipboard's interface everywhere; a selection can
// always be copied.
async function copy(button) {
  const code = button.parentElement.querySelector("code");
  getSelection().selectAllChildren(code);
  try {
    await navigator.clipboard.writeText(code.textContent);
    button.textContent = "Copied";
  } catch {
    button.textContent = document.execCommand("copy") ? "Copied" : "Selected";
  }
}

for (const again of document.querySelectorAll(".again")) {
  const button = make("button", { type: "button", className: "copy" }, "Copy");
  button.addEventListener("click", () => copy(button));
  again.append(" ", button);
}

// The scene that has the focus, or the one at the top of the window.
function current() {
  const focused = document.activeElement?.closest?.("details.scene");
  const below = (scene) => !scene.hidden && scene.getBoundingClientRect().bottom > 60;
  return focused ?? scenes.find(below);
}

// The next scene that diverges, or the one before; from the last the first follows.
function divergence(by) {
  const all = scenes.filter((scene) => scene.dataset.verdict === "diverge");
  if (all.length === 0) return;
  const now = all.indexOf(document.activeElement?.closest?.("details.scene"));
  openScene(all[(Math.max(now, by > 0 ? -1 : 0) + by + all.length) % all.length]);
}

const KEYS = {
  "?": () => (help.open ? help.close() : help.showModal()),
  "/": () => form.elements.name.focus(),
  n: () => divergence(1),
  p: () => divergence(-1),
  w: () => openViewer(current())?.worst(1),
  W: () => openViewer(current())?.worst(-1),
  x: () => openViewer(current())?.swap(),
  "+": () => openViewer(current())?.scale(2),
  "-": () => openViewer(current())?.scale(1 / 2),
  v: () => openViewer(current())?.part("stage").focus(),
};

addEventListener("keydown", (event) => {
  const typing = event.target.closest?.("input:not([type=range]):not([type=radio]), select, textarea");
  if (typing || event.ctrlKey || event.altKey || event.metaKey) return;
  const act = KEYS[event.key];
  if (!act || (help.open && event.key !== "?")) return;
  event.preventDefault();
  act();
});

for (const button of document.querySelectorAll("[data-key]")) {
  button.hidden = false;
  button.addEventListener("click", () => KEYS[button.dataset.key]());
}

addEventListener("hashchange", openTarget);
openTarget();

// Paper has no folds.
let closed = [];
addEventListener("beforeprint", () => {
  closed = [...document.querySelectorAll("details:not([open])")];
  for (const details of closed) details.open = true;
});
addEventListener("afterprint", () => {
  for (const details of closed) details.open = false;
});
