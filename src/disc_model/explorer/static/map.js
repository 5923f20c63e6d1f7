// A variable over two dimensions in colour, or over one as a curve.

let drawn = null; // where cells lie, for the pointer

function places() {
  const { study, x, y, place } = view;
  const rows = y === NONE ? [0] : [...study.dim[y].values.keys()];
  return [...study.dim[x].values.keys()].flatMap((i) =>
    rows.map((j) => ({ i, j, place: y === NONE ? { ...place, [x]: i } : { ...place, [x]: i, [y]: j } })),
  );
}

const failed = (study, place) =>
  Boolean(study.status) && study.status.flags[value(study, study.status, place)] !== "ok";

function drawMap() {
  const { study, x, y, variable } = view;
  element("map-title").textContent =
    [`${study.title}: ${variable.label}`, where(view.place, selectors())].filter(Boolean).join(", ");
  const { ink, width, height } = prepared(element("map"));
  const curve = y === NONE;
  const cells = places();
  const numbers = cells.map((cell) => value(study, variable, cell.place));
  const [xs, ys] = [scaleOf(study.dim[x]), curve ? scaleOfNumbers(variable, numbers) : scaleOf(study.dim[y])];
  const colours = curve || variable.flags ? null : colouring(numbers);
  const box = { left: widest(ink, ys.ticks()) + 14, right: width - 14, top: 26, bottom: height - (colours ? 104 : 48) };
  const horizontal = linear(xs.borders[0], xs.borders.at(-1), box.left, box.right);
  const vertical = linear(ys.borders[0], ys.borders.at(-1), box.bottom, box.top);
  ink.fillStyle = style(curve ? "--back" : "--empty");
  ink.fillRect(box.left, box.top, box.right - box.left, box.bottom - box.top);
  const hatch = hatching(ink);
  const dots = curve ? undefined : marks().find(([key]) => key === view.mark);
  const seen = { flags: new Set(), hatched: false, empty: false };
  cells.forEach(({ i, j, place }, n) => {
    // whole pixels, so that no seams show
    const [x0, x1] = [Math.round(horizontal(xs.borders[i])), Math.round(horizontal(xs.borders[i + 1]))];
    const [y0, y1] = curve ? [box.top, box.bottom]
      : [Math.round(vertical(ys.borders[j + 1])), Math.round(vertical(ys.borders[j]))];
    const fill = (look) => {
      ink.fillStyle = look;
      ink.fillRect(x0, y0, x1 - x0, y1 - y0);
    };
    const lost = failed(study, place);
    if (!curve && variable.flags) seen.flags.add(numbers[n]);
    if (!curve && Number.isFinite(numbers[n]))
      (variable.flags ? flagFills(ink, variable, numbers[n]) : [colours.colour(numbers[n])]).forEach(fill);
    else if (!curve && !lost) seen.empty = true;
    if (variable !== study.status && lost) {
      seen.hatched = true;
      fill(hatch);
    }
    if (dots && dots[1].flags[value(study, dots[1], place)] === dots[2]) {
      disc(ink, (x0 + x1) / 2, (y0 + y1) / 2, Math.max(1, Math.min(3, (x1 - x0) / 5, (y1 - y0) / 5)));
    }
  });
  ink.fillStyle = style("--text");
  xAxis(ink, box, xs.ticks(), horizontal, axisLabel(study.dim[x]));
  yAxis(ink, box, ys.ticks(), vertical, axisLabel(curve ? variable : study.dim[y]));
  if (colours) colourBar(ink, { left: box.left, right: box.right, top: height - 44, bottom: height - 32 }, colours);
  drawn = { box, horizontal, vertical, xs, ys };
  if (curve) drawCurve(ink, cells.map(({ i }, n) => [horizontal(xs.at[i]), vertical(numbers[n])]));
  else markChosen(ink);
  legend(seen, dots);
}

const linear = (from, to, start, end) => (x) => start + ((x - from) / (to - from || 1)) * (end - start);

