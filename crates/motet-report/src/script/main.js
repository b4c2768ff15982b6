// The view: its state, and what follows from each change of it.

const SLIDER = 1000;

class View {
  constructor() {
    this.canvas = byId("view");
    this.drawing = new Drawing(this.canvas);
    this.camera = new Camera();
    this.state = { input: 0, frame: 0, array: -1, range: [0, 1], seen: [], edges: true, bad: false, cut: null, part: 0.5 };
    this.token = 0;
    this.timer = null;
    this.listen();
    this.chooseInput(manifest.inputs.findIndex((input) => input.frames.length > 0));
  }

  get input() {
    return manifest.inputs[this.state.input];
  }
  get frame() {
    return this.input.frames[this.state.frame];
  }

  chooseInput(i) {
    this.pause();
    Object.assign(this.state, { input: i, frame: 0 });
    const { input } = this, corners = input.frames.map(({ skin }) => [skin.low, skin.low.map((x, k) => x + 1048575 * skin.step[k])]);
    this.low = [0, 1, 2].map((k) => Math.min(...corners.map(([low]) => low[k])));
    this.high = [0, 1, 2].map((k) => Math.max(...corners.map(([, high]) => high[k])));
    this.camera.aim(this.low, this.high);
    const has = (array) => input.frames.some((frame) => frame.skin.values[array]);
    this.arrays = input.arrays.map((_, i) => i).filter(has);
    this.state.array = this.firstArray();
    fill(byId("array"), [...this.arrays.map((i) => [i, arrayName(input, i)]), [-1, "one colour"]], this.state.array);
    const isSeries = input.frames.length > 1;
    byId("player").hidden = !isSeries;
    byId("frame").max = input.frames.length - 1;
    const bad = input.frames.some((frame) => frame.inside && frame.bad > 0);
    byId("bad").disabled = !bad;
    byId("bad").checked = this.state.bad = bad && this.state.bad;
    this.resetRange();
    return this.show();
  }

  // Quality where there is some, else gaps.
  firstArray() {
    const { arrays } = this.input;
    const find = (name) => this.arrays.find((i) => arrays[i].name === name);
    return find("EAS quality") ?? find("gap") ?? this.arrays[0] ?? -1;
  }

  resetRange() {
    const { state, input } = this;
    if (state.array < 0) return;
    const isEas = input.arrays[state.array].name === "EAS quality" && state.array === 0;
    const [low, high] = rangeOfArray(input, state.array);
    state.range = isEas ? [Math.min(0, low), 1] : [low, high];
    byId("low").value = short(state.range[0]);
    byId("high").value = short(state.range[1]);
    byId("range").hidden = input.arrays[state.array].is_label;
  }

  // Loads what is chosen, then draws it; what was asked for since is shown instead.
  async show() {
    const token = ++this.token, { state, frame, input } = this;
    document.documentElement.dataset.busy = "1";
    byId("busy").hidden = false;
    try {
      const onPoints = state.array >= 0 && input.arrays[state.array].on === "point";
      if (!this.loaded || this.loaded.frame !== frame) {
        const loaded = await loadFrame(frame);
        if (token !== this.token) return;
        this.loaded = loaded;
      }
      const values = state.array < 0 ? { skin: null, inside: null } : await loadValues(frame, state.array, onPoints);
      if (token !== this.token) return;
      this.values = values;
      this.rebuild();
      this.tell();
    } catch (error) {
      byId("note").textContent = `This frame cannot be shown: ${error.message}`;
      console.error(error);
    }
    byId("busy").hidden = true;
    document.documentElement.dataset.busy = "0";
  }

  // Triangles anew, as the cut wants them.
  rebuild() {
    const { state, loaded, values, drawing } = this, cut = this.cutOf();
    const isLabel = state.array >= 0 && this.input.arrays[state.array].is_label;
    drawing.layers.skin.put(skinTriangles(loaded, values, cut));
    const inside = !cut ? new Triangles(1) : cut.mode === "slice" ? slice(loaded, values, cut) : crinkle(loaded, values, cut);
    drawing.layers.cut.put(inside);
    drawing.layers.bad.put(state.bad ? badTriangles(loaded, cut) : new Triangles(1));
    if (isLabel) state.seen = this.labelsSeen();
    showScale(drawing, this.input, state);
    this.redraw();
  }

  labelsSeen() {
    const seen = new Set();
    for (const list of [this.values.skin, this.values.inside]) if (list) for (const x of list) if (x !== NO_VALUE) seen.add(Math.round(x));
    return [...seen].sort((a, b) => a - b);
  }

  // Where the cut is: at one of the planes, where the frame has no more.
  cutOf() {
    const { cut, part } = this.state;
    if (!cut) return null;
    const { axis } = cut, low = this.low[axis], high = this.high[axis];
    let at = low + part * (high - low);
    const planes = this.loaded.inside && this.loaded.inside.planes[axis];
    if (planes && planes.length) at = planes.reduce((a, b) => (Math.abs(b - at) < Math.abs(a - at) ? b : a));
    byId("place").textContent = `${"xyz"[axis]} = ${short(at)}`;
    return { ...cut, at };
  }

