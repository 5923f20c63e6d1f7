// Figures, and the beginning of it all.

function enlarge(button) {
  const [image, caption] = [button.querySelector("img"), button.nextElementSibling];
  element("large-title").textContent = button.textContent.trim();
  element("large-image").src = image.src;
  element("large-image").alt = image.alt;
  element("large-caption").textContent = caption.textContent;
  if (!element("large").open) element("large").showModal();
  element("large").dataset.index = pictures.indexOf(button);
}

const pictures = [...document.querySelectorAll(".pictures button")];
for (const button of pictures) button.addEventListener("click", () => enlarge(button));
element("large").addEventListener("keydown", (event) => {
  const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
  const next = step && pictures[Number(element("large").dataset.index) + step];
  if (next) enlarge(next);
});

function update() {
  fillControls();
  tellOfSearch();
  redraw();
  element("grids").ariaBusy = "false";
}

/** On a telephone the figures are folded: all of them together are some forty screens high. */
function foldFigures() {
  if (matchMedia("(max-width: 900px)").matches && contents.studies.length)
    for (const group of document.querySelectorAll("#figures details")) group.open = false;
}

function listen() {
  const map = element("map");
  map.addEventListener("pointermove", (event) => hover(cellAt(map, event)));
  map.addEventListener("pointerleave", () => hover(null));
  map.addEventListener("click", (event) => {
    const place = cellAt(map, event);
    if (place) choose(place);
  });
  map.addEventListener("keydown", move);
  element("motion").addEventListener("pointermove", hoverMotion);
  window.addEventListener("resize", () => {
    showCutTexts();
    redraw();
  });
  window.addEventListener("hashchange", async () => {
    await follow(location.hash.slice(1));
    update();
  });
  element("table").addEventListener("click", () => {
    const file = document.createElement("a");
    file.href = URL.createObjectURL(new Blob([csv()], { type: "text/csv" }));
    file.download = `${view.study.name}_${view.variable.name}.csv`;
    file.click();
    URL.revokeObjectURL(file.href);
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => redraw());
}

async function start() {
  try {
    if (!(await follow(location.hash.slice(1)))) await chooseStudy(firstStudy().name);
  } catch (error) {
    element("map-title").textContent = `This browser cannot unpack the studies: ${error}`;
    return;
  }
  update();
  listen();
  listenToSearch();
}

foldFigures();
if (contents.studies.length) start();
else element("grids").hidden = true;
