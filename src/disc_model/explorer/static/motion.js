// The motion at the chosen point, or at the nearest one that has one stored.

/** Places of a motion along the study's dimensions; what it does not lie along is left out. */
function motionPlaces(study, motion) {
  motion.places ??= Object.fromEntries(
    study.dims
      .filter((dim) => Object.keys(dim.parts).every((name) => study.motions.names.includes(name)))
      .map((dim) => [dim.name, dim.values.findIndex((_, i) =>
        Object.entries(dim.parts).every(([name, along]) => along[i] === motion.at[study.motions.names.indexOf(name)]))]),
  );
  return motion.places;
}

/** Motions stored at a point. */
const motionsAt = (place) =>
  (view.study.motions?.points ?? []).filter((motion) =>
    Object.entries(motionPlaces(view.study, motion)).every(([name, at]) => at === place[name]),
  );

/** The variable with the words of what a point comes to: its outcome, or else its kind; undefined without one. */
const wordsOfFate = (study) =>
  outcomeOf(study) ??
  study.variables.find((one) => one.name === "kind" && one.flags && one.dims.every((name) => study.status?.dims.includes(name)));

/** What becomes of a point, as far as its study says: its outcome or kind, or else the stability or lack of its cycle; in words. */
function fateOf(study, place) {
  const outcome = wordsOfFate(study);
  if (outcome) return shown(study, outcome, place);
  const rate = study.variables.find(growth);
  if (!rate) return study.status ? shown(study, study.status, place) : "";
  const gap = gapAt(study, rate, place);
  if (gap) return gap.label;
  const neutral = rate.marks.find((mark) => mark.is_neutral);
  if (neutral && value(study, neutral, place)) return neutral.look.label;
  const stable = stableMark(rate);
  return stable && value(study, stable, place) ? stable.look.label : "unstable";
}

/** The word of what becomes of a cycle: that of its lack, or of its stability. */
function wordOfCycle(study, place) {
  const rate = study.variables.find(growth);
  const gap = rate && gapAt(study, rate, place);
  return gap ? gap.word : fateOf(study, place);
}

/** What a stored motion is, as a sentence: that of its outcome or kind or of its cycle's stability, as far as the quantity has one. */
function saidOfMotion(study, motion) {
  const place = { ...view.place, ...motionPlaces(study, motion) };
  const outcome = wordsOfFate(study);
  const word = outcome ? outcome.flags[value(study, outcome, place)] : wordOfCycle(study, place);
  return study.motions.text_by[word] ?? study.motions.text;
}

/** How far a motion's place is from the chosen point, by places along the axes; infinitely far beyond another word. */
function apartBy(places) {
  const { study, place } = view;
  const along = Object.entries(places).map(([name, at]) => {
    const words = typeof Object.values(study.dim[name].parts)[0][0] === "string"; // which have to agree
    return words && at !== place[name] ? Infinity : ((at - place[name]) / Math.max(1, study.sizes[name] - 1)) ** 2;
  });
  return along.reduce((sum, one) => sum + one, 0);
}

/** The stored motion nearest the chosen point among those of the same fate, null without one. */
function nearestMotion() {
  const { study, place } = view;
  const fate = fateOf(study, place);
  let best = null;
  for (const motion of study.motions?.points ?? []) {
    const places = motionPlaces(study, motion);
    motion.far = apartBy(places);
    const alike = fateOf(study, { ...place, ...places }) === fate;
    if (alike && motion.far < (best?.far ?? Infinity)) best = motion;
  }
  return best;
}

const NEAR = 3; // places along an axis up to which a motion stands for that of another point

/** How many places along any axis a motion is from the chosen point. */
const placesApart = (motion) =>
  Math.max(...Object.entries(motionPlaces(view.study, motion)).map(([name, at]) => Math.abs(at - view.place[name])), 0);

/** Whether a motion was computed at a point of the map: along the axes that it does not show, at their chosen values. */
function isInMap(motion) {
  const { study, place, x, y } = view;
  const places = motionPlaces(study, motion);
  const shown = [x, y].every((name) => places[name] !== undefined);
  return shown && Object.entries(places).every(([name, at]) => name === x || name === y || at === place[name]);
}

