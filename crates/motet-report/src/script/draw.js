// Triangles onto the canvas by WebGL 2: flat light, colours by a table, edges by distance from the sides.
// What is opaque comes first; then what is transparent, the farthest triangle first, without hiding what comes after it.

const VERTEX = `#version 300 es
in vec3 place; in float value; in uvec2 bytes;
uniform mat4 picture, eye;
uniform vec4 plane;
out vec3 at, seen; out float shown, depth; flat out uint sides; flat out float opacity;
void main() {
  int corner = gl_VertexID % 3;
  at = vec3(corner == 0, corner == 1, corner == 2);
  seen = (eye * vec4(place, 1.0)).xyz;
  depth = dot(plane, vec4(place, 1.0));
  shown = value; sides = bytes.x; opacity = float(bytes.y) / 255.0;
  gl_Position = picture * vec4(place, 1.0);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in vec3 at, seen; in float shown, depth; flat in uint sides; flat in float opacity;
uniform sampler2D colours;
uniform vec2 range;       // the lowest value and 1 / (highest - lowest)
uniform float isLabel, edgeStrength, alpha;
uniform vec3 none, fixedColour, edgeColour;
out vec4 colour;
void main() {
  float isFlat = (sides & 8u) != 0u ? 1.0 : 0.0;
  if (depth > 0.0 && isFlat == 0.0) discard;
  vec3 base = none;
  if (fixedColour.x >= 0.0) base = fixedColour;
  else if (shown < 1e38) {
    float t = isLabel > 0.5 ? (mod(floor(shown - range.x + 0.5), 64.0) + 0.5) / 256.0
                            : (clamp((shown - range.x) * range.y, 0.0, 1.0) * 255.0 + 0.5) / 256.0;
    base = texture(colours, vec2(t, 0.5)).rgb;
  }
  vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
  float light = mix(0.58 + 0.42 * abs(dot(normal, normalize(vec3(0.2, 0.45, 0.85)))), 0.97, isFlat);
  vec3 width = fwidth(at);
  vec3 near = smoothstep(vec3(0.35), vec3(1.25), at / max(width, vec3(1e-6)));
  bvec3 isEdge = bvec3((sides & 2u) != 0u, (sides & 4u) != 0u, (sides & 1u) != 0u);
  vec3 open3 = mix(vec3(1.0), near, vec3(isEdge)), dense3 = width * vec3(isEdge);
  float open = min(open3.x, min(open3.y, open3.z)), dense = max(dense3.x, max(dense3.y, dense3.z));
  // Edges closer than their own width would hide all colour. Triangles of a slice are a third of a cell.
  float fade = 1.0 - smoothstep(0.06, 0.3, dense * mix(1.0, 0.35, isFlat));
  vec3 lit = mix(base * light, edgeColour, (1.0 - open) * edgeStrength * fade);
  // A thin sheet seen at an angle is longer to look through.
  float facing = max(abs(dot(normal, normalize(seen))), 0.15);
  float veil = opacity < 1.0 && isFlat == 0.0 ? 1.0 - pow(1.0 - opacity, 1.0 / facing) : opacity;
  colour = vec4(lit, alpha * veil);
}`;

function compiled(gl, type, source) {
  const shader = gl.createShader(type);
  gl.shaderSource(shader, source);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
}

function linked(gl) {
  const program = gl.createProgram();
  gl.attachShader(program, compiled(gl, gl.VERTEX_SHADER, VERTEX));
  gl.attachShader(program, compiled(gl, gl.FRAGMENT_SHADER, FRAGMENT));
  ["place", "value", "bytes"].forEach((name, i) => gl.bindAttribLocation(program, i, name));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

// Triangles on the graphics card: first the opaque ones, then the others.
class Layer {
  constructor(gl) {
    this.gl = gl;
    this.opaque = 0;
    this.clear = [];
    this.array = gl.createVertexArray();
    this.buffers = [0, 1, 2].map(() => gl.createBuffer());
    this.order = gl.createBuffer();
    gl.bindVertexArray(this.array);
    [[3, gl.FLOAT], [1, gl.FLOAT], [2, gl.UNSIGNED_BYTE]].forEach(([size, type], i) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[i]);
      gl.enableVertexAttribArray(i);
      if (type === gl.FLOAT) gl.vertexAttribPointer(i, size, type, false, 0, 0);
      else gl.vertexAttribIPointer(i, size, type, 0, 0);
    });
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.order);
  }
  put(triangles) {
    const { gl } = this, n = triangles.count;
    const parts = [[triangles.places, 9], [triangles.values, 3], [triangles.bytes, 6]];
    gl.bindVertexArray(this.array);
    parts.forEach(([array, width], i) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[i]);
      gl.bufferData(gl.ARRAY_BUFFER, array.subarray(0, width * n), gl.DYNAMIC_DRAW);
    });
    const ids = Uint32Array.from({ length: n }, (_, i) => i);
    const opaque = ids.filter((i) => triangles.isOpaque(i));
    this.clear = ids.filter((i) => !triangles.isOpaque(i));
    this.opaque = opaque.length;
    this.places = this.clear.length ? triangles.places : null;
    this.front = null;
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, cornersOf([opaque, this.clear]), gl.DYNAMIC_DRAW);
  }
  // Puts the transparent ones in order, for a look along `front`.
  sort(front) {
    if (!this.places || (this.front && this.front.every((x, k) => x === front[k]))) return;
    const { gl } = this;
    this.front = [...front];
    gl.bindVertexArray(this.array);
    gl.bufferSubData(gl.ELEMENT_ARRAY_BUFFER, 12 * this.opaque, cornersOf([backToFront(this.places, this.clear, front)]));
  }
  drawOpaque() {
    this.drawSome(0, this.opaque);
  }
  drawClear() {
    this.drawSome(this.opaque, this.clear.length);
  }
  drawSome(first, count) {
    if (!count) return;
    this.gl.bindVertexArray(this.array);
    this.gl.drawElements(this.gl.TRIANGLES, 3 * count, this.gl.UNSIGNED_INT, 12 * first);
  }
}

