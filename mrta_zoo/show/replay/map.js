"use strict";
// The map of one side, as SVG: tasks by status, robots where they are at the moment shown, their trails, and where they
// are heading. Wheel and drag zoom and move it, a double click resets it. Text is as large as anywhere on the page.
const SIDE_LENGTH = 520; // of the longer side, in the SVG's units
const MARGIN = 16;
const AXIS = { size: 11, below: 20 }; // numbers: their size and room below the map, in pixels
const LABEL = { size: 10, most: 300, longest: 70 }; // tasks' names: size and longest in pixels; tasks that have them, at most
const RECENT = 4; // legs of a trail that is cut, where there are many robots
const SHADES = 24; // of urgency

/** The colour of a task by the share of all time that is left to its deadline. */
function urgency(share) {
  const at = (Math.round(Math.min(Math.max(share, 0), 1) * SHADES) / SHADES) * (colours.urgency.length - 1);
  const index = Math.min(Math.floor(at), colours.urgency.length - 2);
  const [below, above] = [0, 1].map((step) => colours.urgency[index + step].match(/\w\w/g).map((hex) => parseInt(hex, 16)));
  return `rgb(${below.map((value, part) => Math.round(value + (at - index) * (above[part] - value)))})`;
}

class MapView {
  constructor(box, onLook) {
    this.box = box;
    this.onLook = onLook;
    const scale = SIDE_LENGTH / Math.max(...place.size), [x, y] = place.low;
    this.size = place.size.map((length) => scale * length);
    this.at = (spot) => [scale * (spot[0] - x), this.size[1] - scale * (spot[1] - y)];
    this.svg = svg("svg", { class: "plan" });
    this.ground = this.add("g", {});
    const detail = Math.min(1, Math.max(0.5, 12 / Math.sqrt(place.tasks.length)));
    this.detail = detail;
    this.trails = place.robots.map((_, robot) => this.add("polyline", { class: "trail", stroke: robotColour(robot),
      "stroke-width": 2.2 * detail }));
    this.ahead = place.robots.map((_, robot) => this.add("line", { class: "ahead", stroke: robotColour(robot),
      "stroke-width": 2.4 * detail }));
    place.robots.forEach((each, robot) => {
      const [x, y] = this.at(each), side = many ? 7 : 10;
      this.add("rect", { class: "home", x: x - side / 2, y: y - side / 2, width: side, height: side,
        stroke: robotColour(robot) });
    });
    this.tasks = place.tasks.map((each, task) => this.task(each, task));
    this.labels = this.add("g", { class: "labels" });
    this.looked = this.add("circle", { r: 11, class: "looked" });
    this.acting = this.add("circle", { r: many ? 12 : 15, class: "acting" });
    this.robots = place.robots.map((each, robot) => this.robot(each, robot));
    this.listen();
    box.append(this.svg);
    new ResizeObserver(() => { if (this.width !== box.clientWidth) this.reset(); }).observe(box);
    this.reset();
  }

  add(tag, attributes, text) {
    return this.svg.appendChild(svg(tag, attributes, text));
  }

  /** Ground, grid and numbers. */
  drawGround() {
    const [width, height] = this.size, px = this.perPixel, [[left, right], [low, high]] = [0, 1].map((axis) =>
      [place.low[axis], place.low[axis] + place.size[axis]]);
    this.ground.replaceChildren(svg("rect", { x: -MARGIN, y: -MARGIN, width: width + 2 * MARGIN,
      height: height + 2 * MARGIN, fill: colours.ground }));
    const wide = this.widestAcross() + 16;
    const about = (length, room) => Math.max(1, Math.min(5, Math.floor(length / px / room)));
    for (const value of roundNumbers(left, right, about(width, wide))) {
      const [x] = this.at([value, low]);
      this.ground.append(svg("line", { class: "grid", x1: x, x2: x, y1: -MARGIN, y2: height + MARGIN }),
        svg("text", { class: "axis below", x, y: height + MARGIN + 14 * px, "font-size": AXIS.size * px }, `${value}`));
    }
    for (const value of this.upNumbers()) {
      const [, y] = this.at([left, value]);
      this.ground.append(svg("line", { class: "grid", x1: -MARGIN, x2: width + MARGIN, y1: y, y2: y }),
        svg("text", { class: "axis", x: -MARGIN - 5 * px, y: y + 4 * px, "font-size": AXIS.size * px }, `${value}`));
    }
  }

