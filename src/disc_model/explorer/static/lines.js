// Curves over values that are stored along a line, such as the branches of cycles over the speed.

const WIDTHS = { stable: 3.5, plain: 1.5, unstable: 1 }; // of lines, pixels
const POINTED = 30; // greatest distance between the pointer and the point of a line that it means, pixels
const LOGARITHMIC = 100; // greatest over least number from which on lines have a logarithmic scale

/** The variable with the values of a parameter along a dimension that counts the points of a line; undefined without. */
function valuesAlong(study, dim, variable) {
  const names = Object.values(study.call.along).flat();
  if (!dim || !ALONG.test(dim.title)) return undefined;
  return study.variables.find((one) =>
    one !== variable && names.includes(one.name) && one.dims.includes(dim.name)
    && (!variable || one.dims.every((name) => variable.dims.includes(name))));
}

/** The variable over which a curve is drawn in place of a count of its points; undefined of other curves, and of maps. */
const across = () => (view.y === NONE ? valuesAlong(view.study, view.study.dim[view.x], view.variable) : undefined);

/** A scale between the ends of some numbers. */
function scaleBetween(numbers, { whole }) {
  const finite = numbers.filter(Number.isFinite);
  const [least, greatest] = finite.length ? [Math.min(...finite), Math.max(...finite)] : [0, 1];
  const ticks = ticksBetween(least, greatest, whole).map((tick) => [tick, number(tick, 4)]);
  return { at: [], borders: [least, greatest], middles: [], to: identity, ticks: () => ticks };
}

/** The scale of the heights of lines: logarithmic where positive numbers are far apart. */
function scaleOfHeights(variable, numbers) {
  const positive = numbers.filter((one) => one > 0 && Number.isFinite(one));
  const [least, greatest] = [Math.min(...positive), Math.max(...positive)];
  if (numbers.some((one) => one <= 0) || !(greatest > LOGARITHMIC * least)) return scaleOfNumbers(variable, numbers);
  const steps = stepsBetween(least, greatest);
  const [low, high] = [steps.findLast((step) => step <= least), steps.find((step) => step >= greatest)];
  const inside = stepsUpTo(high, low);
  const decades = inside.filter(isPowerOfTen);
  const ticks = [...new Set([low, high, ...decades, ...inside])].map((step) => [log10(step), number(step, 2)]);
  return { borders: [log10(low) - 0.05, log10(high) + 0.05], to: log10, ticks: () => ticks };
}

/** The looks of lines by what is known of their points: their stability, and whether contact is lost on the cycle. */
function looksOfLines() {
  const { study, variable } = view;
  const within = (one) => one && one.dims.every((name) => variable.dims.includes(name));
  const [rate, losses] = ["growth_rate", "separations"].map((name) => study.variables.find((one) => one.name === name));
  return {
    rate: within(rate) ? rate : null,
    losses: within(losses) && !losses.flags ? losses : null,
  };
}

/** Whether a line is stable between each of its points and the next one; rates are 0 where stability changes. */
function stableSteps(rates) {
  const steps = [];
  for (let n = 0; n + 1 < rates.length; n++) {
    const areChanges = rates[n] === 0 && rates[n + 1] === 0;
    steps.push(areChanges ? n > 0 && !steps[n - 1] : Math.max(rates[n], rates[n + 1]) <= 0);
  }
  return steps;
}

/** The name of the look of a part of a line. */
function nameOfLook({ isStable, isLosing }) {
  if (isStable === undefined) return isLosing ? "with separations" : "in contact";
  if (!isStable) return "unstable cycle";
  return isLosing ? "stable cycle, separating" : "stable cycle, in contact";
}

/** Draw a part of a line in its look. */
function drawPart(ink, from, to, { isStable, isLosing }) {
  ink.strokeStyle = isLosing ? contents.phases.separation : style("--text");
  ink.lineWidth = isStable === undefined ? WIDTHS.plain : isStable ? WIDTHS.stable : WIDTHS.unstable;
  line(ink, from.x, from.y, to.x, to.y);
  ink.lineWidth = 1;
}

/** Draw lines over the values along them, thick where they are stable; returns the looks that occur, by their names. */
function drawLines(ink, points) {
  const { study } = view;
  const { rate, losses } = looksOfLines();
  const seen = new Map();
  const numbers = view.spread === NONE ? [view.place] : study.dim[view.spread].values.map((_, i) => ({ [view.spread]: i }));
  for (const one of numbers) {
    const along = points.filter(({ place }) => view.spread === NONE || place[view.spread] === one[view.spread]);
    const stable = rate ? stableSteps(along.map(({ place }) => value(study, rate, place))) : [];
    along.slice(1).forEach((to, n) => {
      const from = along[n];
      if (![from.x, from.y, to.x, to.y].every(Number.isFinite)) return;
      const look = { isStable: stable[n], isLosing: Boolean(losses) && value(study, losses, to.place) > 0 };
      drawPart(ink, from, to, look);
      if (rate || losses) seen.set(nameOfLook(look), look);
    });
  }
  ringAtChosen(ink, points);
  return seen;
}

/** A ring at the chosen point of a line. */
function ringAtChosen(ink, points) {
  const { place, x, spread } = view;
  const chosen = points.find((one) => one.place[x] === place[x] && (spread === NONE || one.place[spread] === place[spread]));
  if (!chosen || !Number.isFinite(chosen.x + chosen.y)) return;
  ink.strokeStyle = style("--accent");
  ink.lineWidth = 2;
  ink.beginPath();
  ink.arc(chosen.x, chosen.y, 6, 0, 2 * Math.PI);
  ink.stroke();
  ink.lineWidth = 1;
}

/** The entries of a legend for the looks of lines. */
const entriesOfLines = (looks) =>
  [...looks].sort().map(([name, look]) => [bareSwatch((ink) => drawPart(ink, { x: 0, y: 8 }, { x: 16, y: 8 }, look)), name]);

/** The place of the point of a line that is nearest to a place in the map; null if none is near. */
function placeOnLines(points, px, py) {
  const apart = (one) => Math.hypot(one.x - px, one.y - py);
  const there = points.filter((one) => Number.isFinite(one.x + one.y));
  const nearest = there.reduce((best, one) => (!best || apart(one) < apart(best) ? one : best), null);
  return nearest && apart(nearest) <= POINTED ? nearest.place : null;
}
