// Samples of motions after a transient, as in the figures: marks of their phases, and a strip of kinds of motion.

const ROW = 14; // height of a row of the strip, pixels
const KIND = 4; // half the width of a mark on it
const SAMPLE = 3.5; // and of one of a sample,
const IN_CROWD = 2; // and where there are many

const turned = (count, from, inner = 1) =>
  Array.from({ length: count }, (_, n) => {
    const [angle, size] = [from + (2 * Math.PI * n) / count, n % 2 ? inner : 1];
    return [size * Math.cos(angle), size * Math.sin(angle)];
  });

// Corners of closed marks in a circle of radius 1, and ends of the lines of open ones, by their letters in the figures.
const CORNERS = {
  s: [[-0.8, -0.8], [0.8, -0.8], [0.8, 0.8], [-0.8, 0.8]],
  D: turned(4, 0),
  "^": turned(3, -Math.PI / 2),
  v: turned(3, Math.PI / 2),
  ">": turned(3, 0),
  o: turned(16, 0),
  ".": turned(8, 0).map(([x, y]) => [x / 2, y / 2]),
  "*": turned(10, -Math.PI / 2, 0.4),
  P: [[-0.35, -1], [0.35, -1], [0.35, -0.35], [1, -0.35], [1, 0.35], [0.35, 0.35], [0.35, 1], [-0.35, 1], [-0.35, 0.35],
    [-1, 0.35], [-1, -0.35], [-0.35, -0.35]],
};
const ENDS = {
  "+": [[-1, 0, 1, 0], [0, -1, 0, 1]],
  _: [[-1, 0, 1, 0]],
  1: [[0, 0, 0, 1], [0, 0, -0.8, -0.6], [0, 0, 0.8, -0.6]],
  4: [[0, 0, 1, 0], [0, 0, -0.6, -0.8], [0, 0, -0.6, 0.8]],
};

/** A mark by its letter, in one colour: full or hollow. */
function shapeAt(ink, shape, colour, x, y, radius, isFilled) {
  ink.strokeStyle = ink.fillStyle = colour;
  for (const [x0, y0, x1, y1] of ENDS[shape] ?? []) line(ink, x + radius * x0, y + radius * y0, x + radius * x1, y + radius * y1);
  const corners = CORNERS[shape];
  if (!corners) return;
  ink.beginPath();
  for (const [across, down] of corners) ink.lineTo(x + radius * across, y + radius * down);
  ink.closePath();
  if (isFilled) ink.fill();
  else ink.stroke();
}

const flagOf = (study, name) => study.variables.find((one) => one.name === name && one.flags);
const wordAt = (study, variable, place) => variable.flags[value(study, variable, place)];

/** Whether the curve that is drawn is of samples, each with a phase. */
function areSampled() {
  const { study, variable, y } = view;
  return y === NONE && study.samples.length > 0 && String(flagOf(study, "phase")?.dims) === String(variable.dims);
}

/** The look of a sample: the mark of its phase, or a ring where its motion is not shown to have settled; undefined of none. */
function lookOfSample(place) {
  const { study } = view;
  const mark = study.samples.find((one) => one.phase === wordAt(study, flagOf(study, "phase"), place));
  if (!mark) return undefined;
  if (wordAt(study, flagOf(study, "settled"), place) === "settled")
    return { label: mark.label, shape: mark.shape, colour: contents.phases[mark.phase], isFilled: true };
  return { label: mark.unsettled, shape: mark.ring, colour: style("--soft"), isFilled: false };
}

/** Draw samples; returns the looks that occur, by their names. */
function drawSamples(ink, points) {
  const seen = new Map();
  const radius = points.length > CROWD ? IN_CROWD : SAMPLE;
  for (const { x, y, place } of points) {
    const look = Number.isFinite(y) && lookOfSample(place);
    if (!look) continue;
    shapeAt(ink, look.shape, look.colour, x, y, radius, look.isFilled);
    seen.set(look.label, look);
  }
  return seen;
}

/** The kinds of motion along a curve, in the order of their rows; none where the study's points have no kind of their own. */
function kindsAlong(cells) {
  const { study, y, x } = view;
  const kind = flagOf(study, "kind");
  if (y !== NONE || !study.kinds || !kind?.dims.includes(x)) return [];
  const found = new Set(cells.map(({ place }) => wordAt(study, kind, place)));
  return study.kinds.marks.filter((mark) => found.has(mark.kind));
}

/** Draw the strip of kinds along the lower edge of a curve. */
function drawKinds(ink, box, rows, points) {
  if (!rows.length) return;
  ink.fillStyle = style("--empty");
  ink.fillRect(box.left, box.bottom - ROW * rows.length, box.right - box.left, ROW * rows.length);
  const kind = flagOf(view.study, "kind");
  const firsts = points.filter(({ x }, n) => n === 0 || x !== points[n - 1].x);
  for (const { x, place } of firsts) {
    const row = rows.findIndex((mark) => mark.kind === wordAt(view.study, kind, place));
    if (row >= 0) shapeAt(ink, rows[row].shape, style("--text"), x, box.bottom - ROW * (row + 0.5), KIND, rows[row].is_filled);
  }
}

/** The entries of a legend for samples and kinds. */
function entriesOfSamples(looks, rows) {
  const swatch = (shape, colour, isFilled) => bareSwatch((ink) => shapeAt(ink, shape, colour, 8, 8, 6, isFilled));
  const samples = [...looks.values()].map((look) => [swatch(look.shape, look.colour, look.isFilled), look.label]);
  const kinds = rows.map((mark) => [swatch(mark.shape, style("--text"), mark.is_filled), mark.label]);
  const strip = rows.length ? [[style("--empty"), view.study.kinds.title]] : [];
  return [...samples, ...strip, ...kinds];
}
