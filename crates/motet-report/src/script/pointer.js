// The hand: one finger or button turns, two fingers or another button shift, the wheel or a pinch goes nearer, keys do all of it.

// `grab(event)` returns what is under a pointer that goes down, if it is to be dragged: it is told `move(dx, dy)`, by parts of the
// picture's height, and `drop()`. A second finger drops it.
function listenToHand(canvas, camera, redraw, grab) {
  const fingers = new Map();
  let span = 0, held = null;
  const spanOf = () => {
    const [a, b] = [...fingers.values()];
    return b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  };
  canvas.addEventListener("pointerdown", (e) => {
    canvas.setPointerCapture(e.pointerId);
    fingers.set(e.pointerId, { x: e.clientX, y: e.clientY });
    span = spanOf();
    drop();
    const isTurn = e.altKey || e.shiftKey || e.ctrlKey || e.button !== 0 || fingers.size > 1;
    held = isTurn ? null : grab(e);
    canvas.focus({ preventScroll: true });
  });
  const drop = () => {
    held?.drop();
    held = null;
  };
  const lift = (e) => {
    drop();
    fingers.delete(e.pointerId);
    span = spanOf();
  };
  canvas.addEventListener("pointerup", lift);
  canvas.addEventListener("pointercancel", lift);
  canvas.addEventListener("pointermove", (e) => {
    const before = fingers.get(e.pointerId);
    if (!before) return;
    const dx = (e.clientX - before.x) / canvas.clientHeight, dy = (e.clientY - before.y) / canvas.clientHeight;
    fingers.set(e.pointerId, { x: e.clientX, y: e.clientY });
    if (fingers.size > 1) {
      camera.pan(dx / 2, dy / 2);
      const now = spanOf();
      if (span > 0 && now > 0) camera.approach(now / span);
      span = now;
    } else if (held) {
      held.move(dx, dy);
    } else if (e.shiftKey || e.ctrlKey || e.buttons & 6) {
      camera.pan(dx, dy);
    } else {
      camera.turn(4 * dx, 4 * dy);
    }
    redraw();
  });
  canvas.addEventListener("contextmenu", (e) => e.preventDefault());
  canvas.addEventListener("wheel", (e) => {
    e.preventDefault();
    camera.approach(Math.exp(-Math.max(-200, Math.min(200, e.deltaY)) / 500));
    redraw();
  }, { passive: false });
}

// Keys, while the view has the focus; `acts` are those that concern more than the camera.
function listenToKeys(canvas, camera, redraw, acts) {
  canvas.addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.altKey || e.metaKey) return;
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const views = { x: "+x", X: "-x", y: "+y", Y: "-y", z: "-z", Z: "+z", i: "iso" };
    if (arrows[e.key]) {
      const [dx, dy] = arrows[e.key];
      if (e.shiftKey) camera.pan(0.05 * dx, 0.05 * dy);
      else camera.turn(0.12 * dx, 0.12 * dy);
    } else if (views[e.key]) camera.look(views[e.key]);
    else if (e.key === "+" || e.key === "=") camera.approach(1.15);
    else if (e.key === "-") camera.approach(1 / 1.15);
    else if (e.key === "0" || e.key === "Home") camera.reset();
    else if (acts[e.key]) acts[e.key]();
    else return;
    e.preventDefault();
    redraw();
  });
}
