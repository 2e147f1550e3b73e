"use strict";
// SVG, and where text has room in it.
const FONT = 'system-ui, "Segoe UI", "DejaVu Sans", sans-serif';
const SHORTEST = 5; // letters that a name must keep, with the mark of what is missing, if no part of it tells it from others
const AROUND = [[1, -1], [1, 1], [-1, -1], [-1, 1], [1, 0], [-1, 0], [0, -1], [0, 1]]; // of a mark: the first choice first

function svg(tag, attributes, text = "") {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  if (text) made.textContent = text;
  return made;
}

const measure = document.createElement("canvas").getContext("2d");
const widths = new Map();
function textWidth(text, size) {
  const key = `${size} ${text}`;
  if (!widths.has(key)) {
    measure.font = `${size}px ${FONT}`;
    widths.set(key, measure.measureText(text).width);
  }
  return widths.get(key);
}

/**
 * A text if there is room; else what tells it from the others that are shown with it, after as much of its beginning as
 * there is room for; where that is all of it, its ends; else "". Digits alone are never cut. See mrta_zoo/show/shortened.py.
 */
function fitted(text, room, size, among = []) {
  const fits = (form) => textWidth(form, size) <= room, ended = (tail) => tail.replace(/^\p{M}+/u, "").trimStart();
  if (fits(text)) return text;
  if (/^\d+$/.test(text)) return "";
  const letters = [...text], count = letters.length, part = (from, to) => letters.slice(from, to).join("");
  const parts = (telling(among).get(text) ?? []).filter(([low, high]) => high - low < count);
  for (const [low, high] of parts) {
    const form = (kept) => (kept >= low ? part(0, low) : `${part(0, kept).trimEnd()}…`) + part(low, high) +
      (kept >= low + count - high ? part(high) : `…${ended(part(count - Math.max(kept - low, 0)))}`);
    const kept = most(count, 0, (kept) => fits(form(kept)));
    if (kept >= 0) return form(kept);
  }
  if (parts.length > 0 && parts.at(-1)[1] - parts.at(-1)[0] < SHORTEST) return ""; // one would be as good as another
  const ends = (kept) => `${part(0, Math.ceil(kept / 2)).trimEnd()}…${ended(part(count - Math.floor(kept / 2)))}`;
  const kept = most(count, SHORTEST - 1, (kept) => fits(ends(kept)));
  return kept >= 0 ? ends(kept) : "";
}

/** The largest number from `least` on, below `end`, that fits, -1 if none does. */
function most(end, least, fits) {
  let found = least - 1, tooMany = Math.max(end, least); // halved until they meet
  while (tooMany - found > 1) {
    const middle = Math.floor((found + tooMany) / 2);
    if (fits(middle)) found = middle; else tooMany = middle;
  }
  return found >= least ? found : -1;
}

const NUMBER = /\d+(?:[.,:]\d+)*/gu, WORD = /\d+(?:[.,:]\d+)*|[\p{L}\p{M}_]+/gu;
const told = new Map();
/** Of each name, the part that no other one has at its place: in whole words, and as short as can be. */
function telling(names) {
  if (!told.has(names)) {
    const turned = (name) => [...name].reverse().join(""), before = alike(names), after = alike(names.map(turned));
    told.set(names, new Map(names.map((name) => {
      const length = [...name].length, first = before.get(name), last = length - 1 - after.get(turned(name));
      const part = [Math.max(0, Math.min(first, last)), Math.min(length, Math.max(first, last) + 1)];
      return [name, [whole(name, ...part, WORD), whole(name, ...part, NUMBER)]];
    })));
  }
  return told.get(names);
}

/** How many letters each has in common with another one at their beginnings, at most. */
function alike(names) {
  const ordered = [...new Set(names)].sort().map((name) => [name, [...name]]);
  const common = ordered.slice(1).map(([, letters], index) => {
    const other = ordered[index][1], differs = letters.findIndex((letter, place) => letter !== other[place]);
    return differs < 0 ? letters.length : differs;
  });
  return new Map(ordered.map(([name], index) => [name, Math.max(common[index - 1] ?? 0, common[index] ?? 0)]));
}

/** A part with all of the words or numbers that it begins and ends in, without blanks around it. */
function whole(name, low, high, unit) {
  const letters = [...name];
  while (low < high && !letters[low].trim()) low += 1;
  while (low < high && !letters[high - 1].trim()) high -= 1;
  const spans = [...name.matchAll(unit)].map(({ 0: found, index }) => {
    const start = [...name.slice(0, index)].length;
    return [start, start + [...found].length];
  });
  return [spans.find(([start, stop]) => start <= low && low < stop)?.[0] ?? low,
    spans.find(([start, stop]) => start < high && high <= stop)?.[1] ?? high];
}

/** Where texts lie beside marks so that none covers another, a mark or the frame: left end and base line, or null. */
function placesOfLabels(marks, texts, size, gap, clear, [left, top, width, height]) {
  const taken = [...clear];
  return marks.map(([x, y], index) => {
    const wide = textWidth(texts[index], size), high = 0.75 * size;
    for (const [right, down] of AROUND) {
      const apart = right && down ? gap : gap + 2;
      const a = x + (right > 0 ? apart : right < 0 ? -apart - wide : -wide / 2);
      const b = y + (down > 0 ? apart - 1 : down < 0 ? 1 - apart - high : -high / 2);
      const inside = a >= left && b >= top && a + wide <= left + width && b + high <= top + height;
      if (!inside || taken.some((other) => a < other[2] && a + wide > other[0] && b < other[3] && b + high > other[1]))
        continue;
      taken.push([a, b, a + wide, b + high]);
      return [a, b + high];
    }
    return null;
  });
}

/** Round numbers within a range, some `about` of them. */
function roundNumbers(low, high, about) {
  const power = 10 ** Math.floor(Math.log10((high - low) / about));
  const step = power * ([1, 2, 5].find((each) => (high - low) / (each * power) <= about) ?? 10);
  const first = Math.ceil(low / step - 1e-6), last = Math.floor(high / step + 1e-6);
  return Array.from({ length: last - first + 1 }, (_, index) => Number(((first + index) * step).toPrecision(15)));
}
