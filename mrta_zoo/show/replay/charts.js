"use strict";
// Who does what when, and how many tasks are completed, over time, as SVG in pixels. Both are drawn anew when their width
// changes or one drags over a span of time to see more of it; otherwise only a cursor moves.
const ABOVE = 4, BELOW = 20, RIGHT = 10, EDGE = 4; // margins, in pixels, and room for marks at the end
const BAR = many ? 9 : 17, APART = many ? 3 : 7, LANE = 3, TICKS = 4; // heights
const MOST_LANES = 900; // height of all lanes together; with more, deadlines are ticks, joined to the task pointed at only
const TEXT = 11; // its size
const DRAG = 6; // pixels from which on a click is a drag

/** A chart over time with a cursor, which `moveTo` moves. */
class Chart {
  constructor(box, height, onTime) {
    this.box = box;
    this.height = height;
    this.time = 0;
    this.span = [0, end];
    this.svg = box.appendChild(svg("svg", { class: "chart", height: ABOVE + height + BELOW }));
    this.listen(onTime);
    new ResizeObserver(() => { if (this.width !== box.clientWidth) this.draw(); }).observe(box);
  }

  draw() {
    this.width = this.box.clientWidth;
    this.room = Math.max(this.width - this.left() - RIGHT, 10);
    this.svg.setAttribute("width", this.width);
    this.inner = svg("svg", { x: this.left(), y: ABOVE, width: this.room, height: this.height }); // cuts off
    this.inner.append(svg("rect", { width: this.room, height: this.height, fill: colours.ground }));
    this.svg.replaceChildren(this.inner);
    const widest = textWidth(`${Number(this.span[1].toPrecision(3))}`, TEXT) + 24;
    for (const value of roundNumbers(...this.span, Math.max(1, Math.min(10, Math.floor(this.room / widest))))) {
      const x = this.at(value), half = textWidth(`${value}`, TEXT) / 2;
      this.inner.append(svg("line", { class: "grid", x1: x, x2: x, y1: 0, y2: this.height }));
      if (this.left() + x + half <= this.width)
        this.svg.append(svg("text", { class: "tick", x: this.left() + x, y: ABOVE + this.height + 14 }, `${value}`));
    }
    this.fill();
    this.cursor = this.inner.appendChild(svg("line", { class: "cursor", y1: 0, y2: this.height }));
    this.moveTo(this.time);
  }

  /** Pixels from where the time begins. */
  at(time) {
    return ((this.room - EDGE) * (time - this.span[0])) / (this.span[1] - this.span[0]);
  }

  timeAt(clientX) {
    const share = (clientX - this.svg.getBoundingClientRect().left - this.left()) / (this.room - EDGE);
    return this.span[0] + Math.min(Math.max(share, 0), 1) * (this.span[1] - this.span[0]);
  }

  moveTo(time) {
    this.time = time;
    for (const end of ["x1", "x2"]) this.cursor.setAttribute(end, this.at(time));
  }

  /** A click is a time, a drag the span to be shown; a double click shows all. */
  listen(onTime) {
    let begun = null;
    this.svg.addEventListener("pointerdown", (event) => { begun = event.clientX; });
    this.svg.addEventListener("pointerup", (event) => {
      const from = begun;
      begun = null;
      if (from === null || event.button !== 0) return;
      if (Math.abs(event.clientX - from) < DRAG) return onTime(event);
      this.span = [from, event.clientX].map((x) => this.timeAt(x)).sort((a, b) => a - b);
      if (!(this.span[1] > this.span[0])) this.span = [0, end];
      this.draw();
    });
    this.svg.addEventListener("dblclick", () => { this.span = [0, end]; this.draw(); });
  }
}

