// Measures how many pictures a second a page of `vestige view` shows while it plays over and over. Prints JSON.
// node page_benchmark.mjs PAGE [SECONDS]
import { cpus, release } from "node:os";
import { basename } from "node:path";
import { open } from "./browser.mjs";

const viewport = { width: 1280, height: 860 };
const seconds = Number(process.argv[3] ?? 10);
const { browser, page, complaints } = await open(process.argv[2], viewport);
const shown = await page.evaluate(async (length_s) => {
  const player = window.vestige;
  const [times_ms, end_ms] = [[], performance.now() + 1000 * length_s];
  await new Promise((done) => {
    const tick = (now_ms) => {
      times_ms.push(now_ms);
      if (!player.isPlaying) player.play();
      if (now_ms < end_ms) requestAnimationFrame(tick);
      else done();
    };
    requestAnimationFrame(tick);
  });
  player.pause();
  const gl = player.scene.renderer.getContext();
  const renderer = gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info").UNMASKED_RENDERER_WEBGL);
  return { times_ms, renderer, about: document.getElementById("about").textContent };
}, seconds);
const intervals_ms = shown.times_ms.slice(1).map((time_ms, i) => time_ms - shown.times_ms[i]).sort((a, b) => a - b);
const share = (q) => Number(intervals_ms[Math.floor(q * (intervals_ms.length - 1))].toFixed(1));
const length_s = (shown.times_ms.at(-1) - shown.times_ms[0]) / 1000;
console.log(JSON.stringify({
  page: basename(process.argv[2]), about: shown.about, viewport, length_s: Number(length_s.toFixed(2)), pictures: intervals_ms.length,
  pictures_per_s: Number((intervals_ms.length / length_s).toFixed(1)),
  interval_ms: { median: share(0.5), p95: share(0.95), longest: share(1) },
  browser: `Chromium ${browser.version()}`, renderer: shown.renderer,
  machine: { processor: cpus()[0].model, cores: cpus().length, system: `Linux ${release()}` }, complaints,
}, null, 2));
await browser.close();
