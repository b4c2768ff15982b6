// Where one looks from: a turn, a shift and a distance, and the matrices that they make.

const FIELD = 0.45; // the angle of view, radians

// Rows of rotations that look along an axis, up being z (y for the view along z).
const VIEWS = {
  iso: [[-0.7071, 0.7071, 0], [-0.3536, -0.3536, 0.866], [0.6124, 0.6124, 0.5]],
  "+x": [[0, -1, 0], [0, 0, 1], [-1, 0, 0]],
  "-x": [[0, 1, 0], [0, 0, 1], [1, 0, 0]],
  "+y": [[1, 0, 0], [0, 0, 1], [0, -1, 0]],
  "-y": [[-1, 0, 0], [0, 0, 1], [0, 1, 0]],
  "+z": [[-1, 0, 0], [0, 1, 0], [0, 0, -1]],
  "-z": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
};

class Camera {
  constructor() {
    this.centre = [0, 0, 0];
    this.radius = 1;
    this.look("iso");
    this.reset();
  }
  reset() {
    this.look("iso");
    this.shift = [0, 0];
    this.zoom = 1;
  }
  // From nine numbers of the turn, two of the shift, and the zoom, if they are a look at all.
  restore(numbers) {
    const rows = orthonormal([0, 3, 6].map((i) => numbers.slice(i, i + 3)));
    if (!(rows.flat().every(Number.isFinite) && numbers[11] > 0)) return;
    this.rows = rows;
    this.shift = numbers.slice(9, 11);
    this.zoom = 1;
    this.approach(numbers[11]);
  }
  look(view) {
    this.rows = VIEWS[view].map((row) => [...row]);
  }
  // The sphere that is looked at.
  aim(low, high) {
    this.centre = low.map((x, k) => (x + high[k]) / 2);
    this.radius = Math.hypot(...low.map((x, k) => high[k] - x)) / 2 || 1;
  }
  // Turns what is seen about the picture's own axes: right by `dx`, down by `dy` radians.
  turn(dx, dy) {
    const [r, u, f] = this.rows;
    const mix = (a, b, angle) => {
      const c = Math.cos(angle), s = Math.sin(angle);
      return [a.map((x, k) => c * x + s * b[k]), a.map((x, k) => c * b[k] - s * x)];
    };
    const [r2, f2] = mix(r, f, dx);
    const [f3, u2] = mix(f2, u, dy);
    this.rows = orthonormal([r2, u2, f3]);
  }
  // By parts of the picture's height.
  pan(dx, dy) {
    this.shift = [this.shift[0] + (2 * dx) / this.zoom, this.shift[1] - (2 * dy) / this.zoom];
  }
  approach(factor) {
    this.zoom = Math.min(1e4, Math.max(0.05, this.zoom * factor));
  }
  // The matrix from places to the picture, column by column, and that to the eye.
  matrices(aspect) {
    const r = this.radius, [x, y] = this.shift;
    const narrow = Math.min(1, aspect);
    const away = (0.95 * r) / Math.tan(FIELD / 2) / narrow;
    const eye = new Float32Array(16);
    this.rows.forEach((row, i) => {
      for (let k = 0; k < 3; k++) eye[4 * k + i] = row[k];
      eye[12 + i] = -row[0] * this.centre[0] - row[1] * this.centre[1] - row[2] * this.centre[2];
    });
    // The lens, not the eye, comes nearer: so nothing is ever behind it.
    eye[12] += x * r;
    eye[13] += y * r;
    eye[14] -= away;
    eye[15] = 1;
    const f = this.zoom / Math.tan(FIELD / 2), near = Math.max(away - 1.8 * r, away * 0.02), far = away + 1.8 * r;
    const lens = [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0];
    return { eye, picture: product(lens, eye) };
  }
}

function product(a, b) {
  const out = new Float32Array(16);
  for (let i = 0; i < 4; i++) {
    for (let j = 0; j < 4; j++) for (let k = 0; k < 4; k++) out[4 * i + j] += a[4 * k + j] * b[4 * i + k];
  }
  return out;
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

// Rounding errors of many small turns are taken out.
function orthonormal([r, u, f]) {
  const unit = (a) => a.map((x) => x / Math.hypot(...a));
  const front = unit(f), right = unit(cross(u, front));
  return [right, cross(front, right), front];
}
