// The link to a point. It says values in SI units, and so leads to the same point after the axes have changed.

const MARKS = "dots"; // the word of links for the marked class, which all marked by dots once
const OLDER = "across"; // a word of links of older pages, which counted cells

/** A value as a text; rounding is not a part of it. */
const stated = (value) => (typeof value === "string" ? value : String(Number(value.toPrecision(12))));

/** The address of the chosen point: its study, what is shown of it and how, and its value along each dimension. */
function address() {
  const { study, x, y, spread, variable, colours, mark, place } = view;
  const along = study.dims.flatMap((dim) =>
    Object.entries(dim.parts).map(([name, column]) => [name, stated(column[place[dim.name]])]),
  );
  const shown = { study: study.name, x, y, variable: variable.name, colours, [MARKS]: mark };
  if (offAxes().some(canSpread)) shown.all = spread;
  return new URLSearchParams([...Object.entries(shown), ...along]);
}

/** How far a value of a column is from a text, as a share of the column's range; infinitely far from another word. */
function distance(column, i, text) {
  if (stated(column[i]) === text) return 0;
  const wanted = text.trim() === "" || typeof column[i] === "string" ? NaN : Number(text);
  if (Number.isNaN(wanted)) return Infinity;
  return Math.abs(column[i] - wanted) / (Math.max(...column) - Math.min(...column) || Math.abs(column[i]) || 1);
}

/** Choose the place along a dimension that an address says, or the nearest one; returns a warning unless it is there. */
function followAlong(dim, asked) {
  const parts = Object.entries(dim.parts).filter(([name]) => asked.has(name));
  if (!parts.length) return "";
  const apart = dim.values.map((_, i) => parts.reduce((sum, [name, column]) => sum + distance(column, i, asked.get(name)), 0));
  const least = Math.min(...apart);
  const said = parts.map(([name]) => `${name} = ${asked.get(name)}`).join(", ");
  if (least === Infinity) return `The link's ${said} is not in this study.`;
  view.place[dim.name] = apart.indexOf(least);
  return least > 1e-9 ? `The link's ${said} is not in this study: the nearest point is shown.` : "";
}

/** Choose what an address says, as far as it is there; returns whether there was anything to choose. */
async function follow(hash) {
  const asked = new URLSearchParams(hash);
  const name = asked.get("study");
  if (name === null) return false; // of a part of the page
  if (!contents.studies.some((study) => study.name === name)) {
    view.warning = `The link's study “${name}” is not on this page.`;
    return false;
  }
  await chooseStudy(name);
  if (asked.has(OLDER)) {
    view.warning = "This link is of an older page, and counts cells instead of saying values: its study is shown, not its point.";
    return true;
  }
  const along = view.study.dims.map((dim) => followAlong(dim, asked));
  const warnings = [...followShown(asked), ...along, ...otherValues(asked)];
  view.warning = warnings.filter(Boolean).join(" ");
  return true;
}

const SHOWN_BY = ["study", "x", "y", "variable", "colours", MARKS, "all"]; // words of a link that are no values

/** Warnings of values in an address that are not those of its study: of a parameter that does not vary, or of none. */
function otherValues(asked) {
  const { study } = view;
  const varied = study.dims.flatMap((dim) => Object.keys(dim.parts));
  return [...asked].filter(([name]) => !SHOWN_BY.includes(name) && !varied.includes(name)).map(([name, text]) => {
    const fixed = study.fixed.find((one) => one.name === name);
    if (!fixed) return `The link's ${name} = ${text} is not in this study.`;
    if (typeof fixed.value === "object" || distance([fixed.value], 0, text) < 1e-9) return "";
    return `The link's ${name} = ${text} is not that of this study, ${name} = ${stated(fixed.value)}.`;
  });
}

/** Choose the axes, variable, colours and marks that an address says; returns warnings of those that are not there. */
function followShown(asked) {
  const { study } = view;
  const missing = [];
  const [x, y] = [asked.get("x"), asked.get("y")];
  if (study.dim[x]) view.x = x;
  else if (x !== null) missing.push(x);
  if (y === NONE || (study.dim[y] && y !== view.x)) view.y = y;
  else if (y !== null) missing.push(y);
  if (view.y === view.x) view.y = NONE;
  const variable = asked.get("variable");
  const found = study.variables.find((one) => one.name === variable);
  if (!found && variable !== null) missing.push(variable);
  const [across, up] = [view.x, view.y];
  if (found) chooseVariable(found);
  else chooseAxes();
  const changed = found ? tellOfAxes(across, up) : "";
  const all = asked.get("all");
  if (all === NONE || offAxes().some((dim) => dim.name === all && canSpread(dim))) view.spread = all;
  if (COLOURS.some(([key]) => key === asked.get("colours"))) view.colours = asked.get("colours");
  if ([NONE, ...marks().map((mark) => mark.key)].includes(asked.get(MARKS))) view.mark = asked.get(MARKS);
  return [changed, ...missing.map((word) => `The link's “${word}” is not in this study.`)];
}