  /** The width of the widest number below the map. */
  widestAcross() {
    const numbers = roundNumbers(place.low[0], place.low[0] + place.size[0], 5);
    return Math.max(...numbers.map((value) => textWidth(`${value}`, AXIS.size)));
  }

  /** The numbers at the left. */
  upNumbers() {
    return roundNumbers(place.low[1], place.low[1] + place.size[1], place.size[1] < place.size[0] / 2 ? 2 : 5);
  }

  /** Names of tasks that have room at this size, the others without. */
  drawLabels() {
    if (place.tasks.length > LABEL.most) return;
    const px = this.perPixel, size = LABEL.size, spots = place.tasks.map((task) => this.at(task).map((each) => each / px));
    const homes = place.robots.map((robot) => this.at(robot).map((each) => each / px));
    const box = (side) => ([x, y]) => [x - side, y - side, x + side, y + side];
    const names = place.task_names.map((name) => fitted(name, LABEL.longest, size, place.task_names));
    const radius = (6.5 * this.detail) / px;
    const frame = [-MARGIN, -MARGIN, this.size[0] + 2 * MARGIN, this.size[1] + 2 * MARGIN].map((each) => each / px);
    const found = placesOfLabels(spots, names, size, radius + 0.5, [...spots.map(box(radius)), ...homes.map(box(5 / px))],
      frame);
    this.labels.replaceChildren(...found.flatMap((spot, task) => spot && names[task] ? [svg("text", { x: spot[0] * px,
      y: spot[1] * px, "font-size": size * px, "stroke-width": 2.5 * px, "data-task": task }, names[task])] : []));
  }

  task([x, y, deadline, work], task) {
    const [left, top] = this.at([x, y]);
    const mark = this.add("g", { class: "task", "data-task": task,
      transform: `translate(${left} ${top}) scale(${this.detail})` });
    mark.append(svg("circle", {}), svg("path", { d: "M-4 -4 4 4M-4 4 4 -4" }),
      svg("title", {}, `task ${place.task_names[task]}: due ${number(deadline)}, work ${work}`));
    mark.addEventListener("pointerenter", () => this.onLook(task));
    mark.addEventListener("pointerleave", () => this.onLook(null));
    return mark;
  }

  robot([, , capacity, speed], robot) {
    const mark = this.add("g", { class: "robot", "data-robot": robot });
    mark.append(svg("circle", { r: many ? 8.5 : 11, fill: robotColour(robot) }),
      svg("text", { y: many ? 3 : 4, "font-size": many ? 8.5 : 12 }, `${robot}`),
      svg("title", {}, `${place.robot_names[robot]}: capacity ${capacity}, speed ${speed}`));
    return mark;
  }

  /**
   * Show a moment.
   * taken: for each robot the visits it has decided on; acting: a robot or -1; looked: a task or null.
   */
  draw(time, taken, acting, looked) {
    const by = new Map(); // who took a task, and the visit
    taken.forEach((visits, robot) => visits.forEach((visit) => by.set(visit[0], { robot, visit })));
    this.tasks.forEach((mark, task) => dress(mark, ...taskLook(task, by.get(task), time)));
    taken.forEach((visits, robot) => this.drawRobot(robot, visits, time));
    put(this.acting, acting >= 0 ? this.here(taken[acting], acting, time) : null);
    put(this.looked, looked === null ? null : this.at(place.tasks[looked]));
    if (acting >= 0) this.svg.append(this.acting, this.robots[acting]); // on top
  }

