// Choice of records, and the chosen record. Texts of the corpus become textContent and attribute values only.
// Parts of the page are inflated when they are needed: a quantity or a block of records when it is shown.

const KEPT = 24; // blocks in memory
const ROLES = { operating: true, label: true, feature: false, latent: false, provenance: false }; // open at first?
const COMPARE = {
  "==": (a, b) => a === b,
  "!=": (a, b) => a !== b,
  "<": (a, b) => a < b,
  "<=": (a, b) => a <= b,
  ">": (a, b) => a > b,
  ">=": (a, b) => a >= b,
};
const KEYS = { ArrowLeft: () => step(-1), ArrowRight: () => step(1), "/": () => byId("condition").focus() };

let about;
let numbers; // of the quantities among the parts, by name
let columns; // quantity and unit of the columns of conditions, by name
let shown = []; // rows that the filter leaves, in the chosen order
let current = 0; // row of the shown record
let scatter;
let choices = 0;
const inflated = new Map();

async function inflate(id) {
  const isThere = () => byId(id)?.nextElementSibling || document.readyState !== "loading";
  while (!isThere()) await new Promise((go) => setTimeout(go, 5));
  const packed = Uint8Array.from(atob(byId(id).textContent), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate")));
}

function keep(id, read) {
  if (!inflated.has(id)) inflated.set(id, inflate(id).then(read));
  const blocks = [...inflated.keys()].filter((key) => !key.startsWith("quantity"));
  if (blocks.length > KEPT) inflated.delete(blocks[0]);
  return inflated.get(id);
}

// Values of a quantity by row; NaN where there is none.
function valuesOf(name) {
  return keep(`quantity${numbers[name]}`, async (part) => (await part.json()).map((value) => value ?? NaN));
}

async function arraysOf(row) {
  const place = row % about.block;
  const rows = Math.min(about.block, about.records - row + place); // of the block
  const buffer = await keep(`block${Math.floor(row / about.block)}`, (part) => part.arrayBuffer());
  const types = { float32: Float32Array, int8: Int8Array, uint8: Uint8Array };
  const arrays = {};
  let start = 0;
  for (const [name, type, size] of about.fields) {
    const all = new types[type](buffer, start, rows * size);
    arrays[name] = all.subarray(place * size, (place + 1) * size);
    start += all.byteLength;
  }
  about.scales.forEach((name, number) => (arrays[name] = arrays.scales[number]));
  return arrays;
}

async function drawRecord(row) {
  const names = ["record", "fault", "shaft_rate", "ftf", "bpfo", "bpfi", "bsf"];
  const [arrays, ...columns] = await Promise.all([arraysOf(row), ...names.map(valuesOf)]);
  if (row !== current) return; // another record was chosen meanwhile
  const [record, fault, rate, ftf, bpfo, bpfi, bsf] = columns.map((values) => values[row]);
  const speed = Number.isNaN(rate) ? "" : `, ${Math.round(60 * rate)} rpm`;
  byId("name").textContent = `Record ${record}: ${fault}${speed}`;
  const undrawn = Number.isNaN(arrays.peak);
  byId("undrawn").hidden = !undrawn;
  document.querySelector(".plots").hidden = undrawn;
  if (undrawn) return;
  const nominal = { shaft: 1, ftf, bpfo, bpfi, bsf };
  drawWaveform(arrays);
  drawDensity(arrays);
  drawEnvelope(arrays, fault, nominal);
  drawWaterfall(arrays, fault, nominal);
}

// Number with four digits, or with all before the point.
const brief = (value) => (Math.abs(value) < 1000 ? +value.toPrecision(4) : Math.round(value));

// Values of the record in the units that people read, with the stored values beside them.
async function tellLabels(row) {
  for (const { name, unit, numeric, shown_unit: shownUnit, factor } of about.quantities) {
    const cell = byId(`value_${name}`);
    if (!cell.closest("details").open) continue;
    const value = (await valuesOf(name))[row];
    if (row !== current) return;
    const known = !Number.isNaN(value);
    cell.textContent = !known ? "–" : numeric ? brief(value / factor) : value;
    cell.nextElementSibling.textContent = shownUnit;
    cell.parentElement.querySelector("small").textContent = known && unit !== shownUnit ? `${brief(value)} ${unit}` : "";
  }
}

// Allowed name that differs from a wrong one in the fewest letters.
function nearestName(wrong) {
  const distance = (one, other) => {
    let row = [...Array(other.length + 1).keys()];
    for (const [k, letter] of [...one].entries()) {
      const next = [k + 1];
      for (const [n, found] of [...other].entries())
        next.push(Math.min(row[n] + (letter !== found), row[n + 1] + 1, next[n] + 1));
      row = next;
    }
    return row.at(-1);
  };
  const names = Object.keys(columns);
  return names.reduce((best, name) => (distance(wrong, name) < distance(wrong, best) ? name : best));
}

// Tests of a condition such as "width_mm > 0.5 and split == 'train'", a part of the language of the command line.
async function conditions(text) {
  const tests = [];
  for (const part of text.split(/\band\b/).map((one) => one.trim()).filter(Boolean)) {
    const found = /^(\w+)\s*(==|!=|<=|>=|<|>)\s*(?:'([^']*)'|"([^"]*)"|([-+.\deE]+))$/.exec(part);
    if (!found) throw new Error(`${part}: write a column, a sign and a number or a text in quotes, such as width_mm > 0.5.`);
    const [, column, sign, single, double, number] = found;
    const [name, factor] = columns[column] ?? [];
    if (!name) throw new Error(`${column}: no such column; the nearest is ${nearestName(column)}.`);
    const { numeric } = quantity(name);
    if (numeric !== (number !== undefined) || Number.isNaN(Number(number ?? 0))) {
      throw new Error(`${part}: ${column} has ${numeric ? "numbers" : "text; put it in quotes"}.`);
    }
    const values = await valuesOf(name);
    // rounded as on the command line, so that 0.3 mm equals 0.3
    const read = numeric && factor !== 1 ? (row) => +(values[row] / factor).toFixed(9) : (row) => values[row];
    const against = numeric ? +number : (single ?? double);
    tests.push((row) => !Number.isNaN(values[row]) && COMPARE[sign](read(row), against));
  }
  return tests;
}

