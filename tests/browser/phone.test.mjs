// SPDX-License-Identifier: Apache-2.0
// The page on a phone: the picture first, panels as sheets, and targets for fingers.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { before, test } from 'node:test';
import { changedShare, eventually, keep, openPage, PHONE, pixels, still } from './browser.mjs';
import { smallTargets } from './support/layout_audit.mjs';
import { browser, daemon } from './played.mjs';

const AXE = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const ACROSS = { ...PHONE, viewport: { width: 844, height: 390 }, colorScheme: 'light' };
const TABS = ['view', 'look', 'wrinkles', 'curves', 'capture', 'sources', 'session'];

before(() => daemon.hold(2));

/** Share of the screen that the picture covers. */
const pictureShare = (page) => page.evaluate(() => {
  const { width, height } = document.querySelector('.surface').getBoundingClientRect();
  return (width * height) / (innerWidth * innerHeight);
});

for (const [name, options, share] of [['upright', PHONE, 0.65], ['across', ACROSS, 0.7]]) {
  test(`the picture comes first: phone ${name}`, async () => {
    const page = await openPage(browser, daemon.address, options);
    await still(page);
    assert(await pictureShare(page) > share, `${await pictureShare(page)} of the screen`);
    assert.equal(await page.locator('.tab-panels').isVisible(), false);
    await keep(page, `phone-${name}`);
    const before = await pixels(page);
    await page.tap('#tab-view');
    await page.tap('[data-preset=eyes]');
    await eventually('the eyes', async () => changedShare(before, await pixels(page)) > 0.05);
    await page.tap('#tab-view');
    await eventually('the sheet has gone', async () => !await page.locator('.tab-panels').isVisible());
    assert(await pictureShare(page) > share);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth - innerWidth), 0);
    await page.context().close();
  });

  test(`sheets leave room for the picture and have targets for fingers: phone ${name}`, async () => {
    const page = await openPage(browser, daemon.address, options);
    await still(page);
    assert.deepEqual(await smallTargets(page), []);
    await page.evaluate(AXE);
    for (const tab of TABS) {
      await page.tap(`#tab-${tab}`);
      assert(await page.locator(`#panel-${tab}`).isVisible(), tab);
      if (tab === 'wrinkles') await page.locator('.region').first().tap();
      if (tab === 'wrinkles') await page.locator('.explain article').first().waitFor();
      const picture = await page.locator('.surface').boundingBox();
      assert(Math.min(picture.width, picture.height) >= 200, `${tab}: ${picture.width} x ${picture.height}`);
      assert.deepEqual(await smallTargets(page), [], tab);
      const { violations } = await page.evaluate(() => globalThis.axe.run());
      const serious = violations.filter(({ impact }) => impact === 'serious' || impact === 'critical');
      assert.deepEqual(serious.map(({ id, nodes }) => `${id}: ${nodes[0].html}`), [], tab);
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth - innerWidth), 0, tab);
      await keep(page, `phone-${name}-${tab}`);
    }
    assert.deepEqual(page.errors, []);
    await page.context().close();
  });
}

test('a touched setting is explained', async () => {
  const page = await openPage(browser, `${daemon.address}#panel=look`, PHONE);
  await page.locator('.help-line', { hasText: 'Touch a setting' }).waitFor();
  await page.locator('[data-setting=exposure]').tap({ position: { x: 20, y: 20 } });
  await page.locator('.help-line code', { hasText: 'exposure' }).waitFor();
  await page.context().close();
});
