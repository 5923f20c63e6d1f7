// What the tests of the explorer look at in its page, and do there; each is called with what its test gives.
const control = label => document.getElementById("controls").elements.namedItem(label);
const pixel = (x, y) =>
  [...document.getElementById("map").getContext("2d").getImageData(Math.round(x), Math.round(y), 1, 1).data].slice(0, 3);
const intoView = id => {
  const element = document.getElementById(id);
  element.scrollIntoView({block: "center", behavior: "instant"});
  return element.getBoundingClientRect();
};

const seen = {
  choose(label, option) {
    const select = control(label);
    if (![...select.options].some(one => one.value === option)) throw Error(option);
    select.value = option;
    select.dispatchEvent(new Event("change"));
  },
  options: label => [...control(label).options].map(x => x.value),

  // The middle of a cell, in the window; the map is brought into view.
  centre(i, j) {
    const {left, top} = intoView("map");
    const {xs, ys, horizontal, vertical} = drawn;
    return [left + horizontal(xs.middles[i]), top + vertical(ys.middles[j])];
  },
  // The left end of the history, in the window.
  beginning() {
    const {left, top, height} = intoView("motion");
    return [left + motionDrawn.horizontal(0), top + height / 2];
  },
  // The colour a little below and left of a cell's middle, where no ring and no dot is.
  colour(i, j) {
    const {xs, ys, horizontal, vertical} = drawn;
    const quarter = (scale, position, n) => (position(scale.middles[n]) + position(scale.borders[n])) / 2;
    return pixel(quarter(xs, horizontal, i), quarter(ys, vertical, j));
  },
  // The colour of a pixel some pixels right of a cell's middle.
  pixel(i, j, shift) {
    const {xs, ys, horizontal, vertical} = drawn;
    const found = pixel(horizontal(xs.middles[i]) + shift, vertical(ys.middles[j]) + 20);
    return "#" + found.map(x => x.toString(16).padStart(2, "0")).join("");
  },
  // All colours of the inside of a cell.
  coloursOf(i, j) {
    const {xs, ys, horizontal, vertical} = drawn;
    const [x0, x1] = [horizontal(xs.borders[i]), horizontal(xs.borders[i + 1])];
    const [y0, y1] = [vertical(ys.borders[j + 1]), vertical(ys.borders[j])];
    const {data} = document.getElementById("map").getContext("2d").getImageData(x0 + 4, y0 + 4, x1 - x0 - 8, y1 - y0 - 8);
    const hex = n => "#" + [0, 1, 2].map(k => data[4 * n + k].toString(16).padStart(2, "0")).join("");
    return [...new Set([...Array(data.length / 4).keys()].map(hex))];
  },
  // The first and last value of both axes, and where their cells begin and end.
  ends: () => [drawn.xs, drawn.ys].map(({at, borders}) => [at[0], at.at(-1), borders[0], borders.at(-1)]),
  // The texts below selectors.
  below: () => [...document.querySelectorAll("#controls span")].map(x => x.textContent),
  colours() {
    const map = document.getElementById("map");
    const {data} = map.getContext("2d").getImageData(0, 0, map.width, map.height);
    return new Set(new Uint32Array(data.buffer)).size;
  },
  // Whether the lines of the colour bar's title fit between its ends.
  titleFits() {
    const ink = document.getElementById("map").getContext("2d");
    const { left, right } = drawn.box;
    return wrapped(ink, axisLabel(view.variable), right - left).every(text => ink.measureText(text).width <= right - left);
  },
  // How many pixels are pure white: of dots, in a curve on a dark page.
  whites() {
    const map = document.getElementById("map");
    const {data} = map.getContext("2d").getImageData(0, 0, map.width, map.height);
    return new Uint32Array(data.buffer).filter(pixel => pixel === 0xffffffff).length;
  },
  // The ends of the title and of a number at the right end of an axis from left to right.
  endsOfWords([left, right], title, text) {
    const ends = [];
    const ink = document.createElement("canvas").getContext("2d");
    const half = text => ink.measureText(text).width / 2;
    ink.fillText = (text, x) => ends.push([x - half(text), x + half(text)]);
    xAxis(ink, { left, right, bottom: 10 }, [[1, text]], () => right, title);
    return ends;
  },
  link: () => document.getElementById("link").getAttribute("href"),
  // The selectors whose title is not the text of what is chosen.
  untitled: () => [...document.querySelectorAll("select")].filter(x => x.title !== x.selectedOptions[0].text).map(x => x.name),
  // The colour of a number on the bar's scale.
  colourOf: number => colouring([number], view.variable).colour(number),
  // The words below the bar of growth rates, from left to right.
  wordsOfBar(rates, scale) {
    const words = [];
    const ink = document.createElement("canvas").getContext("2d");
    ink.fillText = (text, x) => text && words.push([x, text]);
    colourBar(ink, { left: 0, right: 300, top: 0, bottom: 10 }, coloursOfRates(rates, scale), []);
    return words.sort((a, b) => a[0] - b[0]).map(([, text]) => text);
  },
  // The numbers that are written on the vertical axis of growth rates, from the largest to the least, and whether it is linear.
  wordsOfRates(rates, scale, height) {
    const words = [];
    const ink = document.createElement("canvas").getContext("2d");
    ink.fillText = (text, x, y) => words.push([y, text]);
    const ys = scaleOfNumbers({ scale }, rates);
    const position = linear(ys.borders[0], ys.borders.at(-1), height, 0);
    yAxis(ink, { left: 50, top: 0 }, ys.ticks(), position, []);
    return [words.sort((a, b) => a[0] - b[0]).map(([, text]) => text), ys.to === identity];
  },
  sizesOfType: of => [...document.querySelectorAll(of)]
    .filter(x => x.innerText).map(x => parseFloat(getComputedStyle(x).fontSize)),
};
