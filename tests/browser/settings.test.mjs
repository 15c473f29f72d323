// SPDX-License-Identifier: Apache-2.0
// The settings menu: every group changes the picture; undo, compare, presets, text; rejected values are reported.
import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { changedShare, COARSE, difference, eventually, keep, openPage, pixels, still } from './browser.mjs';
import { browser, daemon } from './played.mjs';

before(() => daemon.hold(2));

async function search(page, text) {
  await page.fill('#settings-search', text);
}

const row = (page, name) => page.locator(`[data-setting="${name}"]`);

/** Changes a setting to another value with its control in the menu. */
async function change(page, setting) {
  await search(page, setting.name);
  const target = row(page, setting.name);
  if (setting.kind === 'list') {
    await target.locator('button').first().click();
    await target.locator('label').nth(1).click();
  } else if (setting.kind === 'bool') {
    await target.locator('label').first().click();
  } else if (await target.locator('select').count() > 0) {
    const select = target.locator('select');
    const count = await select.locator('option').count();
    const at = await select.evaluate((element) => element.selectedIndex);
    await select.selectOption({ index: (at + count - 1) % count });
  } else if (setting.kind === 'colour') {
    await target.locator('input[type=text]').first().fill('#802020');
    await page.keyboard.press('Enter');
  } else {
    const input = target.locator('input[type=text]').last();
    await input.fill(String(Number(setting.value) === setting.max ? setting.min : setting.max));
    await page.keyboard.press('Enter');
  }
}

test('every setting of the daemon is in the menu', async () => {
  const page = await openPage(browser, daemon.address);
  await page.locator('[data-setting]').first().waitFor({ state: 'attached' });
  const { settings } = await daemon.get('api/settings');
  assert(settings.length > 30);
  const inMenu = await page.locator('[data-setting]').evaluateAll((rows) => rows.map((r) => r.dataset.setting));
  assert.deepEqual(inMenu.sort(), settings.map(({ name }) => name).sort());
  await search(page, 'softness');
  assert.equal(await page.locator('[data-setting]:visible').count(), 1);
  await search(page, 'no such thing');
  await page.getByText('No setting matches.').waitFor();
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test('each group of settings changes the picture', async () => {
  const { settings } = await daemon.get('api/settings');
  // Crowd settings apply to pictures of several subjects, which the page does not show.
  const groups = new Set(settings.map(({ group }) => group));
  assert(groups.delete('detail'));
  // A view in which every group has a visible effect: strong light from behind on pronounced folds.
  const page = await openPage(browser, `${daemon.address}#shading=skin&wrinkle_strength=2&translucency.strength=4` +
    '&lights.turn_degrees=180&bloom.strength=0.8&bloom.threshold=0.1&displacement.enabled=on&displacement.strength=3', COARSE);
  await page.selectOption('select[aria-label=Sharpness]', 'fast');
  await page.keyboard.press('Escape');
  await still(page);
  const base = await pixels(page);
  for (const group of groups) {
    let took = 0;
    for (const setting of settings.filter((candidate) => candidate.group === group)) {
      await change(page, setting);
      await still(page);
      took = changedShare(base, await pixels(page));
      await page.getByRole('button', { name: 'Undo' }).first().click();
      await still(page);
      if (took > 0.0005) break;
    }
    assert(took > 0.0005, `nothing in "${group}" changes the picture`);
  }
  await search(page, '');
  assert(difference(base, await pixels(page)) < 1);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test('holding Compare shows the picture before the change', async () => {
  const page = await openPage(browser, `${daemon.address}#wrinkle_strength=3`);
  await still(page);
  const base = await pixels(page);
  await change(page, { name: 'wrinkles', kind: 'bool' });
  await still(page);
  let without = base;
  await eventually('the wrinkles disappear', async () => changedShare(base, without = await pixels(page)) > 0.002);
  await still(page);
  without = await pixels(page);
  await page.getByRole('button', { name: 'Compare' }).hover();
  await page.mouse.down();
  await still(page);
  assert(difference(base, await pixels(page)) < 1);
  await page.mouse.up();
  await still(page);
  assert(difference(without, await pixels(page)) < 1);
  await page.context().close();
});

test('presets are one undo step and use existing settings', async () => {
  const page = await openPage(browser, daemon.address);
  await still(page);
  const presets = page.locator('select[aria-label=Preset]');
  for (const name of await presets.locator('option').evaluateAll((all) => all.map((o) => o.value).filter(Boolean))) {
    await presets.selectOption(name);
  }
  assert.equal(await page.locator('.toast').count(), 0);
  await presets.selectOption('Skin, portrait');
  await eventually('skin', () => page.url().includes('shading=skin'));
  await page.keyboard.press('Control+z');
  await eventually('the preset before', () => page.url().includes('tone_map=clip'));
  await page.context().close();
});

test('rejected settings are reported and reverted', async () => {
  const page = await openPage(browser, `${daemon.address}#subsurface.width=99`);
  await page.locator('.toast.error', { hasText: 'subsurface.width' }).waitFor();
  await still(page); // the page still shows a picture
  await page.getByRole('button', { name: 'As text…' }).click();
  const text = page.locator('dialog textarea');
  await text.fill('[subsurface]\nwidth = 99\n');
  await page.getByRole('button', { name: 'Set for all viewers' }).click();
  await page.locator('dialog .error', { hasText: 'subsurface.width' }).waitFor();
  await keep(page, 'refused');
  await text.fill('[subsurface\nwidth = 1');
  await page.getByRole('button', { name: 'Set for all viewers' }).click();
  await page.locator('dialog .error', { hasText: 'Line 1' }).waitFor();
  const { settings } = await daemon.get('api/settings');
  const width = settings.find(({ name }) => name === 'subsurface.width');
  assert.equal(width.value, width.default);
  await page.context().close();
});

test('a setting for all viewers reaches other pages', async () => {
  const one = await openPage(browser, daemon.address);
  const other = await openPage(browser, daemon.address);
  await still(other);
  const former = await pixels(other);
  await one.getByRole('button', { name: 'As text…' }).click();
  await one.fill('dialog textarea', 'exposure = 3.0\n');
  const set = one.getByRole('button', { name: 'Set for all viewers' });
  await set.click();
  await eventually('the daemon takes the setting', async () => {
    if (!await set.isVisible()) return true;
    const refusal = await one.locator('dialog .error').textContent();
    // The daemon refuses a computer that asks too often, as two pages that have just loaded do.
    if (/too often/.test(refusal)) await set.click();
    else assert.equal(refusal, '');
    return false;
  });
  await eventually('a brighter picture', async () => difference(former, await pixels(other)) > 10);
  await daemon.patch('api/settings', { exposure: 1 });
  await one.context().close();
  await other.context().close();
});
