"use strict";
// The sides of the page, and the moment that they show.
const REASONS = ["to choose from", "taken", "deadline passed", "too late", "not there", "ruled out"]; // by rules.MaskReason
const GAP = 14, NAMES = 0.4; // around names and notes, in pixels; what names get of the room for both at least, as a share
const WHOLE_PLAY = 40; // seconds that an episode takes at speed 1

// The moment shown: a time and, for each side, the last decision made by then. Of several made at the same time, those
// after it are yet to be made. `side` is the one looked at last, `looked` the task pointed at in its table.
const moment = { time: 0, last: [], side: 0, looked: null };

class Side {
  constructor(index, episode) {
    this.index = index;
    this.episode = episode;
    this.times = episode.decisions.map((decision) => decision.time);
    this.visitOf = new Map(episode.routes.flat().map((visit) => [visit[1], visit])); // by decision
    const box = byId("side").content.cloneNode(true).firstElementChild;
    box.id = `side-${index}`;
    const part = (name) => box.querySelector(`.${name}`);
    document.querySelector("main").append(box);
    part("swatch").style.background = SIDE_COLOURS[index];
    part("method").textContent = episode.method;
    part("score").textContent = `${episode.completed} of ${place.tasks.length} completed, cost ` +
      `${episode.cost.toFixed(2)}, makespan ${number(episode.makespan)}`;
    this.now = part("now");
    this.decision = part("decision");
    this.decision.classList.toggle("certain", episode.decisions.every(({ candidates }) =>
      candidates.every((candidate) => candidate[5] === null)));
    const longest = Math.max(0, ...episode.decisions.map(({ candidates }) => candidates.length));
    this.decision.style.setProperty("--rows", longest); // so that nothing below moves from one decision to the next
    new ResizeObserver(() => { if (this.width !== this.decision.clientWidth) this.fitNames(); }).observe(this.decision);
    this.map = new MapView(part("map"), (task) => look(index, task));
    this.gantt = new Gantt(part("gantt"), episode.routes, (decision) => pick(index, decision), (task) => look(index, task));
    this.strip(byId("time").appendChild(element("div", "", { class: "strip", id: `strip-${index}` })));
  }

  /** A tick for each decision, under the slider. */
  strip(strip) {
    this.episode.decisions.forEach(({ time, robot }, index) => {
      strip.append(element("i", "", { style: `left: ${(100 * time) / end}%; background: ${robotColour(robot)}`,
        title: `decision ${index}: ${place.robot_names[robot]} at ${number(time)}` }));
    });
    strip.addEventListener("click", ({ clientX }) => { // ticks are thin: the nearest is meant
      const { left, width } = strip.getBoundingClientRect(), time = (end * (clientX - left)) / width;
      const distance = this.times.map((each) => Math.abs(each - time));
      if (distance.length > 0) pick(this.index, distance.indexOf(Math.min(...distance)));
    });
  }

  draw() {
    const last = moment.last[this.index], decision = this.episode.decisions[last];
    const taken = this.episode.routes.map((route) => route.filter((visit) => visit[1] <= last));
    const looked = moment.side === this.index ? moment.looked : null;
    this.map.draw(moment.time, taken, decision ? decision.robot : -1, looked);
    if (decision) this.gantt.mark(decision.robot, decision.time, this.visitOf.get(last)?.[4] ?? end);
    this.gantt.moveTo(moment.time);
    this.gantt.look(looked);
    const completed = taken.flat().filter((visit) => visit[5] && visit[4] <= moment.time).length;
    this.now.textContent = `${completed} completed by now`;
    if (this.shown !== last) this.drawDecision(last, decision);
    this.shown = last;
  }

  drawDecision(last, decision) {
    if (!decision) {
      this.decision.replaceChildren(element("p", "No decision has been made yet.", { class: "faint" }));
      return;
    }
    const what = decision.task === null ? "stays for good" : `takes task ${place.task_names[decision.task]}`;
    const advice = decision.advice === null ? "" :
      `; the policy would have taken task ${place.task_names[decision.advice]}`;
    const table = element("table"), head = element("tr"), body = element("tbody");
    const columns = { task: "name", probability: "words likely", distance: "wide", finish: "", due: "wide", slack: "",
      "": "words note" };
    for (const [name, kind] of Object.entries(columns)) head.append(element("th", name, { class: kind }));
    body.append(...decision.candidates.map((candidate) => this.row(candidate, decision)));
    table.append(head, body);
    const which = this.times.length > 1 ? `of 0–${this.times.length - 1}` : "(the only one)"; // they count from 0
    this.decision.replaceChildren(
      element("b", `Decision ${last} ${which}: ${place.robot_names[decision.robot]} ${what} at ` +
        `${number(decision.time)}${advice}`),
      element("p", decision.reasons.map((count, reason) => count && `${count} ${REASONS[reason]}`).filter(Boolean).join(", ") +
        `; ${decision.candidates.length} of them listed`, { class: "faint" }),
      table,
    );
    this.fitNames();
  }

