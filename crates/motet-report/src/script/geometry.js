// What is to be drawn of a frame: its skin, cut or not, the cells at a cut, and its bad tets, as triangles with values.

// Stands for "no number" among values; the shader knows it.
const NO_VALUE = Math.fround(3e38);
// Beside the three bits of edges: the triangle lies in the plane of a cut, which does not cut it.
const IN_CUT = 8;

// Triangles that grow: places, a value at each corner, which sides are edges, and how opaque it is.
class Triangles {
  constructor(room = 1024) {
    this.count = 0;
    // That of the triangles that are added next.
    this.opacity = 1;
    this.grow(room);
  }
  grow(room) {
    const copy = (Type, n, old) => {
      const array = new Type(n);
      if (old) array.set(old);
      return array;
    };
    this.room = room;
    this.places = copy(Float32Array, 9 * room, this.places);
    this.values = copy(Float32Array, 3 * room, this.values);
    // Two bytes a corner: edges, and opacity in parts of 255.
    this.bytes = copy(Uint8Array, 6 * room, this.bytes);
  }
  // Three vertices by their ids, with their values.
  add(points, a, b, c, va, vb, vc, edges) {
    if (this.count === this.room) this.grow(2 * this.room);
    const i = this.count++, p = this.places, v = this.values, opacity = Math.round(255 * this.opacity);
    for (let k = 0; k < 3; k++) {
      p[9 * i + k] = points[3 * a + k];
      p[9 * i + 3 + k] = points[3 * b + k];
      p[9 * i + 6 + k] = points[3 * c + k];
      this.bytes[6 * i + 2 * k] = edges;
      this.bytes[6 * i + 2 * k + 1] = opacity;
    }
    v[3 * i] = va;
    v[3 * i + 1] = vb;
    v[3 * i + 2] = vc;
  }
  isOpaque(i) {
    return this.bytes[6 * i + 1] === 255;
  }
}

async function placesOf(block, low, step) {
  const codes = await unpack(block);
  const places = new Float32Array(codes.length);
  for (let i = 0; i < codes.length; i++) places[i] = low[i % 3] + step[i % 3] * codes[i];
  return places;
}

async function valuesOf(values) {
  if (!values) return null;
  const codes = await unpack(values.block);
  const out = new Float32Array(codes.length);
  for (let i = 0; i < codes.length; i++) out[i] = codes[i] === 65535 ? NO_VALUE : values.low + values.step * codes[i];
  return out;
}

// A frame without values: places of all its vertices, ids of triangles and cells, and the labels of its `parts`.
async function loadFrame(frame, parts) {
  const { skin, inside } = frame;
  const [skinPlaces, triangles, edges, labels] = await Promise.all([
    placesOf(skin.points, skin.low, skin.step), unpack(skin.triangles), unpack(skin.edges), loadLabels(frame, parts),
  ]);
  const loaded = { frame, points: skinPlaces, nSkin: skinPlaces.length / 3, triangles, edges, labels, inside: null };
  if (!inside) return loaded;
  const [innerPlaces, bad] = await Promise.all([placesOf(inside.points, skin.low, skin.step), unpack(inside.bad)]);
  loaded.points = new Float32Array(skinPlaces.length + innerPlaces.length);
  loaded.points.set(skinPlaces);
  loaded.points.set(innerPlaces, skinPlaces.length);
  const solids = inside.tets === undefined ? await loadFacets(inside.facets) : { tets: await unpack(inside.tets) };
  loaded.inside = { ...solids, bad, planes: inside.planes, canCut: inside.holds !== "bad", isWhole: inside.holds === "all" };
  return loaded;
}

// The labels of triangles and cells in each array that parts are told apart by.
async function loadLabels(frame, parts) {
  const arrays = [...new Set(parts.map((part) => part.array))];
  return Promise.all(arrays.map(async (array) => ({ array, ...await loadValues(frame, array, false) })));
}

