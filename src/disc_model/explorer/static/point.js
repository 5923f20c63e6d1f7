// Pointing at the map, and what is known of the chosen point.

function cellAt(canvas, event) {
  const { left, top } = canvas.getBoundingClientRect();
  const [px, py] = [event.clientX - left, event.clientY - top];
  const { box, horizontal, vertical, xs, ys } = drawn;
  if (px < box.left || px > box.right || py < box.top || py > box.bottom) return null;
  const inside = (scale, position, at) =>
    scale.at.findIndex((_, n) => {
      const ends = [position(scale.borders[n]), position(scale.borders[n + 1])];
      return at >= Math.min(...ends) && at <= Math.max(...ends);
    });
  const found = { ...view.place, [view.x]: inside(xs, horizontal, px) };
  return view.y === NONE ? found : { ...found, [view.y]: inside(ys, vertical, py) };
}

/** Where a point lies, in words. */
function where(place, dims = view.study.dims) {
  const valueAlong = (dim) => {
    const i = place[dim.name];
    if (dim.words) return dim.shown[i];
    const inSI = dim.si_unit ? ` (${withUnit(number(dim.parts[dim.name][i]), dim.si_unit)})` : "";
    return `${dim.symbol} = ${withUnit(number(dim.values[i]), dim.unit)}${inSI}`;
  };
  return dims.map(valueAlong).join(", ");
}

function hover(place) {
  const { study, variable, x, y } = view;
  const axes = [x, y].filter((name) => name !== NONE).map((name) => study.dim[name]);
  if (!place) {
    element("hovered").textContent = "";
    return;
  }
  const found = shown(study, variable, place);
  const status = failed(study, place) ? shown(study, study.status, place) : found;
  const said = status === found ? found : `${found}; ${status}`;
  element("hovered").textContent = `${where(place, axes)}. ${variable.label}: ${said}`;
}

const MOVES = {
  ArrowLeft: ["x", -1], ArrowRight: ["x", 1], Home: ["x", -Infinity], End: ["x", Infinity],
  ArrowDown: ["y", -1], ArrowUp: ["y", 1], PageDown: ["y", -Infinity], PageUp: ["y", Infinity],
};

function move(event) {
  const step = MOVES[event.key];
  if (!step || view[step[0]] === NONE) return;
  event.preventDefault();
  const name = view[step[0]];
  const to = Math.min(view.study.sizes[name] - 1, Math.max(0, view.place[name] + step[1]));
  choose({ ...view.place, [name]: to });
}

/** The values of what varies at a point, in SI units, as pairs of name and value. */
const variedAt = (study, place) =>
  study.dims.flatMap((dim) => Object.entries(dim.parts).map(([name, column]) => [name, column[place[dim.name]]]));

const CONSTANTS = new Map([[null, "None"], [true, "True"], [false, "False"]]);

/** A value in Python. */
function python(value) {
  if (CONSTANTS.has(value)) return CONSTANTS.get(value);
  if (Array.isArray(value)) return `[${value.map(python).join(", ")}]`;
  if (typeof value !== "object") return JSON.stringify(value);
  const pairs = Object.entries(value).map(([name, one]) => `${python(name)}: ${python(one)}`);
  return `{${pairs.join(", ")}}`;
}

/** The point as a case of the package, in SI units: what varies, and what is not as in the paper's Table 1; a parameter that the
 * quantity varies by itself has the value where its range begins. */
function caseOf(study, place) {
  const unusual = study.fixed.filter((one) => !one.usual);
  const values = [...unusual.map((one) => [one.name, one.value]), ...Object.entries(study.call.begins), ...variedAt(study, place)];
  const given = (name, value) => python(name === "disc" ? study.discs[value] ?? value : value);
  const stated = values.filter(([name]) => contents.parameters.includes(name)).map(([name, value]) => `${name}=${given(name, value)}`);
  return `dm.Parameters(${stated.join(", ")})`;
}

const PERTURBED = "perturbation_"; // before a coordinate of the start that varies