  redraw() {
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      this.isAsked = false;
      this.draw();
    });
  }

  draw() {
    if (!this.loaded) return;
    const { state } = this, style = getComputedStyle(this.canvas);
    const colour = (name) => style.getPropertyValue(name).trim().split(/[\s,]+/).map((x) => x / 255);
    this.drawing.draw(this.camera, {
      ...state, cut: this.cutOf(), isLabel: state.array >= 0 && this.input.arrays[state.array].is_label,
      ground: colour("--ground"), none: colour("--none"), edgeColour: colour("--edge"),
    });
    showAxes(this.camera);
    this.canvas.dataset.drawn = Number(this.canvas.dataset.drawn ?? 0) + 1;
  }

  // What is said of the frame that is shown.
  tell() {
    const { state, frame, input, loaded } = this, said = [];
    if (input.is_series) said.push(`Frame ${frame.frame + 1} of ${input.n_frames}, time ${short(frame.time)}.`);
    if (frame.tets !== null) {
      said.push(`Worst EAS ${short(frame.worst.eas)}, ${withThousands(frame.bad)} of ${withThousands(frame.tets)} tets bad.`);
    }
    if (state.cut && loaded.inside && loaded.inside.canCut && !loaded.inside.isWhole) {
      const n = loaded.inside.planes[0].length;
      said.push(n === 1 ? "One plane along each axis is there to cut at." : `${n} planes along each axis are there to cut at.`);
    } else if (state.cut && frame.tets !== null && !(loaded.inside && loaded.inside.canCut)) {
      said.push("Only the surface of this frame is on the page: the cut shows it hollow.");
    }
    byId("note").textContent = said.join(" ");
    byId("frame").value = state.frame;
    byId("frame").setAttribute("aria-valuetext", `time ${short(frame.time)}`);
    byId("time").textContent = `time ${short(frame.time)}`;
    showHistograms(state.input, frame);
    markTime(state.input, frame.time);
  }

  go(k) {
    const n = this.input.frames.length;
    this.state.frame = ((k % n) + n) % n;
    return this.show();
  }
  pause() {
    clearTimeout(this.timer);
    this.timer = null;
    byId("play").textContent = "Play";
    byId("play").setAttribute("aria-pressed", "false");
  }
  play() {
    if (this.input.frames.length < 2) return;
    if (this.timer) return this.pause();
    byId("play").textContent = "Pause";
    byId("play").setAttribute("aria-pressed", "true");
    const step = async () => {
      await this.go(this.state.frame + 1);
      if (this.timer) this.timer = setTimeout(step, 160);
    };
    this.timer = setTimeout(step, 0);
  }

  changeCut() {
    const axis = byId("cut").value;
    this.state.cut = axis === "" ? null : { axis: Number(axis), sign: byId("flip").checked ? -1 : 1, mode: byId("mode").value };
    for (const id of ["part", "flip", "mode"]) byId(id).disabled = !this.state.cut;
    if (!this.state.cut) byId("place").textContent = "";
    this.rebuild();
    this.tell();
  }

  listen() {
    const { camera, canvas, state } = this, redraw = () => this.redraw();
    listenToHand(canvas, camera, redraw);
    listenToKeys(canvas, camera, redraw, {
      " ": () => this.play(), ".": () => this.go(state.frame + 1), ",": () => this.go(state.frame - 1),
    });
    const on = (id, event, act) => byId(id).addEventListener(event, act);
    fill(byId("input"), manifest.inputs.map((input, i) => [i, input.name]).filter(([i]) => manifest.inputs[i].frames.length), 0);
    byId("inputs").hidden = byId("input").options.length < 2;
    on("input", "change", () => this.chooseInput(Number(byId("input").value)));
    on("array", "change", () => {
      state.array = Number(byId("array").value);
      this.resetRange();
      this.show();
    });
    for (const id of ["low", "high"]) on(id, "change", () => this.changeRange());
    on("whole", "click", () => {
      this.resetRange();
      this.rebuild();
    });
    on("edges", "change", () => {
      state.edges = byId("edges").checked;
      this.redraw();
    });
    on("bad", "change", () => {
      state.bad = byId("bad").checked;
      this.rebuild();
    });
    for (const id of ["cut", "flip", "mode"]) on(id, "change", () => this.changeCut());
    on("part", "input", () => {
      state.part = byId("part").value / SLIDER;
      // Once a picture: the hand is faster than a million cells.
      this.soon ??= requestAnimationFrame(() => {
        this.soon = null;
        if (state.cut) this.rebuild();
      });
    });
    on("frame", "input", () => {
      this.pause();
      this.go(Number(byId("frame").value));
    });
    on("play", "click", () => this.play());
    on("back", "click", () => this.go(state.frame - 1));
    on("on", "click", () => this.go(state.frame + 1));
    on("save", "click", () => savePicture(canvas, `${this.input.name}-${this.frame.frame}.png`));
    on("reset", "click", () => {
      camera.reset();
      redraw();
    });
    for (const button of document.querySelectorAll("[data-look]")) {
      button.addEventListener("click", () => {
        camera.look(button.dataset.look);
        redraw();
      });
    }
    new ResizeObserver(redraw).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  }

  changeRange() {
    const [low, high] = ["low", "high"].map((id) => Number(byId(id).value.replace("\u2212", "-")));
    if (Number.isFinite(low) && Number.isFinite(high) && low < high) this.state.range = [low, high];
    else [byId("low").value, byId("high").value] = this.state.range.map(short);
    showScale(this.drawing, this.input, this.state);
    this.redraw();
  }
}

// What a page without pictures still shows: the histograms of the last frame of each input, and times in the charts.
manifest.inputs.forEach((input, i) => {
  const last = input.frames.at(-1);
  if (last) showHistograms(i, last);
});

if (byId("view")) {
  try {
    if (typeof DecompressionStream === "undefined") throw new Error("no DecompressionStream");
    new View();
  } catch (error) {
    byId("viewer").hidden = true;
    byId("no-view").hidden = false;
    byId("no-view").querySelector("span").textContent = error.message;
    document.documentElement.dataset.busy = "0";
  }
}
