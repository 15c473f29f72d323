// SPDX-License-Identifier: Apache-2.0
// The picture of the page for a bug report: it shows what the screen shows, at any density and in both colour schemes.
import assert from 'node:assert/strict';
import { copyFileSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { before, test } from 'node:test';
import { PNG } from 'pngjs';
import { changedShare, difference, envelopeOf, filterMessages, openPage, PHONE, pixels, still } from './browser.mjs';
import { browser, daemon } from './played.mjs';

/** Edges of letters are smoothed a little differently in an image. */
const MOST_CHANGED = 0.01;

before(() => daemon.hold(2));

/** The upper left part of a picture, or another part of it. */
function part(image, width, height, left = 0, top = 0) {
  const data = Buffer.alloc(4 * width * height);
  for (let y = 0; y < height; ++y) image.data.copy(data, 4 * width * y, 4 * (image.width * (top + y) + left), 4 * (image.width * (top + y) + left + width));
  return { width, height, data };
}

/** Presses the key, and returns the PNG that the browser saves. */
async function pageScreenshot(page, name) {
  const [file] = await Promise.all([page.waitForEvent('download'), page.keyboard.press('i')]);
  assert.match(file.suggestedFilename(), /^furrow-page-\d{4}-\d\d-\d\d-\d{6}\.png$/);
  copyFileSync(await file.path(), join(process.env.FURROW_ARTEFACTS, `page-${name}.png`));
  return PNG.sync.read(readFileSync(await file.path()));
}

async function screen(page) {
  // Curves that follow the picture would move between both pictures.
  if (await page.locator('.curves').isVisible()) await page.getByRole('button', { name: 'Freeze' }).click();
  await page.mouse.move(1, 1);
  await page.focus('.surface');
  await page.evaluate(() => document.activeElement.blur()); // a ring around what has the focus is not part of the picture
  return PNG.sync.read(await page.screenshot());
}

for (const [name, options, fragment, prepare] of [
  ['dark', { viewport: { width: 1280, height: 720 } }, '#debug=normal&panel=look&camera=eyes', async (page) => {
    // What only properties know: a text, a place in a list that scrolls, a box and a choice.
    await page.fill('#settings-search', 'a');
    assert(await page.locator('#panel-look').evaluate((panel) => (panel.scrollTop = 60, panel.scrollTop)) > 0);
    await page.selectOption('.timeline select', '0.5');
  }],
  ['light-dense', { viewport: { width: 1100, height: 700 }, deviceScaleFactor: 2, colorScheme: 'light' }, '#panel=wrinkles', async (page) => {
    await page.locator('.region').first().waitFor();
    assert.equal(await page.locator('#panel-wrinkles').evaluate((panel) => (panel.scrollTop = 200, panel.scrollTop)), 200);
  }],
  ['phone', PHONE, '#panel=curves', async () => {}],
]) {
  test(`the picture of the page shows what the screen shows: ${name}`, async () => {
    const page = await openPage(browser, daemon.address + fragment, options);
    await still(page);
    await page.waitForSelector('.uplot canvas');
    await prepare(page);
    await still(page);
    const real = await screen(page);
    const image = await pageScreenshot(page, name);
    assert.equal(image.width, real.width);
    const changed = changedShare(part(image, real.width, real.height), real);
    assert(changed < MOST_CHANGED, `${(100 * changed).toFixed(2)} % differ`);
    // The picture itself is the one on the screen. Only buttons and labels lie on it, at its upper edge.
    const density = options.deviceScaleFactor ?? 1;
    const box = await page.locator('.picture').boundingBox();
    const picture = await pixels(page);
    const [width, height, skip] = [picture.width, picture.height - 121 * density, 120 * density];
    const [left, top] = [box.x, box.y].map((value) => Math.round(value * density));
    const drawn = difference(part(image, width, height, left, top + skip), part(picture, width, height, 0, skip));
    // Layouts have parts of pixels, by which the picture may be moved.
    assert(drawn < 2, `the picture differs by ${drawn} of 255`);
    // Below it are words: a line of them has light and dark pixels.
    const caption = part(image, image.width, image.height - real.height, 0, real.height);
    assert(caption.height > 60 * density, `${caption.height} px of caption`);
    const brightness = [...Array(caption.width * caption.height).keys()].map((i) => caption.data[4 * i]);
    assert(Math.max(...brightness.slice(0, 100_000)) - Math.min(...brightness.slice(0, 100_000)) > 120, 'no words');
    assert.deepEqual(page.errors, []);
    await page.context().close();
  });
}

test('the picture of the page can be pasted', async () => {
  const page = await openPage(browser, daemon.address, { permissions: ['clipboard-read', 'clipboard-write'] });
  await still(page);
  const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save the page as PNG' }).click()]);
  await page.locator('.toast', { hasText: `Saved ${file.suggestedFilename()}, and copied it` }).waitFor();
  const copied = await page.evaluate(async () => {
    const [item] = await navigator.clipboard.read();
    return Array.from(new Uint8Array(await (await item.getType('image/png')).arrayBuffer()));
  });
  const [pasted, saved] = [Buffer.from(copied), readFileSync(await file.path())].map((bytes) => PNG.sync.read(bytes));
  assert.equal(difference(pasted, saved), 0);
  await page.context().close();
});

test('without a picture, the page can be saved as well, and never what somebody typed as a token', async () => {
  const page = await openPage(browser, daemon.address, {}, (opened) => filterMessages(opened, (message) => envelopeOf(message).kind !== 'FIMG'));
  await page.waitForSelector('.app[data-state=loading]');
  const copied = await page.evaluate(() => {
    document.querySelector('dialog.token input').value = 'frw1_secret';
    // The page draws its copy as an image. Its source is the copy.
    return new Promise((resolve) => {
      const { set } = Object.getOwnPropertyDescriptor(HTMLImageElement.prototype, 'src');
      Object.defineProperty(HTMLImageElement.prototype, 'src', { set(source) { set.call(this, source); resolve(decodeURIComponent(source)); } });
      document.dispatchEvent(new KeyboardEvent('keydown', { key: 'i' }));
    });
  });
  assert.match(copied, /^data:image\/svg\+xml/);
  assert.match(copied, /class="condition wait"/);
  assert.doesNotMatch(copied, /frw1_secret/);
  await page.locator('.toast', { hasText: 'Saved furrow-page-' }).waitFor();
  await page.context().close();
});
