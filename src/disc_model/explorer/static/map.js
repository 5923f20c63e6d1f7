// A variable over two dimensions in colour, or over one as a curve.

const BESIDE = 8; // free beside the first and last point of a curve, pixels
let drawn = null; // where cells lie, for the pointer

/** All places of the map or curve, the one along other dimensions being as chosen unless it is given. */
function places(place = view.place) {
  const { study, x } = view;
  const other = second();
  const rows = other === NONE ? [0] : [...study.dim[other].values.keys()];
  return [...study.dim[x].values.keys()].flatMap((i) =>
    rows.map((j) => ({ i, j, place: other === NONE ? { ...place, [x]: i } : { ...place, [x]: i, [other]: j } })),
  );
}

/** Whether a flag has its first word because its point has no result. A point that failed may have that of some variables, and
 * one without a cycle was computed. */
function isFiller(study, variable, place) {
  if (!study.status || !variable.flags || variable === study.status) return false;
  const status = study.status.flags[value(study, study.status, place)];
  return value(study, variable, place) === 0 && !contents.computed.includes(status);
}

const failed = (study, place) =>
  Boolean(study.status) && study.status.flags[value(study, study.status, place)] !== "ok";

function drawMap() {
  const { study, x, y, variable } = view;
  element("map-title").textContent =
    [`${study.title}: ${variable.label}`, where(view.place, selectors())].filter(Boolean).join(", ");
  const { ink, width, height } = prepared(element("map"));
  const curve = y === NONE;
  const parameter = across();
  const cells = places();
  const numbers = cells.map((cell) => value(study, variable, cell.place));
  const intervals = curve ? intervalsOf(cells) : [];
  const values = parameter ? cells.map((cell) => value(study, parameter, cell.place)) : [];
  const scaleOfCurve = parameter ? scaleOfHeights : scaleOfNumbers;
  const [xs, ys] = [
    parameter ? scaleBetween(values, parameter) : scaleOf(study.dim[x]),
    curve ? scaleOfCurve(variable, [...numbers, ...intervals.flat()]) : scaleOf(study.dim[y]),
  ];
  const colours = curve || variable.flags ? null : colouring(numbers, variable);
  const [left, right] = [widest(ink, ys.ticks()) + 14, width - 14];
  const upward = wrapped(ink, axisLabel(curve ? variable : study.dim[y]), right - left);
  const named = colours ? wrapped(ink, axisLabel(variable), right - left) : [];
  const below = 48 + (colours ? 40 + LINE * named.length : 0);
  const box = { left, right, top: 10 + LINE * upward.length, bottom: height - below };
  const room = curve ? BESIDE : 0;
  const horizontal = linear(xs.borders[0], xs.borders.at(-1), box.left + room, box.right - room);
  const kinds = kindsAlong(cells);
  const vertical = linear(ys.borders[0], ys.borders.at(-1), box.bottom - ROW * kinds.length, box.top);
  ink.fillStyle = style(curve ? "--back" : "--empty");
  ink.fillRect(box.left, box.top, box.right - box.left, box.bottom - box.top);
  const hatch = hatching(ink);
  const chosen = chosenClass() ?? (curve ? stableClass(variable) : undefined);
  const marked = (place) => Boolean(chosen) && chosen.holds(place);
  const over = curve ? [] : marksOver(variable, x, y);
  const patterns = patternsOf(ink, over);
  const lack = curve ? lackOfCurve(cells, numbers) : "";
  element("map-lack").textContent = lack;
  element("map-lack").hidden = !lack;
  // a curve has a gap where none of its points has a number
  const valued = new Set(cells.filter((cell) => !gapAt(study, variable, cell.place)).map((cell) => cell.i));
  const seen = {
    flags: new Set(), gaps: new Set(), marks: new Set(), doubts: new Set(), statuses: new Set(),
    hatched: false, open: false, intervals: false, chosen: !curve, lines: new Map(), samples: new Map(), modes: new Map(), kinds,
  };
  const lastAcross = xs.at.length - 1;
  cells.forEach(({ i, j, place }, n) => {
    // whole pixels, so that no seams show
    const ends = [i === 0 ? left : horizontal(xs.borders[i]), i === lastAcross ? right : horizontal(xs.borders[i + 1])];
    const [x0, x1] = ends.map(Math.round);
    const [y0, y1] = curve ? [box.top, box.bottom]
      : [Math.round(vertical(ys.borders[j + 1])), Math.round(vertical(ys.borders[j]))];
    const fill = (look) => {
      ink.fillStyle = look;
      ink.fillRect(x0, y0, x1 - x0, y1 - y0);
    };
    const gap = parameter || lack || (curve && valued.has(i)) ? null : gapAt(study, variable, place);
    if (!curve && variable.flags) seen.flags.add(numbers[n]);
    const look = gap ?? (!curve && variable.flags ? variable.looks[numbers[n]] : null);
    if (gap) seen.gaps.add(gap);
    if (look) fillsOf(ink, look).forEach(fill);
    else if (!curve) fill(colours.colour(numbers[n]));
    for (const mark of over.filter((one) => value(study, one, place))) {
      seen.marks.add(mark);
      if (mark.look.hatch) fill(patterns.get(mark)[inkOn(look?.face ?? colours.colour(numbers[n]))]);
    }
    if (!lack && isFiller(study, variable, place)) {
      seen.hatched = true;
      seen.statuses.add(shown(study, study.status, place));
      fill(hatch);
    }
    if (!curve && marked(place)) markOfClass(ink, chosen, (x0 + x1) / 2, (y0 + y1) / 2, radiusIn(x1 - x0, y1 - y0));
  });
  ink.fillStyle = style("--text");
  xAxis(ink, box, xs.ticks(), horizontal, axisLabel(parameter ?? study.dim[x]));
  yAxis(ink, box, ys.ticks(), vertical, upward);
  if (colours) colourBar(ink, { left, right, top: height - 44, bottom: height - 32 }, colours, named);
  drawn = { box, horizontal, vertical, xs, ys, heights: curve ? numbers.map((one) => vertical(ys.to(one))) : [] };
  if (lack) {
    drawEmpty(ink, box);
  } else if (parameter) {
    const height = (one) => vertical(ys.to(one));
    drawn.points = cells.map(({ place }, n) => ({ x: horizontal(values[n]), y: height(numbers[n]), place }));
    ink.strokeRect(box.left, box.top, box.right - box.left, box.bottom - box.top);
    seen.lines = drawLines(ink, drawn.points);
  } else if (curve) {
    const open = isJoined() ? openSteps(cells) : [];
    if (open.includes(true)) seen.open = openAlong().reason;
    const points = curveOf(cells, numbers, intervals, marked, seen);
    drawKinds(ink, box, kinds, points);
    seen.samples = drawCurve(ink, points, open, chosen);
    seen.modes = drawModes(ink, points);
  } else markChosen(ink);
  legend(seen, chosen);
}

