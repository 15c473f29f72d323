// SPDX-License-Identifier: Apache-2.0
// Faults during a session: daemons that die, viewers that stall, missing subjects.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { changedShare, difference, eventually, keep, launch, openPage, pixels, shown, still } from './browser.mjs';
import { Daemon, recording } from './daemon.mjs';

let browser;

before(async () => (browser = await launch()));
after(() => browser?.close());

test('the page reconnects to a daemon that was killed and restarted', async () => {
  const first = await Daemon.start(['--play', recording('performance')]);
  let second;
  try {
    await first.hold(2);
    const page = await openPage(browser, `${first.address}#camera=mouth&wrinkle_strength=3`);
    await still(page);
    const former = await pixels(page);
    await first.stop('SIGKILL');
    await page.locator('.condition.bad', { hasText: 'Connection lost' }).waitFor();
    await keep(page, 'connection-lost');
    second = await Daemon.start(['--play', recording('performance')], first.ports);
    await second.hold(2);
    await page.waitForSelector('.condition.ok');
    await still(page);
    await eventually('the same picture', async () => difference(former, await pixels(page)) < 1);
    assert.match(page.url(), /camera=mouth/);
    await page.context().close();
  } finally {
    await first.stop('SIGKILL');
    await second?.stop();
  }
});

test('the page reports a daemon that shuts down', async () => {
  const daemon = await Daemon.start(['--play', recording('performance')]);
  const page = await openPage(browser, daemon.address);
  await shown(page);
  await daemon.stop();
  await page.locator('.condition.bad').waitFor();
  await page.context().close();
});

test('the page reports a missing subject and a missing renderer', async () => {
  const quiet = await Daemon.start();
  const blind = await Daemon.start(['--no-render', '--play', recording('performance')]);
  try {
    const page = await openPage(browser, quiet.address);
    await page.locator('.condition', { hasText: 'No subject is streaming' }).waitFor();
    assert.deepEqual(page.errors, []);
    await page.goto(blind.address);
    await page.locator('.condition', { hasText: 'does not render pictures' }).waitFor();
    await page.locator('.chip').first().waitFor(); // weights arrive even without pictures
    await page.context().close();
  } finally {
    await quiet.stop();
    await blind.stop();
  }
});

test('two viewers do not affect each other', async () => {
  const daemon = await Daemon.start(['--play', recording('performance')]);
  try {
    await daemon.hold(2);
    const one = await openPage(browser, `${daemon.address}#camera=face`);
    const two = await openPage(browser, `${daemon.address}#camera=profile&view=normal`);
    await still(one);
    await still(two);
    const [first, second] = [await pixels(one), await pixels(two)];
    assert(changedShare(first, second) > 0.3);
    await two.click('[data-preset=eyes]');
    await still(two);
    assert(changedShare(second, await pixels(two)) > 0.05);
    assert.equal(difference(first, await pixels(one)), 0);
    await one.context().close();
    await two.context().close();
  } finally {
    await daemon.stop();
  }
});

test('a stalled viewer delays nobody and resumes with a fresh picture', async () => {
  const daemon = await Daemon.start(['--play', recording('performance')]);
  try {
    const page = await openPage(browser, daemon.address);
    const stalled = await openPage(browser, daemon.address);
    await shown(page);
    await shown(stalled);
    const debuggerOf = await stalled.context().newCDPSession(stalled);
    await debuggerOf.send('Debugger.enable');
    const halted = new Promise((resolve) => debuggerOf.once('Debugger.paused', resolve));
    await debuggerOf.send('Debugger.pause'); // its scripts stop, so it acknowledges no picture
    await halted;
    const rendered = async () => (await daemon.get('api/status')).pictures_rendered;
    const before = await rendered();
    for (let changes = 0; changes < 10; ++changes) {
      const former = await pixels(page);
      await eventually('pictures go on beside the stalled viewer', async () => changedShare(former, await pixels(page)) > 0.001, 10_000);
    }
    assert((await rendered()) > before + 5);
    await daemon.hold(2);
    await still(page);
    await debuggerOf.send('Debugger.resume');
    await still(stalled);
    assert(difference(await pixels(page), await pixels(stalled)) < 1); // the current picture, not a missed one
    await page.context().close();
    await stalled.context().close();
  } finally {
    await daemon.stop();
  }
});
