// What is looked at, and the controls that choose it.

// `spread` is the count, such as of samples, all of which a curve shows as points
const view = {
  study: null, x: "", y: NONE, spread: NONE, variable: null, place: {}, colours: "auto", mark: NONE, warning: "", search: "",
};

const long = (study) => study.dims.filter((dim) => dim.values.length > 1);
const along = (variable, ...dims) => dims.every((dim) => dim === NONE || variable.dims.includes(dim));
const growth = (variable) => variable.name === "growth_rate";
const outcome = (variable) => variable.name === "outcome";
/** Points of a study's largest map, over two numbers, of some variables; 0 if it has none. */
const mapped = (study, ofKind) =>
  Math.max(0, ...study.variables.filter(ofKind).map((variable) => {
    const dims = gridOf(study).filter((dim) => variable.dims.includes(dim.name));
    const numeric = dims.filter((dim) => !dim.words && !COUNTS.test(dim.title) && dim.values.length > 1);
    return numeric.length > 1 ? dims.reduce((product, dim) => product * dim.values.length, 1) : 0;
  }));

/** The study on which the page opens: one that has figures, if any has, with the largest map of growth rates or outcomes, or
 * else of any variable. */
function firstStudy() {
  const ranks = (study) => [study.has_figures, mapped(study, (one) => growth(one) || outcome(one)), mapped(study, () => true)];
  const ranked = contents.studies.map((study) => ({ study, rank: ranks(study) }));
  const later = (a, b) => b.rank.map((one, i) => one - a.rank[i]).find((apart) => apart) ?? 0;
  return ranked.sort(later)[0].study;
}
/** The dimensions of the variable that are not axes, and those of them along which one place is shown. */
const offAxes = () =>
  view.study.dims.filter((dim) => ![view.x, view.y].includes(dim.name) && view.variable.dims.includes(dim.name));
const selectors = () => offAxes().filter((dim) => dim.name !== view.spread);

const MANY = 8; // values from which on a dimension of the quantity's own is worth the height of a map
const COUNTS = /^number of the /i; // the meaning of a dimension that only counts something, such as branches
const ALONG = / along /; // and of one that counts points of a line, in their order

/** Whether a dimension only counts, so that nothing lies between its neighbours, and their order means nothing. */
const counts = (dim) => COUNTS.test(dim.title) && !ALONG.test(dim.title);

/** Axes of a study of which no figure names them: the values along a line, or else the speed, go across. Up goes a dimension of
 * the grid, or else one of the quantity's own that is no short list and no count, as a curve shows more than a map of two rows:
 * the longest of them. */
function usualAxes(study, axes) {
  const line = axes.find((dim) => valuesAlong(study, dim));
  if (line) return [line];
  const grid = axes.filter((dim) => gridOf(study).includes(dim));
  const own = axes.filter((dim) => !grid.includes(dim));
  const worth = own.filter((dim) => dim.values.length >= MANY && !COUNTS.test(dim.title));
  const across = grid.find((dim) => dim.name === "Omega") ?? grid[0] ?? worth[0] ?? own.at(-1);
  const others = [...grid, ...worth].filter((dim) => dim !== across);
  return [across, others.sort((a, b) => b.values.length - a.values.length)[0]];
}

/** The words at which the study before is looked at, by dimension: a reader has chosen them. */
function wordsChosen() {
  const worded = (view.study?.dims ?? []).filter((dim) => dim.words);
  return Object.fromEntries(worded.map((dim) => [dim.name, dim.values[view.place[dim.name]]]));
}

/** The place along a dimension at which a study opens: that of the word in the study before, or else that of a figure or of the
 * usual case, or the first one. */
function beginningAlong(dim, word) {
  const known = dim.words ? dim.values.indexOf(word) : -1;
  return known >= 0 ? known : dim.usual;
}

