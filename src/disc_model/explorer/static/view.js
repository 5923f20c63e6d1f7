// What is looked at, and the controls that choose it.

const view = { study: null, x: "", y: NONE, variable: null, place: {}, colours: "auto", mark: NONE, warning: "", search: "" };

const long = (study) => study.dims.filter((dim) => dim.values.length > 1);
const along = (variable, ...dims) => dims.every((dim) => dim === NONE || variable.dims.includes(dim));
const growth = (variable) => variable.name === "growth_rate";
const outcome = (variable) => variable.name === "outcome";
/** Points of a study's largest map, over two numbers, of some variables; 0 if it has none. */
const mapped = (study, ofKind) =>
  Math.max(0, ...study.variables.filter(ofKind).map((variable) => {
    const dims = gridOf(study).filter((dim) => variable.dims.includes(dim.name));
    const numeric = dims.filter((dim) => !dim.words && !COUNTS.test(dim.label) && dim.values.length > 1);
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
const selectors = () =>
  view.study.dims.filter((dim) => ![view.x, view.y].includes(dim.name) && view.variable.dims.includes(dim.name));

const MANY = 8; // values from which on a dimension of the quantity's own is worth the height of a map
const COUNTS = /^number of the /i; // the label of a dimension that only counts something, such as branches

/** Axes of a study of which no figure names them: the speed goes across. Up goes a dimension of the grid, or else one of the
 * quantity's own that is no short list and no count: a curve shows more than a map of two rows. */
function usualAxes(study, axes) {
  const grid = axes.filter((dim) => gridOf(study).includes(dim));
  const own = axes.filter((dim) => !grid.includes(dim));
  const worth = own.filter((dim) => dim.values.length >= MANY && !COUNTS.test(dim.label));
  const across = grid.find((dim) => dim.name === "Omega") ?? grid[0] ?? worth[0] ?? own.at(-1);
  return [across, [...grid, ...worth].find((dim) => dim !== across)];
}

async function chooseStudy(name) {
  const study = contents.studies.find((one) => one.name === name);
  await unpack(study);
  const numeric = long(study).filter((dim) => !dim.words);
  const axes = numeric.length ? numeric : long(study).length ? long(study) : study.dims;
  const figure = study.axes.map((name) => study.dim[name]);
  const ofFigure = figure.length === 2 && figure.every((dim) => axes.includes(dim));
  const [across, up] = ofFigure ? figure : usualAxes(study, axes);
  const kept = view.place;
  Object.assign(view, { study, x: across.name, y: up ? up.name : NONE, variable: null, mark: NONE });
  view.variable = study.variables.find((one) => one.name === study.first) ?? null;
  view.place = Object.fromEntries(
    study.dims.map((dim) => [dim.name, dim.words ? Math.min(kept[dim.name] ?? 0, dim.values.length - 1) : 0]),
  );
  for (const dim of [across, ...(up ? [up] : [])]) view.place[dim.name] = Math.floor((dim.values.length - 1) / 2);
  chooseAxes();
  if (!hasValues(view.variable)) chooseValued();
  if (marks().some((mark) => mark.key === SIMULATED)) view.mark = SIMULATED;
  view.place = opening();
}

/** Whether a variable has a value at any point. */
const hasValues = (variable) => !variable.gaps || variable.gaps.numbers.includes(0);

/** Show another variable than one without any value, along its own dimensions. */
function chooseValued() {
  const { study } = view;
  const valued = study.variables.find((one) => hasValues(one) && !one.name.endsWith("status"));
  if (!valued) return;
  const dims = study.dims.filter((dim) => valued.dims.includes(dim.name));
  const lengthy = dims.filter((dim) => dim.values.length > 1);
  const [across, up] = usualAxes(study, lengthy.length ? lengthy : dims);
  Object.assign(view, { variable: valued, x: across.name, y: up ? up.name : NONE });
  chooseAxes();
}

/** The point at which a study opens: nearest the middle of its map one that has a value and whose own motion is stored, or
 * else one that has a value. */
function opening() {
  const { study, variable, x, y, place } = view;
  const valued = places().filter((cell) => !gapAt(study, variable, cell.place));
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
  const measures = (one) => wanted(one) && !one.flags && !COUNTS.test(one.label);
  const ranked = [growth, answers, measures, wanted, () => true];
  const usual = ranked.map((kind) => fitting.find(kind)).find((one) => one);
  if (!fitting.includes(view.variable)) view.variable = usual;
  if (!chosenDots()) view.mark = NONE;
}

const variablesShown = () => view.study.variables.filter((variable) => along(variable, view.x, view.y));

const SIMULATED = "method=simulation";
/** The mark of a variable's stable points, if it has one. */
const stableMark = (variable) => variable.marks.find((one) => one.is_stable);

/** What points can be dotted by, a class of a flag or the stability of a growth rate: its key, text, and whether it holds. */
function marks() {
  const { study } = view;
  return variablesShown().flatMap((variable) => {
    const mark = (word, label, holds) => ({
      key: `${variable.name}=${word}`, title: `${variable.label}: ${label}`, holds,
    });
    const stable = stableMark(variable);
    if (stable) return [mark("stable", stable.look.label, (place) => value(study, stable, place) > 0)];
    return (variable.flags ?? []).map((word, code) =>
      mark(word, labelOf(variable, word), (place) => value(study, variable, place) === code));
  });
}

const chosenDots = () => marks().find((mark) => mark.key === view.mark);

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

/** The studies whose name, title or quantity has all words of the search, and the one that is shown. */
function studiesFound(shown) {
  const words = view.search.toLowerCase().split(/\s+/).filter(Boolean);
  const text = (study) => `${study.name} ${study.title} ${study.call.quantity}`.toLowerCase();
  return contents.studies.filter((study) => study === shown || words.every((word) => text(study).includes(word)));
}

/** The selector of a study, in groups of one quantity. */
function studyChoice(shown) {
  const box = choice("Study", [], "", chooseStudy);
  listStudies(box.querySelector("select"), shown);
  return box;
}

function listStudies(select, shown) {
  const found = studiesFound(shown);
  const quantities = [...new Set(found.map((study) => study.call.quantity))];
  const groups = quantities.map((quantity) => {
    const group = document.createElement("optgroup");
    group.label = quantity.replaceAll("_", " ");
    for (const study of found.filter((one) => one.call.quantity === quantity))
      group.append(new Option(`${study.name}: ${study.title}`, study.name, false, study === shown));
    return group;
  });
  const grouped = quantities.length > 1 && found.length > MANY_STUDIES;
  select.replaceChildren(...(grouped ? groups : groups.flatMap((group) => [...group.children])));
  select.value = shown.name;
  select.title = select.selectedOptions[0].text;
}

/** How many studies the search has found, beside its field. */
function tellOfSearch() {
  const all = contents.studies.length;
  element("search").hidden = all <= MANY_STUDIES;
  const found = view.search.trim() ? `: ${studiesFound(null).length} of ${all}` : "";
  element("search").querySelector("span").textContent = `Find a study${found}`;
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
    const [first] = studiesFound(null);
    if (event.key !== "Enter" || !first) return;
    view.warning = "";
    await chooseStudy(first.name);
    update();
  });
}

/** The name of an axis, without what explains it after a colon. */
const shortLabel = (dim) => dim.label.split(":")[0];

function fillControls() {
  const { study } = view;
  const axes = long(study).length ? long(study) : study.dims;
  const axis = (dim) => [dim.name, shortLabel(dim)];
  const named = (one) => [one.name, one.name === one.label ? one.name : `${one.label} (${one.name})`];
  const boxes = [
    studyChoice(study),
    choice("Across", axes.map(axis), view.x, (name) => {
      if (name === view.y) view.y = view.x;
      view.x = name;
      chooseAxes();
    }),
    choice("Up", [...axes.filter((dim) => dim.name !== view.x).map(axis), [NONE, "none: a curve"]], view.y, (name) => {
      view.y = name;
      chooseAxes();
    }),
    choice("Variable", variablesShown().map(named), view.variable.name, (name) => {
      view.variable = variablesShown().find((one) => one.name === name);
    }),
    ...selectors().filter((dim) => dim.values.length > 1).map((dim) =>
      choice(
        shortLabel(dim),
        dim.shown.map((one, i) => [String(i), withUnit(number(one), dim.unit)]),
        String(view.place[dim.name]),
        (i) => (view.place[dim.name] = Number(i)),
        dim.name,
      ),
    ),
  ];
  if (view.y !== NONE && !view.variable.flags)
    boxes.push(
      choice(
        "Colours",
        COLOURS.map(([key, text]) => [key, key === "auto" && view.variable.scale ? "as in the figures" : text]),
        view.colours,
        (name) => (view.colours = name),
      ),
    );
  if (marks().length)
    boxes.push(
      choice("Dots", [[NONE, "none"], ...marks().map((mark) => [mark.key, mark.title])],
        view.mark, (key) => (view.mark = key)),
    );
  element("controls").replaceChildren(...boxes);
  showCutTexts();
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