// The corners of triangles in lists, one list after the other.
function cornersOf(lists) {
  const corners = new Uint32Array(3 * lists.reduce((sum, list) => sum + list.length, 0));
  let n = 0;
  for (const list of lists) for (const i of list) for (let k = 0; k < 3; k++) corners[n++] = 3 * i + k;
  return corners;
}

// Triangles by the place of their middle along `front`, the lowest first, in so many steps.
const STEPS = 65536;

function backToFront(places, ids, front) {
  const heights = new Float32Array(ids.length);
  let low = Infinity, high = -Infinity;
  ids.forEach((id, i) => {
    let height = 0;
    for (let k = 0; k < 9; k++) height += front[k % 3] * places[9 * id + k];
    heights[i] = height;
    low = Math.min(low, heights[i]);
    high = Math.max(high, heights[i]);
  });
  const step = (i) => Math.min(STEPS - 1, Math.floor(((heights[i] - low) / (high - low || 1)) * STEPS));
  const starts = new Uint32Array(STEPS + 1), sorted = new Uint32Array(ids.length);
  for (let i = 0; i < ids.length; i++) starts[step(i) + 1]++;
  for (let s = 0; s < STEPS; s++) starts[s + 1] += starts[s];
  for (let i = 0; i < ids.length; i++) sorted[starts[step(i)]++] = ids[i];
  return sorted;
}

class Drawing {
  constructor(canvas) {
    this.canvas = canvas;
    // The picture is kept, so that it can be saved and copied at any time.
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error("no WebGL 2");
    this.gl = gl;
    this.program = linked(gl);
    this.places = {};
    gl.depthFunc(gl.LEQUAL);
    this.tables = [this.table(valueColours()), this.table(labelColours())];
  }
  table(bytes) {
    const { gl } = this, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    for (const name of ["TEXTURE_MIN_FILTER", "TEXTURE_MAG_FILTER"]) gl.texParameteri(gl.TEXTURE_2D, gl[name], gl.NEAREST);
    return texture;
  }
  set(name, kind, ...values) {
    this.places[name] ??= this.gl.getUniformLocation(this.program, name);
    this.gl["uniform" + kind](this.places[name], ...values);
  }
  resize() {
    const { canvas } = this, ratio = Math.min(2, window.devicePixelRatio || 1);
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
  }
  // Scenes side by side; `look`: range, isLabel, edges, bad, cut, and the colours of the page.
  draw(camera, look, scenes) {
    const { gl } = this;
    this.resize();
    gl.clearColor(...look.ground, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.useProgram(this.program);
    this.slack = 1e-5 * camera.radius;
    const width = Math.floor(this.canvas.width / scenes.length), { height } = this.canvas;
    const { picture, eye } = camera.matrices(width / height);
    this.set("picture", "Matrix4fv", false, picture);
    this.set("eye", "Matrix4fv", false, eye);
    this.set("range", "2f", look.range[0], 1 / (look.range[1] - look.range[0] || 1));
    this.set("isLabel", "1f", look.isLabel ? 1 : 0);
    this.set("none", "3f", ...look.none);
    this.set("edgeColour", "3f", ...look.edgeColour);
    gl.bindTexture(gl.TEXTURE_2D, this.tables[look.isLabel ? 1 : 0]);
    scenes.forEach((scene, i) => {
      gl.viewport(i * width, 0, width, height);
      this.drawScene(scene, camera, look);
    });
  }
  drawScene({ layers, cut }, camera, look) {
    const { gl } = this, byValue = [-1, 0, 0], red = [0.86, 0.08, 0.12];
    this.cutBy(cut && cut.mode === "slice" ? cut : null);
    this.set("edgeStrength", "1f", look.edges ? 0.75 : 0);
    this.pass(byValue, 1, () => layers.surface.drawOpaque());
    this.pass(red, 1, () => layers.bad.drawOpaque());
    this.pass(look.arrowColour, 1, () => layers.arrows.drawOpaque());
    layers.surface.sort(camera.rows[2]);
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    this.pass(byValue, 1, () => layers.surface.drawClear());
    // Bad tets faintly where others hide them.
    gl.depthFunc(gl.GREATER);
    this.set("edgeStrength", "1f", 0);
    this.pass(red, 0.1, () => layers.bad.drawOpaque());
    gl.depthFunc(gl.LEQUAL);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }
  cutBy(cut) {
    const plane = [0, 0, 0, -1];
    if (cut) {
      plane[cut.axis] = cut.sign;
      // What lies in the plane itself stays.
      plane[3] = -cut.sign * cut.at - this.slack;
    }
    this.set("plane", "4f", ...plane);
  }
  pass(fixedColour, alpha, draw) {
    this.set("fixedColour", "3f", ...fixedColour);
    this.set("alpha", "1f", alpha);
    draw();
  }
}
