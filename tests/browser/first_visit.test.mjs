// SPDX-License-Identifier: Apache-2.0
// What somebody sees who opens the page for the first time.
import assert from 'node:assert/strict';
import { mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { PNG } from 'pngjs';
import { envelopeOf, eventually, filterMessages, keep, launch, openPage, still } from './browser.mjs';
import { Daemon, recording } from './daemon.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

/** Mean colour of the middle of the picture. */
async function middle(page) {
  const { data, width, height } = PNG.sync.read(await page.locator('.surface').screenshot());
  const sum = [0, 0, 0];
  let count = 0;
  for (let y = Math.floor(0.42 * height); y < 0.5 * height; ++y) {
    for (let x = Math.floor(0.47 * width); x < 0.53 * width; ++x, ++count) {
      for (const c of [0, 1, 2]) sum[c] += data[4 * (y * width + x) + c];
    }
  }
  return sum.map((value) => value / count);
}

test('before the first picture, there is a face out of focus and the progress', async () => {
  const daemon = await Daemon.startAsShipped(['--play', recording('performance')]);
  try {
    let holds = true;
    const page = await openPage(browser, daemon.address, {}, async (opened) => {
      await filterMessages(opened, (message) => !(holds && envelopeOf(message).kind === 'FIMG'));
      await opened.route('**/api/status', async (route) => {
        const response = await route.fetch();
        const status = await response.json();
        await route.fulfill({ response, json: { ...status, ...(holds ? { drawing: { done: 2, passes: 12 } } : {}) } });
      });
    });
    await page.locator('.notice-title', { hasText: 'step 3 of 12' }).waitFor();
    assert.equal(await page.locator('.notice progress').evaluate(({ value }) => value), 2 / 12);
    assert.equal(await page.locator('.app').getAttribute('data-state'), 'loading');
    assert(await page.locator('.placeholder').isVisible());
    await page.addStyleTag({ content: '.notice { display: none !important; }' });
    const before = await middle(page);
    await keep(page, 'first-visit-loading');
    holds = false;
    await page.waitForSelector('.app[data-state=live]');
    await eventually('the picture', async () => !await page.locator('.placeholder').isVisible());
    const after = await middle(page);
    // Skin, before and after: warm, and of about the same brightness.
    assert(before[0] > before[2] + 20 && after[0] > after[2] + 20, `${before} then ${after}`);
    assert(Math.abs(before[1] - after[1]) < 70, `${before} then ${after}`);
    assert.deepEqual(page.errors, []);
    await page.context().close();
  } finally {
    await daemon.stop();
  }
});

test('the placeholder is in the document, before any script has run', async () => {
  const daemon = await Daemon.start(['--no-render']);
  try {
    const page = await openPage(browser, daemon.address, {}, (opened) => opened.route('**/assets/**', (route) => route.abort()));
    assert(await page.locator('.placeholder').isVisible());
    await page.context().close();
  } finally {
    await daemon.stop();
  }
});

test('the first view is skin, small on a slow machine and in full at rest', async () => {
  const daemon = await Daemon.startAsShipped(['--play', recording('performance')]);
  try {
    await daemon.hold(2);
    const sizes = [];
    const page = await openPage(browser, daemon.address, {}, (opened) => filterMessages(opened, (message) => {
      if (envelopeOf(message).kind === 'FIMG') sizes.push(message.length);
      return true;
    }));
    await still(page);
    const { settings } = await daemon.get('api/settings');
    const shading = settings.find(({ name }) => name === 'shading');
    assert.deepEqual([shading.value, shading.default], ['skin', 'skin']);
    assert.equal(await page.locator('[data-setting=shading] select').evaluate((list) => list.selectedOptions[0].textContent), 'Skin');
    assert(!page.url().includes('shading'), page.url());
    if ((await daemon.get('api/status')).software) {
      assert(sizes.length >= 2 && sizes[0] < sizes.at(-1), `${sizes}`);
    }
    await keep(page, 'first-view');
    await page.context().close();
  } finally {
    await daemon.stop();
  }
});

test('without a stream, the page says what to do, and nothing is cut off', async () => {
  const daemon = await Daemon.start();
  try {
    const page = await openPage(browser, daemon.address, { viewport: { width: 1280, height: 720 } });
    await page.waitForSelector('.app[data-state=empty]');
    const cut = await page.locator('.card, .card *, .condition').evaluateAll((all) => all
      .filter((element) => element.checkVisibility() && element.scrollWidth > element.clientWidth + 1 && getComputedStyle(element).display !== 'inline')
      .map((element) => element.textContent));
    assert.deepEqual(cut, []);
    await page.getByText('furrow play performance --to 127.0.0.1 --loop').waitFor();
    await keep(page, 'state-empty');
    await page.getByRole('button', { name: 'Connect a phone or a tracker' }).click();
    await page.locator('#panel-sources [data-source=livelink_face]').waitFor();
    await page.context().close();
  } finally {
    await daemon.stop();
  }
});

test('compiled shaders are kept in the cache folder, and furrowd says what it loads', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'furrow-cache-'));
  const former = process.env.CACHE_DIRECTORY;
  process.env.CACHE_DIRECTORY = join(folder, 'furrow');
  let daemon;
  try {
    daemon = await Daemon.startAsShipped(['--play', recording('performance')]);
    for (const words of ['starting the renderer', 'loading the character', 'rendering on']) {
      await eventually(words, () => daemon.log.includes(words)); // it serves before it draws
    }
    if (!(await daemon.get('api/status')).software) return; // GPU drivers keep them in their own ways
    const page = await openPage(browser, daemon.address);
    await page.waitForSelector('.app[data-state=live]');
    const numFiles = () => readdirSync(join(folder, 'furrow', 'mesa'), { recursive: true }).length;
    await eventually('compiled shaders', () => numFiles() > 10);
    await page.context().close();
  } finally {
    await daemon?.stop();
    if (former === undefined) delete process.env.CACHE_DIRECTORY;
    else process.env.CACHE_DIRECTORY = former;
    rmSync(folder, { recursive: true, force: true });
  }
});

test('a browser without a language shows the page, and one that cannot run it says so', async () => {
  const daemon = await Daemon.start(['--play', recording('performance')]);
  try {
    await daemon.hold(2);
    const page = await openPage(browser, daemon.address, {}, (opened) => opened.addInitScript(() => {
      Object.defineProperty(Navigator.prototype, 'language', { get: () => 'C', configurable: true });
    }));
    await still(page);
    assert.deepEqual(page.errors, []);
    await page.context().close();
    for (const prepare of [
      // Before and after the picture's place has been built, and a script that the browser cannot read.
      (opened) => opened.addInitScript(() => delete window.ResizeObserver),
      (opened) => opened.addInitScript(() => delete window.IntersectionObserver),
      (opened) => opened.route('**/assets/index-*.js', (route) => route.fulfill({ contentType: 'text/javascript', body: 'let let = 1;' })),
    ]) {
      const old = await openPage(browser, daemon.address, {}, prepare);
      await old.getByRole('alert').filter({ hasText: 'This browser cannot run the page: ' }).waitFor();
      await eventually('the picture', () => old.evaluate(() => document.querySelector('img').naturalWidth > 0));
      await keep(old, 'cannot-run');
      await old.context().close();
    }
  } finally {
    await daemon.stop();
  }
});
