// The view: its state, and what follows from each change of it.

const EAS = "EAS quality";
// The address follows the view once it has been at rest for so long.
const REST_MS = 400;

class View {
  constructor() {
    this.canvas = byId("view");
    this.drawing = new Drawing(this.canvas);
    this.camera = new Camera();
    this.parts = new Parts(() => this.rebuildSoon());
    this.state = {
      input: 0, beside: -1, frame: 0, array: -1, range: [0, 1], seen: [], edges: true, bad: false, arrows: false, cut: null, part: 0.5,
    };
    // What is shown, one mesh or two: the frames as unpacked, and their scenes.
    this.shown = [];
    this.scenes = [new Scene(this.drawing.gl)];
    this.token = 0;
    this.timer = null;
    this.isRecording = false;
    listenToPanel(this);
    if (!this.followLink()) this.chooseInput(this.firstInput());
    addEventListener("hashchange", () => this.followLink());
  }

  get input() {
    return manifest.inputs[this.state.input];
  }
  get frame() {
    return this.input.frames[this.state.frame];
  }
  get inputs() {
    const { beside } = this.state;
    return beside < 0 ? [this.input] : [this.input, manifest.inputs[beside]];
  }
  get isLabel() {
    return this.state.array >= 0 && this.input.arrays[this.state.array].is_label;
  }
  firstInput() {
    return manifest.inputs.findIndex(({ frames }) => frames.length > 0);
  }

  chooseInput(i) {
    this.pause();
    this.setInputs(i, -1);
    return this.show();
  }
  chooseBeside(i) {
    this.setInputs(this.state.input, i);
    return this.show();
  }

  // The meshes to show, and what depends on them; the array and the frame stay where the first mesh stays.
  setInputs(i, beside) {
    const { state } = this, isNew = i !== state.input || this.arrays === undefined;
    Object.assign(state, { input: i, beside });
    const { input } = this;
    [this.low, this.high] = boxOf(this.inputs);
    this.camera.aim(this.low, this.high);
    if (isNew) {
      const has = (array) => input.frames.some((frame) => frame.skin.values[array]);
      this.arrays = input.arrays.map((_, k) => k).filter(has);
      Object.assign(state, { frame: 0, array: this.firstArray() });
    }
    state.bad &&= this.hasBad();
    this.resetRange();
    putChoices(this);
  }

  // Quality where there is some, else gaps.
  firstArray() {
    const { arrays } = this.input;
    const find = (name) => this.arrays.find((i) => arrays[i].name === name);
    return find(EAS) ?? find("gap") ?? this.arrays[0] ?? -1;
  }
  hasBad() {
    return this.inputs.some((input) => input.frames.some((frame) => frame.inside && frame.bad > 0));
  }
  hasArrows() {
    const { array } = this.state;
    return array >= 0 && this.input.frames.some(({ skin }) => skin.vectors[array]);
  }

  // The array of each input that is shown.
  arraysShown() {
    return this.inputs.map((input) => [input, input === this.input ? this.state.array : sameArray(this.input, this.state.array, input)]);
  }

  resetRange() {
    const { state, input } = this;
    if (state.array < 0) return;
    const isEas = input.arrays[state.array].name === EAS && state.array === 0;
    const [low, high] = rangeOfArrays(this.arraysShown());
    state.range = isEas ? [Math.min(0, low), 1] : [low, high];
  }

  // Loads what is chosen, then draws it; what was asked for since is shown instead.
  async show() {
    const token = ++this.token;
    document.documentElement.dataset.busy = "1";
    byId("busy").hidden = false;
    try {
      const frameOf = (input) => (input === this.input ? this.frame : frameAt(input, this.frame.time));
      const wanted = this.arraysShown().map(([input, array], i) => unpackedFrame(this.shown[i], input, frameOf(input), array));
      const shown = await Promise.all(wanted);
      if (token !== this.token) return;
      this.shown = shown;
      this.rebuild();
      this.tell();
    } catch (error) {
      byId("note").textContent = `This frame cannot be shown: ${error.message}`;
      console.error(error);
    }
    byId("busy").hidden = true;
    document.documentElement.dataset.busy = "0";
  }

  // Triangles anew, as cut, parts and arrows want them.
  rebuild() {
    const { state, shown, scenes, drawing } = this;
    while (scenes.length < shown.length) scenes.push(new Scene(drawing.gl));
    const longest = Math.max(...this.arraysShown().map(([input, array]) => longestVector(input, array)));
    const arrowScale = state.arrows && longest > 0 ? (LONGEST_ARROW * this.camera.radius) / longest : 0;
    shown.forEach((mesh, i) => scenes[i].build(mesh, this.cutOf(mesh), this.parts, state.bad, arrowScale));
    byId("place").textContent = scenes[0].cut ? `${"xyz"[scenes[0].cut.axis]} = ${short(scenes[0].cut.at)}` : "";
    if (this.isLabel) state.seen = this.labelsSeen();
    showScale(this.arraysShown(), state);
    showNames(this.inputs);
    this.redraw();
  }
  // Once a picture: the hand is faster than a million cells.
  rebuildSoon() {
    this.soon ??= requestAnimationFrame(() => {
      this.soon = null;
      if (this.shown.length) this.rebuild();
    });
  }

