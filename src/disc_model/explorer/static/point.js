// Pointing at the map, and what is known of the chosen point.

function cellAt(canvas, event) {
  const { left, top } = canvas.getBoundingClientRect();
  const [px, py] = [event.clientX - left, event.clientY - top];
  const { box, horizontal, vertical, xs, ys } = drawn;
  if (px < box.left || px > box.right || py < box.top || py > box.bottom) return null;
  if (drawn.points) return placeOnLines(drawn.points, px, py);
  const inside = (scale, position, pointed) => {
    const [first, last] = [position(scale.borders[0]), position(scale.borders.at(-1))];
    const at = Math.max(Math.min(first, last), Math.min(pointed, Math.max(first, last))); // beside a curve's end: that point
    return scale.at.findIndex((_, n) => {
      const ends = [position(scale.borders[n]), position(scale.borders[n + 1])];
      return at >= Math.min(...ends) && at <= Math.max(...ends);
    });
  };
  const found = { ...view.place, [view.x]: inside(xs, horizontal, px) };
  if (view.spread !== NONE) return { ...found, [view.spread]: nearestAcross(found[view.x], py) };
  return view.y === NONE ? found : { ...found, [view.y]: inside(ys, vertical, py) };
}

/** Which of the points that stand above one value across is nearest to a height. */
function nearestAcross(i, height) {
  const count = view.study.sizes[view.spread];
  const apart = drawn.heights.slice(i * count, (i + 1) * count).map((one) => (Number.isFinite(one) ? Math.abs(one - height) : Infinity));
  const nearest = apart.indexOf(Math.min(...apart));
  return Math.max(0, nearest);
}

/** Whether a word along a dimension is a number: those of a dimension that ends at infinity are words. */
const isNumber = (word) => ["inf", "-inf"].includes(word) || !Number.isNaN(Number(word));

/** Where a point lies, in words. */
function where(place, dims = view.study.dims) {
  const valueAlong = (dim) => {
    const i = place[dim.name];
    if (typeof dim.shown[i] === "string" && !isNumber(dim.shown[i])) return dim.shown[i];
    const holder = valuesAlong(view.study, dim);
    if (holder) return `${holder.symbol} = ${shown(view.study, holder, { ...view.place, ...place })}, point ${number(dim.values[i])} of the line`;
    const inSI = dim.si_unit ? ` (${withUnit(number(dim.parts[dim.name][i]), dim.si_unit)})` : "";
    return `${dim.symbol} = ${withUnit(number(dim.values[i]), dim.unit)}${inSI}`;
  };
  return dims.map(valueAlong).join(", ");
}

/** The value at a place, below the map: that of the chosen point where the pointer is at none. */
function hover(pointed) {
  const { study, variable, x } = view;
  const axes = [x, second()].filter((name) => name !== NONE).map((name) => study.dim[name]);
  const place = pointed ?? view.place;
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
  if (!step) return;
  const name = step[0] === "x" ? view.x : second();
  if (name === NONE) return;
  event.preventDefault();
  const to = Math.min(view.study.sizes[name] - 1, Math.max(0, view.place[name] + step[1]));
  choose({ ...view.place, [name]: to });
}

/** The dimensions of a study's grid, each point of which is computed by itself; others are of its quantity. */
const gridOf = (study) => study.dims.filter((dim) => study.status?.dims.includes(dim.name) ?? true);

/** The values of what varies at a point, in SI units, as pairs of name and value. */
const variedAt = (dims, place) =>
  dims.flatMap((dim) => Object.entries(dim.parts).map(([name, column]) => [name, column[place[dim.name]]]));

const CONSTANTS = new Map([[null, "None"], [true, "True"], [false, "False"]]);

/** A value that a call reads from a file, as it is written in Python. */
class Read {
  constructor(text) {
    this.text = text;
  }
}

/** The disc of a name along an axis, or that of all points, as a call has it: read from its table, if it has one. */
function discOf(study, name, given) {
  const table = study.tables[name];
  return table ? new Read(`dm.Disc.from_csv(${python(table)})`) : given;
}

/** Whether the discs of a study are given by their modes. */
const hasDiscs = (study) =>
  study.fixed.some((one) => one.name === "disc" && one.value) || study.dims.some((dim) => "disc" in dim.parts);

/** The values of parameters that a study does not vary and that differ from the paper's Table 1, by name; and where the slider
 * runs on a disc that is not the paper's, of which the package asks. */
