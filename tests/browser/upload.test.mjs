// SPDX-License-Identifier: Apache-2.0
// Recordings that the user drops on the page or chooses, and what the page says about files that the daemon refuses.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { eventually, launch, openPage } from './browser.mjs';
import { Daemon, recording } from './daemon.mjs';

const folder = mkdtempSync(join(tmpdir(), 'furrow-upload-'));
const config = join(folder, 'furrow.toml');
writeFileSync(config, '[http]\nmax_upload_megabytes = 5\n');
const daemon = await Daemon.start(['--no-render', '--config', config]);
const browser = await launch().catch(async (error) => {
  await daemon.stop();
  throw error;
});
after(async () => {
  await browser.close();
  await daemon.stop();
  rmSync(folder, { recursive: true, force: true });
});

const ANGER = readFileSync(recording('anger'));
const timeline = (page) => page.locator('.timeline');
const toast = (page, hasText) => page.locator('.toast', { hasText }).waitFor();
const subject = (page) => page.getByLabel('Subject', { exact: true });
const closeButton = (page) => timeline(page).getByRole('button', { name: 'Close the recording' });

/** The file dialog of the browser never opens, from the beginning: a key may ask for it sooner than a listener is in place. */
const withoutDialogs = (page) => page.on('filechooser', () => {});

/** A page whose status is known, so that it can judge files. */
async function uploadPage() {
  const page = await openPage(browser, daemon.address, {}, withoutDialogs);
  await page.locator('.app[data-state]').waitFor();
  await eventually('the status', () => page.locator('.session dd').count().then((count) => count > 5));
  return page;
}

/** What a user drags: files of these names and contents. */
function dragged(page, files) {
  return page.evaluateHandle((list) => {
    const transfer = new DataTransfer();
    for (const [name, text] of list) transfer.items.add(new File([text], name));
    return transfer;
  }, files);
}

async function drop(page, ...files) {
  const dataTransfer = await dragged(page, files);
  await page.dispatchEvent('main', 'drop', { dataTransfer });
}

/** Ends what a test has begun, for the next one. */
async function closeAll(page) {
  if ((await daemon.ask('api/playback')).status === 200) await daemon.ask('api/playback', { method: 'DELETE' });
  await page.context().close();
}

test('a dropped recording plays with its timeline, and closes', async () => {
  const page = await uploadPage();
  const dataTransfer = await dragged(page, [['angry.bvh', ANGER.toString()]]);
  assert(await page.locator('.drop-target').isHidden());
  await page.dispatchEvent('main', 'dragenter', { dataTransfer });
  await page.locator('.drop-target', { hasText: 'Drop the recording to play it' }).waitFor();
  await page.dispatchEvent('main', 'dragleave', { dataTransfer });
  assert(await page.locator('.drop-target').isHidden());
  await page.dispatchEvent('main', 'dragenter', { dataTransfer });
  await page.dispatchEvent('main', 'drop', { dataTransfer });
  assert(await page.locator('.drop-target').isHidden());
  await toast(page, 'Playing angry.bvh');
  await timeline(page).locator('.file', { hasText: 'angry.bvh' }).waitFor();
  await eventually('its subject', async () => await subject(page).inputValue() === 'angry');
  await page.locator('.chip').first().waitFor();
  const { uploaded, frames, playing, loop } = await daemon.get('api/playback');
  assert(uploaded && playing && loop && frames > 10);

  await closeButton(page).click();
  await timeline(page).waitFor({ state: 'hidden' });
  assert.equal((await daemon.ask('api/playback')).status, 409);
  await eventually('any subject, as before', async () => await subject(page).inputValue() === '');
  assert.deepEqual(page.errors.filter((error) => !/status of (409|503)/.test(error)), []);
  await closeAll(page);
});