  /** Where a robot is, in the SVG's units: on the straight line to its last task, or there. */
  here(visits, robot, time) {
    if (visits.length === 0) return this.at(place.robots[robot]);
    const [task, , leave, arrive] = visits.at(-1);
    const to = this.at(place.tasks[task]);
    if (time >= arrive) return to;
    const from = this.at(visits.length > 1 ? place.tasks[visits.at(-2)[0]] : place.robots[robot]);
    const share = (time - leave) / (arrive - leave);
    return [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])];
  }

  drawRobot(robot, visits, time) {
    const here = this.here(visits, robot, time);
    put(this.robots[robot], here);
    const before = [place.robots[robot], ...visits.slice(0, -1).map((visit) => place.tasks[visit[0]])].map(this.at);
    const trail = [...(many ? before.slice(-RECENT) : before), here];
    this.trails[robot].setAttribute("points", trail.map((point) => point.map(Math.round).join()).join(" "));
    const to = visits.length > 0 ? this.at(place.tasks[visits.at(-1)[0]]) : here;
    [["x1", here[0]], ["y1", here[1]], ["x2", to[0]], ["y2", to[1]]].forEach(([end, value]) =>
      this.ahead[robot].setAttribute(end, value));
  }

  /** Show all of it, as large as there is room. */
  reset() {
    this.width = this.box.clientWidth;
    const high = this.svg.clientHeight || 1, [width, height] = this.size.map((each) => each + 2 * MARGIN);
    const beside = Math.max(...this.upNumbers().map((value) => textWidth(`${value}`, AXIS.size))) + 8;
    const beyond = this.widestAcross() / 2;
    const px = Math.max(width / Math.max(this.width - beside - beyond, 10), height / Math.max(high - AXIS.below, 10));
    const spare = (this.width * px - width - (beside + beyond) * px) / 2;
    this.show([-MARGIN - beside * px - spare, -MARGIN, this.width * px, high * px]);
  }

  show(view) {
    const { perPixel } = this;
    this.view = view;
    this.perPixel = view[2] / Math.max(this.width, 1);
    this.svg.setAttribute("viewBox", view.join(" "));
    if (perPixel === this.perPixel) return;
    this.drawGround();
    this.drawLabels();
  }

  listen() {
    this.svg.addEventListener("wheel", (event) => {
      event.preventDefault();
      const zoom = event.deltaY < 0 ? 0.8 : 1.25, { x, y } = this.svg.getBoundingClientRect();
      const pointer = [event.clientX - x, event.clientY - y].map((value, axis) => this.view[axis] + this.perPixel * value);
      this.show(this.view.map((value, part) => part < 2 ? pointer[part] + zoom * (value - pointer[part]) : zoom * value));
    }, { passive: false });
    this.svg.addEventListener("pointermove", (event) => {
      if (event.buttons !== 1) return;
      const [left, top, ...size] = this.view;
      this.show([left - this.perPixel * event.movementX, top - this.perPixel * event.movementY, ...size]);
    });
    this.svg.addEventListener("dblclick", () => this.reset());
  }
}

/** How a task looks, as class, radius, fill and edge. */
function taskLook(task, taken, time) {
  const deadline = place.tasks[task][2];
  if (taken && time < taken.visit[4]) return ["assigned", 7, "white", robotColour(taken.robot)];
  if (taken && taken.visit[5]) return ["completed", 5, robotColour(taken.robot), "white"];
  if (taken || deadline < time) return ["missed", 0, "none", "none"];
  return ["active", 6.5, urgency((deadline - time) / horizon), colours.faint];
}

function dress(mark, status, radius, fill, edge) {
  const look = `${status} ${fill} ${edge}`;
  if (mark.look === look) return; // most tasks stay as they are from one picture to the next
  mark.look = look;
  mark.setAttribute("class", `task ${status}`);
  for (const [name, value] of Object.entries({ r: radius, fill, stroke: edge })) mark.firstChild.setAttribute(name, value);
}

function put(mark, point) {
  mark.setAttribute("visibility", point ? "visible" : "hidden");
  if (point) mark.setAttribute("transform", `translate(${point[0]} ${point[1]})`);
}