function unusualOf(study) {
  const stated = study.fixed.filter((one) => !one.usual || (one.name === "r_0" && hasDiscs(study)));
  const values = Object.fromEntries(stated.map((one) => [one.name, one.value]));
  if (values.disc) values.disc = discOf(study, "", values.disc);
  return values;
}

/** A value in Python. */
function python(value) {
  if (value instanceof Read) return value.text;
  if (CONSTANTS.has(value)) return CONSTANTS.get(value);
  if (Array.isArray(value)) return `[${value.map(python).join(", ")}]`;
  if (typeof value !== "object") return JSON.stringify(value);
  const pairs = Object.entries(value).map(([name, one]) => `${python(name)}: ${python(one)}`);
  return `{${pairs.join(", ")}}`;
}

/** The values of the parameters that the quantity varies by itself where a variable was computed; without those that the variable
 * does not depend on. */
function scannedAt(study, place, variable) {
  const valueIn = (name) => {
    const dim = study.dim[name];
    if (dim) return variable.dims.includes(name) ? dim.parts[name][place[name]] : NaN;
    const holder = study.variables.find((one) => one.name === name);
    return holder?.dims.every((one) => variable.dims.includes(one)) ? value(study, holder, place) : NaN;
  };
  const found = Object.entries(study.call.along).map(([parameter, names]) => [parameter, names.map(valueIn)]);
  const known = found.map(([parameter, values]) => [parameter, values.find((one) => !Number.isNaN(one))]);
  return Object.fromEntries(known.filter(([, one]) => one !== undefined));
}

/** The values of the parameters of a sample. */
function sampledAt(study, place) {
  const holder = study.variables.find((one) => one.name === study.call.sampled);
  if (!holder) return {};
  return Object.fromEntries(study.dim.parameter.values.map((name, i) => [name, value(study, holder, { ...place, parameter: i })]));
}

/** Arguments of a call in Python. */
const argumentsOf = (values) => values.map(([name, one]) => `${name}=${python(one)}`).join(", ");

/** What the case of a plate that is not the paper's has to state, and does not yet: of which the package asks. */
function statedWith(study, given) {
  const { measures, stated } = contents.plate;
  if (!measures.some((name) => given.includes(name))) return [];
  const missing = study.fixed.filter((one) => stated.includes(one.name) && !given.includes(one.name) && one.value !== null);
  return missing.map((one) => [one.name, one.value]);
}

/** The point as a case of the package, in SI units: what varies, and what is not as in the paper's Table 1; a parameter that the
 * quantity varies by itself has its value at the point, or else that where its range begins. */
function caseOf(study, place, variable) {
  const scanned = { ...study.call.begins, ...scannedAt(study, place, variable) };
  const values = { ...unusualOf(study), ...Object.fromEntries(variedAt(gridOf(study), place)), ...scanned };
  if (study.call.lifts_mu_s) {
    const least = values.mu_s ?? study.fixed.find((one) => one.name === "mu_s")?.value;
    if (least < values.mu_k) values.mu_s = values.mu_k;
  }
  if (typeof values.disc === "string") values.disc = discOf(study, values.disc, study.discs[values.disc] ?? values.disc);
  const known = Object.entries(values).filter(([name]) => contents.parameters.includes(name));
  // numbers of a disc's modes, and what is drawn about the values of a point
  const ofModes = Object.entries(scanned).filter(([name]) => !contents.parameters.includes(name));
  const replaced = [...ofModes, ...Object.entries(sampledAt(study, place))];
  known.push(...statedWith(study, [...known, ...replaced].map(([name]) => name)));
  return `dm.Parameters(${argumentsOf(known)})${replaced.length ? `.replace(${argumentsOf(replaced)})` : ""}`;
}

const PERTURBED = "perturbation_"; // before a coordinate of the start that varies

/** The start of a point's motion: the motion before it, if any, and the perturbations that are not 0. */
function beginningOf(study, place) {
  const varied = variedAt(gridOf(study), place);
  const { prerun, perturbation } = study.start;
  const kicks = varied.filter(([name]) => name.startsWith(PERTURBED)).map(([name, value]) => [name.slice(PERTURBED.length), value]);
  const kick = Object.fromEntries([...Object.entries(perturbation ?? {}), ...kicks].filter(([, value]) => value !== 0));
  return { prerun, kick, isStatic: !prerun && !Object.keys(kick).length };
}

/** The arguments, in Python, of the start of a point's motion; "" for the static start. */
function startOf(study, place) {
  const { prerun, kick } = beginningOf(study, place);
  const given = Object.keys(kick).length ? [python(kick)] : [];
  if (prerun) given.push(`prerun=${python(prerun)}`);
  return given.join(", ");
}

