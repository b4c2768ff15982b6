// The panel: its controls show the state, and change it.

const SLIDER = 1000;

// All controls as the state says.
function putChoices(view) {
  const { state, input, arrays } = view;
  const others = manifest.inputs.map((other, i) => [i, other.name]).filter(([i]) => i !== state.input && manifest.inputs[i].frames.length);
  byId("input").value = state.input;
  fill(byId("beside"), [[-1, "nothing"], ...others], state.beside);
  fill(byId("array"), [...arrays.map((i) => [i, arrayName(input, i)]), [-1, "one colour"]], state.array);
  byId("player").hidden = input.frames.length < 2;
  byId("frame").max = input.frames.length - 1;
  byId("video").hidden = input.frames.length < 2;
  byId("edges").checked = state.edges;
  byId("bad").disabled = !view.hasBad();
  byId("bad").checked = state.bad;
  putRange(view);
  putCut(state);
  view.parts.list(view.inputs);
}

function putRange(view) {
  const { state, isLabel } = view;
  byId("range").hidden = state.array < 0 || isLabel;
  [byId("low").value, byId("high").value] = state.range.map(short);
  byId("arrow-row").hidden = !view.hasArrows();
  byId("arrows").checked = state.arrows;
}

function putCut({ cut, part }) {
  byId("cut").value = cut ? cut.axis : "";
  byId("part").value = SLIDER * part;
  if (cut) {
    byId("mode").value = cut.mode;
    byId("flip").checked = cut.sign < 0;
  }
  for (const id of ["part", "flip", "mode"]) byId(id).disabled = !cut;
}

function changeCut(view) {
  const axis = byId("cut").value;
  view.state.cut = axis === "" ? null : { axis: Number(axis), sign: byId("flip").checked ? -1 : 1, mode: byId("mode").value };
  putCut(view.state);
  view.rebuild();
  view.tell();
}

function changeRange(view) {
  const { state } = view, [low, high] = ["low", "high"].map((id) => Number(byId(id).value.replace("\u2212", "-")));
  if (Number.isFinite(low) && Number.isFinite(high) && low < high) state.range = [low, high];
  else putRange(view);
  showScale(view.arraysShown(), state);
  view.redraw();
}

async function copyLink(view) {
  view.keepLink();
  byId("done").textContent = (await copied(location.href)) ? "Link copied." : "The browser does not allow it; the link is the address of this page.";
}

function listenToPanel(view) {
  const { camera, canvas, state } = view, redraw = () => view.redraw();
  const on = (id, event, act) => byId(id).addEventListener(event, act);
  listenToHand(canvas, camera, redraw, (e) => view.live?.grab(e) ?? null);
  listenToKeys(canvas, camera, redraw, {
    Escape: () => view.live?.cancel(),
    " ": () => view.play(), ".": () => view.go(state.frame + 1), ",": () => view.go(state.frame - 1),
  });
  fill(byId("input"), manifest.inputs.map((input, i) => [i, input.name]).filter(([i]) => manifest.inputs[i].frames.length), 0);
  byId("inputs").hidden = byId("input").options.length < 2;
  on("input", "change", () => view.chooseInput(Number(byId("input").value)));
  on("beside", "change", () => view.chooseBeside(Number(byId("beside").value)));
  listenToColours(view, on);
  for (const id of ["cut", "flip", "mode"]) on(id, "change", () => changeCut(view));
  on("part", "input", () => {
    state.part = byId("part").value / SLIDER;
    view.rebuildSoon();
  });
  on("opaque", "click", () => {
    view.parts.reset();
    view.parts.list(view.inputs);
    view.rebuild();
  });
  listenToPlayer(view, on);
  listenToButtons(view, on);
  new ResizeObserver(redraw).observe(canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}

function listenToColours(view, on) {
  const { state } = view;
  on("array", "change", () => {
    state.array = Number(byId("array").value);
    view.resetRange();
    putRange(view);
    view.show();
  });
  for (const id of ["low", "high"]) on(id, "change", () => changeRange(view));
  on("whole", "click", () => {
    view.resetRange();
    putRange(view);
    view.rebuild();
  });
  on("edges", "change", () => {
    state.edges = byId("edges").checked;
    view.redraw();
  });
  for (const id of ["bad", "arrows"]) {
    on(id, "change", () => {
      state[id] = byId(id).checked;
      view.rebuild();
    });
  }
}

function listenToPlayer(view, on) {
  const { state } = view;
  on("frame", "input", () => {
    view.pause();
    view.go(Number(byId("frame").value));
  });
  on("play", "click", () => view.play());
  on("back", "click", () => view.go(state.frame - 1));
  on("on", "click", () => view.go(state.frame + 1));
}

function listenToButtons(view, on) {
  const { camera, canvas } = view;
  on("save", "click", () => savePicture(canvas, `${view.input.name}-${view.frame.frame}.png`));
  on("copy", "click", () => copyLink(view));
  byId("video").title = whyNoVideo();
  byId("video").disabled = whyNoVideo() !== "";
  on("video", "click", () => view.saveVideo());
  on("reset", "click", () => {
    camera.reset();
    view.redraw();
  });
  for (const button of document.querySelectorAll("[data-look]")) {
    button.addEventListener("click", () => {
      camera.look(button.dataset.look);
      view.redraw();
    });
  }
}
