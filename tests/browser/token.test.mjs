// SPDX-License-Identifier: Apache-2.0
// A daemon that requires tokens: the page asks for one, once.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { launch, openPage, shown } from './browser.mjs';
import { Daemon, recording } from './daemon.mjs';

const folder = mkdtempSync(join(tmpdir(), 'furrow-token-'));
const keys = join(folder, 'keys');
let browser;

function furrow(...args) {
  execFileSync(join(process.env.FURROW_BIN, 'furrow'), ['token', ...args, '--key', keys], { stdio: 'ignore' });
}

function token(roles) {
  const out = join(folder, `${roles}.token`);
  furrow('new', '--role', roles, '--for', '1h', '--out', out);
  return readFileSync(out, 'utf8').trim();
}

before(async () => {
  furrow('key', 'new');
  browser = await launch();
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true });
});

test('the page asks for a token once, and keeps it for its tab', async () => {
  const daemon = await Daemon.start(['--play', recording('performance'), '--security', 'required', '--keys', keys]);
  try {
    const page = await openPage(browser, daemon.address);
    const dialog = page.locator('dialog.token');
    await dialog.waitFor();
    await dialog.locator('input').fill('frw1_nonsense');
    await dialog.locator('button.primary').click();
    await page.locator('dialog.token', { hasText: 'malformed' }).waitFor();
    await dialog.locator('input').fill(token('watch,direct'));
    await dialog.locator('button.primary').click();
    await page.waitForSelector('.condition.ok');
    await shown(page);
    assert.equal(await page.locator('header .open').isVisible(), false);
    assert(!page.url().includes('frw1_'), 'addresses end up in histories');
    await page.reload();
    await page.waitForSelector('.condition.ok');
    assert.equal(await dialog.isVisible(), false);
    await page.context().close();
  } finally {
    await daemon.stop();
  }
});
