// Curves none of whose points has a value.

/** Why a curve has no value at any of its points, as a sentence; "" of one that has. */
function lackOfCurve(cells, numbers) {
  if (numbers.some(Number.isFinite)) return "";
  const { study, variable } = view;
  const counts = new Map();
  for (const { place } of cells) {
    const reason = isLeftOut(study, place) ? `left out ${ruleOf(study)}` : shown(study, variable, place);
    counts.set(reason, (counts.get(reason) ?? 0) + 1);
  }
  const common = [...counts].sort((one, other) => other[1] - one[1]);
  const reasons = common.map(([reason, count]) => (counts.size > 1 ? `${reason} (${count} of ${cells.length})` : reason));
  return `No point of this curve has a value: ${reasons.join(", ")}.`;
}

/** The frame of a curve without a value, with a line at the chosen point. */
function drawEmpty(ink, box) {
  ink.strokeStyle = style("--line");
  ink.strokeRect(box.left, box.top, box.right - box.left, box.bottom - box.top);
  lineAtChosen(ink, box);
}
