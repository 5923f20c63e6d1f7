// What all drawings share: scales, colours, axes.

// Scales

const MOST_TICKS = 6;
const log10 = (x) => Math.log10(x);
const identity = (x) => x;
const gaps = (values) => values.slice(1).map((x, i) => x - values[i]);
const UNEVEN = 0.4;

/** How far from evenly spread values are: 0 if the median gap is the mean one. */
function unevenness(values) {
  const sorted = gaps(values).sort((a, b) => a - b);
  const median = sorted[Math.floor(sorted.length / 2)];
  return Math.abs((median * sorted.length) / (values[values.length - 1] - values[0]) - 1);
}

/** Where values of a dimension lie: by themselves, by their logarithms, or by their places; and the borders and middles of
 * their cells. As in figures, an axis of several numbers ends at the first and last one, whose cells are half as wide. */
function scaleOf(dim) {
  const count = dim.values.length;
  const decade = !dim.words && dim.values[0] > 0 && dim.values[count - 1] >= 10 * dim.values[0];
  const fits = {
    linear: dim.words ? Infinity : count < 3 ? 0 : unevenness(dim.values),
    log: decade && count > 2 ? unevenness(dim.values.map(log10)) : Infinity,
    place: UNEVEN,
  };
  const kind = Object.keys(fits).reduce((best, one) => (fits[one] < fits[best] ? one : best));
  const to = kind === "log" ? log10 : identity;
  const at = kind === "place" ? dim.values.map((_, i) => i) : dim.values.map(to);
  const apart = count > 1 ? gaps(at) : [1];
  const middle = at.slice(1).map((_, i) => at[i] + apart[i] / 2);
  const isWhole = kind === "place" || count === 1;
  const [before, after] = isWhole ? [apart[0] / 2, apart.at(-1) / 2] : [0, 0];
  const borders = [at[0] - before, ...middle, at[count - 1] + after];
  const middles = at.map((_, i) => (borders[i] + borders[i + 1]) / 2);
  return { kind, at, borders, middles, ticks: () => ticksOf(dim, kind, at) };
}

/** Ticks from the first to the last value, and none beyond in their cells. */
function ticksOf(dim, kind, at) {
  const [first, last] = [at[0], at.at(-1)];
  const whole = dim.values.every(Number.isInteger);
  if (kind === "linear" && at.length === 1) return [[first, number(first, 4)]];
  if (kind === "linear")
    return ticksBetween(first, last, whole)
      .map((x) => [x, number(x, 4)]);
  if (kind === "log") {
    const found = stepsBetween(10 ** first, 10 ** last, last - first > 2.5 ? [1] : STEPS);
    const inside = found.filter((x) => log10(x) >= first && log10(x) <= last);
    return inside.map((x) => [log10(x), number(x, 4)]);
  }
  const every = Math.ceil(at.length / MOST_TICKS);
  return at.filter((i) => i % every === 0).map((i) => [i, number(dim.shown[i], 3)]);
}

function roundTicks(first, last, most = MOST_TICKS) {
  const rough = (last - first) / most || 1;
  const power = 10 ** Math.floor(log10(rough));
  const step = power * [1, 2, 5, 10].find((digit) => digit * power >= rough);
  const found = [];
  for (let i = Math.ceil(first / step - 1e-9); i * step <= last + 1e-9 * step; i++) found.push(i * step);
  return found;
}

/** Round ticks, whole ones of counts. */
const ticksBetween = (first, last, whole) => roundTicks(first, last).filter((x) => !whole || Number.isInteger(x));

// Colours

const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** What figures call a class, by its word. */
const labelOf = (variable, word) => variable.looks[variable.flags.indexOf(word)].label;

/** What an area of a class is filled with: its colour, and its pattern over it; a mark in a legend lies on white paper. */
function fillsOf(ink, { face, hatch, ink: line }) {
  const paper = face === "none" ? "#ffffff" : face;
  return hatch ? [paper, pattern(ink, hatch, line)] : [paper];
}

