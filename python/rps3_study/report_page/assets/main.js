// Ties the page's parts together.

import { Animation } from "rps3/animation";
import { Clock } from "rps3/clock";
import { cases, colour, groups, modes, numbers } from "rps3/data";
import { Plots } from "rps3/plots";

const element = (id) => document.getElementById(id);
const unique = (list) => [...new Set(list)];

function animation() {
  try {
    return new Animation();
  } catch {
    // no WebGL: the plots and tables remain
    element("animation").innerHTML = '<p class="problem">This browser offers no WebGL, so there is no animation.</p>';
    return { choose() {}, seek() {} };
  }
}

const view = animation();
const plots = new Plots((time) => clock.set(time));
const clock = new Clock((time) => {
  view.seek(time);
  plots.seek(time);
});
const shown = new Set(modes);
let group = 0;

function update() {
  const index = cases.findIndex((one) => one.task === element("task").value && one.variant === element("variant").value);
  const time = numbers(cases[index].time);
  view.choose(index, shown);
  plots.choose(index, shown, group, clock.now);
  // single precision: 1.4 s would be 1.39999998
  const exact = (x) => Number(x.toPrecision(6));
  clock.limit(exact(time[time.length - 1] ?? 0), exact(time[1] - time[0] || 1));
  document.querySelectorAll(".case").forEach((table, i) => table.classList.toggle("chosen", i === index));
}

for (const [id, key] of [["task", "task"], ["variant", "variant"]]) {
  element(id).append(...unique(cases.map((one) => one[key])).map((text) => new Option(text)));
  element(id).addEventListener("change", update);
}
for (const mode of modes) {
  const label = document.createElement("label");
  const tick = Object.assign(document.createElement("input"), { type: "checkbox", checked: true, value: mode });
  const key = Object.assign(document.createElement("i"), { className: "key" });
  key.style.background = colour(mode);
  tick.addEventListener("change", () => {
    if (tick.checked) shown.add(mode);
    else shown.delete(mode);
    update();
  });
  label.append(tick, " ", key, mode);
  element("modes").append(label, " ");
}
groups.forEach(({ title }, i) => {
  const tab = Object.assign(document.createElement("button"), { type: "button", textContent: title });
  tab.setAttribute("role", "tab");
  const choose = () => {
    group = i;
    for (const other of element("groups").children) other.setAttribute("aria-selected", String(other === tab));
  };
  tab.addEventListener("click", () => {
    choose();
    update();
  });
  element("groups").append(tab);
  if (i === 0) choose();
});
update();