/** Why no motion is shown, as a sentence. */
function lackOfMotion(study, place) {
  if (!study.motions) return "No motions of this quantity are stored.";
  const alike = study.motions.points.some((motion) => apartBy(motionPlaces(study, motion)) < Infinity);
  return alike ? `No motion of this kind is stored: ${fateOf(study, place)}.` : "No motion is stored that is computed as this point is.";
}

const SWEPT = "direction"; // the dimension of what a sweep has found on its way up and down

/** What the call of a motion shows. A case may hold several motions, such as those after kicks at random. */
function saidOfCall(study, place) {
  const lines = element("motion-call").textContent;
  const above = lines.includes("(case,") && !lines.startsWith("case = ") ? ", with the case above" : "";
  const transient = transientOf(study, place);
  if (transient > 0) return `The motion of this case after the transient, ${number(transient)} s${above}:`;
  if (startOf(study, place)) return `The motion of this case from its start${above}:`;
  if (view.variable.dims.includes(SWEPT)) return "The motion of this case from the static start; that of the sweep came from the speed before, and may differ:";
  return `The motion of this case from the static start${above}:`;
}

const PANEL = { gap: 34, top: 20, bottom: 44, right: 12 };
const STILL = 1e-6; // span over the size of its variable below which a history is a flat line,
const MARGIN_OF_STILL = 0.05; // and share of this size that is shown on either side
let motionDrawn = null;

/** What a stored motion is, and of which point, as sentences. */
function noteOfMotion(study, motion) {
  if (motion.far === 0) return `At this point. ${saidOfMotion(study, motion)}`;
  const fate = fateOf(study, view.place);
  const like = fate ? `of the same kind, ${fate}, ` : "";
  const ring = isInMap(motion) ? " (ring in the map)" : "";
  const nearest = `earest stored motion ${like}at ${placeOf(study, motion)}${ring}`;
  if (placesApart(motion) <= NEAR) return `N${nearest}. ${saidOfMotion(study, motion)}`;
  return `No motion is shown, because none is stored near this point: the n${nearest} is ${placesApart(motion)} cells away.`;
}

/** Where a motion was computed, in words. */
const placeOf = (study, motion) => where(motion.places, study.dims.filter((dim) => motion.places[dim.name] !== undefined));

/** Write what is known of the motion that is shown, its point in the title if that is another one, and the call of this point's. */
function tellOfMotion(study, place, motion, isShown) {
  const own = motion?.far === 0;
  const other = isShown && !own;
  element("motion-title").textContent = other ? `Motion of another point: ${placeOf(study, motion)}` : "The motion";
  element("motion-note").textContent = motion ? noteOfMotion(study, motion) : lackOfMotion(study, place);
  // an own motion is that of the usual call only after a transient
  const isCalled = !own || transientOf(study, place) > 0;
  element("motion-call").textContent = isCalled ? simulation(study, place, view.variable) : "";
  element("motion-by-call").hidden = !element("motion-call").textContent;
  element("motion-says").textContent = saidOfCall(study, place);
}

function drawMotion() {
  const { study, place } = view;
  const motion = nearestMotion();
  const isShown = Boolean(motion) && placesApart(motion) <= NEAR;
  const canvas = element("motion");
  canvas.hidden = !isShown;
  element("motion-hovered").textContent = "";
  element("phases").replaceChildren();
  motionDrawn = null;
  tellOfMotion(study, place, motion, isShown);
  if (!isShown) return;
  const { ink, width, height } = prepared(canvas);
  const { traces, samples } = study.motions;
  const each = (height - PANEL.top - PANEL.bottom - 14 - PANEL.gap * (traces.length - 1)) / traces.length;
  const histories = traces.map((trace) => history(trace, study.motions.points.indexOf(motion), samples));
  const axes = histories.map((numbers, n) => rangeOf(numbers, traces[n].size));
  const left = Math.max(...axes.map((axis) => widest(ink, axis.ticks))) + 14;
  const last = samples - 1;
  const horizontal = linear(0, last, left, width - PANEL.right);
  traces.forEach((_, n) => {
    const top = PANEL.top + n * (each + PANEL.gap);
    const box = { left, right: width - PANEL.right, top, bottom: top + each };
    const vertical = linear(axes[n].least, axes[n].greatest, box.bottom, box.top);
    const { label, unit, origin } = traces[n];
    const head = `${label} (${axes[n].power ? `10${raised(axes[n].power)} ` : ""}${unit})`;
    yAxis(ink, box, axes[n].ticks, vertical, [origin ? `${head}, ${origin}` : head]);
    ink.strokeRect(box.left, box.top, box.right - box.left, box.bottom - box.top);
    ink.strokeStyle = style("--accent");
    polyline(ink, [...histories[n]].map((x, i) => [horizontal(i), vertical(x)]), true);
  });
  const bottom = height - PANEL.bottom;
  phaseBand(ink, study.motions, motion, horizontal, last, bottom - 10, bottom);
  ink.fillStyle = style("--text");
  const ms = 1e3 * motion.length;
  const ticks = roundTicks(0, ms).map((t) => [(t / ms) * last, number(t, 4)]);
  xAxis(ink, { left, right: width - PANEL.right, bottom }, ticks, horizontal, "time (ms)");
  motionDrawn = { histories, horizontal, last, ms };
}