async function chooseStudy(name) {
  const study = contents.studies.find((one) => one.name === name);
  await unpack(study);
  const numeric = long(study).filter((dim) => !dim.words);
  const first = headline(study);
  const axes = first ? axesFor(study, first) : numeric.length ? numeric : long(study).length ? long(study) : study.dims;
  const figure = study.axes.map((name) => study.dim[name]);
  const ofFigure = figure.length === 2 && figure.every((dim) => axes.includes(dim));
  const [across, second] = ofFigure ? figure : usualAxes(study, axes);
  const up = first && !ofFigure && manyOf(study, first) ? null : second; // all points above one axis
  const kept = wordsChosen();
  Object.assign(view, { study, x: across.name, y: up ? up.name : NONE, variable: first, mark: NONE });
  view.place = Object.fromEntries(study.dims.map((dim) => [dim.name, beginningAlong(dim, kept[dim.name])]));
  for (const dim of [across, ...(up ? [up] : [])]) view.place[dim.name] = Math.floor((dim.values.length - 1) / 2);
  chooseAxes();
  if (!hasValues(view.variable)) chooseValued();
  if (marks().some((mark) => mark.key === SIMULATED)) view.mark = SIMULATED;
  view.place = slice();
  view.place = opening();
}

/** Whether a variable has a value at any point. */
const hasValues = (variable) => !variable.gaps || variable.gaps.numbers.includes(0);

/** The variable on which a study opens: that of its first figure, or what its quantity is about, if it has values and varies;
 * null without. */
function headline(study) {
  const named = [study.first, ...study.call.headlines].map((name) => study.variables.find((one) => one.name === name));
  const varies = (one) => one.dims.some((name) => study.sizes[name] > 1);
  return named.find((one) => one && varies(one) && hasValues(one)) ?? null;
}

/** The dimensions of a variable that may be its axes: numbers before words, and counts last. */
function axesFor(study, variable) {
  const dims = study.dims.filter((dim) => variable.dims.includes(dim.name));
  const lengthy = dims.filter((dim) => dim.values.length > 1);
  const uncounted = lengthy.filter((dim) => !counts(dim));
  const numbers = uncounted.filter((dim) => !dim.words);
  return [numbers, uncounted, lengthy, dims].find((some) => some.length);
}

/** Show a variable along its own dimensions; the axes stay if it varies along them. */
function chooseVariable(variable) {
  view.variable = variable;
  if (!along(variable, view.x, view.y)) {
    const [across, up] = usualAxes(view.study, axesFor(view.study, variable));
    Object.assign(view, { x: across.name, y: up ? up.name : NONE });
  }
  chooseAxes();
}

/** Show another variable than one without any value, along its own dimensions. */
function chooseValued() {
  const { study } = view;
  const valued = study.variables.find((one) => hasValues(one) && !one.name.endsWith("status"));
  if (!valued) return;
  const [across, up] = usualAxes(study, axesFor(study, valued));
  Object.assign(view, { variable: valued, x: across.name, y: up ? up.name : NONE });
  chooseAxes();
}

/** A place along what is not on the map: the chosen one, or else the first at which any point of the map has a value, of a
 * growth rate one that is not neutral. */
function slice() {
  const { study, variable } = view;
  const neutral = variable.marks.find((mark) => mark.is_neutral);
  const says = (place) => isValued(study, variable, place) && !(neutral && value(study, neutral, place));
  const chosen = view.place;
  const each = (some, dim) => some.flatMap((place) => dim.values.map((_, i) => ({ ...place, [dim.name]: i })));
  const candidates = [chosen, ...selectors().reduce(each, [chosen])];
  const saysAnything = (place) => places(place).some((cell) => says(cell.place));
  return candidates.find(saysAnything) ?? chosen;
}

/** The point at which a study opens: nearest the middle of its map one that has a value and whose own motion is stored, or
 * else one that has a value. */
