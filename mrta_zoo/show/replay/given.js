"use strict";
// What the page was given: the scenario (`place`) and one or two episodes of it. All times come from there; what is worked
// out here is only what holds at the moment shown. Maps are in map.js, charts in charts.js, what moves them in replay.js.
const { place, episodes, cost, colours } = JSON.parse(document.getElementById("data").textContent);
const SIDE_COLOURS = ["#1864ab", "#c2255c"];
const MANY_ROBOTS = 20; // with more there is less text, and trails are cut

// A name that is written from right to left is set apart, so that what follows it stays behind it.
const apart = (name) => /[\u0590-\u08ff\ufb1d-\ufefc]/.test(name) ? `\u2068${name}\u2069` : name;
for (const names of ["task_names", "robot_names"]) place[names] = place[names].map(apart);

const byId = (id) => document.getElementById(id);
const counted = (count, noun) => `${count} ${noun}${count === 1 ? "" : "s"}`;
const robotColour = (robot) => colours.robots[robot % colours.robots.length];
const { horizon, end } = place;
const written = (value, digits) => { // what is next to nothing is not nothing
  const text = value.toFixed(digits);
  return value === 0 || /[1-9]/.test(text) ? text : `${Number(value.toPrecision(1))}`;
};
const number = (time) => written(time, place.digits[0]), far = (distance) => written(distance, place.digits[1]);
const many = place.robots.length > MANY_ROBOTS;

function element(tag, text = "", attributes = {}) {
  const made = document.createElement(tag);
  made.textContent = text;
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}
