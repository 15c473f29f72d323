// SPDX-License-Identifier: Apache-2.0
// Tools for daily work on the page: several subjects, guided capture, curves, layouts, light.
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { eventually, openPage, shown } from './browser.mjs';
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

const tile = (page, name) => page.locator(`.tile[data-subject="${name}"]`);
const subscriptions = async () => (await daemon.get('api/status')).subscriptions;

test('tiles show all subjects; keys choose one, and two are compared', async () => {
  const page = await openPage(browser, `${daemon.address}#grid=1&subject=performance`);
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
  const page = await openPage(browser, `${daemon.address}#grid=1&subject=performance&follow=1`);
  await page.locator('.tile[data-subject=ada][aria-pressed=true]').waitFor();
  await shown(page);
  assert.match(page.url(), /subject=ada/);
  await closePage(page);
});