async function loadFacets([counts, triangles, edges]) {
  const [n, ids, sides] = await Promise.all([unpack(counts), unpack(triangles), unpack(edges)]);
  const starts = new Uint32Array(n.length + 1);
  for (let i = 0; i < n.length; i++) starts[i + 1] = starts[i] + n[i];
  return { starts, ids, sides };
}

// The values of one array in a frame: on the skin and inside, by triangle and cell or by vertex.
async function loadValues(frame, array, isOnPoints) {
  const [skin, inside] = await Promise.all([
    valuesOf(frame.skin.values[array]), valuesOf(frame.inside && frame.inside.values[array]),
  ]);
  return { skin, inside, isOnPoints };
}

function valueAtVertex(loaded, values, v) {
  const list = v < loaded.nSkin ? values.skin : values.inside;
  return list ? list[v < loaded.nSkin ? v : v - loaded.nSkin] : NO_VALUE;
}

// How far a vertex lies in front of the cut: negative behind it, where things stay.
function depthOf(loaded, cut) {
  const { points } = loaded;
  return (v) => cut.sign * (points[3 * v + cut.axis] - cut.at);
}

// The skin: all of it, or with a cut through whole cells those triangles that have a vertex behind it.
// `opacity` is that of each triangle.
function skinTriangles(loaded, values, cut, opacity) {
  const { triangles: t, edges } = loaded;
  const out = new Triangles(Math.max(16, t.length / 3));
  const depth = cut && cut.mode === "cells" ? depthOf(loaded, cut) : null;
  for (let i = 0; i < edges.length; i++) {
    const a = t[3 * i], b = t[3 * i + 1], c = t[3 * i + 2];
    if (depth && !(depth(a) < 0 || depth(b) < 0 || depth(c) < 0)) continue;
    out.opacity = opacity(i);
    if (out.opacity === 0) continue;
    if (values.isOnPoints) {
      const at = (v) => valueAtVertex(loaded, values, v);
      out.add(loaded.points, a, b, c, at(a), at(b), at(c), edges[i]);
    } else {
      const x = values.skin ? values.skin[i] : NO_VALUE;
      out.add(loaded.points, a, b, c, x, x, x, edges[i]);
    }
  }
  return out;
}

const TET_FACETS = [1, 2, 3, 0, 2, 3, 0, 1, 3, 0, 1, 2];

// Calls `see(cell, a, b, c, edges)` for the triangles that bound those cells that the cut goes through.
function eachCrossed(loaded, cut, see) {
  const { inside, points } = loaded;
  const { tets, starts, ids, sides } = inside;
  const { axis, at, sign } = cut;
  if (tets) {
    for (let i = 0; i < tets.length; i += 4) {
      let behind = 0;
      for (let k = 0; k < 4; k++) if (sign * (points[3 * tets[i + k] + axis] - at) < 0) behind++;
      if (behind === 0 || behind === 4) continue;
      for (let f = 0; f < 12; f += 3) {
        see(i >> 2, tets[i + TET_FACETS[f]], tets[i + TET_FACETS[f + 1]], tets[i + TET_FACETS[f + 2]], 7);
      }
    }
    return;
  }
  for (let cell = 0; cell + 1 < starts.length; cell++) {
    let behind = 0;
    const first = 3 * starts[cell], last = 3 * starts[cell + 1];
    for (let i = first; i < last; i++) if (sign * (points[3 * ids[i] + axis] - at) < 0) behind++;
    if (behind === 0 || behind === last - first) continue;
    for (let i = first; i < last; i += 3) see(cell, ids[i], ids[i + 1], ids[i + 2], sides[i / 3]);
  }
}

