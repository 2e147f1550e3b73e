// What is drawn by Plotly: who does what when, and how many tasks are completed. Both are drawn once; a cursor, which is
// no part of the plot and so costs nothing, shows the moment.
const LEFT = 62, RIGHT = 8, TOP = 6, BOTTOM = 22; // margins of both, in pixels
const plotOptions = { displayModeBar: false, responsive: true };
const plain = (text) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;"); // Plotly reads some HTML in its texts

const chartLayout = () => ({
  margin: { l: LEFT, r: RIGHT, t: TOP, b: BOTTOM }, plot_bgcolor: colours.ground, paper_bgcolor: "white",
  font: { family: 'system-ui, "Segoe UI", "DejaVu Sans", sans-serif', size: 11, color: colours.faint },
  hovermode: "closest", xaxis: { range: [-0.01 * end, 1.01 * end], gridcolor: "white", zeroline: false },
});

/** A plot with a cursor, which `moveTo` moves. */
class Chart {
  constructor(box, height) {
    box.style.height = `${height}px`;
    this.plot = box.appendChild(element("div", "", { class: "plot" }));
    this.cursor = box.appendChild(element("div", "", { class: "cursor" }));
    this.box = box;
    this.time = 0;
  }

  draw(traces, layout) {
    Plotly.newPlot(this.plot, traces, layout, plotOptions);
    this.plot.on("plotly_relayout", () => this.moveTo(this.time)); // zoomed, or of another size
  }

  /** Pixels from the left edge, cut off where the plot ends. */
  pixel(time) {
    const [first, last] = this.plot.layout.xaxis.range, width = this.box.clientWidth - LEFT - RIGHT;
    return LEFT + Math.min(Math.max((width * (time - first)) / (last - first), 0), width);
  }

  moveTo(time) {
    this.time = time;
    this.cursor.style.left = `${this.pixel(time)}px`;
  }
}

/** Bars for travel and work of every robot, and a tick for the deadline of each task under its bar. */
class Gantt extends Chart {
  constructor(box, visits, onPick) {
    const rows = Math.max(place.robots.length, 4), row = many ? 11 : 25;
    super(box, TOP + BOTTOM + rows * row);
    this.row = row;
    this.picked = box.insertBefore(element("div", "", { class: "picked" }), this.cursor);
    const colour = (kept) => kept.map(({ robot }) => robotColour(robot));
    const bars = (kept, width, from, to, look) => ({
      type: "bar", orientation: "h", width, y: kept.map(({ robot }) => robot), base: kept.map(({ visit }) => visit[from]),
      x: kept.map(({ visit }) => visit[to] - visit[from]), customdata: kept.map(({ visit }) => visit[1]),
      hoverinfo: "text", hovertext: kept.map(story), ...look,
    });
    const onTime = visits.filter(({ visit }) => visit[5]), late = visits.filter(({ visit }) => !visit[5]);
    const text = (kept, color) => many ? {} : { text: kept.map(({ visit }) => `${visit[0]}`), textposition: "inside",
      insidetextanchor: "middle", textangle: 0, textfont: { color, size: 10 } };
    this.draw([
      bars(visits, 0.08, 2, 3, { marker: { color: colour(visits) } }),
      bars(onTime, 0.6, 3, 4, { marker: { color: colour(onTime), line: { color: "white", width: many ? 0.3 : 1 } },
        ...text(onTime, "white") }),
      bars(late, 0.56, 3, 4, { marker: { color: "white", line: { color: colours.missed, width: 1.5 } },
        ...text(late, "black") }),
      { type: "scatter", mode: "markers", x: visits.map(({ visit }) => place.tasks[visit[0]][2]),
        y: visits.map(({ robot }) => robot + 0.4), customdata: visits.map(({ visit }) => visit[1]), hoverinfo: "text",
        hovertext: visits.map(story), marker: { symbol: "line-ns", size: many ? 3 : 5, opacity: 1,
          line: { width: many ? 1 : 1.5, color: colour(visits) } } },
    ], {
      ...chartLayout(), barmode: "overlay", showlegend: false,
      yaxis: { range: [rows - 0.5, -0.5], tickvals: place.robots.map((_, robot) => robot), zeroline: false,
        ticktext: place.robots.map((_, robot) => many ? `${robot}` : `robot ${robot}`), showgrid: false,
        tickfont: { size: many ? 8 : 11 }, fixedrange: true },
    });
    this.plot.on("plotly_click", ({ points }) => onPick(points[0].customdata));
  }

  /** Mark a robot's time from a decision to its end. */
  mark(robot, from, to) {
    this.marked = [robot, from, to];
    const left = this.pixel(from);
    Object.assign(this.picked.style, { left: `${left}px`, width: `${this.pixel(to) - left}px`,
      top: `${TOP + robot * this.row}px`, height: `${this.row}px` });
  }

  moveTo(time) {
    super.moveTo(time);
    if (this.marked) this.mark(...this.marked);
  }
}

/** Completed tasks over time, a line for each episode. */
class Progress extends Chart {
  constructor(box, episodes, onPick) {
    super(box, 140);
    this.draw(episodes.map(({ method, routes }, index) => {
      const times = routes.flat().filter((visit) => visit[5]).map((visit) => visit[4]).sort((a, b) => a - b);
      return { type: "scatter", mode: "lines", x: [0, ...times, end], y: [0, ...times.map((_, count) => count + 1),
        times.length], line: { shape: "hv", color: SIDE_COLOURS[index], width: 2.2 }, name: plain(method),
      hovertemplate: "%{y} completed by %{x:.4~g}" };
    }), {
      ...chartLayout(), showlegend: episodes.length > 1, legend: { x: 0.01, y: 0.98, bgcolor: "rgba(0,0,0,0)" },
      yaxis: { gridcolor: "white", zeroline: false, title: { text: "completed" }, rangemode: "tozero", fixedrange: true },
    });
    this.plot.on("plotly_click", ({ points }) => onPick(points[0].x));
  }
}

function story({ robot, visit: [task, decision, leave, arrive, finish] }) {
  return `robot ${robot}, task ${task}<br>leaves ${number(leave)}, arrives ${number(arrive)}, done ${number(finish)}` +
    `<br>due ${number(place.tasks[task][2])}<br>decision ${decision}`;
}
