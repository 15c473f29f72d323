// SPDX-License-Identifier: Apache-2.0
// The timecode of a phone: beside the picture, in the panel Sources and in the CSV, and nowhere without one.
import assert from 'node:assert/strict';
import { createSocket } from 'node:dgram';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { eventually, keep, launch, openPage } from './browser.mjs';
import { Daemon, recording } from './daemon.mjs';
import { layoutFaults } from './support/layout_audit.mjs';
import { liveLinkFace } from './support/live_link_face.mjs';

const SIZES = [[390, 844], [844, 390], [1280, 720], [1024, 768], [1920, 1080], [2560, 1440]];
/** 10:00:00;00 of drop-frame timecode at 29.97 frames per second. */
const TEN_HOURS = 1_078_920;
const NTSC = [30_000, 1001];

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

test('a phone has its timecode on the picture and in the panel, at every size', async () => {
  const daemon = await Daemon.start(['--livelink-face', '0']);
  const socket = createSocket('udp4');
  let frame = TEN_HOURS;
  const timer = setInterval(() => socket.send(liveLinkFace('phone', frame++, NTSC), daemon.ports.livelink_face, '127.0.0.1'), 33);
  try {
    const page = await openPage(browser, `${daemon.address}#panel=sources`);
    await page.locator('.timecode', { hasText: /^10:0\d:\d\d;\d\d$/ }).waitFor();
    await page.locator('[data-stream=phone] .stream-timecode', { hasText: /^Timecode 10:0\d:\d\d;\d\d, 29\.97 frames\/s$/ }).waitFor();
    const first = await page.locator('.timecode').textContent();
    await eventually('the next timecode', async () => await page.locator('.timecode').textContent() > first);
    const faults = [];
    for (const [width, height] of SIZES) {
      await page.setViewportSize({ width, height });
      await eventually('the new size', () => page.evaluate((w) => innerWidth === w, width));
      await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
      await page.locator('.timecode').waitFor(); // hidden for a moment while a picture is late
      await keep(page, `timecode-${width}x${height}`);
      faults.push(...(await layoutFaults(page)).map((fault) => `${width}x${height}: ${fault}`));
    }
    assert.deepEqual(faults, []);
    await page.setViewportSize({ width: 1280, height: 720 });
    const [saved] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'CSV' }).click()]);
    const [header, row] = (await readFile(await saved.path(), 'utf8')).split('\n');
    assert.match(header, /^frame,time,.*,timecode$/);
    assert.match(row, /,10:0\d:\d\d;\d\d$/);
    await page.context().close();
  } finally {
    clearInterval(timer);
    socket.close();
    await daemon.stop();
  }
});

test('a recording without timecode shows none', async () => {
  const daemon = await Daemon.start(['--play', recording('performance')]);
  try {
    const page = await openPage(browser, `${daemon.address}#panel=sources`);
    await page.waitForSelector('.app[data-state=live]');
    await page.locator('tbody[data-stream]').first().waitFor();
    assert.equal(await page.locator('.timecode').isVisible(), false);
    assert.equal(await page.locator('.stream-timecode').first().isVisible(), false);
    await page.context().close();
  } finally {
    await daemon.stop();
  }
});