/** The arguments, in Python, of the start of a point's motion; "" for the static start. */
function startOf(study, place) {
  const varied = variedAt(study, place);
  const named = Object.fromEntries(varied).start;
  const { prerun, perturbation } = study.starts[named] ?? study.start;
  const kicks = varied.filter(([name]) => name.startsWith(PERTURBED)).map(([name, value]) => [name.slice(PERTURBED.length), value]);
  const kick = Object.fromEntries([...Object.entries(perturbation ?? {}), ...kicks].filter(([, value]) => value !== 0));
  const given = Object.keys(kick).length ? [python(kick)] : [];
  if (prerun) given.push(`prerun=${python(prerun)}`);
  return given.join(", ");
}

/** The call in Python for a point: its case, with the start of its motion, or that of a quantity which varies a parameter by itself. */
function call(study, place) {
  const found = `${study.call.before}${caseOf(study, place)}${study.call.after}`;
  const start = startOf(study, place);
  return start ? `case = ${found}\nstart = dm.initial_state(case, ${start})` : found;
}

const SIMULATED_FOR = 60; // s, as in the package's first examples

const LONGEST_CASE = 300; // characters of a case that is written twice: a disc has many more

/** The call in Python that shows the motion of a point from its start; "" if the point is no one case. */
function simulation(study, place) {
  if (Object.keys(study.call.begins).length) return "";
  if (startOf(study, place)) return `dm.simulate(case, ${SIMULATED_FOR}, initial_state=start).plot()`;
  const written = caseOf(study, place);
  return `dm.simulate(${written.length > LONGEST_CASE ? "case" : written}, ${SIMULATED_FOR}).plot()`;
}

const STORED_DIGITS = 5; // of a number

/** What the map shows, as comma-separated values, with those of the dimensions that are not on it. */
function csv() {
  const { study, variable, x, y } = view;
  const axes = [x, y].filter((name) => name !== NONE).map((name) => study.dim[name]);
  const cell = (text) => (/[",\n]/.test(text) ? `"${String(text).replaceAll('"', '""')}"` : text);
  const dims = [...axes, ...selectors()];
  const rows = [[...dims, variable].map((thing) => cell(heading(thing)))];
  const inner = axes[1]?.values ?? [null];
  for (const [j] of inner.entries())
    for (const [i] of axes[0].values.entries()) {
      const place = { ...view.place, [x]: i, ...(axes[1] ? { [y]: j } : {}) };
      const stored = value(study, variable, place);
      rows.push([...dims.map((dim) => cell(dim.values[place[dim.name]])), variable.flags ? variable.flags[stored] : Number(stored.toPrecision(STORED_DIGITS))]);
    }
  return rows.map((row) => row.join(",")).join("\n");
}

/** Choose a point. */
function choose(place) {
  view.place = place;
  view.warning = "";
  redraw(place);
}

/** Draw all that depends on what is looked at; `pointed` is where the pointer is. */
function redraw(pointed = null) {
  element("warning").textContent = view.warning;
  element("link").href = `#${address()}`;
  drawMap();
  hover(pointed);
  showPoint();
  drawMotion();
}

function showPoint() {
  const { study, place, variable } = view;
  const own = study.dims.filter((dim) => study.status?.dims.includes(dim.name) || variable.dims.includes(dim.name));
  element("point").textContent = `${where(place, own)}. ${variable.label}: ${shown(study, variable, place)}`;
  element("call").textContent = call(study, place);
  const message = messageAt(study, place);
  const status = study.status ? shown(study, study.status, place) : "ok";
  element("message").textContent = status === "ok" ? message : `${status}: ${message}`;
  fillTable("values", study.variables.map((one) => [one, shownWithin(study, one, place)]));
  fillTable("fixed", study.fixed.map((one) => [one, withUnit(number(one.shown), one.unit)]));
}

/** The value of a variable at a point; of one that has several there, such as one for each speed of a scan, with the place of it. */
function shownWithin(study, variable, place) {
  const grid = study.status?.dims ?? variable.dims;
  const within = study.dims.filter((dim) => variable.dims.includes(dim.name) && !grid.includes(dim.name));
  const said = shown(study, variable, place);
  return within.length ? `${said}, at ${where(place, within)}` : said;
}

function fillTable(id, rows) {
  const filled = rows.map(([one, text]) => {
    const row = document.createElement("tr");
    const [head, cell] = ["th", "td"].map((tag) => document.createElement(tag));
    head.scope = "row";
    head.textContent = `${one.name}: ${one.title}`;
    cell.textContent = text;
    row.append(head, cell);
    return row;
  });
  element(id).replaceChildren(...filled);
}