/** Black or white, whichever is seen on a colour in grey print. */
function inkOn(colour) {
  const channels = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16) / 255);
  const lightness = channels.reduce((sum, channel, i) => sum + contents.weights[i] * channel, 0);
  return lightness < 0.5 ? "#ffffff" : "#000000";
}

// shares of a bar that is not linear, those first that are written where there is no room for all
const EIGHTHS = [0, 1, 0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875];

/** Colours of numbers: `colour(x)`, `ticks(size)` of the bar, of a size in pixels, as shares of it and numbers, the more important
 * ones first, and the words of its ends `beyond` which numbers lie. */
function colouring(numbers, { scale, whole }) {
  const finite = numbers.filter(Number.isFinite).sort((a, b) => a - b);
  if (!finite.length) return null;
  if (scale && view.colours === "auto") return coloursOfRates(finite, scale);
  const [least, greatest] = [finite[0], finite[finite.length - 1]];
  const both = least < 0 && greatest > 0;
  const zero = both ? 0 : least;
  const size = both ? Math.max(-least, greatest) : greatest - least;
  // what lies at the beginning of the scale does not say how the rest is spread
  const sizes = finite.map((x) => Math.abs(x - zero)).filter((x) => x > 0).sort((a, b) => a - b);
  const quarter = sizes[Math.floor(sizes.length / 4)] || size / 100;
  const stretched = view.colours === "stretched" || (view.colours === "auto" && !whole && size > 40 * quarter);
  const width = stretched ? Math.max(quarter, 1e-6 * size) : 0;
  const share = (x) => (stretched ? Math.asinh(x / width) / Math.asinh(size / width) : x / size);
  const back = (s) => (stretched ? width * Math.sinh(s * Math.asinh(size / width)) : s * size);
  const map = both ? contents.maps.diverging : contents.maps.sequential;
  const place = (x) => (size === 0 ? 0.5 : both ? (1 + share(x)) / 2 : share(x - zero));
  const found = (at) => (size === 0 ? least : both ? back(2 * at - 1) : zero + back(at));
  return {
    map,
    beyond: ["", ""],
    colour: (x) => colourAt(map, place(x)),
    ticks: (pixels) => {
      if (size === 0) return [[0.5, least]]; // one number alone
      if (whole) return wholeTicks(least, greatest, pixels).map((count) => [place(count), count]);
      const places = stretched ? EIGHTHS : pixels < 360 ? [0, 0.5, 1] : [0, 0.25, 0.5, 0.75, 1];
      return places.map((at) => [at, found(at)]);
    },
  };
}

/** Whole numbers between two, as many as a bar has room for. */
const wholeTicks = (least, greatest, pixels) =>
  [...new Set([least, ...roundTicks(least, greatest, pixels < 360 ? 3 : MOST_TICKS), greatest])]
    .filter((x, i, all) => Number.isInteger(x) && (x === greatest || i === 0 || greatest - x > (greatest - least) / 12));

const colourAt = (map, share) => map[Math.round(Math.min(1, Math.max(0, share)) * (map.length - 1))];

/** Colours of growth rates in ascending order, on a scale that ends at a rate of either sign, or at zero where no rate has one of
 * the signs. */
function coloursOfRates(rates, usual) {
  const { width, end } = scaleOfColours(rates, usual);
  const share = (x) => (1 + Math.asinh(x / width) / Math.asinh(end / width)) / 2;
  const [low, high] = endsOfRates(rates, end);
  const place = (x) => (share(x) - share(low)) / (share(high) - share(low));
  const all = contents.maps.diverging;
  const map = all.slice(low === 0 ? all.length / 2 : 0, high === 0 ? all.length / 2 : all.length);
  const beyond = [rates[0] < -end ? `≤ ${number(-end, 3)}` : "", rates.at(-1) > end ? `≥ ${number(end, 3)}` : ""];
  const marked = ratesOnBar(low, high).filter((rate) => isAwayFromEnds(place(rate)));
  const steps = stepsUpTo(end, width, STEPS_OF_BAR).flatMap((size) => [-size, size]);
  const between = steps.filter((rate) => isAwayFromEnds(place(rate)));
  const ticks = () => [...new Set([low, high, ...marked, ...between])].map((rate) => [place(rate), rate]);
  return { map, beyond, colour: (x) => colourAt(all, share(x)), ticks };
}

