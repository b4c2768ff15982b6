// Triangles onto the canvas by WebGL 2: flat light, colours by a table, edges by distance from the sides.

const VERTEX = `#version 300 es
in vec3 place; in float value; in uint edges;
uniform mat4 picture, eye;
uniform vec4 plane;
out vec3 at, seen; out float shown, depth; flat out uint sides;
void main() {
  int corner = gl_VertexID % 3;
  at = vec3(corner == 0, corner == 1, corner == 2);
  seen = (eye * vec4(place, 1.0)).xyz;
  depth = dot(plane, vec4(place, 1.0));
  shown = value; sides = edges;
  gl_Position = picture * vec4(place, 1.0);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in vec3 at, seen; in float shown, depth; flat in uint sides;
uniform sampler2D colours;
uniform vec2 range;       // the lowest value and 1 / (highest - lowest)
uniform float isLabel, edgeStrength, alpha, isFlat;
uniform vec3 none, fixedColour, edgeColour;
out vec4 colour;
void main() {
  if (depth > 0.0) discard;
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
  colour = vec4(lit, alpha);
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
  ["place", "value", "edges"].forEach((name, i) => gl.bindAttribLocation(program, i, name));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

// Triangles on the graphics card.
class Layer {
  constructor(gl) {
    this.gl = gl;
    this.count = 0;
    this.array = gl.createVertexArray();
    this.buffers = [0, 1, 2].map(() => gl.createBuffer());
    gl.bindVertexArray(this.array);
    [[3, gl.FLOAT], [1, gl.FLOAT], [1, gl.UNSIGNED_BYTE]].forEach(([size, type], i) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[i]);
      gl.enableVertexAttribArray(i);
      if (type === gl.FLOAT) gl.vertexAttribPointer(i, size, type, false, 0, 0);
      else gl.vertexAttribIPointer(i, size, type, 0, 0);
    });
  }
  put(triangles) {
    const { gl } = this, n = triangles.count;
    const parts = [[triangles.places, 9], [triangles.values, 3], [triangles.edges, 3]];
    parts.forEach(([array, width], i) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[i]);
      gl.bufferData(gl.ARRAY_BUFFER, array.subarray(0, width * n), gl.DYNAMIC_DRAW);
    });
    this.count = n;
  }
  draw() {
    this.gl.bindVertexArray(this.array);
    this.gl.drawArrays(this.gl.TRIANGLES, 0, 3 * this.count);
  }
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
    this.layers = { skin: new Layer(gl), cut: new Layer(gl), bad: new Layer(gl) };
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
  // `look`: range, isLabel, edges, bad, cut, and the colours of the page.
  draw(camera, look) {
    const { gl, layers } = this;
    this.resize();
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(...look.ground, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    this.slack = 1e-5 * camera.radius;
    gl.useProgram(this.program);
    const { picture, eye } = camera.matrices(this.canvas.width / this.canvas.height);
    this.set("picture", "Matrix4fv", false, picture);
    this.set("eye", "Matrix4fv", false, eye);
    this.set("range", "2f", look.range[0], 1 / (look.range[1] - look.range[0] || 1));
    this.set("isLabel", "1f", look.isLabel ? 1 : 0);
    this.set("edgeStrength", "1f", look.edges ? 0.75 : 0);
    this.set("none", "3f", ...look.none);
    this.set("edgeColour", "3f", ...look.edgeColour);
    gl.bindTexture(gl.TEXTURE_2D, this.tables[look.isLabel ? 1 : 0]);
    const isSlice = look.cut && look.cut.mode === "slice";
    this.pass(layers.skin, isSlice ? look.cut : null, [-1, 0, 0], 1, 0);
    this.pass(layers.cut, null, [-1, 0, 0], 1, isSlice ? 1 : 0);
    if (look.bad) this.drawBad(isSlice ? look.cut : null);
  }
  // Bad tets as they are, and faintly where others hide them.
  drawBad(cut) {
    const { gl, layers } = this, red = [0.86, 0.08, 0.12];
    this.pass(layers.bad, cut, red, 1, 0);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthFunc(gl.GREATER);
    gl.depthMask(false);
    this.set("edgeStrength", "1f", 0);
    this.pass(layers.bad, cut, red, 0.1, 1);
    gl.depthMask(true);
    gl.depthFunc(gl.LEQUAL);
    gl.disable(gl.BLEND);
  }
  pass(layer, cut, fixedColour, alpha, isFlat) {
    const plane = [0, 0, 0, -1];
    if (cut) {
      plane[cut.axis] = cut.sign;
      // What lies in the plane itself stays.
      plane[3] = -cut.sign * cut.at - this.slack;
    }
    this.set("plane", "4f", ...plane);
    this.set("fixedColour", "3f", ...fixedColour);
    this.set("alpha", "1f", alpha);
    this.set("isFlat", "1f", isFlat);
    layer.draw();
  }
}
