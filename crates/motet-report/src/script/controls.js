// The words and knobs round the view: what they say of the state, and the scale of colours.

const byId = (id) => document.getElementById(id);

// A number in few signs.
function short(x) {
  if (!Number.isFinite(x)) return "none";
  const size = Math.abs(x);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return x.toExponential(2).replace("e+", "e");
  return String(Number(x.toPrecision(4)));
}

function fill(select, options, chosen) {
  select.replaceChildren(...options.map(([value, text]) => new Option(text, value, false, String(value) === String(chosen))));
}

// The least and the largest value of arrays over all frames, given as pairs of an input and an array of it.
function rangeOfArrays(pairs) {
  let low = Infinity, high = -Infinity;
  for (const [input, array] of pairs) {
    for (const part of input.frames.flatMap((frame) => [frame.skin, frame.inside])) {
      const values = part && part.values[array];
      if (values) [low, high] = [Math.min(low, values.low), Math.max(high, values.high)];
    }
  }
  return low <= high ? [low, high] : [0, 1];
}

function arrayName(input, i) {
  const { title, name, on } = input.arrays[i];
  const isTwice = input.arrays.filter((array) => array.name === name).length > 1;
  return isTwice ? `${title} (${on}s)` : title;
}

// The array of another input that is the same as one of this; -1 if there is none.
function sameArray(input, i, other) {
  const { name, on } = input.arrays[i] ?? {};
  return other.arrays.findIndex((array) => array.name === name && array.on === on);
}

// The scale of an array: a bar with its range, or a list of labels. `pairs`: an input and its array, for each mesh shown.
function showScale(pairs, state) {
  const scale = byId("scale"), [[input, array]] = pairs;
  scale.replaceChildren();
  if (array < 0) return;
  const title = document.createElement("strong"), { unit, is_label: isLabel } = input.arrays[array];
  title.textContent = arrayName(input, array) + (unit ? `, ${unit}` : "");
  scale.append(title);
  if (isLabel) showLabels(scale, pairs, state);
  else showBar(scale, state.range);
}

function showLabels(scale, pairs, { range: [low], seen }) {
  // The same number may have another name in the mesh beside.
  const nameOf = (id) => [...new Set(pairs.map(([input, array]) => input.arrays[array]?.names[id]).filter(Boolean))].join(" / ");
  const colours = labelColours(), list = document.createElement("ul");
  for (const id of seen.slice(0, 24)) {
    const item = document.createElement("li"), patch = document.createElement("i");
    patch.style.background = css(colours, (id - low) % MAX_LABELS);
    item.append(patch, nameOf(id) || String(id));
    list.append(item);
  }
  if (seen.length > 24) list.append(Object.assign(document.createElement("li"), { textContent: `and ${seen.length - 24} more` }));
  scale.append(list);
}

function showBar(scale, [low, high]) {
  const colours = valueColours(), stops = [];
  for (let i = 0; i < 256; i += 15) stops.push(css(colours, i));
  const bar = document.createElement("div"), ends = document.createElement("p");
  bar.className = "bar";
  bar.style.background = `linear-gradient(to right, ${stops.join(",")})`;
  for (const x of [low, (low + high) / 2, high]) {
    ends.append(Object.assign(document.createElement("span"), { textContent: short(x) }));
  }
  scale.append(bar, ends);
}

// The names of meshes side by side.
function showNames(inputs) {
  const names = inputs.length < 2 ? [] : inputs.map(({ name }) => Object.assign(document.createElement("span"), { textContent: name }));
  byId("names").replaceChildren(...names);
}

// The axes in the corner, as the camera sees them.
function showAxes(camera) {
  const parts = [];
  const ends = [0, 1, 2].map((k) => ({ k, x: camera.rows[0][k], y: -camera.rows[1][k], near: camera.rows[2][k] }));
  for (const { k, x, y } of ends.sort((a, b) => a.near - b.near)) {
    parts.push(svg("line", { x1: 0, y1: 0, x2: 22 * x, y2: 22 * y, class: "a" + k }));
    parts.push(svg("text", { x: 30 * x, y: 30 * y + 4, "text-anchor": "middle" }, "xyz"[k]));
  }
  byId("axes").replaceChildren(...parts);
}
