// The one time of animation and plots: slider, play and pause.

const slider = document.getElementById("time");
const button = document.getElementById("play");
const face = document.getElementById("clock");
const speed = document.getElementById("speed");

export class Clock {
  /** `onChange` is called with the new time, s. */
  constructor(onChange) {
    this.onChange = onChange;
    this.now = 0;
    this.playing = false;
    slider.addEventListener("input", () => {
      this.play(false);
      this.set(Number(slider.value));
    });
    button.addEventListener("click", () => this.play(!this.playing));
  }

  /** Sets the end of the time, s, and the step of the slider. */
  limit(end, step) {
    [this.end, slider.max, slider.step] = [end, end, step];
    this.set(Math.min(this.now, end));
  }

  set(now) {
    this.now = now;
    slider.value = now;
    face.textContent = `${now.toFixed(3)} s`;
    this.onChange(now);
  }

  play(on) {
    this.playing = on;
    button.innerHTML = on ? "&#10074;&#10074; Pause" : "&#9654; Play";
    button.setAttribute("aria-label", on ? "Pause" : "Play");
    if (!on) return;
    if (this.now >= this.end) this.set(0);
    let last = performance.now();
    const tick = (moment) => {
      if (!this.playing) return;
      const next = this.now + (Math.max(0, moment - last) / 1000) * Number(speed.value);
      last = moment;
      this.set(Math.min(next, this.end));
      if (next >= this.end) this.play(false);
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }
}