/** The class that a curve of growth rates marks, that of its stable points, unless another is chosen; it stands for the map's marks. */
const stableClass = (variable) => marks().find((mark) => mark.key === `${variable.name}=stable`);

/** The marks that lie over the cells of a map, as in the figures: a doubt that is one of them already is not drawn twice. */
function marksOver(variable, x, y) {
  const marks = variable.marks.filter((mark) => mark.axes.includes(x) && mark.axes.includes(y));
  const names = marks.map((mark) => mark.look.label);
  return [...marks, ...variable.doubts.filter((doubt) => !names.includes(doubt.look.label))];
}

/** The patterns of marks in black and in white. */
const patternsOf = (ink, over) =>
  new Map(over.map((mark) => [mark, Object.fromEntries(["#000000", "#ffffff"].map((colour) => [colour, pattern(ink, mark.look.hatch, colour)]))]));

const linear = (from, to, start, end) => (x) => start + ((x - from) / (to - from || 1)) * (end - start);

/** The radius of a mark in a cell. */
const radiusIn = (width, height) => Math.max(1, Math.min(MOST_RADIUS, width / 5, height / 5));

/** A dot that shows on any colour. */
function disc(ink, x, y, radius) {
  ink.beginPath();
  ink.arc(x, y, radius, 0, 2 * Math.PI);
  fillOutlined(ink, Math.min(1, radius / 2));
}

