// SPDX-License-Identifier: Apache-2.0
// A page in a real browser: opened, watched for errors, looked at.
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { chromium, firefox } from 'playwright-core';
import { PNG } from 'pngjs';
import { EXECUTABLE, IS_FIREFOX } from './chosen_browser.mjs';

const ARTEFACTS = process.env.FURROW_ARTEFACTS;
const PATIENCE_MS = 180_000;

/** `options`: further switches of Chromium. */
export function launch(options = []) {
  mkdirSync(ARTEFACTS, { recursive: true });
  // Firefox as it is, by the standard protocol (WebDriver BiDi).
  if (IS_FIREFOX) return firefox.launch({ channel: 'moz-firefox', executablePath: EXECUTABLE, headless: true });
  return chromium.launch({
    executablePath: EXECUTABLE,
    headless: true,
    args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
      '--disable-component-update', '--disable-sync', ...options],
  });
}

/** The size and the touch screen of a phone. */
export const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 };

/** Options of a page whose pictures have half as many pixels each way, for tests that draw many and do not look at details. */
export const COARSE = { deviceScaleFactor: 0.5 };

/**
 * Opens an isolated page. `errors` collects the errors on its console. `prepare` gets the page before it loads anything.
 */
export async function openPage(browser, address, options = {}, prepare = () => {}) {
  const context = await browser.newContext({ viewport: { width: 1000, height: 640 }, colorScheme: 'dark', acceptDownloads: true, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE_MS);
  page.errors = [];
  page.on('console', (message) => message.type() === 'error' && page.errors.push(message.text()));
  page.on('pageerror', (error) => page.errors.push(String(error)));
  await prepare(page);
  await page.goto(address);
  return page;
}

/** The kind of a wire message, "FIMG", and the sequence in its envelope (protocol/STANDARD.md section 2). */
export function envelopeOf(message) {
  return { kind: message.toString('latin1', 36, 40), sequence: message.readUInt32LE(16) };
}

/**
 * Holds back the daemon's messages for which `passes(message, send)` is false. The rest reaches the page as it is.
 * `send()` delivers the message later.
 */
export async function filterMessages(page, passes) {
  await page.routeWebSocket(/\/ws$/, (socket) => {
    const server = socket.connectToServer();
    socket.onMessage((message) => server.send(message));
    const send = (message) => socket.send(message);
    server.onMessage((message) => passes(message, () => send(message)) && send(message));
    server.onClose((code, reason) => socket.close({ code: code === 1006 ? 1001 : code, reason }));
  });
}

/** Waits until the picture shows the last change. */
export async function shown(page) {
  await page.waitForSelector('.stage[aria-busy=false]');
}

/** Waits for the refined picture of a pose at rest that shows the last change. */
export async function still(page) {
  await page.waitForSelector('.stage[aria-busy=false][data-still=true]');
}

/** Returns the pixels of the picture, without overlays. */
export async function pixels(page) {
  const url = await page.evaluate(() => new Promise((resolve) => {
    requestAnimationFrame(() => requestAnimationFrame(() => resolve(document.querySelector('canvas.picture').toDataURL('image/png'))));
  }));
  return PNG.sync.read(Buffer.from(url.split(',')[1], 'base64'));
}

/** Mean absolute difference of two pictures, 0 to 255. 255 if their sizes differ. */
export function difference(a, b) {
  if (a.width !== b.width || a.height !== b.height) return 255;
  let sum = 0;
  for (let i = 0; i < a.data.length; ++i) sum += Math.abs(a.data[i] - b.data[i]);
  return sum / (a.data.length * 0.75); // alpha is equal everywhere and does not count
}

/** Fraction of pixels that differ visibly. */
export function changedShare(a, b) {
  if (a.width !== b.width || a.height !== b.height) return 1;
  let changed = 0;
  for (let i = 0; i < a.data.length; i += 4) {
    if (Math.max(...[0, 1, 2].map((c) => Math.abs(a.data[i + c] - b.data[i + c]))) > 6) ++changed;
  }
  return changed / (a.data.length / 4);
}

/** Repeats a check until it succeeds. */
export async function eventually(what, holds, patienceMs = PATIENCE_MS) {
  const end = Date.now() + patienceMs;
  while (!(await holds())) {
    if (Date.now() > end) throw new Error(`not in ${patienceMs / 1000} s: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

/** Touches at the points `from`, moves to `to` in steps and lifts. One point per finger. */
export async function swipe(page, from, to) {
  const steps = 6;
  const session = await page.context().newCDPSession(page);
  const touch = (type, points) => session.send('Input.dispatchTouchEvent', {
    type, touchPoints: points.map(([x, y], id) => ({ x, y, id })),
  });
  await touch('touchStart', from);
  for (let step = 1; step <= steps; ++step) {
    const at = (a, b) => a + ((b - a) * step) / steps;
    await touch('touchMove', from.map(([x, y], finger) => [at(x, to[finger][0]), at(y, to[finger][1])]));
  }
  await touch('touchEnd', []);
  await session.detach();
}

export function keep(page, name) {
  return page.screenshot({ path: join(ARTEFACTS, `${name}.png`) });
}
