// What the page holds: stored numbers, and their words.

const contents = JSON.parse(document.getElementById("contents").textContent);
const element = (id) => document.getElementById(id);
const NONE = "";

// Words and numbers

const SUPERSCRIPTS = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
const raised = (text) => [...String(text)].map((sign) => SUPERSCRIPTS[sign] ?? sign).join("");

function number(value, digits = 5) {
  if (typeof value === "string") return value;
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "no number" : String(value);
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${Number(mantissa)}·10${raised(Number(exponent))}`.replace("-", "−");
  }
  return String(Number(value.toPrecision(digits))).replace("-", "−");
}

/** Significant digits that tell numbers apart, at least two; four of a number alone. */
function digitsOf(numbers) {
  if (numbers.length === 1) return 4;
  const apart = (digits) => new Set(numbers.map((x) => number(x, digits))).size === numbers.length;
  return [2, 3, 4, 5].find(apart) ?? 6;
}

/** A number with its unit, which may begin with a power of ten. */
const withUnit = (text, unit) => (unit ? `${text}${unit.startsWith("10") ? "·" : " "}${unit}` : text);
const axisLabel = (thing) => (thing.unit ? `${thing.label} (${thing.unit})` : thing.label);
const heading = (thing) => (thing.unit ? `${thing.name} (${thing.unit})` : thing.name);

// Stored numbers

/** Numbers as `disc_model.explorer.packed` wrote them. */
async function unpacked(text, Kind) {
  const deflated = Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0));
  const stream = new Blob([deflated]).stream().pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const size = Kind.BYTES_PER_ELEMENT;
  const count = planes.length / size;
  const bytes = new Uint8Array(planes.length);
  for (let byte = 0; byte < size; byte++)
    for (let i = 0; i < count; i++) bytes[i * size + byte] = planes[byte * count + i];
  return new Kind(bytes.buffer);
}

/** The array that holds the numbers of a variable. */
const kindOf = (variable) => (variable.flags ? Uint8Array : variable.exact ? Float64Array : Float32Array);

/** Unpacks what a study holds, once. */
async function unpack(study) {
  const parts = [
    ...study.variables.map((variable) => [variable, kindOf(variable)]),
    ...study.variables.filter((variable) => variable.gaps).map((variable) => [variable.gaps, Uint8Array]),
    ...study.variables.flatMap((variable) =>
      [...variable.marks, ...variable.open, ...variable.doubts].map((one) => [one, Uint8Array])),
    ...(study.messages ? [[study.messages, Uint32Array]] : []),
    ...(study.motions ? study.motions.traces.map((trace) => [trace, Uint16Array]) : []),
  ].filter(([part]) => !part.numbers);
  await Promise.all(parts.map(async ([part, Kind]) => (part.numbers = await unpacked(part.data, Kind))));
}

/** The stored number of a variable at a place, given by a mapping of dimensions to indices. */
function value(study, variable, place) {
  let at = 0;
  for (const dim of variable.dims) at = at * study.sizes[dim] + place[dim];
  return variable.numbers[at];
}

/** The look of the class of a point where a variable has no number, which says why; null where it has one. */
function gapAt(study, variable, place) {
  const code = variable.gaps ? value(study, variable.gaps, place) : 0;
  return code ? variable.gaps.looks[code - 1] : null;
}

/** The variable with the words of outcomes; undefined in studies without one. */
const outcomeOf = (study) => study.variables.find((variable) => variable.name === "outcome" && variable.flags);

const EXCLUDED = "excluded"; // the status of a point that the rule of its study leaves out

/** Whether the rule of a study leaves a point out. */
const isLeftOut = (study, place) =>
  Boolean(study.status) && study.status.flags[value(study, study.status, place)] === EXCLUDED;

/** Whether a variable has a value at a point: a variable of several points together is not left out with one of them. */
function isValued(study, variable, place) {
  const ofPoint = study.status?.dims.every((name) => variable.dims.includes(name));
  return !gapAt(study, variable, place) && !(ofPoint && isLeftOut(study, place));
}

/** What figures say of the value of a point that may be another one: that it is at a bound, or of what it is not shown. */
const doubtsAt = (study, variable, place) => variable.doubts.filter((one) => value(study, one, place));

const intervalName = (study) => `${number(100 * study.confidence)} % interval`;

/** The variables that hold the ends of the interval of another one; null without. */
function intervalOf(study, variable) {
  const [low, high] = ["low", "high"].map((end) => study.variables.find((one) => one.name === `${variable.name}_${end}`));
  const alike = (one) => one && !variable.flags && String(one.dims) === String(variable.dims);
  return alike(low) && alike(high) ? [low, high] : null;
}

function shown(study, variable, place) {
  const found = value(study, variable, place);
  if (variable.flags) return variable.looks[found].label;
  const gap = gapAt(study, variable, place);
  if (gap) return gap.label;
  const said = [withUnit(number(found), variable.unit)];
  const ends = intervalOf(study, variable)?.map((one) => number(value(study, one, place), 3));
  if (ends) said.push(`${intervalName(study)} ${withUnit(ends.join(" to "), variable.unit)}`);
  return [...said, ...doubtsAt(study, variable, place).map((one) => one.look.label)].join(", ");
}

function messageAt(study, place) {
  const messages = study.messages;
  return messages ? messages.words[value(study, messages, place)] : "";
}

for (const study of contents.studies) {
  study.sizes = Object.fromEntries(study.dims.map((dim) => [dim.name, dim.values.length]));
  study.dim = Object.fromEntries(study.dims.map((dim) => [dim.name, dim]));
  study.status = study.variables.find((variable) => variable.name === "status" && variable.flags);
  for (const dim of study.dims) dim.words = typeof dim.values[0] === "string";
  for (const variable of study.variables) {
    variable.open ??= [];
    variable.doubts ??= [];
    for (const one of [...variable.marks, ...variable.open, ...variable.doubts]) one.dims = variable.dims;
  }
}