/** A study of the point alone, as it was computed; what it has of a variable is a code where that is a flag. */
function studyOf(study, place, variable) {
  const axes = variedAt(gridOf(study), place);
  const given = {
    study: "point", quantity: study.call.quantity, options: study.call.options, base: unusualOf(study),
    axes: Object.fromEntries(axes.map(([name, one]) => [name, [one]])),
  };
  const { disc } = Object.fromEntries(axes);
  if (study.discs[disc]) given.discs = { [disc]: discOf(study, disc, study.discs[disc]) };
  const stored = `found["${variable.name}"]`;
  const one = `${stored}${placeWithin(study, place, variable)}.item()`;
  return {
    found: `dm.run_study(${python(given)})`,
    number: variable.flags && !variable.truth ? `${stored}.attrs["flag_meanings"].split()[${one}]` : one,
  };
}

/** Where a number lies along the quantity's own dimensions, in Python. */
function placeWithin(study, place, variable) {
  const own = variable.dims.filter((name) => !gridOf(study).includes(study.dim[name]));
  return own.length ? `.isel(${own.map((name) => `${name}=${place[name]}`).join(", ")})` : "";
}

const LEFT_OUT = "not_simulated"; // the outcome of a sample that is not followed

/** What computes the value of a variable at a point, and the expression of the value; null if a point alone does not have it. */
function computation(study, place, variable) {
  const { columns, recipes } = study.call;
  if (!columns.includes(variable.name) || variable.flags?.[value(study, variable, place)] === LEFT_OUT) return null;
  const { prerun, kick, isStatic } = beginningOf(study, place);
  const recipe = recipes.find((one) => variable.name in one.numbers && (isStatic || (one.takes_kick && !prerun)));
  if (!recipe) return studyOf(study, place, variable);
  const given = ["case", ...recipe.arguments, ...(isStatic ? [] : [`start=${python(kick)}`])];
  return {
    found: `${recipe.function}(${given.join(", ")})`,
    number: recipe.numbers[variable.name] || `found["${variable.name}"]${placeWithin(study, place, variable)}.item()`,
  };
}

/** The call in Python for a point: its case, and what computes the value that is shown. */
function call(study, place, variable) {
  if (isLeftOut(study, place)) return "";
  const written = caseOf(study, place, variable);
  const known = computation(study, place, variable);
  return known ? [`case = ${written}`, `found = ${known.found}`, known.number].join("\n") : written;
}

/** Why a point is left out, in words. */
const ruleOf = (study) => (study.where ? `by the study's rule “${study.where}”` : "by the study's rule");

/** What the call for a point gives, in words. */
function saidOfPoint(study, place, variable) {
  if (isLeftOut(study, place)) return `This point is left out ${ruleOf(study)}: it is not computed, and there is no call of it.`;
  const known = computation(study, place, variable);
  const scanned = scannedAt(study, place, variable);
  const waiting = Object.keys(study.call.begins).filter((name) => !(name in scanned));
  const ends = waiting.length > 1 ? "stand where their ranges begin" : "stands where its range begins";
  const begins = waiting.length ? ` ${waiting.join(" and ")}, which the study varies by itself, ${ends}.` : "";
  const remark = variable.remark ? ` ${variable.remark}` : "";
  if (!known) return `The case of this point.${study.call.quantity ? " No call of it alone gives the value above." : ""}${remark}${begins}`;
  const alone = known.found.startsWith("dm.run_study") ? "a study of it alone" : "the call";
  const what = gapAt(study, variable, place) ? "computes it anew" : `gives the value above${variable.unit ? ", in SI units" : ""}`;
  const all = study.call.computes && !known.found.startsWith("dm.steady") ? ` It computes ${study.call.computes}.` : "";
  return `The case of this point, and ${alone} that ${what}.${all}${remark}${begins}`;
}

const SIMULATED_FOR = 60; // s, as in the package's first examples

const LONGEST_CASE = 120; // characters of a case that is written twice: a sample or a disc has more

/** Whether a motion is known to separate within the horizon of a study. */
function isSeparating(study, place) {
  const outcome = outcomeOf(study);
  return Boolean(outcome) && outcome.flags[value(study, outcome, place)] === "separation";
}

/** How long a simulation shows the motion of a point, s: beyond its first separation where the study has a later one, and to
 * the horizon where the motion separates within it at a time that the study does not have. */