  labelsSeen() {
    const seen = new Set();
    for (const list of this.shown.flatMap(({ values }) => [values.skin, values.inside])) {
      if (list) for (const x of list) if (x !== NO_VALUE) seen.add(Math.round(x));
    }
    return [...seen].sort((a, b) => a - b);
  }

  // Where the cut is: at one of the planes, where the frame has no more.
  cutOf({ loaded }) {
    const { cut, part } = this.state;
    if (!cut) return null;
    const { axis } = cut, low = this.low[axis], high = this.high[axis];
    let at = low + part * (high - low);
    const planes = loaded.inside && loaded.inside.planes[axis];
    if (planes && planes.length) at = planes.reduce((a, b) => (Math.abs(b - at) < Math.abs(a - at) ? b : a));
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
    const { shown, scenes, canvas } = this;
    if (!shown.length) return;
    const style = getComputedStyle(canvas);
    const colour = (name) => style.getPropertyValue(name).trim().split(/[\s,]+/).map((x) => x / 255);
    const look = {
      ...this.state, isLabel: this.isLabel, ground: colour("--ground"), none: colour("--none"),
      edgeColour: colour("--edge"), arrowColour: colour("--arrow"),
    };
    this.drawing.draw(this.camera, look, scenes.slice(0, shown.length));
    showAxes(this.camera);
    canvas.dataset.drawn = Number(canvas.dataset.drawn ?? 0) + 1;
    clearTimeout(this.rest);
    this.rest = setTimeout(() => this.keepLink(), REST_MS);
  }

  keepLink() {
    history.replaceState(null, "", linkOf(this));
  }

  // Shows what the page's address says; false if it says nothing of the view.
  followLink() {
    const link = stateOfLink(location.hash), { state, camera } = this;
    if (!link.isLink) return false;
    const isShowable = (i) => manifest.inputs[i]?.frames.length > 0;
    this.pause();
    const input = isShowable(link.input) ? link.input : this.firstInput();
    this.setInputs(input, isShowable(link.beside) && link.beside !== input ? link.beside : -1);
    if (this.arrays.includes(link.array) || link.array === -1) state.array = link.array;
    this.resetRange();
    if (link.range && link.range[0] < link.range[1]) state.range = link.range;
    if (this.input.frames[link.frame]) state.frame = link.frame;
    const { cut, part, edges, arrows } = link;
    Object.assign(state, { cut, part, edges, arrows, bad: link.bad && this.hasBad() });
    camera.restore(link.camera);
    this.parts.set = new Map(link.parts);
    putChoices(this);
    this.show();
    return true;
  }

  // What is said of the frame that is shown.
  tell() {
    const { state, frame, input } = this, [{ loaded }] = this.shown, said = [];
    if (input.is_series) said.push(`Frame ${frame.frame + 1} of ${input.n_frames}, time ${short(frame.time)}.`);
    // A page whose mesh is moved says so beside it.
    if (frame.tets !== null && !byId("live")) {
      said.push(`Worst EAS (quality of a tet) ${short(frame.worst.eas)}, ${withThousands(frame.bad)} of ${withThousands(frame.tets)} tets bad.`);
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
    for (const mesh of this.shown) {
      const view = manifest.inputs.indexOf(mesh.input);
      showHistograms(view, mesh.frame);
      markTime(view, mesh.frame.time);
    }
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
      if (this.timer) this.timer = setTimeout(step, FRAME_MS);
    };
    this.timer = setTimeout(step, 0);
  }

  // Records all frames; a second call ends it before the last, with what was recorded.
  async saveVideo() {
    if (this.isRecording) {
      this.isRecording = false;
      return;
    }
    const button = byId("video"), first = this.state.frame;
    this.pause();
    this.isRecording = true;
    button.textContent = "Stop video";
    const showFrame = async (k) => {
      await this.go(k);
      this.draw();
    };
    try {
      const film = await recordVideo(this.canvas, this.input.frames.length, showFrame, () => this.isRecording);
      const address = URL.createObjectURL(film);
      download(address, `${this.input.name}.webm`);
      setTimeout(() => URL.revokeObjectURL(address), 60000);
      byId("done").textContent = `Video of ${Math.round(film.size / 1000)} kB saved.`;
    } catch (error) {
      byId("done").textContent = `No video: ${error.message}`;
    }
    this.isRecording = false;
    button.textContent = "Save video";
    this.go(first);
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
    const view = new View();
    if (byId("live")) view.live = new Live(view);
  } catch (error) {
    byId("viewer").hidden = true;
    byId("no-view").hidden = false;
    byId("no-view").querySelector("span").textContent = error.message;
    document.documentElement.dataset.busy = "0";
  }
}
