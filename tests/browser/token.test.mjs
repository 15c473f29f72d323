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

test('over TLS, the page shows pictures and downloads the rig with its token', async () => {
  const [certificate, key] = [join(folder, 'crt'), join(folder, 'key')];
  execFileSync('openssl', ['req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:P-256', '-nodes', '-days', '2', '-subj', '/CN=test',
    '-addext', 'subjectAltName=IP:127.0.0.1', '-keyout', key, '-out', certificate], { stdio: 'ignore' });
  const daemon = await Daemon.start(['--play', recording('performance'), '--security', 'required', '--keys', keys,
    '--tls-certificate', certificate, '--tls-key', key]);
  try {
    const requests = [];
    const page = await openPage(browser, daemon.address.replace('http:', 'https:'), { ignoreHTTPSErrors: true });
    page.on('request', (request) => requests.push(request.url()));
    page.on('websocket', (socket) => requests.push(socket.url()));
    const dialog = page.locator('dialog.token');
    await dialog.locator('input').fill(token('watch,direct'));
    await dialog.locator('button.primary').click();
    await page.waitForSelector('.condition.ok');
    await shown(page);
    await page.click('#tab-capture');
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Download rig' }).click()]);
    assert(JSON.parse(readFileSync(await download.path(), 'utf8')).regions.length > 0);
    assert(requests.some((url) => url.startsWith('wss:')), requests.join(' '));
    assert(!requests.some((url) => url.includes('frw1_')), 'addresses end up in logs');
    await page.context().close();
  } finally {
    await daemon.stop();
  }
});
