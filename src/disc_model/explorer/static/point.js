// Pointing at the map, and what is known of the chosen point.

function cellAt(canvas, event) {
  const { left, top } = canvas.getBoundingClientRect();
  const [px, py] = [event.clientX - left, event.clientY - top];
  const { box, horizontal, vertical, xs, ys } = drawn;
  if (px < box.left || px > box.right || py < box.top || py > box.bottom) return null;
  const inside = (scale, position, at) =>
    scale.at.findIndex((_, n) => {
      const ends = [position(scale.borders[n]), position(scale.borders[n + 1])];
      return at >= Math.min(...ends) && at <= Math.max(...ends);
    });
  const found = { ...view.place, [view.x]: inside(xs, horizontal, px) };
  return view.y === NONE ? found : { ...found, [view.y]: inside(ys, vertical, py) };
}

/** Where a point lies, in words. */
function where(place, dims = view.study.dims) {
  return dims
    .map((dim) => (dim.words ? dim.values[place[dim.name]]
      : `${dim.name} = ${withUnit(number(dim.values[place[dim.name]]), dim.unit)}`))
    .join(", ");
}

function hover(place) {
  const { study, variable, x, y } = view;
  const axes = [x, y].filter((name) => name !== NONE).map((name) => study.dim[name]);
  const status = place && failed(study, place) && variable !== study.status ? `; ${shown(study, study.status, place)}` : "";
  element("hovered").textContent =
    place ? `${where(place, axes)}: ${variable.name} ${shown(study, variable, place)}${status}` : "";
}

const MOVES = { ArrowLeft: ["x", -1], ArrowRight: ["x", 1], ArrowDown: ["y", -1], ArrowUp: ["y", 1] };

function move(event) {
  const step = MOVES[event.key];
  if (!step || view[step[0]] === NONE) return;
  event.preventDefault();
  const name = view[step[0]];
  const to = Math.min(view.study.sizes[name] - 1, Math.max(0, view.place[name] + step[1]));
  choose({ ...view.place, [name]: to });
}

function choose(place, pointed = place) {
  view.place = place;
  drawMap();
  hover(pointed);
  showPoint();
  drawMotion();
}

function showPoint() {
  const { study, place, variable } = view;
  const own = study.dims.filter((dim) => study.status?.dims.includes(dim.name) || variable.dims.includes(dim.name));
  element("point").textContent = `${where(place, own)}: ${variable.name} ${shown(study, variable, place)}`;
  const message = messageAt(study, place);
  const status = study.status ? shown(study, study.status, place) : "ok";
  element("message").textContent = status === "ok" ? message : `${status}: ${message}`;
  fillTable("values", study.variables.map((one) => [one, shown(study, one, place)]));
  fillTable("fixed", study.fixed.map((one) => [one, withUnit(number(one.value), one.unit)]));
}

function fillTable(id, rows) {
  const filled = rows.map(([one, text]) => {
    const row = document.createElement("tr");
    const [head, cell] = ["th", "td"].map((tag) => document.createElement(tag));
    head.scope = "row";
    head.textContent = `${one.name}: ${one.title}`;
    cell.textContent = text;
    row.append(head, cell);
    return row;
  });
  element(id).replaceChildren(...filled);
}
