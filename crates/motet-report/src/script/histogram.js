// Bars of quality of the frame that is shown, as SVG.

const SVG_NAMESPACE = "http://www.w3.org/2000/svg";

function svg(name, attributes, text) {
  const element = document.createElementNS(SVG_NAMESPACE, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  return element;
}

function withThousands(n) {
  return String(n).replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

// Round counts from 0 to the first that is not below `most`.
function roundUpTo(most) {
  const power = 10 ** Math.floor(Math.log10(Math.max(1, most / 4)));
  const step = [1, 2, 5, 10].map((x) => x * power).find((x) => 4 * x >= most) ?? most;
  return Array.from({ length: Math.ceil(most / step) + 1 }, (_, i) => i * step);
}

// `ticks`: pairs of a place, counted in bars, and what stands there. The first `nBad` bars are marked.
function histogram(element, counts, ticks, name, nBad, rangeOf) {
  const width = 360, height = 190, left = 50, right = 12, above = 10, below = 34;
  const most = Math.max(1, ...counts), step = (width - left - right) / counts.length;
  const marks = roundUpTo(most), top = marks.at(-1);
  const y = (n) => height - below - ((height - below - above) * n) / top;
  const parts = [];
  for (const n of marks) {
    const at = y(n);
    parts.push(svg("line", { class: "grid", x1: left, x2: width - right, y1: at, y2: at }));
    parts.push(svg("text", { x: left - 6, y: at + 3.5, "text-anchor": "end" }, withThousands(n)));
  }
  counts.forEach((n, i) => {
    // What is there shows, be it ever so few.
    const tall = n > 0 ? Math.max(1.5, height - below - y(n)) : 0;
    const bar = svg("rect", {
      class: i < nBad ? "bar bad" : "bar", x: left + i * step + 0.5, width: Math.max(0.5, step - 1), y: height - below - tall, height: tall,
    });
    bar.append(svg("title", {}, `${rangeOf(i)}: ${withThousands(n)}`));
    parts.push(bar);
  });
  parts.push(svg("line", { class: "axis", x1: left, x2: width - right, y1: height - below, y2: height - below }));
  for (const [place, text] of ticks) {
    parts.push(svg("text", { x: left + place * step, y: height - below + 15, "text-anchor": "middle" }, text));
  }
  parts.push(svg("text", { class: "name", x: (left + width - right) / 2, y: height - 4, "text-anchor": "middle" }, name));
  element.replaceChildren(...parts);
}

// The histograms of one input, for the frame that is shown of it.
function showHistograms(view, frame) {
  const eas = document.getElementById(`eas-${view}`), angle = document.getElementById(`angle-${view}`);
  if (!eas || !frame.bars) return;
  // Where nothing is inverted the bar below 0 is left out.
  const first = frame.bars.eas[0] === 0 ? 1 : 0, counts = frame.bars.eas.slice(first);
  const zero = 1 - first;
  const ticks = [0, 0.2, 0.4, 0.6, 0.8, 1].map((x) => [zero + 20 * x, String(x)]);
  if (zero) ticks.unshift([0.2, "< 0"]);
  const rangeOf = (i) => (i < zero ? "below 0" : `${((i - zero) / 20).toFixed(2)} to ${((i - zero + 1) / 20).toFixed(2)}`);
  histogram(eas, counts, ticks, "EAS quality (bad below 0.2)", zero + 4, rangeOf);
  const angles = [0, 15, 30, 45, 60, 75].map((x) => [x / 5, String(x)]);
  histogram(angle, frame.bars.angle, angles, "smallest dihedral angle, degrees", 0, (i) => `${5 * i} to ${5 * i + 5}`);
}

// The line in the charts of an input that marks the time of the frame that is shown.
function markTime(view, time) {
  for (const chart of document.querySelectorAll(`[data-view="${view}"] svg.chart[data-x]`)) {
    const [from, to, low, high] = chart.dataset.x.split(" ").map(Number);
    const at = from + ((to - from) * (time - low)) / (high - low), cursor = chart.querySelector(".cursor");
    cursor.setAttribute("x1", at);
    cursor.setAttribute("x2", at);
  }
}
