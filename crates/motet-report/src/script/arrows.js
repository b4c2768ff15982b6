// Arrows of a vector array at a sample of the skin: a shaft and a head, as long as the vector says.

// The longest arrow, in radii of what is shown.
const LONGEST_ARROW = 0.12;
const ZERO_CODE = 32767;
const SIDES = 5;

// The vectors of one array in a frame, at the places that the program chose (arrays.rs).
async function loadVectors(frame, array) {
  const packed = frame.skin.vectors[array];
  return packed ? { codes: await unpack(packed.block), step: packed.step } : null;
}

// The length of the longest vector of an array over all frames, but for rounding.
function longestVector(input, array) {
  return Math.max(0, ...input.frames.map(({ skin }) => skin.values[array]?.high ?? 0));
}

// Calls `see(place, vector)` for each vector on a triangle that is shown; `opacity` is that of each triangle.
function eachVector(loaded, { codes, step }, isOnPoints, cut, opacity, see) {
  const { triangles: t, points } = loaded, count = codes.length / 3;
  const total = isOnPoints ? loaded.nSkin : t.length / 3, isShown = new Uint8Array(total);
  for (let i = 0; i < t.length / 3; i++) {
    if (opacity(i) > 0) for (const at of isOnPoints ? t.subarray(3 * i, 3 * i + 3) : [i]) isShown[at] = 1;
  }
  for (let i = 0; i < count; i++) {
    const at = Math.floor((i * total) / count), code = codes.subarray(3 * i, 3 * i + 3);
    if (!isShown[at] || code[0] === 65535) continue;
    const ids = isOnPoints ? [at] : t.subarray(3 * at, 3 * at + 3), place = [0, 0, 0];
    for (const v of ids) for (let k = 0; k < 3; k++) place[k] += points[3 * v + k] / ids.length;
    if (cut && cut.sign * (place[cut.axis] - cut.at) >= 0) continue;
    see(place, Array.from(code, (x) => step * (x - ZERO_CODE)));
  }
}

function arrowTriangles(loaded, vectors, isOnPoints, cut, opacity, scale) {
  const out = new Triangles();
  eachVector(loaded, vectors, isOnPoints, cut, opacity, (place, vector) => {
    const length = scale * Math.hypot(...vector);
    if (length > 0) addArrow(out, place, vector.map((x) => scale * x), length);
  });
  return out;
}

function addArrow(out, from, vector, length) {
  const along = vector.map((x) => x / length), [u, v] = across(along);
  const head = 0.4 * length, wide = 0.09 * length;
  const ring = (at, radius) => Array.from({ length: SIDES }, (_, i) => {
    const angle = (2 * Math.PI * i) / SIDES, c = radius * Math.cos(angle), s = radius * Math.sin(angle);
    return from.map((x, k) => x + at * along[k] + c * u[k] + s * v[k]);
  });
  const tail = ring(0, 0.3 * wide), neck = ring(length - head, 0.3 * wide), brim = ring(length - head, wide);
  const tip = from.map((x, k) => x + vector[k]), middle = from.map((x, k) => x + (length - head) * along[k]);
  const add = (...corners) => out.add(corners.flat(), 0, 1, 2, 0, 0, 0, 0);
  for (let i = 0; i < SIDES; i++) {
    const j = (i + 1) % SIDES;
    add(tail[i], tail[j], neck[i]);
    add(tail[j], neck[j], neck[i]);
    add(brim[i], brim[j], tip);
    add(brim[j], brim[i], middle);
  }
}

// Two directions that are square to a third and to each other.
function across(along) {
  const least = along.map(Math.abs).indexOf(Math.min(...along.map(Math.abs)));
  const axis = [0, 1, 2].map((k) => (k === least ? 1 : 0)), u = cross(along, axis), size = Math.hypot(...u);
  const unit = u.map((x) => x / size);
  return [unit, cross(along, unit)];
}
