// SPDX-License-Identifier: Apache-2.0
// Tools for daily work on the page: several subjects, guided capture, curves, layouts, light.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, test } from 'node:test';
import { changedShare, eventually, openPage, pixels, shown, still } from './browser.mjs';
import { furrow, recording } from './daemon.mjs';
import { browser, daemon } from './played.mjs';

const publisher = furrow('play', recording('anger'), '--to', `127.0.0.1:${daemon.ports.udp}`, '--udp', '--subject', 'ada', '--loop', '--rate', '10');
publisher.stdout.resume();
after(() => publisher.kill());
await daemon.hold(2);

async function closePage(page) {
  assert.deepEqual(page.errors, []);
  await page.context().close();
}

/** Wide enough for bars beside the picture, and quick to draw. */
const SMALL = { viewport: { width: 920, height: 540 } };

const tile = (page, name) => page.locator(`.tile[data-subject="${name}"]`);
const subscriptions = async () => (await daemon.get('api/status')).subscriptions;

/** Waits for the address, which the page writes a moment after a change. */
const addressIs = (page, pattern) => eventually(`the address ${pattern}`, () => pattern.test(page.url()));

test('tiles show all subjects; keys choose one, and two are compared', async () => {
  const page = await openPage(browser, `${daemon.address}#grid=1&panel=&dock=0&subject=performance`, SMALL);
  await page.locator('.tile.has-picture[data-subject=ada][data-state=live]').waitFor();
  await page.locator('.tile.large[data-subject=performance][data-state=paused][aria-pressed=true]').waitFor();
  await page.getByText('2 subjects').waitFor();
  // The tile in focus has no picture of its own.
  assert.equal(await tile(page, 'performance').evaluate((element) => element.classList.contains('has-picture')), false);
  await tile(page, 'performance').focus();
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('End');
  const last = await page.evaluate(() => document.activeElement.dataset.subject);
  await page.keyboard.press(last === 'ada' ? 'End' : 'Home');
  assert.equal(await page.evaluate(() => document.activeElement.dataset.subject), 'ada');
  await page.keyboard.press('Enter');
  await page.locator('.tile[data-subject=ada][aria-pressed=true]').waitFor();
  await page.locator('.tile.has-picture[data-subject=performance][data-state=paused]').waitFor();
  await page.selectOption('.grid-bar select', 'performance');
  await page.locator('.against.has-picture[data-state=paused]', { hasText: 'performance: Paused' }).waitFor();
  await eventually('the address', () => /grid=1/.test(page.url()) && /subject=ada/.test(page.url()) && /against=performance/.test(page.url()));
  await page.getByRole('button', { name: 'End the comparison' }).click();
  await page.locator('.tile.has-picture[data-subject=performance]').waitFor();
  const before = await subscriptions();
  await page.keyboard.press('v');
  await eventually('no tile asks for a picture', async () => await subscriptions() < before);
  await closePage(page);
});

test('the focus follows the one who moves', async () => {
  const page = await openPage(browser, `${daemon.address}#grid=1&panel=&dock=0&subject=performance&follow=1`, SMALL);
  await page.locator('.tile[data-subject=ada][aria-pressed=true]').waitFor();
  await shown(page);
  await addressIs(page, /subject=ada/);
  await closePage(page);
});

test('guided capture: get ready, hold, good; then a summary and one undo', async () => {
  const captures = async () => (await daemon.get('api/rig?subject=performance')).captures.map(({ pose }) => pose);
  await daemon.hold(0);
  const page = await openPage(browser, `${daemon.address}#panel=capture&subject=performance`, SMALL);
  await page.getByRole('button', { name: 'Guided capture' }).click();
  await page.locator('.guide-card', { hasText: 'Relax your face' }).waitFor();
  await page.locator('.guide h2', { hasText: 'Raise your brows' }).waitFor(); // the pose rests, so it was captured
  assert.deepEqual(await captures(), ['neutral']);
  await page.locator('.guide[data-phase=move]').waitFor(); // the face is still neutral
  await page.getByRole('button', { name: 'Skip' }).click();
  await page.locator('.guide h2', { hasText: 'Frown' }).waitFor();
  await daemon.hold(2);
  await page.locator('.guide h2').filter({ hasNotText: 'Frown' }).waitFor();
  assert.deepEqual((await captures()).slice(0, 3), ['neutral', 'brow_lower_l', 'brow_lower_r']);
  await page.getByRole('button', { name: 'Finish' }).click();
  const row = page.locator('.guide-summary tr[data-taken=true]', { hasText: 'Frown' });
  assert.match(await row.innerText(), /\d mm\s+± 0\.0 mm/);
  assert.equal(await page.locator('.guide-summary tr[data-taken=false]', { hasText: 'Raise your brows' }).count(), 1);
  await page.getByRole('button', { name: 'Undo all' }).click();
  await page.getByText(/^\d+ captures undone$/).waitFor();
  assert.deepEqual(await captures(), []);
  await closePage(page);
});