  /** Names and notes share the room that numbers leave, and names that lack room are shortened. */
  fitNames() {
    this.width = this.decision.clientWidth;
    const rows = [...this.decision.querySelectorAll("tbody tr")], head = this.decision.querySelector("tr");
    if (rows.length === 0) return;
    const texts = [".name", ".note"].map((part) => rows.map((row) => row.querySelector(part)));
    const size = parseFloat(getComputedStyle(texts[0][0]).fontSize), bold = 1.1; // of what is chosen
    const longest = texts.map((cells, part) => bold * Math.max(...cells.map((cell) =>
      textWidth(part ? cell.textContent : cell.title, size))));
    const widths = (cells) => cells.map((cell) => cell.getBoundingClientRect().width).reduce((sum, width) => sum + width, 0);
    for (const cell of texts[0]) cell.textContent = "";
    this.decision.classList.add("numbers");
    const others = [...head.children].filter((cell) => !cell.matches(".name, .note"));
    const rest = this.width - widths(others) - 2 * GAP;
    this.decision.classList.remove("numbers");
    const room = Math.max(Math.min(longest[0], Math.max(NAMES * rest, rest - longest[1])), head.firstChild.textContent.length);
    for (const cell of texts[0]) cell.textContent = fitted(cell.title, room / bold, size, place.task_names) || "…";
  }

  row([task, distance, finish, reason, note, probability, percent], decision) {
    const due = place.tasks[task][2], chosen = task === decision.task;
    const notes = [task === decision.advice && "the policy's choice", note].filter(Boolean).join("; ");
    const row = element("tr", "", { class: chosen ? "chosen" : reason ? "barred" : "", "data-task": task });
    const likely = element("td", "", { class: "words likely" });
    if (probability !== null && !reason) {
      likely.textContent = `${percent} %`;
      likely.style.setProperty("--share", `${100 * probability}%`);
    }
    const name = place.task_names[task], cells = [["", "name"], null, [far(distance), "wide"],
      [number(finish), ""], [number(due), "wide"], [number(due - finish), ""], [notes, "words note"]];
    row.append(...cells.map((cell) => cell === null ? likely : element("td", cell[0], { class: cell[1] })));
    row.firstChild.title = name; // shortened by fitNames
    row.addEventListener("mouseenter", () => look(this.index, task));
    row.addEventListener("mouseleave", () => look(this.index, null));
    return row;
  }

  /** The last decision made at or before a time, -1 if there is none. */
  lastBy(time) {
    return this.times.findLastIndex((each) => each <= time);
  }
}

// What moves the moment.
function go(time) {
  moment.time = Math.min(Math.max(time, 0), end);
  moment.last = sides.map((side) => side.lastBy(moment.time));
  draw();
}
function pick(index, decision) {
  moment.time = sides[index].times[decision];
  moment.last = sides.map((side) => side.lastBy(moment.time));
  moment.last[index] = decision;
  moment.side = index;
  location.replace(`#${decision}/${index}`); // so that the address can be passed on
  draw();
}
/** To the decision before or after, on the side looked at last. */
function step(by) {
  const next = moment.last[moment.side] + by;
  if (next >= 0 && next < sides[moment.side].times.length) pick(moment.side, next);
}
/** Point at a task, on map and chart; null points at none. */
function look(index, task) {
  if (moment.side === index && moment.looked === task) return;
  moment.side = index;
  moment.looked = task;
  sides[index].draw();
}

let playing = null; // the time stamp of the last picture while playing
function play() {
  if (playing === null && moment.time >= end) go(0);
  playing = playing === null ? performance.now() : null;
  byId("play").textContent = playing === null ? "play" : "pause";
  if (playing !== null) requestAnimationFrame(animate);
}
function animate(stamp) {
  if (playing === null) return;
  go(moment.time + (Math.max(stamp - playing, 0) / 1000) * (end / WHOLE_PLAY) * Number(byId("speed").value));
  playing = stamp;
  if (moment.time >= end) play(); else requestAnimationFrame(animate);
}

function draw() {
  byId("slider").value = moment.time;
  byId("clock").textContent = `time ${number(moment.time)}`;
  for (const side of sides) side.draw();
  progress.moveTo(moment.time);
}

document.querySelector("h1").textContent = place.name;
byId("about").textContent = `${counted(place.tasks.length, "task")}, ` +
  `${counted(place.robots.length, "robot")}, mask rule ` +
  [...new Set(episodes.map((episode) => episode.mask_rule))].join(" and ") +
  `; cost by ${cost}`;
document.querySelector("main").className = `${episodes.length > 1 ? "pair" : ""} ${many ? "many" : ""}`;
const sides = episodes.map((episode, index) => new Side(index, episode));
const progress = new Progress(byId("progress"), episodes, go);
if (sides.some((side) => !side.gantt.lane)) byId("due").lastChild.textContent = " deadline: point at it to see of which task";
byId("slider").max = end;
byId("slider").addEventListener("input", ({ target }) => go(Number(target.value)));
byId("play").addEventListener("click", play);
byId("previous").addEventListener("click", () => step(-1));
byId("next").addEventListener("click", () => step(1));
document.addEventListener("keydown", (event) => {
  if (event.target.matches("input, select, button")) return; // they have uses of their own for these keys
  const action = { " ": play, ArrowLeft: () => step(-1), ArrowRight: () => step(1) }[event.key];
  if (action) { event.preventDefault(); action(); }
});
const [decision, side = 0] = location.hash.slice(1).split("/").map((part) => parseInt(part, 10));
const marked = episodes.findIndex((episode) => episode.decisions[episode.bookmark]);
if (episodes[side]?.decisions[decision]) pick(side, decision);
else if (marked >= 0) pick(marked, episodes[marked].bookmark);
else go(0);