// Sentence of the command line on a condition that no record meets: a unit is easily mistaken.
function noneMeets(condition) {
  const words = (condition.match(/[A-Za-z_]\w*/g) ?? []).filter((word) => word in columns);
  const named = [...new Set(words.map((word) => columns[word][0]))].filter((name) => quantity(name).range);
  const ranges = named.map((name) => `${name} is ${quantity(name).range}`).join(", ");
  return `where '${condition}': none of ${about.records} records is chosen; choose others${ranges && ` (${ranges})`}.`;
}

function withinRange(axis, values) {
  const [from, to] = ["from", "to"].map((end) => byId(`${axis}_${end}`).value);
  return (row) => (from === "" || values[row] >= +from) && (to === "" || values[row] <= +to);
}

// Filter and sort the records, and draw those that are left.
async function choose() {
  const turn = ++choices;
  const quantities = [byId("x").value, byId("y").value];
  const [across, upwards, faults] = await Promise.all([...quantities.map(shownValues), valuesOf("fault")]);
  const classes = new Set([...document.querySelectorAll("#classes input:checked")].map((box) => box.value));
  const tests = [(row) => classes.has(faults[row]), withinRange("x", across), withinRange("y", upwards)];
  let complaint = "";
  try {
    const condition = byId("condition").value;
    const further = await conditions(condition);
    if (!faults.some((_, row) => further.every((test) => test(row)))) complaint = noneMeets(condition);
    tests.push(...further);
  } catch (error) {
    complaint = error.message;
  }
  if (turn !== choices) return; // the choice was changed meanwhile
  shown = [...faults.keys()].filter((row) => tests.every((test) => test(row)));
  const sorted = { x: across, y: upwards }[byId("order").value];
  const key = (row) => (Number.isNaN(sorted[row]) ? Infinity : sorted[row]);
  if (sorted) shown.sort((one, other) => key(one) - key(other) || one - other);
  const logs = [byId("x_log").checked, byId("y_log").checked];
  scatter = drawScatter(across, upwards, faults, shown, quantities.map(titleOf), logs);
  scatter.svg.addEventListener("click", (event) => show(scatter.nearest(event) ?? current));
  const lacking = shown.length - scatter.drawn;
  const note = lacking ? `, ${lacking} of them without a value to draw` : "";
  byId("complaint").textContent = complaint;
  byId("count").textContent = `${shown.length} of ${about.records} records${note}.`;
  show(shown.includes(current) || !shown.length ? current : shown[0]);
}