function simulatedFor(study, place) {
  const timed = study.variables.find((one) => one.name === "first_separation" && one.unit === "s");
  const separates = timed ? value(study, timed, place) : NaN;
  if (separates > SIMULATED_FOR) return 10 * Math.ceil(separates / 10) + 10;
  const horizon = Number(study.call.options.horizon);
  const isUntimed = !Number.isFinite(separates) && isSeparating(study, place);
  return isUntimed && horizon > SIMULATED_FOR ? horizon : SIMULATED_FOR;
}

/** The time before what a study tells of a point, s: its transient, as long as it was there; NaN of a study without. */
function transientOf(study, place) {
  const timed = study.variables.find((one) => one.name === "transient_time" && one.unit === "s");
  return timed ? value(study, timed, place) : Number(study.call.options.transient ?? NaN);
}

const SHOWN_AFTER = 0.1; // s of motion after a transient, the longest that is stored

/** The lines in Python that show the motion of a point after its transient. */
function afterTransient(time, start) {
  const from = start ? ", initial_state=start" : "";
  return [
    `later = dm.simulate(case, ${stated(time)}${from}).final_state`,
    `dm.simulate(case, duration=${SHOWN_AFTER}, initial_state=later).plot()`,
  ];
}

/** The call in Python that shows the motion of a point from its start, or after its transient; "" if the point is no one case. */
function simulation(study, place, variable) {
  if (isLeftOut(study, place)) return "";
  const scanned = scannedAt(study, place, variable);
  if (Object.keys(study.call.begins).some((name) => !(name in scanned))) return "";
  const time = simulatedFor(study, place);
  const written = caseOf(study, place, variable);
  const above = call(study, place, variable).startsWith("case = ");
  const start = startOf(study, place);
  const transient = transientOf(study, place);
  if (start || transient > 0) {
    const lines = above ? [] : [`case = ${written}`];
    if (start) lines.push(`start = dm.initial_state(case, ${start})`);
    if (transient > 0) lines.push(...afterTransient(transient, start));
    else lines.push(`dm.simulate(case, ${time}, initial_state=start).plot()`);
    return lines.join("\n");
  }
  const long = written.length > LONGEST_CASE && above;
  return `dm.simulate(${long ? "case" : written}, ${time}).plot()`;
}

/** A stored number with the fewest digits that give it back. */
function inFull(stored, variable) {
  if (variable.exact || !Number.isFinite(stored)) return String(stored);
  const texts = [6, 7, 8, 9].map((digits) => String(Number(stored.toPrecision(digits))));
  return texts.find((text) => Math.fround(Number(text)) === stored);
}

/** What the map shows, as comma-separated values, with those of the dimensions that are not on it. */
function csv() {
  const { study, variable, x } = view;
  const axes = [x, second()].filter((name) => name !== NONE).map((name) => study.dim[name]);
  const cell = (text) => (/[",\n]/.test(text) ? `"${String(text).replaceAll('"', '""')}"` : text);
  const dims = [...axes, ...selectors()];
  const shownVariables = [across(), variable].filter(Boolean); // with the values over which lines are drawn
  const rows = [[...dims, ...shownVariables].map((thing) => cell(heading(thing)))];
  const text = (one, stored) => (one.flags ? one.flags[stored] : inFull(stored, one));
  for (const { place } of places().sort((a, b) => a.j - b.j || a.i - b.i)) {
    const numbers = shownVariables.map((one) => text(one, value(study, one, place)));
    rows.push([...dims.map((dim) => cell(dim.values[place[dim.name]])), ...numbers]);
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
  element("call-says").textContent = saidOfPoint(study, place, variable);
  element("call").textContent = call(study, place, variable);
  const message = isLeftOut(study, place) ? ruleOf(study) : messageAt(study, place);
  const status = study.status ? shown(study, study.status, place) : "ok";
  element("message").textContent = status === "ok" ? message : `${status}: ${message}`;
  const sampled = Object.entries(sampledAt(study, place)).map(([name, one]) => [{ name, title: "value of the sample, SI units" }, number(one)]);
  const others = study.variables.filter((one) => one.name !== study.call.sampled);
  fillTable("values", [...others.map((one) => [one, shownWithin(study, one, place)]), ...sampled]);
  fillTable("fixed", study.fixed.map((one) => [one, fixedText(one)]));
}

/** The value of a parameter that does not vary, with its unit unless it is a word. */
function fixedText({ shown, unit }) {
  return typeof shown === "string" && !isNumber(shown) ? shown : withUnit(number(shown), unit);
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
    head.textContent = `${one.name}: ${one.title}${one.remark ? `. ${one.remark}` : ""}`;
    cell.textContent = text;
    row.append(head, cell);
    return row;
  });
  element(id).replaceChildren(...filled);
}