function opening() {
  const { study, variable, x, place } = view;
  const y = second();
  const valued = places().filter((cell) => isValued(study, variable, cell.place));
  const stored = valued.filter((cell) => motionsAt(cell.place).length);
  const middle = (name) => (name === NONE ? 0 : (study.sizes[name] - 1) / 2);
  const apart = ({ i, j }) => Math.hypot((i - middle(x)) / study.sizes[x], (j - middle(y)) / (study.sizes[y] ?? 1));
  const [first] = (stored.length ? stored : valued).sort((a, b) => apart(a) - apart(b));
  return first?.place ?? place;
}

/** After another choice of axes: a variable along both of them, the one before if it will do. */
function chooseAxes() {
  if (!variablesShown().length) view.y = NONE;
  const fitting = variablesShown();
  const wanted = (one) => !one.name.endsWith("status");
  const answers = (one) => outcome(one) || one.name.endsWith("_outcome") || one.name === "kind";
  const measures = (one) => wanted(one) && !one.flags && !COUNTS.test(one.title);
  const ranked = [growth, answers, measures, wanted, () => true];
  const usual = ranked.map((kind) => fitting.find(kind)).find((one) => one);
  if (!fitting.includes(view.variable)) view.variable = usual;
  if (!chosenClass()) view.mark = NONE;
  view.spread = usualSpread();
}

/** The count along which a curve shows all of a variable's numbers, as points: the first one of several. */
function usualSpread() {
  if (view.y !== NONE) return NONE;
  const many = manyOf(view.study, view.variable);
  return many && many.name !== view.x ? many.name : NONE;
}

/** The first count of several along which a variable has numbers. */
const manyOf = (study, variable) =>
  study.dims.find((dim) => variable.dims.includes(dim.name) && counts(dim) && dim.values.length > 1);

/** The dimension beside that across of which all places are shown: that of the map up, or the count whose points are. */
const second = () => (view.y === NONE ? view.spread : view.y);

// What a choice has changed besides itself, in words

const quoted = (text) => `“${text}”`;
const axisWord = (name) => (name === NONE ? "none: a curve" : shortLabel(view.study.dim[name]));

/** Say so where a variable that was chosen has changed the axes. */
function tellOfAxes(x, y) {
  if (view.x === x && view.y === y) return "";
  const without = [x, y].filter((name) => name !== NONE && !view.variable.dims.includes(name)).map(axisWord).map(quoted);
  return `${quoted(view.variable.label)} does not vary with ${without.join(" or ")}, so the axes have changed: across is now `
    + `${quoted(axisWord(view.x))}, up ${quoted(axisWord(view.y))}.`;
}

/** Say so where axes that were chosen have changed the variable, or cannot be had together. */
function tellOfVariable(variable, y) {
  const lost = view.y === y ? "" : `Nothing varies with both ${quoted(axisWord(view.x))} and ${quoted(axisWord(y))}: a curve is shown.`;
  const axes = [view.x, view.y].filter((name) => name !== NONE).map(axisWord).map(quoted).join(" and ");
  const changed = view.variable === variable ? ""
    : `${quoted(variable.label)} does not vary with ${axes}: ${quoted(view.variable.label)} is shown instead.`;
  return [lost, changed].filter(Boolean).join(" ");
}

const variablesShown = () => view.study.variables.filter((variable) => along(variable, view.x, view.y));

/** The words of a flag that any point has; none of a number. */
const wordsOf = (variable) => (variable.flags ?? []).filter((_, code) => variable.numbers.includes(code));

const SIMULATED = "method=simulation";
/** The mark of a variable's stable points, if it has one. */
const stableMark = (variable) => variable.marks.find((one) => one.is_stable);

/** What points can be marked by, a class of a flag that occurs or the stability of a growth rate: its key, text, and whether it
 * holds. */
function marks() {
  const { study } = view;
  return variablesShown().flatMap((variable) => {
    const mark = (word, label, holds) => ({
      key: `${variable.name}=${word}`, title: `${variable.label}: ${label}`, holds,
    });
    const stable = stableMark(variable);
    if (stable) return [{ ...mark("stable", stable.look.label, (place) => value(study, stable, place) > 0), isStable: true }];
    return wordsOf(variable).map((word) =>
      mark(word, labelOf(variable, word), (place) => variable.flags[value(study, variable, place)] === word));
  });
}