const LARGER = 1.6; // half a diagonal of a diamond over the radius of a dot

/** A diamond that shows on any colour. */
function diamond(ink, x, y, radius) {
  const half = LARGER * radius;
  ink.beginPath();
  ink.moveTo(x, y - half);
  ink.lineTo(x + half, y);
  ink.lineTo(x, y + half);
  ink.lineTo(x - half, y);
  ink.closePath();
  fillOutlined(ink, Math.min(1.5, radius / 2));
}

/** Fill a path with white, and draw its outline in black. */
function fillOutlined(ink, thick) {
  ink.fillStyle = "#ffffff";
  ink.strokeStyle = "#000000";
  ink.lineWidth = thick;
  ink.fill();
  ink.stroke();
  ink.lineWidth = 1;
}

/** The mark of a chosen class: a dot of stable growth rates, as in the figures, and a diamond of any other. */
function markOfClass(ink, chosen, x, y, radius) {
  const draw = chosen.isStable ? disc : diamond;
  draw(ink, x, y, radius);
}

const APART = 10; // between texts below a bar, pixels

/** The room that a text takes at an end of a bar, with a gap beside it. */
const roomOf = (ink, text) => (text ? ink.measureText(text).width + APART : 0);

function colourBar(ink, box, colours, title) {
  const size = box.right - box.left;
  colours.map.forEach((colour, i) => {
    ink.fillStyle = colour;
    ink.fillRect(box.left + (i / colours.map.length) * size, box.top, size / colours.map.length + 0.5, box.bottom - box.top);
  });
  ink.fillStyle = style("--text");
  const ticks = colours.ticks(size);
  const digits = digitsOf(ticks.map(([, found]) => found));
  const [below, above] = colours.beyond;
  write(ink, below, box.left, box.bottom + 5, "left", "top");
  write(ink, above, box.right, box.bottom + 5, "right", "top");
  const [first, last] = [box.left + roomOf(ink, below), box.right - roomOf(ink, above)];
  const written = [];
  const extra = ticks.some(([, found]) => found < 0) ? ink.measureText("−").width : 0;
  for (const [share, found] of ticks) {
    const text = number(found, digits);
    const width = ink.measureText(text).width;
    const at = box.left + share * size;
    const left = Math.max(box.left, Math.min(at - width / 2, box.right - width));
    const right = left + width;
    // as wide as with a minus, so that both signs of a number are written or neither
    const more = found > 0 ? extra / 2 : 0;
    const isFree = written.every((other) => right + more + APART <= other.left || left - more >= other.right + APART);
    if (left < first || right > last || !isFree) continue;
    write(ink, text, left, box.bottom + 5, "left", "top");
    written.push({ left: left - more, right: right + more });
  }
  writeLines(ink, title, box.left, box.top - 4);
}

/** The chosen cell in a frame, a ring where the motion that is shown was computed. */
function markChosen(ink) {
  const { x, y, place } = view;
  const { horizontal, vertical, xs, ys } = drawn;
  const [i, j] = [place[x], place[y]];
  const [x0, x1] = [horizontal(xs.borders[i]), horizontal(xs.borders[i + 1])];
  const [y0, y1] = [vertical(ys.borders[j + 1]), vertical(ys.borders[j])];
  for (const [colour, thick] of [["#000000", 4], ["#ffffff", 2]]) {
    ink.strokeStyle = colour;
    ink.lineWidth = thick;
    ink.strokeRect(x0, y0, x1 - x0, y1 - y0);
    const near = nearestMotion();
    if (near && isInMap(near)) {
      ink.beginPath();
      ink.arc(horizontal(xs.middles[near.places[x]]), vertical(ys.middles[near.places[y]]), 6, 0, 2 * Math.PI);
      ink.stroke();
    }
  }
  ink.lineWidth = 1;
}

