// Opens a page in Debian's Chromium, which has no window and draws without a GPU.
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const kPatience_ms = 120_000;  // tests of other programs may run at the same time
const kFlags = ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
                "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

/** Returns {browser, page, complaints, requests}: what the page complains of, and what it asks for beside itself. */
export async function open(file, { width = 900, height = 700, motion = false, webgl = true } = {}) {
  const browser = await chromium.launch({
    executablePath: "/usr/bin/chromium", timeout: kPatience_ms, args: webgl ? kFlags : [...kFlags.slice(0, -2), "--disable-gpu", "--disable-3d-apis"],
  });
  const page = await browser.newPage({ viewport: { width, height }, reducedMotion: motion ? "no-preference" : "reduce" });
  page.setDefaultTimeout(kPatience_ms);
  const [complaints, requests] = [[], []];
  page.on("console", (message) => complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("dialog", (dialog) => { complaints.push("a dialog opens"); dialog.dismiss(); });
  const url = pathToFileURL(file).href;
  page.on("request", (request) => { if (request.url() !== url && !/^(data|blob):/.test(request.url())) requests.push(request.url()); });
  await page.goto(url);
  await page.waitForFunction(() => window.vestige?.shownRow >= 0 || !document.getElementById("failure").hidden);
  return { browser, page, complaints, requests };
}