const chosenClass = () => marks().find((mark) => mark.key === view.mark);

// Controls

const COLOURS = [["auto", "automatic"], ["linear", "linear"], ["stretched", "small values spread"]];

function choice(label, options, chosen, act, name = label) {
  const box = document.createElement("label");
  box.textContent = label;
  const select = document.createElement("select");
  select.name = name;
  for (const [key, text] of options) select.add(new Option(text, key, false, key === chosen));
  select.title = select.selectedOptions[0]?.text ?? "";
  select.addEventListener("change", async () => {
    element("grids").ariaBusy = "true";
    view.warning = "";
    await act(select.value);
    update();
    element("controls").elements.namedItem(name)?.focus();
  });
  box.append(select);
  return box;
}

const MANY_STUDIES = 8; // which a reader does not overlook in a list

/** The studies whose name, title or quantity has all words of the search. */
function studiesFound() {
  const words = view.search.toLowerCase().split(/\s+/).filter(Boolean);
  const text = (study) => `${study.name} ${study.title} ${study.call.quantity}`.toLowerCase();
  return contents.studies.filter((study) => words.every((word) => text(study).includes(word)));
}

/** The selector of a study, in groups of one quantity. */
function studyChoice(shown) {
  const box = choice("Study", [], "", chooseStudy);
  listStudies(box.querySelector("select"), shown);
  return box;
}

const NOT_FOUND = "still shown, but not found"; // the heading of the study that is shown and does not match

/** Some studies in the list, below a heading. */
function groupOf(label, studies, shown) {
  const group = document.createElement("optgroup");
  group.label = label;
  group.append(...studies.map((study) => new Option(`${study.name}: ${study.title}`, study.name, false, study === shown)));
  return group;
}

/** Lists the studies that are found; the one that is shown is apart from them if it does not match. */
function listStudies(select, shown) {
  const found = studiesFound().length ? studiesFound() : contents.studies;
  const quantities = [...new Set(found.map((study) => study.call.quantity))];
  const groups = quantities.map((quantity) =>
    groupOf(quantity.replaceAll("_", " "), found.filter((one) => one.call.quantity === quantity), shown));
  const grouped = quantities.length > 1 && found.length > MANY_STUDIES;
  const listed = grouped ? groups : groups.flatMap((group) => [...group.children]);
  if (!found.includes(shown)) listed.push(groupOf(NOT_FOUND, [shown], shown));
  select.replaceChildren(...listed);
  select.value = shown.name;
  select.title = select.selectedOptions[0].text;
}

/** How many studies the search has found, beside its field. */
function tellOfSearch() {
  const all = contents.studies.length;
  element("search").hidden = all <= MANY_STUDIES;
  const searched = view.search.trim();
  const found = studiesFound().length;
  element("search").querySelector("span").textContent = `Find a study${searched ? `: ${found} of ${all}` : ""}`;
  element("search-says").textContent = searched && !found
    ? `No study matches ${quoted(searched)}: ${view.study.name} is still shown, and the list has all studies.` : "";
}

/** The field leaves in the list of studies those with the words that are typed; Enter shows the first. */
function listenToSearch() {
  const field = element("search").querySelector("input");
  field.addEventListener("input", () => {
    view.search = field.value;
    listStudies(element("controls").elements.namedItem("Study"), view.study);
    tellOfSearch();
    showCutTexts();
  });
  field.addEventListener("keydown", async (event) => {
    const [first] = studiesFound();
    if (event.key !== "Enter" || !first) return;
    view.warning = "";
    await chooseStudy(first.name);
    update();
  });
}

/** The name of an axis, without what explains it after a colon; that of the parameter that is stored along a line. */
function shortLabel(dim) {
  const holder = valuesAlong(view.study, dim, view.variable) ?? valuesAlong(view.study, dim);
  if (holder) return dim.title.replace(/^.*(?= along )/, holder.label);
  return dim.label.split(":")[0];
}