function legend(seen, chosen) {
  const { study, variable } = view;
  const entries = [...seen.flags].sort((a, b) => a - b)
    .map((code) => [swatchOf(variable.looks[code]), variable.looks[code].label]);
  for (const look of variable.gaps?.looks ?? []) if (seen.gaps.has(look)) entries.push([swatchOf(look), look.label]);
  for (const mark of [...variable.marks, ...variable.doubts])
    if (seen.marks.has(mark)) entries.push([swatchOf(mark.look), mark.look.label]);
  for (const doubt of variable.doubts) if (seen.doubts.has(doubt)) entries.push([bareSwatch(markOf(doubt)), doubt.look.label]);
  if (seen.intervals) entries.push([bareSwatch((ink) => bar(ink, 8, 1, 15)), intervalName(study)]);
  if (seen.open) entries.push([bareSwatch((ink) => stroke(ink, 8, 3)), seen.open]);
  if (seen.hatched) entries.push(["hatched", `no result: ${[...seen.statuses].join(", ")}`]);
  entries.push(...entriesOfLines(seen.lines), ...entriesOfSamples(seen.samples, seen.kinds));
  entries.push(...entriesOfModes(seen.modes));
  if (chosen && !seen.lines.size && seen.chosen) entries.push([classSwatch(chosen), chosen.title]);
  element("legend").replaceChildren(...entries.map(legendEntry));
}

function legendEntry([look, text]) {
  const item = document.createElement("li");
  const swatch = look instanceof Node ? look : document.createElement("span");
  swatch.classList.add("swatch");
  if (look === "hatched") swatch.classList.add(look);
  else if (!(look instanceof Node)) swatch.style.background = look;
  item.append(swatch, text);
  return item;
}

// A curve, where one axis is chosen

/** The scale of a curve's numbers, with some room above and below. */
function scaleOfNumbers(variable, numbers) {
  const finite = numbers.filter(Number.isFinite);
  const [least, greatest] = finite.length ? [Math.min(...finite), Math.max(...finite)] : [0, 1];
  const isOfRates = variable.scale && finite.length > 0;
  if (isOfRates && isOverDecades(variable.scale, least, greatest)) return scaleOfRates(variable.scale, least, greatest);
  const room = (greatest - least || Math.abs(greatest) || 1) / 20;
  if (!finite.length) return { borders: [least, greatest], to: identity, ticks: () => [] };
  const ticks = variable.flags
    ? variable.looks.map((look, code) => [code, look.label]).filter(([code]) => code >= least && code <= greatest)
    : ticksBetween(least - room, greatest + room, variable.whole).map((tick) => [tick, number(tick, 4)]);
  return { borders: [least - room, greatest + room], to: identity, ticks: () => ticks };
}

/** Whether growth rates lie over more than a linear axis shows: some by more than a decade beyond the width around 0 in which
 * colours are linear, and not all of one sign within a decade. */
function isOverDecades({ width }, least, greatest) {
  const [smaller, larger] = [Math.abs(least), Math.abs(greatest)].sort((a, b) => a - b);
  return larger > 10 * width && !(least * greatest > 0 && larger <= 10 * smaller);
}

/** The scale of a curve of growth rates: nearly linear around 0 and nearly logarithmic beyond, as peaks of tens stand beside
 * hundredths; its width is that of the colours of maps. It has round numbers at both ends. */
function scaleOfRates({ width }, least, greatest) {
  const to = (rate) => Math.asinh(rate / width);
  const [low, high] = [-endBeyond(-least, width), endBeyond(greatest, width)];
  const room = (to(high) - to(low)) / 50;
  const borders = [to(low) - room, to(high) + room];
  const sizes = stepsUpTo(Math.max(-low, high), 10 ** Math.floor(log10(width)));
  const decades = sizes.filter(isPowerOfTen);
  const signed = [...decades, ...sizes].flatMap((size) => [size, -size]);
  const inside = signed.filter((rate) => rate > low && rate < high);
  const ticks = [...new Set([low, high, ...(low <= 0 && high >= 0 ? [0] : []), ...inside])];
  return { borders, to, ticks: () => ticks.map((rate) => [to(rate), number(rate, 2)]) };
}

