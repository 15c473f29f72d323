// SPDX-License-Identifier: Apache-2.0
// Basic use of the page: it loads, shows the performer, and responds to mouse, touch and keys.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { test } from 'node:test';
import { PNG } from 'pngjs';
import { changedShare, difference, envelopeOf, eventually, filterMessages, keep, openPage, pixels, shown, still, swipe } from './browser.mjs';
import { browser, daemon } from './played.mjs';

const AXE = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const SMILE_S = 2.0;

async function closePage(page) {
  assert.deepEqual(page.errors, []);
  await page.context().close();
}

test('pictures arrive and change with the pose', async () => {
  const page = await openPage(browser, daemon.address);
  await shown(page);
  const first = await pixels(page);
  await eventually('another picture', async () => changedShare(first, await pixels(page)) > 0.005);
  await page.waitForSelector('.condition.ok');
  await keep(page, 'live-1000x640');
  await closePage(page);
});

test('a pose at rest gives one stable picture', async () => {
  await daemon.hold(SMILE_S);
  const page = await openPage(browser, daemon.address);
  await still(page);
  assert.equal(difference(await pixels(page), await pixels(page)), 0);
  await closePage(page);
});

test('a drag orbits the camera, a framing resets it', async () => {
  await daemon.hold(SMILE_S);
  const page = await openPage(browser, daemon.address);
  await still(page);
  const front = await pixels(page);
  const box = await page.locator('.surface').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 80, box.y + box.height / 2, { steps: 4 });
  await page.mouse.up();
  // The page may still show the picture from before, which is still as well.
  await eventually('the drag turns the picture', async () => {
    await still(page);
    return changedShare(front, await pixels(page)) > 0.05;
  });
  await page.click('[data-preset=face]');
  await eventually('the framing resets the picture', async () => {
    await still(page);
    return difference(front, await pixels(page)) < 1;
  });
  await closePage(page);
});

test('the bar below the picture fits one row', async () => {
  const page = await openPage(browser, daemon.address, { viewport: { width: 1440, height: 900 } });
  await page.waitForSelector('.view-bar [data-preset]');
  const middles = await page.evaluate(() => [...document.querySelectorAll('.view-bar :is(button, select)')].map((element) => {
    const { top, bottom } = element.getBoundingClientRect();
    return Math.round((top + bottom) / 2);
  }));
  assert(middles.length > 8);
  assert(Math.max(...middles) - Math.min(...middles) < 5, middles.join());
  await closePage(page);
});

test('touch orbits, pans, zooms and taps', async () => {
  await daemon.hold(SMILE_S);
  const page = await openPage(browser, daemon.address, { hasTouch: true, viewport: { width: 1180, height: 820 } });
  await still(page);
  const box = await page.locator('.surface').boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  let former = await pixels(page);
  for (const [what, from, to] of [
    ['one finger turns', [[x, y]], [[x + 90, y]]],
    ['two fingers move', [[x - 60, y], [x + 60, y]], [[x - 60, y + 80], [x + 60, y + 80]]],
    ['two fingers zoom', [[x - 40, y], [x + 40, y]], [[x - 120, y], [x + 120, y]]],
  ]) {
    await swipe(page, from, to);
    await still(page);
    const now = await pixels(page);
    assert(changedShare(former, now) > 0.02, what);
    former = now;
  }
  await page.tap('[data-preset=eyes]');
  await still(page);
  assert(changedShare(former, await pixels(page)) > 0.05);
  await page.tap('#tab-session');
  await page.locator('.subjects button').first().waitFor();
  assert.equal(await page.evaluate(() => document.scrollingElement.scrollTop), 0); // touch moves only the camera, not the page
  await closePage(page);
});

test('the first paint takes at most 300 kB', async () => {
  const page = await openPage(browser, daemon.address);
  await shown(page);
  const loaded = await page.evaluate(() => [
    ...performance.getEntriesByType('navigation'), ...performance.getEntriesByType('resource'),
  ].map(({ name, encodedBodySize, transferSize }) => ({ name, bytes: Math.max(encodedBodySize, transferSize) })));
  const total = loaded.reduce((sum, { bytes }) => sum + bytes, 0);
  assert(loaded.length >= 3 && total > 10_000, 'nothing was loaded?');
  assert(total <= 300_000, `${total} bytes: ${JSON.stringify(loaded)}`);
  assert.deepEqual(loaded.filter(({ name }) => !name.startsWith(daemon.address)), []);
  await closePage(page);
});