/** The rates at the ends of a bar of rates in ascending order: zero at one end where no rate has that sign, but for rounding. */
function endsOfRates(rates, end) {
  const { rounding } = contents.rates;
  const [least, greatest] = [rates[0], rates.at(-1)];
  if (least >= -rounding && greatest > rounding) return [0, end];
  if (greatest <= rounding && least < -rounding) return [-end, 0];
  return [-end, end];
}

const STEPS = [1, 2, 5]; // times powers of ten, along an axis

const STEPS_OF_BAR = [1, 3]; // those of figures

/** The steps of the decades from a number on, up to another one. */
const stepsUpTo = (greatest, least, digits = STEPS) =>
  stepsBetween(least, greatest, digits).filter((step) => step >= least && step <= greatest);

const isPowerOfTen = (step) => Math.abs(log10(step) - Math.round(log10(step))) < 1e-9;

/** The steps of some decades, in ascending order: those of two numbers, and one more. */
function stepsBetween(least, greatest, digits = STEPS) {
  const found = [];
  for (let power = Math.floor(log10(least)); power <= Math.floor(log10(greatest)) + 1; power++)
    for (const digit of digits) found.push(Number(`${digit}e${power}`));
  return found;
}

/** Zero and two powers of ten on each side of it, up to the larger end of a bar of growth rates, zero first. */
function ratesOnBar(low, high) {
  const largest = 10 ** Math.floor(log10(Math.max(-low, high)));
  return [0, -largest, largest, -largest / 10, largest / 10];
}

/** Whether a number at this share of a bar does not meet those of its ends. */
const isAwayFromEnds = (share) => share > contents.rates.near_end && share < 1 - contents.rates.near_end;

/** The scale that figures have for a variable; that of the rates of the map alone where most of them lie beyond it. */
function scaleOfColours(rates, usual) {
  const { rounding, common, linear_share, linear_of_median } = contents.rates;
  // the zeros of undamped modes say nothing of the others
  const sizes = rates.map(Math.abs).filter((size) => size > rounding).sort((a, b) => a - b);
  const median = sizes[Math.floor(sizes.length / 2)] ?? 0;
  if (median <= usual.end) return usual;
  const end = sizes[Math.ceil(common * (sizes.length - 1))];
  return { end, width: Math.min(linear_of_median * median, linear_share * end) };
}

// Canvas

function prepared(canvas) {
  const { width, height } = canvas.getBoundingClientRect();
  const ratio = window.devicePixelRatio || 1;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const ink = canvas.getContext("2d");
  ink.scale(ratio, ratio);
  ink.font = "13px system-ui, sans-serif";
  ink.fillStyle = ink.strokeStyle = style("--text");
  return { ink, width, height };
}

function write(ink, text, x, y, align = "center", baseline = "middle") {
  ink.textAlign = align;
  ink.textBaseline = baseline;
  ink.fillText(text, x, y);
}

const LINE = 16; // height of a line of text, pixels