const FEWEST = 3; // numbers on a part of an axis that is logarithmic

/** The round number at an end of an axis of growth rates at or beyond a rate, counted outward from 0; where the rate lies beyond
 * the width, it is one of at least three beyond it. Of a rate on the other side of 0, it is the one before that. */
function endBeyond(rate, width) {
  const { rounding } = contents.rates;
  if (Math.abs(rate) <= rounding) return 0;
  const steps = stepsBetween(Math.abs(rate), Math.abs(rate));
  if (rate < 0) return -steps.findLast((step) => step <= -rate);
  const end = steps.find((step) => step >= rate);
  if (rate <= width) return end;
  return Math.max(end, stepsBetween(width, width).filter((step) => step >= width)[FEWEST - 1]);
}

/** Whether a curve joins its points: those of one line, along which its number has values between them; counts have none. */
const isJoined = () => {
  const across = view.study.dim[view.x];
  return !view.variable.flags && !view.variable.whole && view.spread === NONE && !across.words && !counts(across);
};

/** The points of a curve as they are drawn, and what of them the legend names. */
function curveOf(cells, numbers, intervals, marked, seen) {
  const { study, variable } = view;
  const { horizontal, vertical, xs, ys } = drawn;
  const height = (one) => vertical(ys.to(one));
  const isOfSamples = areSampled();
  return cells.map(({ i, place }, n) => {
    const isDoubtful = Number.isFinite(numbers[n]) && !isOfSamples; // samples have rings instead
    const doubts = isDoubtful ? doubtsAt(study, variable, place) : [];
    const ends = (intervals[n] ?? []).filter(Number.isFinite).map(height);
    for (const doubt of doubts) seen.doubts.add(doubt);
    if (ends.length) seen.intervals = true;
    if (marked(place) && Number.isFinite(numbers[n])) seen.chosen = true;
    return { place, x: horizontal(xs.at[i]), y: height(numbers[n]), ends, doubts, marked: marked(place) };
  });
}

/** The open steps of curves along the horizontal axis; undefined without. */
function openAlong() {
  return view.variable.open.find((one) => one.axis === view.x);
}

/** At which steps to the next point the curve is open, by the rule of the figures. */
function openSteps(cells) {
  const open = openAlong();
  return cells.map(({ place }) => Boolean(open) && value(view.study, open, place) > 0);
}

/** The ends of the interval of each point of a curve; none of a variable without. */
function intervalsOf(cells) {
  const { study, variable } = view;
  const ends = intervalOf(study, variable);
  return ends ? cells.map(({ place }) => ends.map((one) => value(study, one, place))) : [];
}

const STROKE = 10; // height of a stroke, pixels

/** A stroke, as figures have above an open step of a line. */
function stroke(ink, x, top) {
  ink.lineWidth = 2;
  line(ink, x, top, x, top + STROKE);
  ink.lineWidth = 1;
}

/** The bar of an interval, with its ends. */
function bar(ink, x, low, high) {
  line(ink, x, low, x, high);
  for (const end of [low, high]) line(ink, x - 3, end, x + 3, end);
}

/** An arrow below a point whose value is a bound, and may be less. */
function arrow(ink, x, y) {
  line(ink, x, y, x, y + 12);
  line(ink, x - 3, y + 8, x, y + 12);
  line(ink, x + 3, y + 8, x, y + 12);
}

/** A large filled mark, of a point whose value may be another one. */
function filledMark(ink, x, y) {
  ink.beginPath();
  ink.arc(x, y, 5, 0, 2 * Math.PI);
  ink.fill();
}