const history = (trace, point, samples) =>
  Float64Array.from(
    trace.numbers.subarray(point * samples, (point + 1) * samples),
    (n) => trace.least[point] + trace.step[point] * n,
  );

/** Axis of a history: its range, a power of ten taken out of its labels, and ticks. `size`: the greatest value of all
 * histories of the variable; one that hardly varies beside it stands still, and is a flat line. */
function rangeOf(numbers, size = 0) {
  const [low, high] = [Math.min(...numbers), Math.max(...numbers)];
  const middle = Math.max(Math.abs(low), Math.abs(high));
  const greatestSize = Math.max(middle, size);
  const isStill = high - low <= STILL * greatestSize;
  const room = Math.max(isStill ? MARGIN_OF_STILL * greatestSize : (high - low) / 15, 1e-300);
  const [least, greatest] = [low - room, high + room];
  const reach = isStill ? Math.max(-least, greatest) : middle;
  const decade = Math.floor(log10(reach || 1));
  const power = decade < -2 || decade > 4 ? 3 * Math.floor(decade / 3) : 0;
  let steps = [];
  for (let most = 4; steps.length < 2; most++) steps = roundTicks(least, greatest, most);
  const digits = Math.max(2, Math.ceil(log10((reach || 1) / (greatest - least))) + 3);
  return { least, greatest, power, ticks: steps.map((x) => [x, number(x / 10 ** power, digits)]) };
}

/** The look of a phase of a motion: stick has a pattern, as in grey print its colour is that of separation. */
const lookOfPhase = (word) =>
  ({ face: contents.phases[word] ?? style("--empty"), hatch: word === "stick" ? "////" : "", ink: "#ffffff" });

function phaseBand(ink, motions, motion, horizontal, last, top, bottom) {
  const seen = [];
  motion.phase.forEach(([begin, code], n) => {
    const end = n + 1 < motion.phase.length ? motion.phase[n + 1][0] : last;
    const word = motions.phases[code];
    const look = lookOfPhase(word);
    seen[code] = [swatchOf(look), word]; // the legend has the order of the figures
    for (const fill of fillsOf(ink, look)) {
      ink.fillStyle = fill;
      ink.fillRect(horizontal(begin), top, horizontal(end) - horizontal(begin), bottom - top);
    }
  });
  element("phases").replaceChildren(...seen.filter(Boolean).map(legendEntry));
}

/** A number of a trace with its unit, and from where it counts. */
function numberOf(trace, one) {
  const said = `${trace.label} ${withUnit(number(one), trace.unit)}`;
  return trace.origin ? `${said} ${trace.origin}` : said;
}

function hoverMotion(event) {
  if (!motionDrawn) return;
  const { histories, horizontal, last, ms } = motionDrawn;
  const x = event.clientX - element("motion").getBoundingClientRect().left;
  const i = Math.round(((x - horizontal(0)) / (horizontal(last) - horizontal(0))) * last);
  const { traces } = view.study.motions;
  element("motion-hovered").textContent =
    i < 0 || i > last ? "" : [`${number((i / last) * ms, 4)} ms`,
      ...traces.map((trace, n) => numberOf(trace, histories[n][i]))].join(", ");
}
