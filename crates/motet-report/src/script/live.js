// A part is dragged with the mouse: the program that serves the page computes where all vertices go, and repairs bad tets when
// the part is released. One request is under way at a time; the latest displacement since is requested next.

const ANY = "any", NONE = "none";
// The scale of gaps ends at so many times the least one.
const NEAR = 4;

async function request(path, body) {
  const answer = await fetch(path, body === undefined ? {} : { method: "POST", body: JSON.stringify(body) });
  if (!answer.ok) throw new Error((await answer.text()) || answer.statusText);
  return answer;
}

class Live {
  constructor(view) {
    this.view = view;
    this.patches = [];
    // The part that is being dragged.
    this.grip = null;
    // The displacement to be previewed next.
    this.pending = null;
    this.isRequesting = false;
    this.isFinishing = false;
    this.link = location.hash;
    byId("undo").addEventListener("click", () => this.finish("undo", {}));
    byId("shift").addEventListener("click", () => this.shift());
    this.start();
  }
  async start() {
    try {
      const facts = await (await request("facts")).json();
      this.patches = facts.patches;
      const names = this.patches.map(({ name }) => [name, name]);
      fill(byId("grabbed"), [[ANY, "what is grabbed"], ...names, [NONE, "nothing"]], facts.has_separate_parts ? ANY : NONE);
      if (facts.gap > 0) this.colourByGap(facts.gap);
      this.tell(facts);
    } catch (error) {
      this.fail(error);
    }
  }
  // What comes near another part is what one looks for, unless the page's address says otherwise.
  colourByGap(gap) {
    const { view } = this, array = view.input.arrays.findIndex(({ name }) => name === "gap");
    if (!view.arrays.includes(array) || stateOfLink(this.link).isLink) return;
    Object.assign(view.state, { array, range: [0, NEAR * gap] });
    putChoices(view);
    view.show();
  }

  // The part under a pointer that is to be moved, as `listenToHand` wants it.
  grab(e) {
    const hit = this.hit(e), chosen = byId("grabbed").value;
    if (!hit || this.isFinishing || chosen === NONE) return null;
    const patch = this.patches.find(({ name, id }) => (chosen === ANY ? id === hit.patch && hit.isOpaque : name === chosen));
    // A part that was chosen is dragged wherever the mesh is seen.
    if (!patch) return null;
    const { camera, canvas } = this.view, [right, up] = camera.rows;
    // How long a picture's height is, there.
    const height = (2 * hit.away * Math.tan(FIELD / 2)) / camera.zoom, by = [0, 0, 0];
    const grip = (this.grip = {});
    return {
      move: (dx, dy) => {
        if (this.grip !== grip) return;
        for (let k = 0; k < 3; k++) by[k] += height * (dx * right[k] - dy * up[k]);
        this.requestPreview({ patch: patch.name, by: [...by] });
      },
      drop: () => {
        if (this.grip === grip && by.some((x) => x !== 0)) this.drop({ patch: patch.name, by });
      },
    };
  }

  // The front triangle under a pointer, opaque ones first: its patch, and how far from the eye it is.
  hit(e) {
    const { view } = this, { camera, canvas } = view, [mesh] = view.shown;
    if (!mesh || view.shown.length > 1) return null;
    const box = canvas.getBoundingClientRect(), aspect = canvas.clientWidth / canvas.clientHeight;
    const x = (2 * (e.clientX - box.left)) / box.width - 1, y = 1 - (2 * (e.clientY - box.top)) / box.height;
    const { picture, eye } = camera.matrices(aspect), { points, triangles, labels } = mesh.loaded;
    const opacity = view.parts.opacities(mesh.input, labels, "skin"), cut = view.cutOf(mesh);
    const patches = labels.find(({ array }) => mesh.input.arrays[array].name === "patch")?.skin;
    const n = points.length / 3, seen = new Float32Array(3 * n);
    for (let v = 0; v < n; v++) {
      const row = (i) => picture[i] * points[3 * v] + picture[4 + i] * points[3 * v + 1] + picture[8 + i] * points[3 * v + 2] + picture[12 + i];
      const w = row(3);
      seen.set([row(0) / w, row(1) / w, row(2) / w], 3 * v);
    }
    let best = null;
    for (let i = 0; i < triangles.length / 3; i++) {
      const alpha = opacity(i), corners = triangles.subarray(3 * i, 3 * i + 3);
      if (alpha === 0) continue;
      const weights = weightsIn(seen, corners, x, y);
      if (!weights || (cut && isCutAway(points, corners, weights, cut))) continue;
      const depth = weights.reduce((sum, w, k) => sum + w * seen[3 * corners[k] + 2], 0), isOpaque = alpha === 1;
      if (best && (best.isOpaque > isOpaque || (best.isOpaque === isOpaque && best.depth <= depth))) continue;
      best = { depth, isOpaque, corners, patch: patches ? Math.round(patches[i]) : null };
    }
    if (!best) return null;
    const v = best.corners[0];
    const away = -(eye[2] * points[3 * v] + eye[6] * points[3 * v + 1] + eye[10] * points[3 * v + 2] + eye[14]);
    return { ...best, away };
  }

  // By the numbers that are written, for those without a pointer.
  shift() {
    const by = ["by-x", "by-y", "by-z"].map((id) => Number(byId(id).value.replace("\u2212", "-")));
    const patch = byId("grabbed").value;
    if (!this.patches.some(({ name }) => name === patch)) return this.say("Choose the part to move first.");
    if (!by.every(Number.isFinite)) return this.say("Three numbers are expected.");
    return this.drop({ patch, by });
  }

