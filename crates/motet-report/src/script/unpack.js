// Tables of numbers as the program packed them (codec.rs): base64, zlib, bytes of like weight together, differences.

const manifest = JSON.parse(document.getElementById("manifest").textContent);

function bytesOf(base64) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64);
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Rows end to end.
function decoded(bytes, rows, columns, planes, kind) {
  const out = new Uint32Array(rows * columns);
  for (let c = 0; c < columns; c++) {
    const first = c * planes * rows;
    const isBeside = kind === "ids" && c > 0;
    let above = 0;
    for (let r = 0; r < rows; r++) {
      let x = bytes[first + r];
      for (let p = 1; p < planes; p++) x |= bytes[first + p * rows + r] << (8 * p);
      if (kind !== "plain") {
        x = (x >>> 1) ^ -(x & 1);
        x += isBeside ? out[r * columns + c - 1] : above;
      }
      out[r * columns + c] = x;
      above = out[r * columns + c];
    }
  }
  return out;
}

// What was unpacked stays, the latest longest, up to this many bytes.
const CACHE_BYTES = 4e8;
const cache = new Map();

// Replaces all data of the page.
function replaceData(update) {
  cache.clear();
  Object.assign(manifest, update);
}

async function unpack(block) {
  const id = manifest.ids[block];
  let entry = cache.get(id);
  if (entry) {
    cache.delete(id);
  } else {
    const [rows, columns, planes, kind] = manifest.blocks[id];
    const text = manifest.texts ? manifest.texts[id] : document.getElementById("b" + id).textContent;
    const numbers = inflated(bytesOf(text)).then((bytes) => decoded(bytes, rows, columns, planes, kind));
    entry = { numbers, size: 4 * rows * columns };
  }
  cache.set(id, entry);
  let total = 0;
  for (const { size } of cache.values()) total += size;
  for (const [old, { size }] of cache) {
    if (total <= CACHE_BYTES || old === id) break;
    cache.delete(old);
    total -= size;
  }
  return entry.numbers;
}