test('curves are moved in time, marked, read and saved', async () => {
  await daemon.patch('api/playback', { playing: true, position_s: 0 });
  const page = await openPage(browser, `${daemon.address}#subject=performance&curves=brow_l.squash`, SMALL);
  const span = () => page.evaluate(() => document.querySelector('.plot').dataset.span);
  await page.locator('.chip[data-name="brow_l.squash"] output', { hasText: /\d/ }).waitFor();
  await page.focus('.plot');
  for (let i = 0; i < 6; ++i) await page.keyboard.press('+');
  assert.equal(await span(), '0.9');
  await eventually('enough to move in', async () => {
    await page.keyboard.press('ArrowLeft');
    return await page.getByRole('button', { name: 'Freeze' }).getAttribute('aria-pressed') === 'true';
  });
  await page.keyboard.press('m');
  const marker = await page.locator('.mark button').first().getAttribute('title');
  const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'CSV' }).click()]);
  const rows = readFileSync(await file.path(), 'utf8').trim().split('\n').slice(1).map((row) => row.split(',').map(Number));
  assert(rows.at(-1)[1] <= 0.9, `${rows.at(-1)[1]} s`);
  assert.equal(marker, `Show marker 1, pose ${rows.at(-1)[0]}`); // the last pose shown
  const box = await page.locator('.plot .u-over').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  const read = /^-?[\d.]+ s, pose (\d+)$/.exec(await page.locator('.moment').innerText());
  const row = rows.find(([sequence]) => sequence === Number(read[1]));
  const column = (await daemon.get('api/rig')).regions.flatMap(({ weights }) => weights.map(({ name }) => name)).indexOf('brow_l.squash');
  assert.equal(await page.locator('.chip output').innerText(), row[2 + column].toFixed(2));
  await page.focus('.plot');
  await page.keyboard.press('End');
  assert.equal(await page.getByRole('button', { name: 'Freeze' }).getAttribute('aria-pressed'), 'false');
  await daemon.hold(2);
  await closePage(page);
});

/** The mean sRGB luma of the middle of the picture. */
async function middleOf(page) {
  const { width, height, data } = await pixels(page);
  let sum = 0;
  for (let dy = -2; dy <= 2; ++dy) {
    for (let dx = -2; dx <= 2; ++dx) {
      const at = 4 * (((height >> 1) + dy) * width + (width >> 1) + dx);
      sum += (0.2126 * data[at] + 0.7152 * data[at + 1] + 0.0722 * data[at + 2]) / 25;
    }
  }
  return sum;
}

test('a drag moves the lamps; exposure is measured; layouts are kept', async () => {
  await daemon.hold(2);
  const page = await openPage(browser, `${daemon.address}#subject=performance&camera=mouth`, SMALL);
  await still(page);
  const former = await pixels(page);
  await page.focus('.surface');
  await page.keyboard.press('Shift+L');
  const { x, y, width, height } = await page.locator('.surface').boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2 + height / 4, y + height / 2);
  await page.mouse.up();
  await page.keyboard.press('ArrowUp');
  await page.locator('.light-figures', { hasText: 'Turn 45°, tilt 5°' }).waitFor();
  await eventually('another light', async () => changedShare(former, await pixels(page)) > 0.1);
  await addressIs(page, /camera=mouth.*lights\.turn_degrees=45/);
  await still(page);
  await page.focus('.light-bar button:has-text("Measure")');
  await page.keyboard.press('Enter');
  await eventually('the exposure', () => page.url().includes('exposure='));
  await still(page);
  assert(Math.abs(await middleOf(page) - 118) < 12, `${await middleOf(page)} of 255`);
  for (let i = 0; i < 3; ++i) await page.keyboard.press('Control+z'); // the exposure, the key, the whole drag
  await eventually('the light as it was', () => !page.url().includes('lights'));
  await page.focus('.surface');
  await page.keyboard.press('l');
  await page.keyboard.press('t');
  await page.getByRole('button', { name: 'Turntable' }).waitFor({ state: 'hidden' });
  await page.keyboard.press('t');
  await eventually('another camera', () => /camera=[-\d.]+,/.test(page.url()));

  await page.keyboard.press('o');
  await page.locator('.layouts').getByRole('button', { name: 'Wrinkles' }).click();
  await page.locator('#panel-wrinkles').waitFor();
  await page.keyboard.press('o');
  await page.getByRole('button', { name: 'All subjects' }).click();
  await page.locator('.grid').waitFor();
  assert.equal(await page.locator('.curves').isVisible() || await page.locator('.side').isVisible(), false);
  await page.keyboard.press('o');
  await page.fill('#layout-name', 'wall');
  await page.getByRole('button', { name: 'Save this layout' }).click();
  await page.getByRole('button', { name: 'Usual' }).click();
  await page.locator('.curves').waitFor();
  await page.reload();
  await page.locator('.view-bar [data-preset]').first().waitFor();
  await page.keyboard.press('o');
  await page.getByRole('button', { name: 'wall', exact: true }).click();
  await page.locator('.grid').waitFor();
  await eventually('the address', () => /panel=&.*grid=1&dock=0/.test(page.url()));
  await closePage(page);
});
