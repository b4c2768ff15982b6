// The state of the view as text behind the `#` of the page's address, and back. What is not understood is passed over.

const few = (x) => String(Number(x.toPrecision(5)));

function linkOf({ state, camera, parts }) {
  const { cut } = state, words = new URLSearchParams({
    input: state.input, frame: state.frame, array: state.array, range: state.range.map(few),
    camera: [...camera.rows.flat(), ...camera.shift, camera.zoom].map(few), edges: Number(state.edges),
  });
  if (state.beside >= 0) words.set("beside", state.beside);
  if (state.bad) words.set("bad", 1);
  if (state.arrows) words.set("arrows", 1);
  if (cut) words.set("cut", [cut.axis, cut.sign, cut.mode, few(state.part)]);
  for (const [key, { isShown, opacity }] of parts.set) words.append("part", `${Number(isShown)},${opacity},${key}`);
  // Commas may stand as they are.
  return `#${words}`.replaceAll("%2C", ",");
}

// `count` numbers, or nothing.
function numbersOf(text, count) {
  const numbers = (text ?? "").split(",").map((word) => (word === "" ? NaN : Number(word)));
  return numbers.length === count && numbers.every(Number.isFinite) ? numbers : null;
}

// What a link says: only what it has, and as far as it can be so.
function stateOfLink(hash) {
  const words = new URLSearchParams(hash.replace(/^#/, ""));
  const number = (name) => numbersOf(words.get(name), 1)?.[0];
  const camera = numbersOf(words.get("camera"), 12), [axis, sign, mode, part] = (words.get("cut") ?? "").split(",");
  const isCut = ["0", "1", "2"].includes(axis) && ["cells", "slice"].includes(mode) && numbersOf(part, 1);
  const parts = words.getAll("part").map((text) => text.match(/^([01]),(0|1|0\.\d+),(.+)$/s)).filter(Boolean);
  return {
    isLink: camera !== null, input: number("input"), beside: number("beside"), frame: number("frame"), array: number("array"),
    range: numbersOf(words.get("range"), 2), edges: words.get("edges") !== "0", bad: words.has("bad"), arrows: words.has("arrows"),
    cut: isCut ? { axis: Number(axis), sign: sign === "-1" ? -1 : 1, mode } : null,
    part: isCut ? Math.min(1, Math.max(0, Number(part))) : 0.5,
    camera, parts: parts.map(([, isShown, opacity, key]) => [key, { isShown: isShown === "1", opacity: Number(opacity) }]),
  };
}

// Puts a text on the clipboard; false if the browser does not let the page.
async function copied(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const field = Object.assign(document.createElement("textarea"), { value: text });
    document.body.append(field);
    field.select();
    const isDone = document.execCommand("copy");
    field.remove();
    return isDone;
  }
}
