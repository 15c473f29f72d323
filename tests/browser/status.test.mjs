// SPDX-License-Identifier: Apache-2.0
// The page tells the truth about the picture: its state, its age, its size, its pose, and what limits it.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { envelopeOf, eventually, filterMessages, keep, openPage, shown, still } from './browser.mjs';
import { Daemon, recording } from './daemon.mjs';
import { browser, daemon } from './played.mjs';

const SMILE_S = 2.0;
const stateOf = (page) => page.locator('.app').getAttribute('data-state');
const inState = (page, state) => page.waitForSelector(`.app[data-state=${state}]`);
const figure = (page, name) => page.locator(`[data-number=${name}]`).textContent();
const isDimmed = (page) => page.locator('.stage').evaluate((stage) => stage.classList.contains('dimmed'));
const isPicture = (message) => envelopeOf(message).kind === 'FIMG';

test('the picture of a dead daemon is never live', async () => {
  const first = await Daemon.start(['--play', recording('performance')]);
  let second;
  try {
    let holds = false;
    let held = [];
    const page = await openPage(browser, first.address, {}, (opened) => filterMessages(opened, (message, send) => {
      if (!holds || !isPicture(message)) return true;
      held.push(send);
      return false;
    }));
    await inState(page, 'live');
    await shown(page);
    holds = true;
    await first.stop('SIGKILL');
    await inState(page, 'lost');
    held = []; // only the pictures of the next daemon arrive later
    assert(await isDimmed(page));
    assert.equal(await figure(page, 'age'), '–');
    await eventually('the position of the recording stands still', () => page.evaluate(async () => {
      const before = document.querySelector('.timeline .time').textContent;
      await new Promise((resolve) => setTimeout(resolve, 400));
      return document.querySelector('.timeline .time').textContent === before;
    }));
    await keep(page, 'state-lost');
    second = await Daemon.start(['--play', recording('performance')], first.ports);
    await inState(page, 'loading');
    await page.locator('.subjects', { hasText: 'performance' }).waitFor({ state: 'attached' });
    // Everything but a picture has arrived from the second daemon.
    for (let i = 0; i < 10; ++i) {
      assert.equal(await stateOf(page), 'loading');
      assert(await isDimmed(page));
      await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 100)));
    }
    holds = false;
    for (const send of held) send();
    await inState(page, 'live');
    assert(!await isDimmed(page));
    await page.context().close();
  } finally {
    await first.stop('SIGKILL');
    await second?.stop();
  }
});

test('a daemon that does not answer makes the picture stale', async () => {
  const stuck = await Daemon.start(['--play', recording('performance')]);
  try {
    const page = await openPage(browser, stuck.address);
    await inState(page, 'live');
    stuck.child.kill('SIGSTOP');
    await inState(page, 'stale');
    assert(await isDimmed(page));
    await page.locator('.notice-title', { hasText: 'has not answered' }).waitFor();
    await keep(page, 'state-stale');
    stuck.child.kill('SIGCONT');
    await inState(page, 'live');
    await page.context().close();
  } finally {
    stuck.child.kill('SIGCONT');
    await stuck.stop();
  }
});

test('pictures that stop make the picture stale, with its age', async () => {
  await daemon.patch('api/playback', { playing: true });
  let holds = false;
  const page = await openPage(browser, daemon.address, {}, (opened) => filterMessages(opened, (message) => !(holds && isPicture(message))));
  await inState(page, 'live');
  holds = true;
  await inState(page, 'stale');
  assert.match(await figure(page, 'age'), /^\d+\.\d s$/);
  assert(await isDimmed(page));
  // The daemon has drawn what it may without an acknowledgement.
  await eventually('what the pictures wait for', async () => await figure(page, 'limit') === 'network');
  await page.locator('.notice', { hasText: 'slow network' }).waitFor();
  await page.context().close();
});

test('a paused recording is paused, and its picture not dimmed', async () => {
  await daemon.hold(SMILE_S);
  const page = await openPage(browser, daemon.address);
  await still(page);
  await inState(page, 'paused');
  await eventually('at rest', async () => await figure(page, 'age') === 'at rest');
  assert.equal(await figure(page, 'limit'), 'none');
  assert(!await isDimmed(page));
  await page.selectOption('select[aria-label=Sharpness]', 'sharp');
  const size = await page.locator('.surface').evaluate(({ clientWidth, clientHeight }) =>
    `${2 * Math.round(clientWidth * devicePixelRatio / 2)} × ${2 * Math.round(clientHeight * devicePixelRatio / 2)}`);
  await eventually('the size of the picture', async () => await figure(page, 'size') === size);
  await keep(page, 'state-paused');
  await daemon.patch('api/playback', { playing: true });
  await inState(page, 'live');
  await eventually('both rates', async () => /^[1-9]\d* of [1-9]\d* \/s$/.test(await figure(page, 'rate')));
  await eventually('the limit', async () => /^(none|drawing|network|this browser)$/.test(await figure(page, 'limit')));
  await page.context().close();
});

test('the weights beside the picture are those of its pose', async () => {
  await daemon.patch('api/playback', { playing: true, position_s: 0 });
  let picture = null;
  const weights = [];
  const page = await openPage(browser, daemon.address, {}, (opened) => filterMessages(opened, (message) => {
    const { kind, sequence } = envelopeOf(message);
    if (kind === 'FWGT') weights.push(sequence);
    if (kind !== 'FIMG') return true;
    // The third picture is the last one. The weights go on.
    if (picture !== null && picture.count === 3) return false;
    picture = { sequence, count: (picture?.count ?? 0) + 1 };
    return true;
  }));
  await eventually('three pictures', () => picture?.count === 3);
  await eventually('weights of later poses', () => weights.at(-1) > picture.sequence + 30);
  const chips = await page.locator('.chip').evaluateAll((all) => all.map((chip) => [chip.dataset.name, chip.querySelector('output').textContent]));
  assert(chips.length > 0);
  const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'CSV' }).click()]);
  const [header, ...rows] = readFileSync(await file.path(), 'utf8').trim().split('\n').map((line) => line.split(','));
  const row = rows.filter(([sequence]) => Number(sequence) <= picture.sequence).at(-1);
  const last = rows.at(-1);
  for (const [name, value] of chips) {
    const column = header.indexOf(name);
    assert.equal(value, Number(row[column]).toFixed(2), `${name} of pose ${picture.sequence}; the newest is ${last[column]}`);
  }
  await page.context().close();
});
