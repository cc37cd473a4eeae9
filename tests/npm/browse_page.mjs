// Does what a reader does with a page of `vestige view`, and prints what the reader then sees, as JSON.
// node browse_page.mjs PAGE '{"width": 1280, "steps": [{"press": "n"}, {"click": "#play"}, {"scrub": 20}, {"see": true}]}'
import { open } from "./browser.mjs";

const options = JSON.parse(process.argv[3] ?? "{}");
const { browser, page, complaints, requests } = await open(process.argv[2], options);

/** What stands on the page, and how much of the picture is drawn: of its whole and of parts of it. */
function look() {
  const text = (id) => document.getElementById(id).textContent;
  const rows = (id) => [...document.querySelectorAll(`#${id} tr`)].slice(1).map((row) => [...row.cells].map((cell) => cell.textContent));
  const shown = (id) => (document.getElementById(id).hidden ? "" : text(id));
  window.vestige?.draw();  // the picture is kept only until the browser shows it
  const copy = document.createElement("canvas");
  const scene = document.getElementById("scene");
  [copy.width, copy.height] = [scene.width, scene.height];
  const context = copy.getContext("2d", { willReadFrequently: true });
  context.drawImage(scene, 0, 0);
  const drawn = (left, width) => {
    const { data } = context.getImageData(left * copy.width, 0, width * copy.width, copy.height);
    let [opaque, colourful, sum] = [0, 0, 0];
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b, a] = data.subarray(i, i + 4);
      if (a > 250) ++opaque;
      if (a > 250 && Math.max(r, g, b) - Math.min(r, g, b) > 100) ++colourful;
      sum = (sum * 31 + r + 3 * g + 7 * b) % 1000003;
    }
    return { opaque: opaque / data.length * 4, colourful: colourful / data.length * 4, sum };
  };
  return {
    title: text("title"), tab: document.title, about: text("about"), precision: text("precision"), failure: shown("failure"),
    warnings: [...document.querySelectorAll("#warnings li")].map((item) => item.textContent),
    time: text("time"), frame: Number(text("frame")), count: Number(text("count")), contacts: rows("contacts"), motors: rows("motors"),
    actuators: [...document.querySelectorAll("#of-actuator option")].map((option) => option.textContent),
    play: text("play"), speed: document.getElementById("speed").selectedOptions[0]?.textContent,
    help: document.getElementById("help").open, images: document.querySelectorAll("img").length,
    width: document.documentElement.scrollWidth, picture: drawn(0, 1), middle: drawn(0.4, 0.2), left: drawn(0, 0.5), right: drawn(0.5, 0.5),
    sides: [...document.querySelectorAll("#sides span")].map((side) => side.textContent),
    totals: rows("totals"),
    alone: [...document.querySelectorAll(".alone td:last-child")].map((cell) => cell.textContent),
  };
}

/**
 * Returns the largest distances in mm, over all contacts and at their times: from the place of the contact to the skin
 * that the page draws, and to the middle of its collider less the collider's radius.
 */
function contactGaps() {
  const { trace } = window.vestige;
  const origin = trace.head.origin_m;
  const gaps = { skin: 0, collider: 0, contacts: 0 };
  for (const person of trace.people)
    for (let i = 0; i < person.contact_row.length; ++i) {
      const row = person.contact_row[i];
      const from_s = trace.time_s[row - 1];
      const time_s = from_s + (trace.time_s[row] - from_s) * person.contact_t[i];
      person.pose(time_s);
      const at = [0, 1, 2].map((axis) => person.contact_position_m[i * 3 + axis] - origin[axis]);
      const from = (place) => Math.hypot(...at.map((x, axis) => x - place[axis]));
      const collider = [0, 0, 0, 0];
      if (!trace.colliders.place(person.contact_collider[i], time_s, collider)) throw new Error("a contact without its collider");
      gaps.skin = Math.max(gaps.skin, 1000 * from(person.contactPlace(i)));
      gaps.collider = Math.max(gaps.collider, 1000 * Math.abs(from(collider) - collider[3]));
      ++gaps.contacts;
    }
  return gaps;
}

const seen = [];
const deeds = {
  press: (key) => page.keyboard.press(key),
  click: (selector) => page.click(selector),
  choose: ([selector, label]) => page.selectOption(selector, { label }),
  scrub: (row) => page.fill("#scrubber", String(row)),
  drag: async ([selector, from, to]) => {
    const box = await page.locator(selector).boundingBox();
    const at = (share) => [box.x + share * box.width, box.y + box.height / 2];
    await page.mouse.move(...at(from));
    await page.mouse.down();
    await page.mouse.move(...at(to), { steps: 5 });
    await page.mouse.up();
  },
  wait_for: (text) => page.waitForFunction((play) => document.getElementById("play").textContent === play, text),
  run: (script) => page.evaluate(script),
  picture: (file) => page.screenshot({ path: file }),
  gaps: async () => seen.push(await page.evaluate(contactGaps)),
  see_timeline: async () => seen.push(await page.evaluate(() => [window.vestige.raster.from_s, window.vestige.raster.to_s])),
  see: async () => seen.push(await page.evaluate(look)),
};
for (const step of options.steps ?? [{ see: true }])
  for (const [deed, what] of Object.entries(step)) {
    await deeds[deed](what);
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  }
await browser.close();
console.log(JSON.stringify({ seen, complaints, requests }));