test('a refused file leaves the recording that plays', async () => {
  const page = await uploadPage();
  await drop(page, ['angry.bvh', ANGER.toString()]);
  await toast(page, 'Playing angry.bvh');
  await drop(page, ['photo.png', 'no recording']);
  await toast(page, /photo\.png is not played: photo\.png: unknown recording format '\.png' \(use a \.bvh/);
  await drop(page, ['cut.bvh', ANGER.toString().slice(0, 5000)]);
  await toast(page, /cut\.bvh is not played: cut\.bvh/);
  await page.locator('.upload-progress').waitFor({ state: 'hidden' });
  assert.equal((await daemon.get('api/playback')).file, 'angry.bvh');
  await timeline(page).locator('.file', { hasText: 'angry.bvh' }).waitFor();
  await closeAll(page);
});

test('what the page can judge is not sent', async () => {
  const page = await uploadPage();
  const sent = [];
  page.on('request', (request) => request.method() === 'POST' && sent.push(request.url()));
  await drop(page, ['a.bvh', '1'], ['b.bvh', '2']);
  await toast(page, 'Drop one recording at a time');
  await drop(page, ['large.bvh', 'x'.repeat(5_000_001)]);
  await toast(page, 'The file has 6 MB, and this daemon takes 5 MB (http.max_upload_megabytes)');
  await page.evaluate(() => {
    const text = new DataTransfer();
    text.setData('text/plain', 'no file');
    document.querySelector('main').dispatchEvent(new DragEvent('drop', { dataTransfer: text, bubbles: true, cancelable: true }));
  });
  assert.deepEqual(sent, []);
  await closeAll(page);
});

test('a recording is chosen and closed by keyboard alone', async () => {
  const page = await uploadPage();
  const file = join(folder, 'chosen.bvh');
  writeFileSync(file, ANGER);
  const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.keyboard.press('u')]);
  await chooser.setFiles(file);
  await toast(page, 'Playing chosen.bvh');
  await closeButton(page).waitFor();
  await page.getByRole('tab', { name: 'Session' }).click();
  const close = page.locator('.upload').getByRole('button', { name: 'Close the recording' });
  await close.focus();
  await page.keyboard.press('Enter');
  await timeline(page).waitFor({ state: 'hidden' });
  const open = page.locator('.upload').getByRole('button', { name: 'Open a recording' });
  await open.focus();
  const [again] = await Promise.all([page.waitForEvent('filechooser'), page.keyboard.press('Enter')]);
  await again.setFiles(file); // the same one
  await timeline(page).waitFor();
  await closeAll(page);
});

test('an upload shows its progress and can be cancelled', async () => {
  const page = await uploadPage();
  let release;
  const held = new Promise((resolve) => (release = resolve));
  await page.route(/api\/playback\?name=/, async (route) => {
    await held;
    await route.abort().catch(() => {}); // the page has cancelled it
  });
  await drop(page, ['slow.bvh', ANGER.toString()]);
  const progress = page.locator('.upload-progress');
  await progress.getByText(/slow\.bvh/).waitFor();
  await progress.getByRole('progressbar', { name: 'Upload' }).waitFor();
  await drop(page, ['other.bvh', ANGER.toString()]);
  await toast(page, 'Another upload of this page is under way');
  await progress.getByRole('button', { name: 'Cancel' }).click();
  await toast(page, 'The upload of slow.bvh was cancelled');
  await progress.waitFor({ state: 'hidden' });
  release();
  assert.equal((await daemon.ask('api/playback')).status, 409);
  await closeAll(page);
});

test('the page of a daemon without subjects offers to open a recording', async () => {
  const page = await openPage(browser, daemon.address, {}, withoutDialogs);
  await page.locator('.notice').getByText('Drop a recording on this page').waitFor();
  const [chooser] = await Promise.all([
    page.waitForEvent('filechooser'), page.locator('.notice').getByRole('button', { name: 'Open a recording' }).click(),
  ]);
  await chooser.setFiles(recording('anger'));
  await timeline(page).locator('.file', { hasText: 'anger.bvh' }).waitFor();
  await closeAll(page);
});
