// One mesh of the view: a frame of it, unpacked, and its triangles on the graphics card.

// What a frame has to be drawn by an array (-1: in one colour); what was unpacked before is used again.
async function unpackedFrame(before, input, frame, array) {
  const isOnPoints = array >= 0 && input.arrays[array].on === "point";
  const loaded = before && before.frame === frame ? before.loaded : await loadFrame(frame, input.parts);
  const values = array < 0 ? { skin: null, inside: null, isOnPoints } : await loadValues(frame, array, isOnPoints);
  return { input, frame, loaded, values, vectors: await loadVectors(frame, array) };
}

class Scene {
  constructor(gl) {
    this.layers = { surface: new Layer(gl), arrows: new Layer(gl), bad: new Layer(gl) };
    this.cut = null;
  }
  // Triangles anew; `arrowScale` is 0 for no arrows.
  build({ input, loaded, values, vectors }, cut, parts, isBadShown, arrowScale) {
    const ofTriangle = parts.opacities(input, loaded.labels, "skin"), ofCell = parts.opacities(input, loaded.labels, "inside");
    const surface = skinTriangles(loaded, values, cut, ofTriangle);
    if (cut) (cut.mode === "slice" ? slice : crinkle)(loaded, values, cut, ofCell, surface);
    const hasArrows = vectors && arrowScale > 0;
    this.cut = cut;
    this.layers.surface.put(surface);
    this.layers.bad.put(isBadShown ? badTriangles(loaded, cut, ofCell) : new Triangles(1));
    this.layers.arrows.put(hasArrows ? arrowTriangles(loaded, vectors, values.isOnPoints, cut, ofTriangle, arrowScale) : new Triangles(1));
  }
}

// The box of all frames of inputs together.
function boxOf(inputs) {
  const low = [Infinity, Infinity, Infinity], high = low.map((x) => -x);
  for (const { skin } of inputs.flatMap((input) => input.frames)) {
    for (let k = 0; k < 3; k++) {
      low[k] = Math.min(low[k], skin.low[k]);
      high[k] = Math.max(high[k], skin.low[k] + 1048575 * skin.step[k]);
    }
  }
  return [low, high];
}

// The frame of an input nearest to a time.
function frameAt(input, time) {
  return input.frames.reduce((a, b) => (Math.abs(b.time - time) < Math.abs(a.time - time) ? b : a));
}
