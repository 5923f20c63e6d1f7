// Modes of a Campbell diagram, as in its figure: growing ones in their colour, and marks of crossings.

const GROWING = 5; // side of the square of a growing mode, pixels
const CROSSING = 4; // half the width of a mark of a crossing

/** The growth rate of the modes whose frequencies are drawn over the speed; undefined of other curves. */
function rateOfModes() {
  const { study, variable, x, y } = view;
  if (y !== NONE || x !== "Omega" || !study.modes) return undefined;
  return study.variables.find((one) => one.name === study.modes.rates[variable.name]);
}

/** Where a number lies along a dimension, between its values. */
function placeBetween(dim, at, wanted) {
  const i = Math.max(0, Math.min(dim.values.findLastIndex((one) => one <= wanted), at.length - 2));
  const share = (wanted - dim.values[i]) / (dim.values[i + 1] - dim.values[i]);
  return at[i] + share * (at[i + 1] - at[i]);
}

/** The crossings of the modes that are shown: where they lie in the picture, and their looks. */
function crossingsShown() {
  const { study, variable, x, place } = view;
  const { horizontal, vertical, xs, ys } = drawn;
  const [speed, frequency, effect] = ["Omega", "frequency", "effect"].map((end) => study.variables.find((one) => one.name === `crossing_${end}`));
  if (speed.unit !== study.dim[x].unit || frequency.unit !== variable.unit || xs.at.length < 2) return [];
  const all = study.dim.crossing.values.map((_, i) => ({ ...place, crossing: i }));
  const found = all.filter((one) => Number.isFinite(value(study, speed, one)));
  return found.map((one) => ({
    x: horizontal(placeBetween(study.dim[x], xs.at, value(study, speed, one))),
    y: vertical(ys.to(value(study, frequency, one))),
    look: study.modes.crossings.find(({ effects }) => effects.includes(effect.flags[value(study, effect, one)])),
  })).filter(({ look }) => look);
}

/** Draw what a Campbell diagram shows of the modes of a curve; returns the looks that occur, by their names. */
function drawModes(ink, points) {
  const { study } = view;
  const seen = new Map();
  const rate = rateOfModes();
  if (!rate) return seen;
  const { growing } = study.modes;
  ink.fillStyle = growing.colour;
  for (const { x, y, place } of points) {
    if (!Number.isFinite(y) || !(value(study, rate, place) > growing.above)) continue;
    ink.fillRect(x - GROWING / 2, y - GROWING / 2, GROWING, GROWING);
    seen.set(growing.label, { shape: "s", colour: growing.colour, isFilled: true });
  }
  for (const { x, y, look } of crossingsShown()) {
    markOfCrossing(ink, look, x, y);
    seen.set(look.label, look);
  }
  return seen;
}

/** The mark of a crossing: hollow ones are white inside, as on lines of figures. */
function markOfCrossing(ink, look, x, y) {
  shapeAt(ink, look.shape, style(look.is_filled ? "--text" : "--back"), x, y, CROSSING, true);
  shapeAt(ink, look.shape, style("--text"), x, y, CROSSING, false);
}

/** The entries of a legend for modes and their crossings. */
function entriesOfModes(looks) {
  const swatch = (look) => bareSwatch((ink) =>
    look.colour ? shapeAt(ink, look.shape, look.colour, 8, 8, GROWING, true) : markOfCrossing(ink, look, 8, 8));
  return [...looks].map(([name, look]) => [swatch(look), name]);
}
