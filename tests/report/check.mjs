// Drives a page of `gnomon report` in headless Chromium: hover, click, sort, both themes,
// a narrow window, print, and a browser without scripts. No packages: the browser's
// protocol goes through a pipe.
//
//   node tests/report/check.mjs PAGE.html [FOLDER-FOR-SCREENSHOTS]
//
// The page has one technique and a history of one pixel at least.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [page, shots] = process.argv.slice(2);
const profile = mkdtempSync(join(tmpdir(), "gnomon-report-"));
const browser = spawn(process.env.CHROMIUM ?? "chromium", [
  "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--no-first-run",
  `--user-data-dir=${profile}`, "--remote-debugging-pipe", "about:blank",
], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });

// Messages end in a zero byte.
const waiting = new Map(), heard = [];
let next = 0, rest = Buffer.alloc(0), session;
browser.stdio[4].on("data", (data) => {
  rest = Buffer.concat([rest, data]);
  for (let end; (end = rest.indexOf(0)) >= 0; rest = rest.subarray(end + 1)) {
    const message = JSON.parse(rest.subarray(0, end).toString());
    if (!message.id) { heard.push(message); continue; }
    const [resolve, reject] = waiting.get(message.id);
    waiting.delete(message.id);
    message.error ? reject(new Error(JSON.stringify(message.error))) : resolve(message.result);
  }
});
const send = (method, params = {}) => new Promise((resolve, reject) => {
  waiting.set(++next, [resolve, reject]);
  browser.stdio[3].write(JSON.stringify({ id: next, method, params, sessionId: session }) + "\0");
});
const evaluate = async (expression) => {
  const { result, exceptionDetails } = await send("Runtime.evaluate", { expression, returnByValue: true, awaitPromise: true });
  assert.equal(exceptionDetails, undefined, JSON.stringify(exceptionDetails));
  return result.value;
};
const until = async (expression) => {
  for (let i = 0; i < 200; i++) {
    if (await evaluate(expression)) return;
    await new Promise((r) => setTimeout(r, 50));
  }
  assert.fail(`never: ${expression}`);
};
const open = async () => {
  await send("Page.navigate", { url: pathToFileURL(resolve(page)).href });
  await until("document.readyState === 'complete' && !!document.querySelector('footer')");
};
const mouse = (type, x, y, more = {}) => send("Input.dispatchMouseEvent", { type, x, y, ...more });
const click = async ([x, y]) => {
  await mouse("mouseMoved", x, y);
  for (const type of ["mousePressed", "mouseReleased"]) await mouse(type, x, y, { button: "left", clickCount: 1 });
};
// The middle of an element, or a part of it, in view.
const middle = (element, at = [0.5, 0.5]) => evaluate(
  `(() => { const e = ${element}; e.scrollIntoView({ block: "center", behavior: "instant" }); const b = e.getBoundingClientRect();
  return [b.left + b.width * ${at[0]}, b.top + b.height * ${at[1]}]; })()`);
const $ = (selector) => `document.querySelector(${JSON.stringify(selector)})`;
const media = (features, type = "") => send("Emulation.setEmulatedMedia", {
  media: type, features: Object.entries(features).map(([name, value]) => ({ name, value })),
});
const size = (width, height) => send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
const shoot = async (name) => {
  if (!shots) return;
  const { data } = await send("Page.captureScreenshot", { captureBeyondViewport: true });
  writeFileSync(join(shots, `${name}.png`), Buffer.from(data, "base64"));
};
const shown = () => evaluate(`[...${$(".stage")}.querySelectorAll("img")].filter((i) => getComputedStyle(i).display !== "none").map((i) => i.alt)`);

