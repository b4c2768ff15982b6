// The patches and regions of what is shown: which are visible, how opaque each is, and their list in the panel.

// Meshes side by side share what is set for a part of the same name.
function partName(input, { array, id }) {
  const { name, names } = input.arrays[array];
  return id === null ? `no ${name}` : names[id] || `${name} ${id}`;
}

function partKey(input, part) {
  return `${input.arrays[part.array].name}: ${partName(input, part)}`;
}

class Parts {
  // `changed` is called after each change by hand.
  constructor(changed) {
    this.changed = changed;
    // What differs from the page's own choice, by key.
    this.set = new Map();
  }
  of(input, part) {
    return this.set.get(partKey(input, part)) ?? { isShown: true, opacity: part.opacity };
  }
  // A function from a triangle of the skin, or a cell inside (`where`), to its opacity: that of its patch times that of its region.
  opacities(input, labels, where) {
    const tables = labels.filter((list) => list[where]).map((list) => {
      const parts = input.parts.filter(({ array }) => array === list.array);
      const opacity = (part) => (this.of(input, part).isShown ? this.of(input, part).opacity : 0);
      return [list[where], new Map(parts.map((part) => [part.id ?? NO_VALUE, opacity(part)]))];
    });
    return (i) => tables.reduce((product, [ids, byId]) => product * (byId.get(ids[i]) ?? 1), 1);
  }
  reset() {
    this.set.clear();
  }
  list(inputs) {
    const kinds = { patch: new Map(), region: new Map() };
    for (const input of inputs) {
      for (const part of input.parts) kinds[input.arrays[part.array].name].set(partKey(input, part), [input, part]);
    }
    const lists = Object.entries(kinds).filter(([, rows]) => rows.size > 0);
    byId("parts").hidden = lists.length === 0;
    byId("part-lists").replaceChildren(...lists.map(([kind, rows]) => {
      const list = document.createElement("ul");
      list.setAttribute("aria-label", kind === "patch" ? "Patches" : "Regions");
      list.append(...[...rows.values()].map(([input, part]) => this.row(input, part)));
      return list;
    }));
  }
  row(input, part) {
    const { isShown, opacity } = this.of(input, part), name = partName(input, part);
    const row = document.createElement("li"), label = document.createElement("label");
    const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: isShown });
    const knob = Object.assign(document.createElement("input"), { type: "range", min: 0, max: 100, step: 5, value: 100 * opacity });
    knob.setAttribute("aria-label", `Opacity of ${name}, percent`);
    knob.disabled = !isShown;
    label.className = "check";
    label.append(box, name);
    row.append(label, knob);
    row.addEventListener("input", () => {
      knob.disabled = !box.checked;
      this.set.set(partKey(input, part), { isShown: box.checked, opacity: knob.value / 100 });
      this.changed();
    });
    return row;
  }
}
