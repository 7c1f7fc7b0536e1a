// The views of all chosen modes, side by side in one canvas under one camera.

import { THREE, OrbitControls } from "three";
import { cases, colour, geometry, modes, numbers, sampleAt, singularRegion } from "rps3/data";
import { forceGradient } from "rps3/limbs";
import { Mechanism } from "rps3/mechanism";

const box = document.getElementById("animation");
const canvas = document.getElementById("canvas");

/** Digits that neither jump nor mislead: three significant ones. */
const short = (x) => (Math.abs(x) >= 100 ? x.toFixed(0) : Math.abs(x) >= 1e-3 || x === 0 ? String(Number(x.toPrecision(3))) : x.toExponential(1));

export class Animation {
  constructor() {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.renderer.setScissorTest(true);
    this.camera = new THREE.PerspectiveCamera(27, 1, 0.1, 10);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(0.6, -1.45, 1.3);
    this.controls = new OrbitControls(this.camera, box);
    this.controls.target.set(0, 0, 0.09);
    this.controls.minDistance = 0.4;
    this.controls.maxDistance = 5;
    this.controls.addEventListener("change", () => this.draw());
    this.controls.update();
    this.views = modes.map((mode) => {
      const panel = document.createElement("div");
      panel.className = "view";
      panel.style.borderTopColor = colour(mode);
      box.append(panel);
      return { mode, panel, mechanism: new Mechanism(geometry, singularRegion) };
    });
    document.getElementById("scale").style.background = forceGradient;
    new ResizeObserver(() => this.draw()).observe(box);
  }

  /** Chooses a case and the modes to show. */
  choose(index, shown) {
    this.case = cases[index];
    this.time = numbers(this.case.time);
    this.shown = this.views.filter(({ mode }) => shown.has(mode) && numbers(this.case.runs[mode]?.sigma ?? "").length > 0);
    for (const view of this.views) view.panel.hidden = !this.shown.includes(view);
    box.classList.toggle("single", this.shown.length < 2);
    document.getElementById("tension").textContent = `pull ${this.case.forceScale} N`;
    document.getElementById("compression").textContent = `push ${this.case.forceScale} N`;
  }

  /** Shows the sample at a time, s. */
  seek(now) {
    for (const { mode, panel, mechanism } of this.shown) {
      const run = this.case.runs[mode];
      const [poses, forces, twists, sigmas, errors] = ["pose", "forces", "twist", "sigma", "error"].map((key) => numbers(run[key]));
      const k = sampleAt(this.time, sigmas.length, now);
      const force = forces.subarray(3 * k, 3 * k + 3);
      mechanism.show({
        pose: poses.subarray(7 * k, 7 * k + 7),
        twist: twists.subarray(6 * k, 6 * k + 6),
        forces: force,
        forceScale: this.case.forceScale,
        sigma: sigmas[k],
      });
      const ended = now > this.time[sigmas.length - 1] + 1e-9 ? `<br><span class="ended">ended at ${short(this.time[sigmas.length - 1])} s</span>` : "";
      panel.innerHTML = `<strong>${mode}</strong><br>error ${short(errors[k])} mm<br>&sigma;<sub>min</sub> ${short(sigmas[k])}<br>axial ${Array.from(force, short).join(", ")} N${ended}`;
    }
    this.draw();
  }

  draw() {
    const size = canvas.getBoundingClientRect();
    if (!this.shown || size.width === 0) return;
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(size.width, size.height, false);
    for (const { panel, mechanism } of this.shown) {
      const part = panel.getBoundingClientRect();
      const [x, y] = [part.left - size.left, size.bottom - part.bottom];
      this.renderer.setViewport(x, y, part.width, part.height);
      this.renderer.setScissor(x, y, part.width, part.height);
      this.camera.aspect = part.width / part.height;
      this.camera.updateProjectionMatrix();
      this.renderer.render(mechanism.scene, this.camera);
    }
  }
}
