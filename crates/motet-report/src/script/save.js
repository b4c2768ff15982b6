// What is taken away from the page: the picture with its scale as a file, all frames as a video.

const VIDEO = "video/webm";
const FRAME_MS = 160;
const OFFERS = 4;
const OFFER_MS = FRAME_MS / OFFERS;
const MOST_OFFERS = 100;

function download(address, name) {
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
}

function savePicture(canvas, name) {
  const out = document.createElement("canvas");
  paint(out, canvas);
  download(out.toDataURL("image/png"), name);
}

// The picture with what the page says in front of it.
function paint(out, canvas) {
  if (out.width !== canvas.width || out.height !== canvas.height) [out.width, out.height] = [canvas.width, canvas.height];
  const pen = out.getContext("2d"), scale = byId("scale"), ratio = canvas.width / canvas.clientWidth;
  pen.setTransform(1, 0, 0, 1, 0, 0);
  pen.drawImage(canvas, 0, 0);
  pen.scale(ratio, ratio);
  pen.font = "13px sans-serif";
  pen.fillStyle = getComputedStyle(scale).color;
  paintScale(pen, scale);
  paintNames(pen, canvas);
}

function paintScale(pen, scale) {
  let y = 22;
  const left = 14, ink = pen.fillStyle, title = scale.querySelector("strong"), bar = scale.querySelector(".bar");
  if (title) pen.fillText(title.textContent, left, y);
  if (bar) {
    const colours = valueColours(), texts = [...scale.querySelectorAll("span")].map((e) => e.textContent);
    for (let i = 0; i < 180; i++) {
      pen.fillStyle = css(colours, Math.floor((i * 255) / 179));
      pen.fillRect(left + i, y + 8, 1.5, 12);
    }
    pen.fillStyle = ink;
    ["left", "center", "right"].forEach((side, i) => {
      pen.textAlign = side;
      pen.fillText(texts[i], left + 90 * i, y + 36);
    });
    pen.textAlign = "left";
  }
  for (const item of scale.querySelectorAll("li")) {
    y += 18;
    const patch = item.querySelector("i");
    if (patch) {
      pen.fillStyle = patch.style.background;
      pen.fillRect(left, y - 10, 12, 12);
      pen.fillStyle = ink;
    }
    pen.fillText(item.textContent, left + 18, y);
  }
}

// Names of meshes side by side, and the time, at the lower edge.
function paintNames(pen, canvas) {
  const names = [...byId("names").children], width = canvas.clientWidth, y = canvas.clientHeight - 12;
  pen.textAlign = "center";
  names.forEach((name, i) => pen.fillText(name.textContent, ((i + 0.5) * width) / names.length, y));
  pen.textAlign = "right";
  if (!byId("player").hidden) pen.fillText(byId("time").textContent, width - 14, y);
  pen.textAlign = "left";
}

// Why this browser makes no videos; nothing if it does.
function whyNoVideo() {
  if (!HTMLCanvasElement.prototype.captureStream) return "This browser cannot record a canvas (no captureStream)";
  if (typeof MediaRecorder === "undefined") return "This browser cannot record (no MediaRecorder)";
  return MediaRecorder.isTypeSupported(VIDEO) ? "" : "This browser cannot write WebM";
}

// VP9 keeps up with a busy machine better than what a browser takes without a word.
function videoType() {
  const best = `${VIDEO};codecs=vp9`;
  return MediaRecorder.isTypeSupported(best) ? best : VIDEO;
}

// Records what `show(k)` draws for each of `n` frames, until `isWanted()` is no longer true. A recorder drops pictures while
// it starts, and when it is busy: each is offered several times, and until something was written.
async function recordVideo(canvas, n, show, isWanted) {
  const out = document.createElement("canvas"), chunks = [];
  paint(out, canvas);
  const stream = out.captureStream(0), recorder = new MediaRecorder(stream, { mimeType: videoType(), videoBitsPerSecond: 8e6 });
  const ended = new Promise((resolve) => recorder.addEventListener("stop", resolve));
  let written = 0;
  recorder.addEventListener("dataavailable", ({ data }) => {
    chunks.push(data);
    // Less is no picture.
    if (data.size > 30) written++;
  });
  recorder.start(OFFER_MS);
  for (let k = 0; k < n && isWanted(); k++) {
    await show(k);
    const before = written;
    paint(out, canvas);
    for (let i = 0; i < OFFERS || (written === before && i < MOST_OFFERS); i++) {
      stream.getVideoTracks()[0].requestFrame();
      await new Promise((resolve) => setTimeout(resolve, OFFER_MS));
    }
  }
  recorder.stop();
  await ended;
  return new Blob(chunks, { type: VIDEO });
}
