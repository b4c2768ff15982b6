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

// The least and the largest value of an array over all frames.
function rangeOfArray(input, array) {
  let low = Infinity, high = -Infinity;
  for (const frame of input.frames) {
    for (const part of [frame.skin, frame.inside]) {
      const values = part && part.values[array];
      if (values) [low, high] = [Math.min(low, values.low), Math.max(high, values.high)];
    }
  }
  return low <= high ? [low, high] : [0, 1];
}

function arrayName(input, i) {
  const { name, on } = input.arrays[i];
  const isTwice = input.arrays.filter((array) => array.name === name).length > 1;
  return isTwice ? `${name} (${on}s)` : name;
}

// The scale of an array: a bar with its range, or a list of labels.
function showScale(drawing, input, state) {
  const scale = byId("scale");
  scale.replaceChildren();
  if (state.array < 0) return;
  const title = document.createElement("strong");
  title.textContent = arrayName(input, state.array);
  scale.append(title);
  if (input.arrays[state.array].is_label) showLabels(scale, input, state);
  else showBar(scale, state.range);
}

function showLabels(scale, input, state) {
  const [low, high] = rangeOfArray(input, state.array), { names } = input.arrays[state.array];
  const colours = labelColours(), list = document.createElement("ul");
  const seen = state.seen.filter((id) => id >= low && id <= high);
  for (const id of seen.slice(0, 24)) {
    const item = document.createElement("li"), patch = document.createElement("i");
    patch.style.background = css(colours, (id - low) % MAX_LABELS);
    item.append(patch, names[id] ?? String(id));
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

// The picture with its scale, as a file.
function savePicture(canvas, name) {
  const out = document.createElement("canvas"), scale = byId("scale");
  [out.width, out.height] = [canvas.width, canvas.height];
  const pen = out.getContext("2d"), ratio = canvas.width / canvas.clientWidth;
  pen.drawImage(canvas, 0, 0);
  pen.scale(ratio, ratio);
  pen.font = "13px sans-serif";
  pen.fillStyle = getComputedStyle(scale).color;
  let y = 22;
  const left = 14, title = scale.querySelector("strong"), bar = scale.querySelector(".bar");
  if (title) pen.fillText(title.textContent, left, y);
  if (bar) {
    const colours = valueColours(), texts = [...scale.querySelectorAll("span")].map((e) => e.textContent);
    const ink = pen.fillStyle;
    for (let i = 0; i < 180; i++) {
      pen.fillStyle = css(colours, Math.floor((i * 255) / 179));
      pen.fillRect(left + i, y + 8, 1.5, 12);
    }
    pen.fillStyle = ink;
    ["left", "center", "right"].forEach((side, i) => {
      pen.textAlign = side;
      pen.fillText(texts[i], left + 90 * i, y + 36);
    });
  }
  for (const item of scale.querySelectorAll("li")) {
    y += 18;
    const patch = item.querySelector("i");
    if (patch) {
      const ink = pen.fillStyle;
      pen.fillStyle = patch.style.background;
      pen.fillRect(left, y - 10, 12, 12);
      pen.fillStyle = ink;
    }
    pen.fillText(item.textContent, left + 18, y);
  }
  const link = document.createElement("a");
  link.href = out.toDataURL("image/png");
  link.download = name;
  link.click();
}