const tests = {
  async "nothing is fetched and no picture stands twice"() {
    const fetched = heard.filter((m) => m.method === "Network.requestWillBeSent").map((m) => m.params.request.url);
    assert.deepEqual(fetched.filter((url) => !url.startsWith("data:") && !url.startsWith("file:")), []);
    const pictures = await evaluate(`[...document.images].flatMap((i) => [i.src, i.dataset.values].filter(Boolean))`);
    assert.ok(pictures.length >= 9);
    const colored = await evaluate(`[...document.images].map((i) => i.src)`);
    assert.equal(new Set(colored).size, colored.length);
  },
  async "hover tells the values that the legend sums"() {
    await until(`${$(".maps")}.dataset.ready === "4"`);
    const sums = await evaluate(`(async () => { const sums = [];
      for (const i of ${$(".stage")}.querySelectorAll("img[data-values]")) {
        const p = new Image(); p.src = i.dataset.values; await p.decode();
        const c = document.createElement("canvas"); c.width = p.width; c.height = p.height;
        const g = c.getContext("2d"); g.drawImage(p, 0, 0);
        const d = g.getImageData(0, 0, p.width, p.height).data; let sum = 0;
        for (let k = 0; k < d.length; k += 4) sum += d[k] * 65536 + d[k + 1] * 256 + d[k + 2];
        sums.push(sum); } return sums; })()`);
    const legends = await evaluate(`[1, 2, 3, 4].map((i) => Number(/: (\\d+) in all/.exec(document.querySelector(".legends > .m" + i).textContent)[1]))`);
    assert.deepEqual(sums, legends);
    assert.ok(sums[0] > 0 && sums[3] > 0);
    const [width, height] = await evaluate(`${$(".maps")}.dataset.size.split(",").map(Number)`);
    const [x, y] = await middle($(".stage"));
    await mouse("mouseMoved", x + 0.25, y + 0.25);
    const told = await evaluate(`${$(".value")}.textContent`);
    assert.match(told, new RegExp(`^pixel ${Math.floor(width / 2)}, ${Math.floor(height / 2)}: overdraw \\d+, stencil operations \\d+, HiZ kills \\d+, bytes \\d+$`));
  },
  async "a click tells the command, a mark leads to the history"() {
    await click(await middle($(".stage"), [0.001, 0.001]));
    assert.match(await evaluate(`${$(".value code")}.textContent`), /^gnomon report .* --pixel 0,0$/);
    await click(await middle($(".mark")));
    const hash = await evaluate("location.hash");
    assert.match(hash, /^#s0p\d+-\d+$/);
    assert.ok(await evaluate(`document.querySelector(location.hash).querySelectorAll("tbody tr").length > 0`));
  },
  async "the table of draws sorts both ways"() {
    const table = `[...document.querySelectorAll("h3")].find((h) => h.textContent.startsWith("Draws")).nextElementSibling`;
    const head = `[...${table}.querySelectorAll("th button")].at(-1)`;
    const column = () => evaluate(`[...${table}.querySelectorAll("tbody tr")].map((r) => Number(r.cells[r.cells.length - 1].textContent))`);
    const first = await column();
    assert.ok(first.length > 1 && first.every(Number.isInteger), "full numbers");
    const sorted = first.toSorted?.((a, b) => b - a) ?? [...first].sort((a, b) => b - a);
    assert.notDeepEqual(first, sorted, "a page that is sorted at first proves nothing");
    await click(await middle(head));
    assert.deepEqual(await column(), sorted);
    await click(await middle(head));
    assert.deepEqual(await column(), [...sorted].reverse());
  },
  async "maps switch"() {
    for (const [i, name] of ["the picture", "overdraw", "stencil operations", "HiZ kills", "bytes"].entries()) {
      await click(await middle($(`label[for="s0m${i}"]`)));
      assert.deepEqual(await shown(), [name]);
      await shoot(`map${i}`);
    }
  },
  async "both themes are readable"() {
    // Relative luminance by WCAG.
    const contrast = () => evaluate(`(() => { const s = getComputedStyle(document.body);
      const l = (c) => { const [r, g, b] = c.match(/\\d+/g).map((v) => { v /= 255; return v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; }); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
      const [a, b] = [l(s.color), l(s.backgroundColor)]; return [b, (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05)]; })()`);
    await media({ "prefers-color-scheme": "light" });
    const light = await contrast();
    await shoot("light");
    await media({ "prefers-color-scheme": "dark" });
    const dark = await contrast();
    await shoot("dark");
    assert.ok(light[0] > 0.9 && dark[0] < 0.05, `${light} ${dark}`);
    assert.ok(light[1] >= 7 && dark[1] >= 7, `${light} ${dark}`);
    await media({});
  },
  async "a narrow window needs no sideways scrolling"() {
    await size(360, 800);
    assert.ok(await evaluate("document.documentElement.scrollWidth <= 360"), await evaluate("String(document.documentElement.scrollWidth)"));
    await shoot("narrow");
    await size(1280, 900);
  },
  async "it prints whole"() {
    await media({ "prefers-color-scheme": "dark" }, "print");
    assert.equal(await evaluate("getComputedStyle(document.body).getPropertyValue('--page').trim()"), "#fff");
    assert.ok(await evaluate(`[...document.querySelectorAll(".wide")].every((w) => w.scrollHeight <= w.clientHeight + 1)`));
    const { data } = await send("Page.printToPDF", { printBackground: true });
    const pdf = Buffer.from(data, "base64");
    assert.equal(pdf.subarray(0, 5).toString(), "%PDF-");
    if (shots) writeFileSync(join(shots, "print.pdf"), pdf);
    await media({});
  },
  async "it reads without scripts"() {
    await send("Emulation.setScriptExecutionDisabled", { value: true });
    await open();
    assert.equal(await evaluate(`document.querySelectorAll("th button").length`), 0);
    await click(await middle($('label[for="s0m1"]')));
    assert.deepEqual(await shown(), ["overdraw"]);
    for (const heading of ["Findings", "Logical bytes by pass and client", "Draws"]) {
      assert.ok(await evaluate(`document.body.innerText.includes(${JSON.stringify(heading)})`), heading);
    }
    await shoot("no-scripts");
  },
};

let failed = 0;
try {
  const { targetInfos } = await send("Target.getTargets");
  const { targetId } = targetInfos.find((t) => t.type === "page");
  ({ sessionId: session } = await send("Target.attachToTarget", { targetId, flatten: true }));
  for (const domain of ["Page", "Runtime", "Network", "Log"]) await send(`${domain}.enable`);
  await size(1280, 900);
  await open();
  for (const [name, test] of Object.entries(tests)) {
    try {
      await test();
      console.log(`ok   ${name}`);
    } catch (error) {
      failed += 1;
      console.log(`FAIL ${name}\n${error.stack}`);
    }
  }
  const errors = heard.filter((m) => m.method === "Runtime.exceptionThrown");
  if (errors.length) { failed += 1; console.log(`FAIL errors of scripts: ${JSON.stringify(errors)}`); }
} finally {
  browser.kill();
  await new Promise((r) => browser.once("exit", r));
  rmSync(profile, { recursive: true, force: true });
}
console.log(`${Object.keys(tests).length - failed} of ${Object.keys(tests).length} checks of the page passed`);
process.exit(failed ? 1 : 0);
