"use strict";
// Drawings in SVG from numbers. `about` has the facts of the page. A filter inverts the inks on a dark page.

const INK = "#222";
const FAINT = "#8a8a8a";
const DASHED = { stroke: FAINT, "stroke-width": 0.7, "stroke-dasharray": "3 3" };
const LABEL_ROWS = 3; // above the axes of orders
const OVER_ORDERS = { xTitle: "order of the shaft", above: 10 + 12 * LABEL_ROWS, height: 242 };

const byId = (id) => document.getElementById(id);

function addHtml(parent, tag, properties = {}) {
  const made = Object.assign(document.createElement(tag), properties);
  parent.append(made);
  return made;
}

function add(parent, tag, attributes) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  parent.append(made);
  return made;
}

const addPath = (plot, d, attributes) => add(plot.svg, "path", { d, fill: "none", stroke: INK, ...attributes });

function addText(plot, text, attributes) {
  add(plot.svg, "text", { fill: "currentColor", "text-anchor": "middle", ...attributes }).textContent = text;
}

function addBand(plot, low, high, fill, opacity) {
  const from = plot.at(low);
  const place = { x: from, y: plot.top, width: plot.at(high) - from, height: plot.bottom - plot.top };
  add(plot.svg, "rect", { ...place, fill, "fill-opacity": opacity });
}

function addLine(plot, points) {
  const places = points.map(([x, y]) => `${plot.at(x)} ${plot.up(y)}`);
  addPath(plot, `M${places.join("L")}`, { "stroke-width": 0.9, "stroke-linejoin": "round" });
}

function scale([low, high], from, to, log) {
  const of = log ? Math.log10 : (value) => value;
  const span = of(high) - of(low) || 1;
  return (value) => +(from + ((of(value) - of(low)) / span) * (to - from)).toFixed(2);
}

function ticks([low, high], log, count) {
  if (log) {
    const powers = [];
    for (let power = Math.ceil(Math.log10(low)); power <= Math.log10(high); power++) powers.push(+`1e${power}`);
    if (powers.length > 1) return powers;
  }
  const rough = (high - low) / count || 1;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((one) => one * power >= rough);
  const found = [];
  const first = Math.ceil(low / step - 1e-9);
  for (let k = first; k * step <= high + 1e-9 * step; k++) found.push(+(k * step).toPrecision(6));
  return found.length > 1 || count > 20 ? found : ticks([low, high], log, 2 * count);
}

// Empty axes in a figure: `at` and `up` give the place of a value across and upwards.
function axes(id, title, { x, y, xTitle, yTitle, height = 190, above = 10, logX = false, logY = false }) {
  const figure = byId(id);
  const width = Math.max(240, figure.clientWidth);
  const [left, right, top, bottom] = [62, width - 12, above, height - 36];
  figure.replaceChildren();
  if (title) addHtml(figure, "h3", { textContent: title });
  const told = title || `${yTitle} against ${xTitle}`;
  const svg = add(figure, "svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": told });
  const plot = { svg, left, top, bottom, at: scale(x, left, right, logX), up: scale(y, bottom, top, logY) };
  for (const tick of ticks(x, logX, width / 90)) {
    addPath(plot, `M${plot.at(tick)} ${bottom}v4`, { stroke: FAINT });
    addText(plot, tick, { x: plot.at(tick), y: bottom + 15 });
  }
  for (const tick of ticks(y, logY, height / 50)) {
    addPath(plot, `M${left} ${plot.up(tick)}h-4`, { stroke: FAINT });
    const text = Math.abs(tick) >= 1e5 ? tick.toExponential(0) : tick;
    addText(plot, text, { x: left - 6, y: plot.up(tick) + 4, "text-anchor": "end" });
  }
  addPath(plot, `M${left} ${top}V${bottom}H${right}`, { stroke: FAINT });
  addText(plot, xTitle, { x: (left + right) / 2, y: height - 6 });
  const middle = (top + bottom) / 2;
  addText(plot, yTitle, { x: 12, y: middle, transform: `rotate(-90 12 ${middle})` });
  return plot;
}

// Lines of the fault with their sidebands, and the fundamental lines of the others, up to the last order.
function addCursors(plot, fault, nominal, last) {
  const { colour, lines, side } = about.classes[fault];
  const place = ([, base, multiple]) => multiple * nominal[base];
  const own = new Set(lines.map(([label]) => label));
  const all = [...lines, ...about.compared.filter(([label]) => !own.has(label))];
  const drawn = all.filter((one) => place(one) < last).sort((one, other) => place(one) - place(other));
  const rule = (order, look) => addPath(plot, `M${plot.at(order)} ${plot.top}V${plot.bottom}`, look);
  const ends = Array(LABEL_ROWS).fill(-Infinity); // of the labels in each row
  for (const one of drawn) {
    const [label] = one;
    const order = place(one);
    if (own.has(label)) {
      addBand(plot, order * (1 - about.tolerance), Math.min(last, order * (1 + about.tolerance)), colour, 0.25);
      const beside = side ? [order - nominal[side], order + nominal[side]] : [];
      const visible = beside.filter((found) => found > 0 && found < last);
      visible.forEach((found) => rule(found, { stroke: colour, "stroke-dasharray": "1 3" }));
    } else rule(order, DASHED);
    const half = 3.4 * label.length + 3;
    const fits = ends.findIndex((end) => plot.at(order) - half > end);
    const row = fits < 0 ? ends.indexOf(Math.min(...ends)) : fits;
    ends[row] = plot.at(order) + half;
    const weight = own.has(label) ? "bold" : "normal";
    addText(plot, label, { x: plot.at(order), y: plot.top - 4 - 12 * row, "font-weight": weight });
  }
}