/** A dot that shows on any colour. */
function disc(ink, x, y, radius) {
  ink.beginPath();
  ink.arc(x, y, radius, 0, 2 * Math.PI);
  ink.fillStyle = "#ffffff";
  ink.strokeStyle = "#000000";
  ink.lineWidth = Math.min(1, radius / 2);
  ink.fill();
  ink.stroke();
  ink.lineWidth = 1;
}

function colourBar(ink, box, colours) {
  const size = box.right - box.left;
  colours.map.forEach((colour, i) => {
    ink.fillStyle = colour;
    ink.fillRect(box.left + (i / colours.map.length) * size, box.top, size / colours.map.length + 0.5, box.bottom - box.top);
  });
  ink.fillStyle = style("--text");
  const shares = size < 360 ? [0, 0.5, 1] : [0, 0.25, 0.5, 0.75, 1];
  for (const share of shares) {
    const align = share === 0 ? "left" : share === 1 ? "right" : "center";
    write(ink, number(colours.value(share), 2), box.left + share * size, box.bottom + 5, align, "top");
  }
  write(ink, axisLabel(view.variable), box.left, box.top - 4, "left", "alphabetic");
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
    if (near && near.places[x] !== undefined && near.places[y] !== undefined) {
      ink.beginPath();
      ink.arc(horizontal(xs.at[near.places[x]]), vertical(ys.at[near.places[y]]), 6, 0, 2 * Math.PI);
      ink.stroke();
    }
  }
  ink.lineWidth = 1;
}

function legend(seen, dots) {
  const { study, variable } = view;
  const entries = [...seen.flags].sort((a, b) => a - b)
    .map((code) => [swatchOf(variable.looks[code]), variable.looks[code].label]);
  if (seen.empty) entries.push([style("--empty"), variable.missing]);
  if (seen.hatched) entries.push(["hatched", "no result; the point's status says why"]);
  if (dots) entries.push(["dotted", `${dots[1].label}: ${labelOf(dots[1], dots[2])}`]);
  element("legend").replaceChildren(...entries.map(legendEntry));
}

function legendEntry([look, text]) {
  const item = document.createElement("li");
  const swatch = look instanceof Node ? look : document.createElement("span");
  swatch.classList.add("swatch");
  if (["hatched", "dotted"].includes(look)) swatch.classList.add(look);
  else if (!(look instanceof Node)) swatch.style.background = look;
  item.append(swatch, text);
  return item;
}

// A curve, where one axis is chosen

/** The scale of a curve's numbers, with some room above and below. */
function scaleOfNumbers(variable, numbers) {
  const finite = numbers.filter(Number.isFinite);
  const [least, greatest] = finite.length ? [Math.min(...finite), Math.max(...finite)] : [0, 1];
  const room = (greatest - least || Math.abs(greatest) || 1) / 20;
  const ticks = variable.flags
    ? variable.flags.map((word, code) => [code, word]).filter(([code]) => code >= least && code <= greatest)
    : roundTicks(least - room, greatest + room).map((tick) => [tick, number(tick, 4)]);
  return { borders: [least - room, greatest + room], ticks: () => ticks };
}

/** The curve in its frame, and a line at the chosen point. */
function drawCurve(ink, points) {
  const { box, horizontal, xs } = drawn;
  ink.strokeRect(box.left, box.top, box.right - box.left, box.bottom - box.top);
  ink.strokeStyle = ink.fillStyle = style("--accent");
  polyline(ink, points, !view.variable.flags);
  ink.strokeStyle = style("--text");
  ink.setLineDash([4, 3]);
  const at = horizontal(xs.at[view.place[view.x]]);
  line(ink, at, box.top, at, box.bottom);
  ink.setLineDash([]);
}

/** Points, joined where neighbours have numbers. */
function polyline(ink, points, joined) {
  ink.beginPath();
  let before = false;
  for (const [x, y] of points) {
    const there = Number.isFinite(y);
    if (there && before && joined) ink.lineTo(x, y);
    else if (there) ink.moveTo(x, y);
    before = there;
  }
  ink.stroke();
  if (points.length > 200) return;
  for (const [x, y] of points) if (Number.isFinite(y)) ink.fillRect(x - 2, y - 2, 4, 4);
}
