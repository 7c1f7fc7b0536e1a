// The plots of the chosen case, all modes over each other, with a cursor at the time of the animation.

import { cases, groups, numbers, styles } from "rps3/data";

const box = document.getElementById("plot");
const HEIGHT = 150; // of a plot with its caption, px
const CAPTION = 24; // of it, px

export class Plots {
  /** `onPick` is called with a time (s) that was clicked. */
  constructor(onPick) {
    this.onPick = onPick;
    this.drawn = Promise.resolve();
  }

  /** Draws a group of plots of a case for the chosen modes. */
  choose(caseIndex, shown, groupIndex, now) {
    const [chosen, group] = [cases[caseIndex], groups[groupIndex]];
    const time = numbers(chosen.time);
    const count = group.panels.length;
    const traces = [];
    const height = Math.max(600, count * HEIGHT);
    const margin = { l: 52, r: 12, t: 26, b: 42 };
    const part = 1 / count;
    const caption = CAPTION / (height - margin.t - margin.b);
    const layout = {
      height,
      margin,
      annotations: group.panels.map(({ label }, i) => ({ text: label, xref: "paper", yref: "paper", x: 0, y: 1 - i * part - caption, xanchor: "left", yanchor: "bottom", showarrow: false })),
      font: { family: "system-ui, DejaVu Sans, sans-serif", size: 12, color: "#1c2733" },
      legend: { orientation: "h", x: 0, y: 1, yanchor: "bottom" },
      hovermode: "x",
      shapes: [cursor(now)],
      xaxis: { title: { text: "time, s" }, range: [time[0], time[time.length - 1]], gridcolor: "#e6e9ed", anchor: count === 1 ? "y" : `y${count}`, hoverformat: ".3f" },
    };
    group.panels.forEach((panel, i) => {
      const axis = i === 0 ? "" : String(i + 1);
      layout[`yaxis${axis}`] = {
        type: panel.scale,
        domain: [1 - (i + 1) * part, 1 - i * part - caption],
        gridcolor: "#e6e9ed",
        zerolinecolor: "#c3c9d0",
        exponentformat: "power",
        automargin: false,
        nticks: 5,
        hoverformat: ".4g",
      };
      const channel = `${group.title}/${i}`;
      const window = chosen.windows[channel];
      if (window) layout[`yaxis${axis}`].range = window;
      if (panel.reference) {
        traces.push(line(time, numbers(chosen.references[channel]), "reference", { color: styles.reference.colour, width: 4 }, axis, i === 0));
      }
      for (const [mode, run] of Object.entries(chosen.runs)) {
        if (!shown.has(mode)) continue;
        const { colour, dash } = styles[mode];
        traces.push(line(time, numbers(run.panels[channel]), mode, { color: colour, dash, width: 1.8 }, axis, i === 0));
      }
    });
    this.drawn = Plotly.react(box, traces, layout, { responsive: true, displaylogo: false }).then(() => {
      box.removeAllListeners("plotly_click");
      box.on("plotly_click", (event) => this.onPick(event.points[0].x));
    });
  }

  /** Moves the cursor; a move that comes while one is under way replaces those that wait. */
  seek(now) {
    this.wanted = now;
    if (this.moving) return;
    this.moving = true;
    requestAnimationFrame(async () => {
      await this.drawn;
      await Plotly.relayout(box, { shapes: [cursor(this.wanted)] });
      this.moving = false;
      if (this.wanted !== now) this.seek(this.wanted);
    });
  }
}

const cursor = (now) => ({ type: "line", xref: "x", yref: "paper", x0: now, x1: now, y0: 0, y1: 1, line: { color: "#1c2733", width: 1 } });

const line = (time, values, name, style, axis, first) => ({
  type: "scatter",
  mode: "lines",
  x: time.subarray(0, values.length),
  y: values,
  name,
  line: style,
  xaxis: "x",
  yaxis: `y${axis}`,
  legendgroup: name,
  showlegend: first,
});