function show(row) {
  current = row;
  history.replaceState(null, "", `#${row}`);
  scatter.mark(row);
  drawRecord(row);
  tellLabels(row);
}

function step(by) {
  const place = shown.indexOf(current) + by;
  if (place >= 0 && place < shown.length) show(shown[place]);
}

function quantity(name) {
  return about.quantities[numbers[name]];
}

async function shownValues(name) {
  const { factor } = quantity(name);
  return (await valuesOf(name)).map((value) => value / factor);
}

function titleOf(name) {
  const { shown_unit: unit } = quantity(name);
  return unit ? `${name} [${unit}]` : name;
}

function makeClasses(faults) {
  for (const [value, { colour }] of Object.entries(about.classes)) {
    const count = faults.filter((fault) => fault === value).length;
    if (!count) continue;
    const label = addHtml(byId("classes"), "label");
    addHtml(label, "input", { type: "checkbox", value, checked: true });
    addHtml(label, "span", { className: "swatch" }).style.background = colour;
    label.append(`${value} (${count})`);
  }
}

function makeAxis(axis, first) {
  for (const role of Object.keys(ROLES)) {
    const names = about.quantities.filter((one) => one.role === role && one.numeric).map((one) => one.name);
    const group = addHtml(byId(axis), "optgroup", { label: role, hidden: !names.length });
    group.append(...names.map((name) => new Option(titleOf(name), name)));
  }
  byId(axis).value = first;
  byId(axis).addEventListener("change", () => (byId(`${axis}_from`).value = byId(`${axis}_to`).value = ""));
}

function makeLabels() {
  for (const [role, open] of Object.entries(ROLES)) {
    const rows = about.quantities.filter((one) => one.role === role);
    if (!rows.length) continue;
    const details = addHtml(byId("labels"), "details", { open });
    addHtml(details, "summary", { textContent: `${role} (${rows.length})` });
    details.addEventListener("toggle", () => tellLabels(current));
    const table = addHtml(details, "table");
    for (const { name, meaning, numeric } of rows) {
      const row = Object.assign(table.insertRow(), { title: meaning, className: numeric ? "" : "text" });
      const head = addHtml(row, "th", { scope: "row" });
      // a long name is parted between its words
      for (const word of name.split(/(?<=_)/)) head.append(word, document.createElement("wbr"));
      row.insertCell().id = `value_${name}`;
      row.insertCell();
      addHtml(row.insertCell(), "small");
    }
  }
}

function onKey(event) {
  const writing = event.target.matches("select, input:not([type=checkbox])");
  if (writing && event.key === "Escape") event.target.blur();
  if (writing || event.ctrlKey || event.altKey || event.metaKey || !(event.key in KEYS)) return;
  event.preventDefault();
  KEYS[event.key]();
}

async function start() {
  about = await (await inflate("about")).json();
  numbers = Object.fromEntries(about.quantities.map(({ name }, place) => [name, place]));
  columns = Object.fromEntries(
    about.quantities.flatMap((one) => Object.entries(one.columns).map(([key, factor]) => [key, [one.name, factor]])),
  );
  const faults = await valuesOf("fault");
  about.records = faults.length;
  makeClasses(faults);
  makeAxis("x", about.axes[0]);
  makeAxis("y", about.axes[1]);
  makeLabels();
  current = Math.min(about.records - 1, Number.parseInt(location.hash.slice(1), 10) || 0);
  document.querySelector("section").addEventListener("input", choose);
  byId("previous").addEventListener("click", () => step(-1));
  byId("next").addEventListener("click", () => step(1));
  document.addEventListener("keydown", onKey);
  let width = innerWidth;
  addEventListener("resize", () => {
    if (innerWidth !== width) choose();
    width = innerWidth;
  });
  await choose();
}

start();