test('keys, wheel and framings move the camera', async () => {
  await daemon.hold(SMILE_S);
  const page = await openPage(browser, daemon.address);
  await still(page);
  await page.focus('.surface');
  let former = await pixels(page);
  for (const [what, act] of [
    ['arrow', () => page.keyboard.press('ArrowLeft')],
    ['walk', () => page.keyboard.press('w', { delay: 300 })],
    ['zoom', () => page.keyboard.press('+')],
    ['wheel', () => page.mouse.wheel(0, 240)],
    ['framing by key', () => page.keyboard.press('3')],
    ['framing by button', () => page.click('[data-preset=eyes]')],
  ]) {
    if (what === 'wheel') await page.locator('.surface').hover();
    await act();
    await still(page);
    const now = await pixels(page);
    assert(changedShare(former, now) > 0.01, what);
    former = now;
  }
  assert.equal(await page.getAttribute('[data-preset=eyes]', 'aria-pressed'), 'true');
  await closePage(page);
});

test('keys work after a click on a button, a list or a slider', async () => {
  await daemon.hold(SMILE_S);
  const page = await openPage(browser, daemon.address);
  await still(page);
  let plays = false;
  for (const act of [
    () => page.click('[data-preset=eyes]'),
    () => page.selectOption('select[aria-label=Sharpness]', 'sharp'),
    () => page.locator('input[aria-label="Position in the recording"]').click(),
    () => page.click('#tab-wrinkles'),
  ]) {
    // By mouse, as people do; selectOption() alone has no pointer.
    await page.locator('select[aria-label=Sharpness]').dispatchEvent('pointerdown');
    await act();
    await page.keyboard.press('Space');
    plays = !plays;
    await eventually(`playing: ${plays}`, async () => (await daemon.get('api/playback')).playing === plays);
    await eventually('the page knows', async () => await page.locator('.play').textContent() === (plays ? 'Pause' : 'Play'));
  }
  // People who use the keyboard alone keep their place, and press the button again.
  await daemon.hold(SMILE_S);
  await page.focus('[data-preset=face]');
  await page.keyboard.press('Space');
  assert.equal(await page.evaluate(() => document.activeElement.dataset.preset), 'face');
  assert.equal((await daemon.get('api/playback')).playing, false);
  await closePage(page);
});

test('the page says what it draws, and does not leave the old picture without a word', async () => {
  await daemon.hold(SMILE_S);
  let holds = false;
  const page = await openPage(browser, `${daemon.address}#camera=eyes`, {}, (opened) =>
    filterMessages(opened, (message) => !(holds && envelopeOf(message).kind === 'FIMG')));
  await still(page);
  holds = true;
  await page.click('[data-preset=face]');
  await page.locator('.busy', { hasText: 'Drawing Face' }).waitFor();
  await keep(page, 'drawing-face');
  await closePage(page);
});

test('the picture can be saved, recorded and shown alone', async () => {
  await daemon.hold(SMILE_S);
  const page = await openPage(browser, daemon.address);
  await still(page);
  const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save the picture as PNG' }).click()]);
  assert.match(file.suggestedFilename(), /^furrow-\d{4}-\d\d-\d\d-\d{6}\.png$/);
  assert.equal(difference(PNG.sync.read(readFileSync(await file.path())), await pixels(page)), 0);
  await daemon.patch('api/playback', { playing: true });
  await page.keyboard.press('r');
  await page.locator('.record-clock', { hasText: '0:01' }).waitFor();
  const [video] = await Promise.all([page.waitForEvent('download'), page.keyboard.press('r')]);
  assert.match(video.suggestedFilename(), /\.webm$/);
  const bytes = readFileSync(await video.path());
  assert.equal(bytes.toString('hex', 0, 4), '1a45dfa3', 'the magic of WebM');
  assert(bytes.length > 5000, `${bytes.length} bytes`);
  await page.keyboard.press('f');
  await eventually('fullscreen', () => page.evaluate(() => document.fullscreenElement !== null));
  await page.keyboard.press('f');
  await eventually('a window', () => page.evaluate(() => document.fullscreenElement === null));
  await closePage(page);
});

test('settings survive a reload', async () => {
  await daemon.hold(SMILE_S);
  const page = await openPage(browser, `${daemon.address}#camera=mouth&wrinkles=off&wrinkle_strength=2&panel=session`);
  await still(page);
  const former = await pixels(page);
  await page.click('[data-preset=profile]');
  await eventually('the address', () => page.url().includes('camera=profile'));
  // The first picture from the new camera is not a still yet. The stage shows the former still until it arrives.
  await eventually('the profile', async () => changedShare(former, await pixels(page)) > 0.05);
  await still(page);
  const profile = await pixels(page);
  await page.reload();
  await still(page);
  assert(difference(profile, await pixels(page)) < 1);
  assert.match(page.url(), /wrinkles=off/);
  assert.equal(await page.getAttribute('#tab-session', 'aria-selected'), 'true');
  await closePage(page);
});

