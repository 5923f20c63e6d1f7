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
    return [left + horizontal(xs.at[i]), top + vertical(ys.at[j])];
  },
  // The left end of the history, in the window.
  beginning() {
    const {left, top, height} = intoView("motion");
    return [left + motionDrawn.horizontal(0), top + height / 2];
  },
  // The colour a little below and left of a cell's middle, where no ring and no dot is.
  colour(i, j) {
    const {xs, ys, horizontal, vertical} = drawn;
    const quarter = (scale, position, n) => (position(scale.at[n]) + position(scale.borders[n])) / 2;
    return pixel(quarter(xs, horizontal, i), quarter(ys, vertical, j));
  },
  // The colour of a pixel some pixels right of a cell's middle.
  pixel(i, j, shift) {
    const {xs, ys, horizontal, vertical} = drawn;
    const found = pixel(horizontal(xs.at[i]) + shift, vertical(ys.at[j]) + 20);
    return "#" + found.map(x => x.toString(16).padStart(2, "0")).join("");
  },
  middle(i, j) {
    const {xs, ys, horizontal, vertical} = drawn;
    return pixel(horizontal(xs.at[i]), vertical(ys.at[j]));
  },
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
  link: () => document.getElementById("link").getAttribute("href"),
  // The selectors whose title is not the text of what is chosen.
  untitled: () => [...document.querySelectorAll("select")].filter(x => x.title !== x.selectedOptions[0].text).map(x => x.name),
  // The colour of a number on the bar's scale.
  colourOf: number => colouring([number], view.variable.scale).colour(number),
  sizesOfType: of => [...document.querySelectorAll(of)]
    .filter(x => x.innerText).map(x => parseFloat(getComputedStyle(x).fontSize)),
};