/** A text in lines that fit a width. */
function wrapped(ink, text, width) {
  const lines = [];
  for (const word of text.split(" ")) {
    const longer = lines.length ? `${lines.at(-1)} ${word}` : word;
    if (lines.length && ink.measureText(longer).width <= width) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

/** Lines of text of which the last one stands at a height. */
function writeLines(ink, lines, x, y) {
  lines.forEach((text, n) => write(ink, text, x, y - LINE * (lines.length - 1 - n), "left", "alphabetic"));
}

/** A pattern for points without a result. */
const hatching = (ink) => pattern(ink, "////", style("--text"));

// Lines of a pattern in a square of side 1, by its letter as in the figures; dots and rings are drawn apart.
const STROKES = {
  "/": [[-1, 1, 1, -1], [0, 1, 1, 0], [1, 1, 2, 0], [0, 2, 2, 0]],
  "\\": [[-1, 0, 1, 2], [0, 0, 1, 1], [0, -1, 2, 1]],
  "|": [[0.5, 0, 0.5, 1]],
  "-": [[0, 0.5, 1, 0.5]],
  "+": [[0.5, 0, 0.5, 1], [0, 0.5, 1, 0.5]],
  x: [[0, 0, 1, 1], [0, 1, 1, 0]],
  "*": [[0.5, 0.2, 0.5, 0.8], [0.24, 0.35, 0.76, 0.65], [0.24, 0.65, 0.76, 0.35]],
};

/** The side of the square that a pattern repeats: as in the figures, more letters make it denser. */
const tileSide = (hatch) => Math.max(5, 14 - 1.5 * hatch.length);

function patternTile(hatch, colour) {
  const side = Math.round(tileSide(hatch));
  const tile = document.createElement("canvas");
  tile.width = tile.height = side;
  const own = tile.getContext("2d");
  own.strokeStyle = own.fillStyle = colour;
  own.lineWidth = 1;
  own.beginPath();
  for (const [x0, y0, x1, y1] of STROKES[hatch[0]] ?? []) {
    own.moveTo(x0 * side, y0 * side);
    own.lineTo(x1 * side, y1 * side);
  }
  if (hatch[0] === "o") own.arc(side / 2, side / 2, side / 4, 0, 2 * Math.PI);
  own.stroke();
  if (hatch[0] === ".") {
    own.beginPath();
    own.arc(side / 2, side / 2, 1.2, 0, 2 * Math.PI);
    own.fill();
  }
  return tile;
}

const pattern = (ink, hatch, colour) => ink.createPattern(patternTile(hatch, colour), "repeat");

/** A legend's swatch in the look of a class. */
function swatchOf(look) {
  const swatch = document.createElement("canvas");
  swatch.width = swatch.height = 16;
  const own = swatch.getContext("2d");
  for (const fill of fillsOf(own, look)) {
    own.fillStyle = fill;
    own.fillRect(0, 0, swatch.width, swatch.height);
  }
  return swatch;
}

const MOST_RADIUS = 3; // of a dot, pixels

/** A legend's swatch with the mark of a class as in the map. */
function classSwatch(chosen) {
  const swatch = document.createElement("canvas");
  swatch.width = swatch.height = 16;
  swatch.classList.add("bare");
  markOfClass(swatch.getContext("2d"), chosen, 8, 8, MOST_RADIUS);
  return swatch;
}

const MARGIN = 12; // free on the right of an axis, pixels

/** An axis at the bottom; its title and numbers stay inside the picture, which is little wider. */
function xAxis(ink, box, ticks, position, title) {
  ink.strokeStyle = style("--line");
  const inside = (x, half) => Math.max(half, Math.min(x, box.right + MARGIN - half));
  let free = -Infinity;
  for (const [at, text] of ticks) {
    const mark = position(at);
    const half = ink.measureText(text).width / 2;
    const x = inside(mark, half);
    line(ink, mark, box.bottom, mark, box.bottom + 4);
    if (x - half > free + 6) {
      write(ink, text, x, box.bottom + 7, "center", "top");
      free = x + half;
    }
  }
  const middle = inside((box.left + box.right) / 2, ink.measureText(title).width / 2);
  write(ink, title, middle, box.bottom + 26, "center", "top");
}

/** An axis on the left, its title in lines above it; a number that would meet one before it in the list is not written. */
function yAxis(ink, box, ticks, position, title) {
  ink.strokeStyle = style("--line");
  const written = [];
  for (const [at, text] of ticks) {
    const y = position(at);
    line(ink, box.left - 4, y, box.left, y);
    if (written.some((other) => Math.abs(other - y) < LINE - 2)) continue;
    write(ink, text, box.left - 7, y, "right");
    written.push(y);
  }
  writeLines(ink, title, box.left, box.top - 10);
}

function line(ink, x0, y0, x1, y1) {
  ink.beginPath();
  ink.moveTo(x0, y0);
  ink.lineTo(x1, y1);
  ink.stroke();
}

const widest = (ink, ticks) => Math.max(...ticks.map(([, text]) => ink.measureText(text).width), 0);