// Whole cells stay that have a vertex behind the cut: of those that it goes through, the facets in front of it are seen.
// `opacity` is that of each cell.
function crinkle(loaded, values, cut, opacity, out = new Triangles()) {
  if (!loaded.inside || !loaded.inside.canCut) return out;
  const depth = depthOf(loaded, cut);
  eachCrossed(loaded, cut, (cell, a, b, c, edges) => {
    if (depth(a) < 0 || depth(b) < 0 || depth(c) < 0) return;
    out.opacity = opacity(cell);
    if (out.opacity === 0) return;
    if (values.isOnPoints) {
      const at = (v) => valueAtVertex(loaded, values, v);
      out.add(loaded.points, a, b, c, at(a), at(b), at(c), edges);
    } else {
      const x = values.inside ? values.inside[cell] : NO_VALUE;
      out.add(loaded.points, a, b, c, x, x, x, edges);
    }
  });
  return out;
}

// The cut through cells itself: of each the sides where its facets meet the plane, joined to their middle.
function slice(loaded, values, cut, opacity, out = new Triangles()) {
  if (!loaded.inside || !loaded.inside.canCut) return out;
  const depth = depthOf(loaded, cut);
  let cell = -1, sides = [];
  const meet = (u, v) => {
    const part = depth(u) / (depth(u) - depth(v));
    const between = (x, y) => x + part * (y - x);
    const place = [0, 1, 2].map((k) => between(loaded.points[3 * u + k], loaded.points[3 * v + k]));
    const x = valueAtVertex(loaded, values, u), y = valueAtVertex(loaded, values, v);
    const value = values.isOnPoints ? (x === NO_VALUE || y === NO_VALUE ? NO_VALUE : between(x, y)) : 0;
    return [...place, value];
  };
  const finish = () => {
    if (cell >= 0) out.opacity = opacity(cell);
    if (sides.length >= 3 && out.opacity > 0) fan(out, sides, values.isOnPoints ? null : values.inside ? values.inside[cell] : NO_VALUE);
    sides = [];
  };
  eachCrossed(loaded, cut, (i, a, b, c, edges) => {
    if (i !== cell) finish();
    cell = i;
    const ends = [];
    if (depth(a) < 0 !== depth(b) < 0) ends.push(meet(a, b));
    if (depth(b) < 0 !== depth(c) < 0) ends.push(meet(b, c));
    if (depth(c) < 0 !== depth(a) < 0) ends.push(meet(c, a));
    if (ends.length === 2) sides.push(ends);
  });
  finish();
  return out;
}

// Triangles from the middle of a polygon to its sides.
function fan(out, sides, value) {
  const middle = [0, 0, 0, 0];
  for (const [p] of sides) for (let k = 0; k < 4; k++) middle[k] += p[k] / sides.length;
  for (const [p, q] of sides) {
    const points = [...middle.slice(0, 3), ...p.slice(0, 3), ...q.slice(0, 3)];
    const [x, y, z] = value === null ? [middle[3], p[3], q[3]] : [value, value, value];
    out.add(points, 0, 1, 2, x, y, z, 2 | IN_CUT);
  }
}

// All facets of the bad tets, those behind the cut where there is one; none of those that are hidden.
function badTriangles(loaded, cut, opacity) {
  const out = new Triangles(16);
  const { inside, points } = loaded;
  if (!inside) return out;
  const depth = cut ? depthOf(loaded, cut) : null;
  const shown = Array.from(inside.bad).filter((cell) => opacity(cell) > 0), isShown = new Set(shown);
  for (const cell of shown) {
    const ids = inside.tets ? TET_FACETS.map((k) => inside.tets[4 * cell + k])
      : inside.ids.subarray(3 * inside.starts[cell], 3 * inside.starts[cell + 1]);
    if (depth && !Array.from(ids).some((v) => depth(v) < 0)) continue;
    for (let i = 0; i < ids.length; i += 3) out.add(points, ids[i], ids[i + 1], ids[i + 2], 0, 0, 0, 7);
  }
  if (cut && cut.mode === "slice") slice(loaded, { isOnPoints: false }, cut, (cell) => (isShown.has(cell) ? 1 : 0), out);
  return out;
}