/** Bars for travel and work of every robot, and from each bar a line to its task's deadline. */
class Gantt extends Chart {
  constructor(box, routes, onPick, onLook) {
    const lanes = (route, inTime) => 1 + Math.max(-1, ...route.filter((visit) => visit[5] === inTime).map((visit) => visit[6]));
    const counts = routes.map((route) => [lanes(route, false), lanes(route, true)]);
    const lane = LANE * counts.flat().reduce((sum, count) => sum + count, 0) <= MOST_LANES ? LANE : 0;
    let height = 0;
    const rows = counts.map(([above, below]) => {
      const top = height;
      height += APART + BAR + (lane ? lane * (above + below) : TICKS);
      return { top, bar: top + APART / 2 + lane * above, above, below, height: height - top };
    });
    super(box, Math.max(height, 60), (event) => {
      const visit = event.target.closest(".visit");
      if (visit) onPick(Number(visit.dataset.decision));
    });
    Object.assign(this, { routes, rows, lane, looked: null });
    this.svg.addEventListener("pointerover", (event) => {
      const visit = event.target.closest(".visit");
      onLook(visit ? Number(visit.dataset.task) : null);
    });
    this.svg.addEventListener("pointerleave", () => onLook(null));
    this.draw();
  }

  /** Room for the names of robots. */
  left() {
    const widest = Math.max(...place.robot_names.map((name, robot) => textWidth(many ? "999" : `${this.number(robot)}${name}`, TEXT)));
    return Math.min(widest + 8, Math.max(78, 0.18 * this.box.clientWidth));
  }

  /** What stands before a robot's name: its number, which it has on the map. */
  number(robot) {
    return place.named ? `${robot}: ` : "";
  }

  fill() {
    this.picked = this.inner.appendChild(svg("rect", { class: "picked", visibility: "hidden" }));
    this.visits = new Map();
    this.routes.forEach((route, robot) => {
      const room = this.left() - 8 - textWidth(this.number(robot), TEXT);
      const name = many ? `${robot}` : this.number(robot) + fitted(place.robot_names[robot], room, TEXT, place.robot_names);
      this.svg.append(svg("text", { class: "who", x: this.left() - 6, y: ABOVE + this.rows[robot].bar + BAR / 2 + 4,
        fill: robotColour(robot), "data-robot": robot }, name));
      for (const visit of [...route].reverse()) this.inner.append(this.visit(robot, visit)); // bars on the ways from them
    });
    if (this.marked) this.mark(...this.marked);
    this.look(this.looked);
  }

  visit(robot, visit) {
    const [task, decision, leave, arrive, finish, inTime] = visit, { bar } = this.rows[robot];
    const [left, from, to] = [leave, arrive, finish].map((time) => this.at(time)), middle = bar + BAR / 2;
    const group = svg("g", { class: inTime ? "visit" : "visit late", "data-task": task, "data-decision": decision,
      color: robotColour(robot) });
    const way = this.wayToDeadline(robot, visit, to);
    group.append(
      svg("title", {}, story(robot, visit)),
      svg("path", { class: "hit", d: way }),
      svg("path", { class: this.lane ? "due" : "due quiet", d: way }),
      svg("line", { class: "travel", x1: left, x2: from, y1: middle, y2: middle }),
      svg("rect", { class: to - from > 2.5 ? "work" : "work thin", x: from, y: bar, width: Math.max(to - from, 0.5),
        height: BAR }),
      ...this.tick(robot, visit),
    );
    if (!many) group.append(...this.name(place.task_names[task], (from + to) / 2, middle, to - from - 4));
    this.visits.set(task, group);
    return group;
  }

  /** The name of a task in its bar, upright or on its side, if there is room for it. */
  name(name, x, y, room) {
    const fit = (room) => fitted(name, room, TEXT - 1, place.task_names);
    const upright = fit(room), turned = room >= 7 && upright !== name ? fit(BAR - 2) : "";
    const side = turned.length > upright.length;
    if (!upright && !turned) return [];
    return [svg("text", { class: "what", x, y: y + 3.5, ...(side && { transform: `rotate(-90 ${x} ${y})` }) },
      side ? turned : upright)];
  }