test('the wipe shows both sides', async () => {
  await daemon.hold(SMILE_S);
  const page = await openPage(browser, `${daemon.address}#camera=face&wrinkle_strength=3`);
  await still(page);
  const on = await pixels(page);
  await page.selectOption('select[aria-label="Split the picture"]', 'wrinkles');
  await page.waitForSelector('.wipe-label.left');
  await eventually('the left side without wrinkles', async () => changedShare(on, await pixels(page)) > 0.002);
  await still(page);
  const half = await pixels(page);
  await keep(page, 'wipe-wrinkles');
  // The picture right of the divider must not change.
  const right = (image) => ({ width: 1, height: 1, data: image.data.filter((_, i) => (i / 4) % image.width > image.width * 0.52) });
  assert(difference(right(on), right(half)) < 1.5);
  await closePage(page);
});

test('debug views are live thumbnails that enlarge', async () => {
  await daemon.hold(SMILE_S);
  const page = await openPage(browser, daemon.address);
  await still(page);
  await page.selectOption('select[aria-label="Add a debug view"]', 'normal');
  const thumbnail = page.locator('figure[data-view=normal] button.thumb');
  await thumbnail.waitFor();
  const colours = () => page.evaluate(() => {
    const canvas = document.querySelector('figure[data-view=normal] canvas');
    return new Set(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data).size;
  });
  await eventually('a picture in the thumbnail', async () => (await colours()) > 40);
  await still(page);
  const final = await pixels(page);
  await thumbnail.click();
  await still(page);
  assert(changedShare(final, await pixels(page)) > 0.2);
  assert.equal(await thumbnail.getAttribute('aria-pressed'), 'true');
  await keep(page, 'debug-view');
  await page.focus('.surface');
  await page.keyboard.press('Escape');
  await still(page);
  assert(changedShare(final, await pixels(page)) < 0.05);
  await closePage(page);
});

test('the timeline plays, pauses, scrubs and loops', async () => {
  await daemon.hold(0);
  const page = await openPage(browser, daemon.address);
  await still(page);
  await page.locator('.timeline').waitFor();
  const former = await pixels(page);
  await page.locator('input[aria-label="Position in the recording"]').fill('2');
  await eventually('the daemon follows', async () => Math.abs((await daemon.get('api/playback')).position_s - 2) < 0.1);
  await eventually('its picture', async () => changedShare(former, await pixels(page)) > 0.005);
  await page.getByRole('button', { name: 'Play', exact: true }).click();
  await eventually('it plays', async () => (await daemon.get('api/playback')).playing);
  await page.selectOption('select[aria-label=Speed]', '0.5');
  await eventually('the speed', async () => (await daemon.get('api/playback')).speed === 0.5);
  const { loop } = await daemon.get('api/playback');
  await page.locator('.timeline input[type=checkbox]').click();
  await eventually('the loop', async () => (await daemon.get('api/playback')).loop === !loop);
  await daemon.patch('api/playback', { loop: true, speed: 1 });
  await closePage(page);
});

for (const [name, options] of [
  ['1280x720', { viewport: { width: 1280, height: 720 } }],
  ['tablet-upright', { viewport: { width: 820, height: 1180 }, hasTouch: true }],
  ['tablet-across', { viewport: { width: 1180, height: 820 }, deviceScaleFactor: 2, hasTouch: true }],
  ['light', { viewport: { width: 1024, height: 768 }, colorScheme: 'light', reducedMotion: 'reduce' }],
]) {
  test(`axe finds no serious fault: ${name}`, async () => {
    await daemon.hold(SMILE_S);
    const page = await openPage(browser, `${daemon.address}#shading=skin`, options);
    await still(page);
    await page.evaluate(AXE);
    for (const tab of ['look', 'wrinkles', 'capture', 'session']) {
      await page.click(`#tab-${tab}`);
      if (tab === 'wrinkles') await page.locator('.region').first().click();
      if (tab === 'wrinkles') await page.locator('.explain article').first().waitFor();
      const { violations } = await page.evaluate(() => globalThis.axe.run());
      const serious = violations.filter(({ impact }) => impact === 'serious' || impact === 'critical');
      assert.deepEqual(serious.map(({ id, nodes }) => `${id}: ${nodes[0].html}`), [], tab);
      await keep(page, `${name}-${tab}`);
    }
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert(overflow <= 0, `${overflow} pixels too wide`);
    await closePage(page);
  });
}
