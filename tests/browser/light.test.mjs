// SPDX-License-Identifier: Apache-2.0
// The light around the subject: one click, back again, and nothing else changes.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { before, test } from 'node:test';
import { changedShare, difference, eventually, keep, openPage, PHONE, pixels, still } from './browser.mjs';
import { browser, daemon } from './played.mjs';
import { layoutFaults, smallTargets } from './support/layout_audit.mjs';

const AXE = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const NAMES = ['studio', 'overcast', 'sunset', 'stage', 'neutral'];
const SMALL = { viewport: { width: 1000, height: 640 } };

before(() => daemon.hold(2));

async function openLight(options, fragment = '') {
  const page = await openPage(browser, daemon.address + fragment, options);
  await still(page);
  await page.getByRole('button', { name: 'Move the lamps' }).click();
  return page;
}

const press = (page, name) => page.click(`[data-environment=${name}]`);
const pressed = (page) => page.locator('.environment[aria-pressed=true]').evaluateAll((all) => all.map((one) => one.dataset.environment));

/** The picture after a change of the address. */
async function pictureAt(page, what, holds) {
  await eventually(what, () => holds(page.url()));
  await still(page);
  return pixels(page);
}

test('an environment changes the light, and one step leads back', async () => {
  const page = await openLight(SMALL, '#camera=eyes&wrinkle_strength=2&lights.turn_degrees=30&background=0.1,0.2,0.1');
  const before = await pixels(page);
  assert.deepEqual(await pressed(page), []);
  await press(page, 'sunset');
  const sunset = await pictureAt(page, 'the address of the sunset', (url) => /lights\.turn_degrees=-20/.test(url));
  assert(changedShare(before, sunset) > 0.3);
  assert.deepEqual(await pressed(page), ['sunset']);
  assert.match(page.url(), /wrinkle_strength=2/);
  assert.match(page.url(), /background=0\.1(,|%2C)0\.2(,|%2C)0\.1/);

  await press(page, 'stage');
  await pictureAt(page, 'the stage', (url) => /lights\.intensity=3/.test(url));
  await page.keyboard.press('Control+z'); // each click is a step, however soon it comes
  assert(difference(sunset, await pictureAt(page, 'the sunset again', (url) => /lights\.turn_degrees=-20/.test(url))) < 1);
  await page.keyboard.press('Control+z');
  assert(difference(before, await pictureAt(page, 'the light before', (url) => /lights\.turn_degrees=30/.test(url))) < 1);
  assert.deepEqual(await pressed(page), []);

  // The one that is shown leads back as well, past others that were tried.
  await press(page, 'overcast');
  await press(page, 'neutral');
  await pictureAt(page, 'neutral light', (url) => /lights\.preset=thesis/.test(url));
  await press(page, 'neutral');
  assert(difference(before, await pictureAt(page, 'the light before', (url) => /lights\.turn_degrees=30/.test(url))) < 1);

  await press(page, 'stage');
  await page.locator('.light-tools').getByRole('button', { name: 'Reset' }).click();
  await pictureAt(page, 'the light of the daemon', (url) => !/lights|exposure/.test(url) && /wrinkle_strength=2/.test(url));
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test('no environment burns the skin or hides the eyes', async () => {
  const page = await openLight(SMALL, '#shading=skin&camera=face');
  for (const name of NAMES) {
    await press(page, name);
    await eventually(name, async () => (await pressed(page)).join() === name);
    await still(page);
    const { data } = await pixels(page);
    let [face, burnt, black, red, blue] = [0, 0, 0, 0, 0];
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = data.subarray(i, i + 3);
      if (Math.max(Math.abs(r - 47), Math.abs(g - 48), Math.abs(b - 49)) < 16) continue; // the background
      ++face;
      if (Math.max(r, g, b) > 252) ++burnt;
      if (Math.max(r, g, b) < 16) ++black;
      red += r;
      blue += b;
    }
    const say = (share) => `${name}: ${(100 * share / face).toFixed(2)} % of the subject`;
    assert(face > 0.1 * data.length / 4, say(face));
    assert(burnt < 0.005 * face, `burnt, ${say(burnt)}`);
    assert(black < 0.03 * face, `black, ${say(black)}`);
    // Skin and a blue shirt together: warmer than grey, and warmest at sunset.
    assert(red / blue > 1 && red / blue < 1.8, `${name}: ${red / blue}`);
    await keep(page, `environment-${name}`);
  }
  await page.context().close();
});

for (const [name, options, isPhone] of [
  ['wide', { viewport: { width: 1280, height: 720 }, colorScheme: 'light' }, false],
  ['upright', PHONE, true], ['across', { ...PHONE, viewport: { width: 844, height: 390 } }, true],
]) {
  test(`the bar of the light is whole and accessible: ${name}`, async () => {
    const page = await openLight(options, '#panel=session');
    if (isPhone) await page.tap('#tab-session'); // closes its sheet, beside which there is little room for a bar
    await page.locator('.light-bar').waitFor();
    await still(page);
    await page.evaluate(AXE);
    const { violations } = await page.evaluate(() => globalThis.axe.run());
    assert.deepEqual(violations.map(({ id, nodes }) => `${id}: ${nodes[0].html}`), []);
    assert.deepEqual(await layoutFaults(page), []);
    if (isPhone) assert.deepEqual(await smallTargets(page), []);
    await keep(page, `light-bar-${name}`);
    await page.context().close();
  });
}