function fillControls() {
  const { study } = view;
  const axes = long(study).length ? long(study) : study.dims;
  const axis = (dim) => [dim.name, shortLabel(dim)];
  const chooseAxis = (chosen) => {
    const { variable } = view;
    Object.assign(view, chosen);
    const { y } = view;
    chooseAxes();
    view.warning = tellOfVariable(variable, y);
  };
  const boxes = [
    studyChoice(study),
    choice("Across", axes.map(axis), view.x, (x) => chooseAxis({ x, y: x === view.y ? view.x : view.y })),
    choice("Up", [...axes.filter((dim) => dim.name !== view.x).map(axis), [NONE, "none: a curve"]], view.y, (y) => chooseAxis({ y })),
    variableChoice(),
    ...offAxes().filter((dim) => dim.values.length > 1).map(placeChoice),
  ];
  if (view.y !== NONE && !view.variable.flags)
    boxes.push(
      choice(
        "Colours",
        COLOURS.map(([key, text]) => [key, key === "auto" && view.variable.scale ? "usual for growth rates" : text]),
        view.colours,
        (name) => (view.colours = name),
      ),
    );
  if (marks().length && !across())
    boxes.push(
      choice("Marks", [[NONE, "none"], ...marks().map((mark) => [mark.key, mark.title])],
        view.mark, (key) => (view.mark = key)),
    );
  element("controls").replaceChildren(...boxes);
  showCutTexts();
}

/** The selector of a variable: all of the study, those along the axes that are chosen first. */
function variableChoice() {
  const fitting = variablesShown();
  const others = view.study.variables.filter((one) => !fitting.includes(one));
  const box = choice("Variable", [], "", (name) => {
    const { x, y } = view;
    chooseVariable(view.study.variables.find((one) => one.name === name));
    view.warning = tellOfAxes(x, y);
  });
  const option = (one) => {
    const text = one.name === one.label ? one.name : `${one.label} (${one.name})`;
    return new Option(text, one.name, false, one === view.variable);
  };
  const select = box.querySelector("select");
  select.append(...fitting.map(option));
  if (others.length) {
    const group = document.createElement("optgroup");
    group.label = "along other axes";
    group.append(...others.map(option));
    select.append(group);
  }
  select.title = select.selectedOptions[0].text;
  return box;
}

const ALL = "all";
/** Whether a curve may show all places along a dimension. */
const canSpread = (dim) => view.y === NONE && counts(dim) && dim.values.length > 1;

/** The selector of the place along a dimension that is no axis; a curve may show all places of a count, as points. */
function placeChoice(dim) {
  const places = dim.shown.map((one, i) => [String(i), withUnit(number(one), dim.unit)]);
  if (canSpread(dim)) places.unshift([ALL, across() ? "all, as lines" : "all, as points"]);
  const chosen = dim.name === view.spread ? ALL : String(view.place[dim.name]);
  return choice(shortLabel(dim), places, chosen, (i) => {
    if (i === ALL) view.spread = dim.name;
    else view.place[dim.name] = Number(i);
    if (i !== ALL && view.spread === dim.name) view.spread = NONE;
  }, dim.name);
}

/** Below each selector that is too narrow for the text of what is chosen, this text. */
function showCutTexts() {
  const ink = document.createElement("canvas").getContext("2d");
  for (const select of element("controls").querySelectorAll("select")) {
    select.parentElement.querySelector("span")?.remove();
    ink.font = getComputedStyle(select).font;
    const widthOf = (text) => ink.measureText(text).width;
    const width = select.offsetWidth;
    select.style.width = "max-content"; // of its longest text, and what is beside that
    const beside = select.offsetWidth - Math.max(...[...select.options].map((option) => widthOf(option.text)));
    select.style.width = "";
    if (widthOf(select.title) <= width - beside + 1) continue;
    const whole = document.createElement("span");
    whole.textContent = select.title;
    whole.ariaHidden = "true"; // the selector says the same
    select.after(whole);
  }
}
