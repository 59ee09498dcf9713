// Filters scenes, enlarges pictures, opens what a link leads to. The page is
// complete without it.
"use strict";
const form = document.getElementById("filter");
const scenes = [...document.querySelectorAll("[data-verdict]")];

function filter() {
  const verdict = form.elements.verdict.value;
  const name = form.elements.name.value.trim().toLowerCase();
  let shown = 0;
  for (const scene of scenes) {
    const { verdict: own, name: ownName } = scene.dataset;
    scene.hidden = (verdict && own !== verdict) || !ownName.toLowerCase().includes(name);
    if (!scene.hidden && scene.tagName === "TR") shown += 1;
  }
  form.elements.shown.value = `${shown} of ${scenes.length / 2} shown`;
}

function openTarget() {
  const target = document.getElementById(location.hash.slice(1));
  if (target instanceof HTMLDetailsElement) {
    target.hidden = false;
    target.open = true;
    target.scrollIntoView();
  }
}

form.hidden = false;
form.addEventListener("input", filter);
form.addEventListener("submit", (event) => event.preventDefault());
filter();

for (const button of document.querySelectorAll("button.zoom")) {
  button.setAttribute("aria-pressed", "false");
  button.addEventListener("click", () => {
    const large = button.parentElement.classList.toggle("large");
    button.setAttribute("aria-pressed", String(large));
  });
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
