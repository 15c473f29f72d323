// SPDX-License-Identifier: Apache-2.0
// The picture alone: as a kiosk, and in a frame of another page.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { eventually, keep, launch, openPage } from './browser.mjs';
import { Daemon, recording } from './daemon.mjs';

const folder = mkdtempSync(join(tmpdir(), 'furrow-embed-'));
let browser;
let daemon;
let stage;
let stranger;

/** A server of one page with a frame. */
async function pageWithFrame(source) {
  const server = createServer((_, response) => {
    response.setHeader('Content-Type', 'text/html');
    response.end(`<!doctype html><title>stage</title><iframe src="${source()}" width="600" height="400"></iframe>`);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { server, origin: `http://127.0.0.1:${server.address().port}` };
}

before(async () => {
  const source = () => `${daemon.address}embed?camera=body`;
  [stage, stranger] = [await pageWithFrame(source), await pageWithFrame(source)];
  const config = join(folder, 'furrow.toml');
  writeFileSync(config, `[http]\nallow_origins = ["${stage.origin}"]\n`);
  daemon = await Daemon.start(['--config', config, '--play', recording('performance')]);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await daemon?.stop();
  for (const page of [stage, stranger]) page?.server.close();
  rmSync(folder, { recursive: true });
});

/** The share of the window that the picture covers, and whether anything else is visible. */
const alone = (target) => target.evaluate(() => {
  const { width, height } = document.querySelector('.surface').getBoundingClientRect();
  const others = [...document.querySelectorAll('header, .side, .dock, .view-bar, .stage-actions')].filter((element) => element.checkVisibility());
  return { share: (width * height) / (innerWidth * innerHeight), others: others.length };
});

test('a kiosk shows the picture alone, and a key ends it', async () => {
  const page = await openPage(browser, `${daemon.address}#kiosk=1`);
  await page.waitForSelector('.app[data-state=live]');
  assert.deepEqual(await alone(page), { share: 1, others: 0 });
  await keep(page, 'kiosk');
  await page.focus('.surface');
  await page.keyboard.press('k');
  await page.locator('header').waitFor();
  await eventually('the address', () => !page.url().includes('kiosk'));
  await page.context().close();
});

test('a listed page may show the picture in a frame, a stranger may not', async () => {
  const page = await openPage(browser, stage.origin);
  const frame = page.frames()[1];
  await frame.waitForSelector('.app[data-state=live]');
  assert.deepEqual(await alone(frame), { share: 1, others: 0 });
  await frame.waitForSelector('[data-preset=body][aria-pressed=true]', { state: 'attached' }); // as the query says
  await page.context().close();
  const other = await openPage(browser, stranger.origin);
  await eventually('the refusal', () => other.errors.some((error) => error.includes('frame-ancestors')));
  assert.equal(await other.frames()[1].locator('.app').count(), 0);
  // Not even a listed page may frame the controls.
  const controls = await fetch(daemon.address);
  assert.match(controls.headers.get('content-security-policy'), /frame-ancestors 'none'/);
  await other.context().close();
});
