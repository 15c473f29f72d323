// SPDX-License-Identifier: Apache-2.0
// Curves, face map, why, and capture, against what the daemon tells others.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { once } from 'node:events';
import { test } from 'node:test';
import { eventually, keep, openPage, still } from './browser.mjs';
import { furrow, furrowOutput, recording } from './daemon.mjs';
import { browser, daemon } from './played.mjs';

/** A pose with lowered brows. */
const FROWN_S = 6.5;
/** A pose on the way to lowered brows, weaker than the rig's frown. */
const HALF_FROWN_S = 9;

/** Reads a CSV: rows by their first column, and the names in the header. */
function table(csv) {
  const [header, ...lines] = csv.trim().split('\n').map((line) => line.split(','));
  return { names: header.slice(2), rows: new Map(lines.map(([frame, , ...values]) => [frame, values.map(Number)])) };
}

test('curves equal the output of furrow watch', async () => {
  await daemon.patch('api/playback', { playing: true, position_s: 0 });
  const page = await openPage(browser, daemon.address);
  await page.locator('.chip').first().waitFor();
  const watched = table(await furrowOutput('watch', `localhost:${daemon.ports.tcp}`, '--format', 'csv', '--frames', '120'));
  const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'CSV' }).click()]);
  const shown = table(readFileSync(await file.path(), 'utf8'));
  assert.deepEqual(shown.names, watched.names);
  let common = 0;
  let moved = 0;
  for (const [frame, values] of watched.rows) {
    const seen = shown.rows.get(frame);
    if (seen === undefined) continue;
    ++common;
    values.forEach((value, i) => {
      assert(Math.abs(value - seen[i]) < 1e-2, `${watched.names[i]} of pose ${frame}: ${value}, but ${seen[i]} on the page`);
      if (value > 0.1) ++moved;
    });
  }
  assert(common > 60 && moved > 0, `${common} poses in common, ${moved} weights above 0.1`);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test('chosen curves remain chosen', async () => {
  const page = await openPage(browser, `${daemon.address}#curves=brow_l.squash,nose.squash`);
  await page.locator('.chip[data-name="nose.squash"]').waitFor();
  assert.equal(await page.locator('.chip').count(), 2);
  await page.locator('.picker summary').click();
  await page.locator('.picker label', { hasText: /^glabella\.squash$/ }).click();
  await page.locator('.chip[data-name="glabella.squash"]').waitFor();
  assert.match(page.url(), /curves=brow_l\.squash,nose\.squash/);
  await page.context().close();
});

test('the face map opens the explanation of a region', async () => {
  await daemon.hold(FROWN_S);
  const page = await openPage(browser, `${daemon.address}#panel=wrinkles`, { viewport: { width: 1280, height: 720 } });
  await page.locator('.region-shape[data-region=brow_l]').waitFor();
  assert.equal(await page.locator('.region-shape').count(), 8);
  await page.locator('.region-shape[data-region=brow_l]').click();
  const article = page.locator('.explain article[data-weight="brow_l.squash"]');
  await article.waitFor();
  const expected = await daemon.get('api/explain?weight=brow_l.squash');
  const drivers = await article.locator('tbody th').evaluateAll((cells) => cells.map((cell) => cell.firstChild.textContent));
  // The largest share first. The rest is named in one line.
  const [shares, rest] = [true, false].map((has) => expected.contributions.filter(({ product }) => Math.abs(product) >= 0.005 === has));
  assert(shares.length > 0 && rest.length > 0);
  assert.deepEqual(drivers, shares.sort((a, b) => b.product - a.product).map(({ value }) => value));
  assert.equal(await article.locator('.rest').textContent(), `These drivers add nothing: ${rest.map(({ value }) => value).join(', ')}`);
  assert.equal(await article.locator('h3 output').textContent(), expected.live.toFixed(2));
  const rig = await daemon.get('api/rig');
  assert.equal(await page.locator('.regions .region').count(), rig.regions.length);
  await eventually('a warm brow', () => page.locator('.region-shape[data-region=brow_l]').evaluate((shape) => {
    const [red, , blue] = getComputedStyle(shape).fill.match(/\d+/g).map(Number);
    return red > blue + 80;
  }));
  await keep(page, 'why');
  await page.context().close();
});

test('capture: preview changes nothing, capture changes the rig, undo reverts it', async () => {
  await daemon.hold(HALF_FROWN_S);
  const page = await openPage(browser, `${daemon.address}#panel=capture`);
  await still(page);
  const file = () => fetch(`${daemon.address}api/rig.json`).then((response) => response.text());
  const before = await file();
  await page.selectOption('select[aria-label="Save the pose as"]', 'brow_lower_l');
  await page.getByRole('button', { name: 'Preview' }).click();
  await page.getByText('Preview: weights with this pose').waitFor();
  assert.equal(await file(), before);
  assert(await page.locator('.capture-result tbody tr').count() > 0);
  await keep(page, 'capture');
  await page.getByRole('button', { name: 'Capture', exact: true }).last().click();
  await page.getByText('Weights with the captured pose').waitFor();
  const captured = await file();
  assert.notEqual(captured, before);
  const [saved] = await Promise.all([page.waitForEvent('download'), page.getByText('Download changed rig').click()]);
  assert.equal(readFileSync(await saved.path(), 'utf8'), captured);
  await page.locator('.capture').getByRole('button', { name: 'Undo' }).click();
  await eventually('the rig as it was', async () => (await file()) === before);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test('a second subject is listed and can be chosen', async () => {
  const publisher = furrow('play', recording('anger'), '--to', `localhost:${daemon.ports.udp}`, '--udp', '--subject', 'guest', '--loop');
  try {
    const page = await openPage(browser, `${daemon.address}#panel=session`);
    await page.locator('.subjects button', { hasText: 'guest' }).click();
    await page.locator('.condition', { hasText: 'Live: guest' }).waitFor();
    await eventually('the address', () => page.url().includes('subject=guest'));
    assert.deepEqual(page.errors, []);
    await page.context().close();
  } finally {
    publisher.kill();
    await once(publisher, 'exit');
  }
});
