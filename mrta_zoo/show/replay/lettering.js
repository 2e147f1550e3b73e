"use strict";
// SVG, and where text has room in it.
const FONT = 'system-ui, "Segoe UI", "DejaVu Sans", sans-serif';
const SHORTEST = 5; // letters that a shortened name must keep, the mark of what is missing included, to be worth showing
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

/** A text if there is room; else shortened in the middle, as its ends tell names apart; else "". Digits are never cut. */
function fitted(text, room, size) {
  if (textWidth(text, size) <= room) return text;
  const letters = [...text];
  if (/^\d+$/.test(text) || letters.length <= SHORTEST) return "";
  const shortened = (kept) => {
    const end = Math.floor(kept / 2);
    return `${letters.slice(0, kept - end).join("")}…${letters.slice(letters.length - end).join("")}`;
  };
  let fits = SHORTEST - 2, tooMany = letters.length; // halved until they meet
  while (tooMany - fits > 1) {
    const kept = Math.floor((fits + tooMany) / 2);
    if (textWidth(shortened(kept), size) <= room) fits = kept; else tooMany = kept;
  }
  return fits >= SHORTEST - 1 ? shortened(fits) : "";
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