function drawWaveform({ peak, seconds, lowest, highest }) {
  const facts = { x: [0, seconds], y: [-1.05 * peak, 1.05 * peak], xTitle: "time [s]", yTitle: "acceleration [m/s²]" };
  const plot = axes("waveform", `Waveform, first ${seconds.toPrecision(2)} s`, facts);
  const ends = (low, k) => [low, highest[k]].map((value) => [(k * seconds) / lowest.length, (value / 127) * peak]);
  addLine(plot, [...lowest].flatMap(ends));
}

function drawDensity({ density, highest_db: highest }) {
  const half = about.fs / 2000;
  const levels = [...density].map((step) => highest - step * about.step_db);
  const range = { x: [0, half], y: [Math.min(...levels), highest + 2] };
  const facts = { ...range, xTitle: "frequency [kHz]", yTitle: "dB re 1 (m/s²)²/Hz" };
  const plot = axes("density", "Power spectral density", facts);
  const [low, high] = about.band.map((edge) => Math.min(edge / 1000, half));
  addBand(plot, low, high, FAINT, 0.15);
  addLine(plot, levels.map((level, k) => [((k + 0.5) * half) / levels.length, level]));
}

function drawEnvelope({ envelope, last_order: last }, fault, nominal) {
  const levels = [...envelope].map((step) => step * about.step_db);
  const range = { x: [0, last], y: [0, Math.max(20, ...levels) + 2] };
  const facts = { ...range, ...OVER_ORDERS, yTitle: "dB above the median" };
  const plot = axes("envelope", "Squared envelope spectrum", facts);
  addCursors(plot, fault, nominal, last);
  addLine(plot, levels.map((level, k) => [((k + 0.5) * last) / levels.length, level]));
}

function drawWaterfall(arrays, fault, nominal) {
  const { waterfall, rows, first_time: first, last_time: end, last_order: last, seconds } = arrays;
  const margin = rows > 1 ? (end - first) / 2 / (rows - 1) : seconds / 2;
  const range = { x: [0, last], y: [first - margin, end + margin] };
  const plot = axes("waterfall", "Envelope spectrum over time", { ...range, ...OVER_ORDERS, yTitle: "time [s]" });
  addCursors(plot, fault, nominal, last);
  const width = (plot.at(last) - plot.at(0)) / about.cells;
  const height = (plot.bottom - plot.top) / rows;
  const box = `h${width.toFixed(2)}v${height.toFixed(2)}h-${width.toFixed(2)}z`;
  const paths = []; // one for each shade
  for (let cell = 0; cell < rows * about.cells; cell++) {
    const shade = (waterfall[cell >> 1] >> (4 * (cell % 2))) & 15;
    const x = plot.left + (cell % about.cells) * width;
    const y = plot.bottom - Math.floor(cell / about.cells + 1) * height;
    if (shade) (paths[shade] ??= []).push(`M${x.toFixed(1)} ${y.toFixed(1)}${box}`);
  }
  paths.forEach((path, shade) => {
    const look = { fill: INK, stroke: "none", "fill-opacity": shade / about.shades, "shape-rendering": "crispEdges" };
    addPath(plot, path.join(""), look);
  });
}

// Range of an axis.
function rangeOf(values, rows, log) {
  let [low, high] = [Infinity, -Infinity];
  for (const row of rows) [low, high] = [Math.min(low, values[row]), Math.max(high, values[row])];
  if (!rows.length) return [1, 2];
  if (log) return [low / 1.1, high * 1.1];
  const rim = 0.03 * (high - low) || 0.05 * Math.abs(high) || 1;
  return [low - rim, high + rim];
}

// Records over two quantities; the result draws a ring around a record, and finds the record nearest to a click.
function drawScatter(across, upwards, faults, rows, titles, [logX, logY]) {
  const fits = (value, log) => Number.isFinite(value) && (!log || value > 0);
  const drawn = rows.filter((row) => fits(across[row], logX) && fits(upwards[row], logY));
  const [x, y] = [rangeOf(across, drawn, logX), rangeOf(upwards, drawn, logY)];
  const height = Math.max(260, Math.round(0.75 * byId("scatter").clientWidth));
  const plot = axes("scatter", "", { x, y, logX, logY, xTitle: titles[0], yTitle: titles[1], height });
  const paths = {};
  for (const row of drawn) (paths[faults[row]] ??= []).push(`M${plot.at(across[row])} ${plot.up(upwards[row])}h0`);
  const size = { "stroke-width": drawn.length > 2000 ? 3 : 6, "stroke-linecap": "round", "stroke-opacity": 0.75 };
  for (const [fault, path] of Object.entries(paths)) {
    addPath(plot, path.join(""), { stroke: about.classes[fault].colour, ...size });
  }
  const ring = add(plot.svg, "circle", { r: 7, fill: "none", stroke: INK, "stroke-width": 2 });
  const places = new Map(drawn.map((row) => [row, [plot.at(across[row]), plot.up(upwards[row])]]));
  return {
    svg: plot.svg,
    drawn: drawn.length,
    mark(row) {
      const [cx, cy] = places.get(row) ?? [-99, -99];
      ring.setAttribute("cx", cx);
      ring.setAttribute("cy", cy);
    },
    nearest({ clientX, clientY }) {
      const box = plot.svg.getBoundingClientRect();
      const ratio = plot.svg.viewBox.baseVal.width / box.width;
      const away = ([x, y]) => Math.hypot(x - (clientX - box.left) * ratio, y - (clientY - box.top) * ratio);
      const nearer = (best, row) => (away(places.get(row)) < away(places.get(best)) ? row : best);
      return drawn.length ? drawn.reduce(nearer) : null;
    },
  };
}