  requestPreview(displacement) {
    this.pending = displacement;
    if (!this.isRequesting) this.preview();
  }
  async preview() {
    this.isRequesting = true;
    const { view } = this;
    while (this.pending) {
      const displacement = this.pending;
      this.pending = null;
      try {
        const array = view.state.array < 0 ? null : view.input.arrays[view.state.array].name;
        const answer = await request("preview", { ...displacement, array, inside: view.state.cut !== null });
        const { facts, numbers } = unpackedAnswer(await answer.arrayBuffer());
        this.put(facts, numbers);
      } catch (error) {
        this.fail(error);
      }
      // A picture in between.
      await new Promise(requestAnimationFrame);
    }
    this.isRequesting = false;
    this.onIdle?.();
  }
  // New places and values into what is shown.
  put(facts, { points, skin, inside, bad }) {
    const { view } = this, [mesh] = view.shown;
    if (!mesh) return;
    mesh.loaded.points.set(points);
    mesh.values.skin?.set(skin.subarray(0, mesh.values.skin.length));
    mesh.values.inside?.set(inside.subarray(0, mesh.values.inside.length));
    if (mesh.loaded.inside) mesh.loaded.inside.bad = bad;
    view.state.bad = bad.length > 0;
    view.rebuild();
    byId("bad").disabled = bad.length === 0;
    byId("bad").checked = view.state.bad;
    this.tell(facts);
    this.view.canvas.dataset.previews = Number(this.view.canvas.dataset.previews ?? 0) + 1;
  }

  drop(displacement) {
    return this.finish("move", displacement);
  }
  // Puts back what is being dragged.
  cancel() {
    if (!this.grip) return undefined;
    this.grip = null;
    return this.finish(null);
  }

  // Lets the program move, repair or undo, and shows what became of the mesh.
  async finish(act, body) {
    if (this.isFinishing) return;
    this.isFinishing = true;
    this.grip = this.pending = null;
    if (this.isRequesting) await new Promise((resolve) => (this.onIdle = resolve));
    this.onIdle = null;
    document.documentElement.dataset.busy = "1";
    byId("busy").hidden = false;
    if (act === "move") this.say("Moving and repairing\u2026");
    try {
      const facts = await (await request(act ?? "facts", act === null ? undefined : body)).json();
      await this.update();
      this.tell(facts);
    } catch (error) {
      await this.update();
      this.fail(error);
    }
    this.isFinishing = false;
  }
  async update() {
    const { view } = this, { state } = view;
    replaceData(await (await request("update")).json());
    const array = state.array, range = state.range;
    view.setInputs(0, -1);
    Object.assign(state, { array, range, bad: view.hasBad() });
    putChoices(view);
    await view.show();
  }

  tell(facts) {
    const said = [];
    if (facts.not_movable) said.push(facts.not_movable);
    if (facts.outcome) said.push(facts.outcome);
    if (facts.tets > 0) said.push(`${qualityOf(facts)}.`, `At first ${qualityOf(facts.at_first)}.`);
    if (facts.gap !== null && facts.gap !== undefined) said.push(`Least gap ${short(facts.gap)}.`);
    if (facts.milliseconds !== undefined) said.push(`${short(facts.milliseconds)} ms.`);
    byId("undo").disabled = !facts.can_undo;
    this.say(said.join(" "));
  }
  say(text) {
    byId("state").textContent = text;
  }
  fail(error) {
    this.say(`The program did not answer: ${error.message}`);
    console.error(error);
  }
}

// Counts and qualities of a mesh in words.
function qualityOf({ tets, bad, inverted, eas: { worst, p1, mean } }) {
  return `${withThousands(tets)} tets, ${withThousands(bad)} bad, ${withThousands(inverted)} inverted; EAS worst ${short(worst)}, 1 % ${short(p1)}, mean ${short(mean)}`;
}

// The weights of the corners of a triangle at a place of the picture; nothing where it lies outside.
function weightsIn(seen, [a, b, c], x, y) {
  const ax = seen[3 * a] - x, ay = seen[3 * a + 1] - y, bx = seen[3 * b] - x, by = seen[3 * b + 1] - y, cx = seen[3 * c] - x, cy = seen[3 * c + 1] - y;
  const u = bx * cy - by * cx, v = cx * ay - cy * ax, w = ax * by - ay * bx, sum = u + v + w;
  if (!(u >= 0 && v >= 0 && w >= 0) && !(u <= 0 && v <= 0 && w <= 0)) return null;
  return sum === 0 ? null : [u / sum, v / sum, w / sum];
}

function isCutAway(points, corners, weights, { axis, at, sign }) {
  return sign * (weights.reduce((sum, w, k) => sum + w * points[3 * corners[k] + axis], 0) - at) > 0;
}

// Facts as JSON, then numbers: the length of the JSON, the JSON filled up to a multiple of four, and lists of 32-bit numbers.
function unpackedAnswer(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const facts = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const numbers = {};
  let at = 4 + Math.ceil(length / 4) * 4;
  for (const [name, n] of facts.lists) {
    numbers[name] = new (name === "bad" ? Uint32Array : Float32Array)(buffer, at, n);
    at += 4 * n;
  }
  return { facts, numbers };
}
