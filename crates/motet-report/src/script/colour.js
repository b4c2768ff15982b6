// Colours: for values a path through OKLab (Ottosson 2020) in equal steps, so that equal differences look equal;
// for labels the eight of Okabe and Ito (2008), then hues apart by the golden angle.

function linearToByte(x) {
  const y = x <= 0.0031308 ? 12.92 * x : 1.055 * Math.pow(x, 1 / 2.4) - 0.055;
  return Math.round(255 * Math.min(1, Math.max(0, y)));
}

// From OKLab to sRGB, by the matrices of the definition.
function oklabToBytes([L, a, b]) {
  const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (L - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    linearToByte(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
    linearToByte(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
    linearToByte(-0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s),
  ];
}

function oklch(L, C, degrees) {
  const h = (degrees * Math.PI) / 180;
  return [L, C * Math.cos(h), C * Math.sin(h)];
}

// From dark violet over teal to light yellow: lightness rises all the way.
function pathOfValues(t) {
  return oklch(0.27 + 0.66 * t, 0.1 + 0.06 * t * t, 305 - 200 * t);
}

// The path at 256 places that are equally far from each other in OKLab.
function valueColours() {
  const fine = Array.from({ length: 2049 }, (_, i) => pathOfValues(i / 2048));
  const along = [0];
  for (let i = 1; i < fine.length; i++) {
    along.push(along[i - 1] + Math.hypot(...fine[i].map((x, k) => x - fine[i - 1][k])));
  }
  const bytes = new Uint8Array(256 * 4);
  for (let i = 0, j = 0; i < 256; i++) {
    while (along[j] < (along[2048] * i) / 255 - 1e-12) j++;
    bytes.set([...oklabToBytes(fine[j]), 255], 4 * i);
  }
  return bytes;
}

const OKABE_ITO = [
  [0, 114, 178], [230, 159, 0], [0, 158, 115], [204, 121, 167],
  [86, 180, 233], [213, 94, 0], [240, 228, 66], [120, 120, 120],
];
const MAX_LABELS = 64;

function labelColour(i) {
  if (i < OKABE_ITO.length) return OKABE_ITO[i];
  return oklabToBytes(oklch(0.6 + 0.12 * (i % 3), 0.12, 137.508 * i));
}

function labelColours() {
  const bytes = new Uint8Array(256 * 4);
  for (let i = 0; i < MAX_LABELS; i++) bytes.set([...labelColour(i), 255], 4 * i);
  return bytes;
}

function css(bytes, i) {
  return `rgb(${bytes[4 * i]},${bytes[4 * i + 1]},${bytes[4 * i + 2]})`;
}