  /** The height of the line to a deadline. */
  lineAt(robot, [, , , , , inTime, lane]) {
    const { bar, above, below } = this.rows[robot];
    if (!this.lane) return bar + BAR + 0.6 * TICKS;
    return inTime ? bar + BAR + this.lane * (below - lane - 0.2) : bar - this.lane * (above - lane - 0.4);
  }

  wayToDeadline(robot, visit, from) {
    const { bar } = this.rows[robot], y = this.lineAt(robot, visit);
    const due = this.at(Math.min(place.tasks[visit[0]][2], end));
    return `M${from} ${visit[5] ? bar + BAR : bar}V${y}H${due}`;
  }

  /** The mark of a deadline: a tick, or an arrow where it is later than what is shown. */
  tick(robot, visit) {
    const due = place.tasks[visit[0]][2], x = this.at(Math.min(due, end)), y = this.lineAt(robot, visit);
    const marks = [svg("path", { class: "deadline", d: due > end ? `M${x - 5} ${y - 3}l5 3l-5 3z` : `M${x} ${y - 1.5}v3` })];
    if (!visit[5]) {
      const to = this.at(visit[4]);
      marks.push(svg("path", { class: "missed", d: `M${to - 3} ${y - 3}l6 6m-6 0l6 -6` }));
    }
    return marks;
  }

  /** Mark a robot's time from a decision to its end. */
  mark(robot, from, to) {
    this.marked = [robot, from, to];
    const x = this.at(from), { top, height } = this.rows[robot];
    for (const [name, value] of Object.entries({ x, y: top, width: Math.max(this.at(to) - x, 0), height,
      visibility: "visible" })) this.picked.setAttribute(name, value);
  }

  /** Highlight a task with its deadline; null highlights none. */
  look(task) {
    this.visits.get(this.looked)?.classList.remove("pointed");
    this.visits.get(task)?.classList.add("pointed");
    this.looked = task;
  }
}

/** Completed tasks over time, a line for each episode. */
class Progress extends Chart {
  constructor(box, episodes, onPick) {
    super(box, 116, (event) => onPick(this.timeAt(event.clientX)));
    this.lines = episodes.map(({ method, routes }) => ({ method,
      times: routes.flat().filter((visit) => visit[5]).map((visit) => visit[4]).sort((a, b) => a - b) }));
    this.most = Math.max(1, ...this.lines.map(({ times }) => times.length));
    this.draw();
  }

  left() {
    return Math.max(textWidth(`${this.most}`, TEXT) + 10, 30);
  }

  fill() {
    const up = (count) => this.height - 4 - ((this.height - 20) * count) / this.most;
    for (const count of roundNumbers(0, this.most, Math.min(5, this.most))) {
      this.inner.append(svg("line", { class: "grid", x1: 0, x2: this.room, y1: up(count), y2: up(count) }));
      this.svg.append(svg("text", { class: "who", x: this.left() - 6, y: ABOVE + up(count) + 4 }, `${count}`));
    }
    this.lines.forEach(({ method, times }, index) => {
      const steps = times.map((time, count) => `H${this.at(time)}V${up(count + 1)}`).join("");
      this.inner.append(svg("path", { class: "progress", stroke: SIDE_COLOURS[index],
        d: `M${this.at(0)} ${up(0)}${steps}H${this.at(end)}` }));
      const y = 14 + 15 * index;
      if (this.lines.length > 1) this.inner.append(
        svg("line", { x1: 8, x2: 26, y1: y - 4, y2: y - 4, stroke: SIDE_COLOURS[index], "stroke-width": 3 }),
        svg("text", { class: "series", x: 31, y }, fitted(method, this.room / 2, TEXT)));
    });
    this.inner.append(svg("text", { class: "unit", x: this.room - 6, y: this.height - 8 }, "tasks completed"));
  }
}

function story(robot, [task, decision, leave, arrive, finish]) {
  return `${place.robot_names[robot]}, task ${place.task_names[task]}\nleaves ${number(leave)}, arrives ${number(arrive)}, ` +
    `done ${number(finish)}\ndue ${number(place.tasks[task][2])}\ndecision ${decision}`;
}