/** What draws the mark of a doubt in the middle of a swatch. */
const markOf = (doubt) => (doubt.is_bound ? (ink) => arrow(ink, 8, 2) : (ink) => filledMark(ink, 8, 8));

/** A legend's swatch with a mark of a curve. */
function bareSwatch(draw) {
  const swatch = document.createElement("canvas");
  swatch.width = swatch.height = 16;
  swatch.classList.add("bare");
  const own = swatch.getContext("2d");
  own.fillStyle = own.strokeStyle = style("--accent");
  draw(own);
  return swatch;
}

/** The marks of a curve's points and open steps. */
function markCurve(ink, points, open, chosen) {
  points.forEach(({ x, y, ends, doubts, marked }, n) => {
    if (open[n]) stroke(ink, (x + points[n + 1].x) / 2, drawn.box.top + 3);
    if (!Number.isFinite(y)) return;
    if (ends.length === 2) bar(ink, x, ...ends);
    for (const doubt of doubts) {
      if (doubt.is_bound) arrow(ink, x, y);
      else filledMark(ink, x, y);
    }
    if (marked) markOfClass(ink, chosen, x, y, MOST_RADIUS);
    ink.fillStyle = ink.strokeStyle = style("--accent");
  });
}

/** A dashed line at the chosen point of a curve; returns where it is. */
function lineAtChosen(ink, box) {
  const at = drawn.horizontal(drawn.xs.at[view.place[view.x]]);
  ink.strokeStyle = style("--text");
  ink.setLineDash([4, 3]);
  line(ink, at, box.top, at, box.bottom);
  ink.setLineDash([]);
  return at;
}

/** The curve in its frame, with its marks, and a line at the chosen point, which has a ring among others; returns the looks of
 * samples, by their names. */
function drawCurve(ink, points, open, chosen) {
  const { box } = drawn;
  ink.strokeStyle = style("--line");
  ink.strokeRect(box.left, box.top, box.right - box.left, box.bottom - box.top);
  const zero = drawn.vertical(0);
  if (view.variable.scale && zero > box.top && zero < box.bottom) line(ink, box.left, zero, box.right, zero);
  ink.strokeStyle = ink.fillStyle = style("--accent");
  const isAtBound = (n) => points[n].doubts.some((doubt) => doubt.is_bound);
  const opens = (n) => open[n] || isAtBound(n) || isAtBound(n + 1); // a value at a bound may lie anywhere below
  const samples = areSampled() ? drawSamples(ink, points) : new Map();
  ink.strokeStyle = ink.fillStyle = style("--accent");
  if (!areSampled()) polyline(ink, points.map(({ x, y }) => [x, y]), isJoined(), opens);
  markCurve(ink, points, open, chosen);
  const at = lineAtChosen(ink, box);
  const height = drawn.vertical(drawn.ys.to(value(view.study, view.variable, view.place)));
  if (view.spread === NONE || !Number.isFinite(height)) return samples;
  ink.beginPath();
  ink.arc(at, height, 6, 0, 2 * Math.PI);
  ink.stroke();
  return samples;
}

const FEW = 200; // points of a line that have squares
const CROWD = 2000; // points from which on their squares are small

/** Points, joined where neighbours have numbers and the step from one to the next is not open; each has a square where they
 * are few, and where no line shows it. */
function polyline(ink, points, joined, opens = () => false) {
  const there = (n) => n >= 0 && n < points.length && Number.isFinite(points[n][1]);
  const joins = (n) => joined && there(n) && there(n + 1) && !opens(n);
  ink.beginPath();
  points.forEach(([x, y], n) => {
    if (!joined || !there(n)) return;
    if (joins(n - 1)) ink.lineTo(x, y);
    else ink.moveTo(x, y);
  });
  ink.stroke();
  const side = points.length > CROWD ? 2 : 4;
  points.forEach(([x, y], n) => {
    const isAlone = !(joins(n - 1) || joins(n));
    if (there(n) && (isAlone || points.length <= FEW)) ink.fillRect(x - side / 2, y - side / 2, side, side);
  });
}
