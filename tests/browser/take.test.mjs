// SPDX-License-Identifier: Apache-2.0
// Takes that the page records: every program of furrow reads them, and they have the poses that the page showed.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { eventually, openPage } from './browser.mjs';
import { Daemon, furrow, furrowOutput, recording, SHARE } from './daemon.mjs';
import { browser, daemon } from './played.mjs';

/** The filter of the weights has settled after this many poses. */
const SETTLED = 30;
/** The opcode of MCAP's messages. */
const MESSAGE = 5;
const RECORD = 'Record a take: the poses of this subject, until you stop';
const STOP = 'Stop, and save the take';

/** Rows by their first column. */
function table(csv) {
  const [header, ...lines] = csv.trim().split('\n').map((line) => line.split(','));
  return { names: header.slice(2), rows: new Map(lines.map(([frame, , ...values]) => [Number(frame), values.map(Number)])) };
}

async function download(page, name) {
  const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name, exact: true }).click()]);
  return file;
}

/** The sequence numbers of the poses, in the order of the file. The first message is the skeleton. */
function sequencesOf(bytes) {
  const found = [];
  for (let at = 8; at < bytes.length - 8; at += 9 + Number(bytes.readBigUInt64LE(at + 1))) {
    if (bytes[at] === MESSAGE) found.push(bytes.readUInt32LE(at + 11));
  }
  return found.slice(1);
}

/** Saves a take where programs know it by the end of its name. */
async function saveTake(file, path) {
  assert.match(file.suggestedFilename(), /^furrow-performance-[\d-]+\.mcap$/);
  await file.saveAs(path);
  return path;
}

/** Computes the weights of the poses of a take, by sequence number. */
async function solved(path) {
  const { names, rows } = table(await furrowOutput('solve', path, '--rig', join(SHARE, 'default.rig.json'), '--format', 'csv'));
  const sequences = sequencesOf(readFileSync(path));
  assert.equal(rows.size, sequences.length);
  return { names, rows: new Map(sequences.map((sequence, i) => [sequence, rows.get(i)])) };
}

const csvOf = async (page) => table(readFileSync(await (await download(page, 'CSV')).path(), 'utf8'));
const pathOf = (name) => join(process.env.FURROW_ARTEFACTS, `take-${process.pid}-${name}.mcap`);
const toast = (page, hasText) => page.locator('.toast', { hasText }).waitFor();

async function recordingPage(seconds, prepare) {
  await daemon.patch('api/playback', { playing: true, position_s: 0 });
  const page = await openPage(browser, daemon.address, {}, prepare);
  await page.locator('.chip').first().waitFor();
  assert(await page.getByRole('button', { name: 'Take', exact: true }).isDisabled());
  await page.getByRole('button', { name: RECORD }).click();
  await eventually(`${seconds} s`, async () => await page.getByRole('timer').textContent() >= `0:0${seconds}`);
  return page;
}

test('a take has the poses whose weights the curves showed, and a span has its part', async () => {
  const page = await recordingPage(8);
  // Before the recording ends, so that all that the curves show from now on is part of it.
  await page.getByRole('button', { name: 'Freeze' }).click();
  const path = await saveTake(await download(page, STOP), pathOf('all'));
  await toast(page, /Saved furrow-.*\.mcap: \d+ poses/);
  const shown = await csvOf(page);
  for (let i = 0; i < 4; ++i) await page.getByRole('button', { name: 'Shorter time' }).click();
  const partPath = await saveTake(await download(page, 'Take'), pathOf('part'));
  const shownPart = await csvOf(page);
  assert.deepEqual(page.errors, []);
  await page.context().close();

  const take = await solved(path);
  assert.deepEqual(take.names, shown.names);
  const common = [...take.rows.keys()].slice(SETTLED).filter((frame) => shown.rows.has(frame));
  assert(common.length > 10, `${common.length} poses in common`);
  for (const frame of common) {
    take.rows.get(frame).forEach((value, i) => assert(Math.abs(value - shown.rows.get(frame)[i]) < 1e-2, `${take.names[i]} of pose ${frame}`));
  }
  const frames = [...(await solved(partPath)).rows.keys()];
  assert(frames.length > 5 && frames.length < take.rows.size / 2, `${frames.length} of ${take.rows.size} poses`);
  const last = [...shownPart.rows.keys()];
  // Poses and weights of one moment arrive one after the other.
  assert(frames[0] >= last[0] - 2 && frames.at(-1) <= last.at(-1) + 2, `${frames[0]} to ${frames.at(-1)}, shown ${last[0]} to ${last.at(-1)}`);
});

test('a take that could not be saved is kept, and Take tries again', async () => {
  const parts = /take_(file|schemas)/;
  const page = await recordingPage(1, (opened) => opened.route(parts, (route) => route.abort()));
  await page.getByRole('button', { name: STOP }).click();
  await toast(page, 'The take was not saved');
  await page.unroute(parts);
  const path = await saveTake(await download(page, 'Take'), pathOf('again'));
  assert(sequencesOf(readFileSync(path)).length > 10);
  await page.context().close();
});

test('a page that reloads saves its take first', async () => {
  const page = await recordingPage(1);
  const [file] = await Promise.all([page.waitForEvent('download'), page.evaluate(() => (location.hash = '#view=albedo'))]);
  const path = await saveTake(file, pathOf('reloaded'));
  assert(sequencesOf(readFileSync(path)).length > 10);
  await page.context().close();
});

/** Leaves the page as a user does. Returns the question that the browser asks; null: it asks none. */
async function leave(page) {
  let asked = null;
  page.once('dialog', (dialog) => {
    asked = dialog.type();
    void dialog.accept();
  });
  await Promise.all([page.waitForEvent('close'), page.close({ runBeforeUnload: true })]);
  return asked;
}

test('the browser asks before a page that records is closed, and not afterwards', async () => {
  const records = await recordingPage(1);
  assert.equal(await leave(records), 'beforeunload');
  await records.context().close();
  const saved = await recordingPage(1);
  await download(saved, STOP);
  await toast(saved, /Saved furrow-/);
  assert.equal(await leave(saved), null);
  await saved.context().close();
});

test('a recording waits for a subject that leaves, and ends with another subject', async () => {
  const quiet = await Daemon.start(['--no-render']);
  const play = (subject) => {
    const publisher = furrow('play', recording('anger'), '--to', `127.0.0.1:${quiet.ports.udp}`, '--udp', '--subject', subject, '--loop');
    publisher.stdout.resume();
    return publisher;
  };
  let publisher = play('ada');
  try {
    const page = await openPage(browser, quiet.address);
    const numRecorded = async () => Number((await page.getByRole('timer').textContent()).slice(2));
    await page.locator('.chip').first().waitFor();
    await page.getByRole('button', { name: RECORD }).click();
    await eventually('a second', async () => await numRecorded() >= 1);
    publisher.kill();
    await page.locator('.app[data-state=empty], .app[data-state=lost]').waitFor();
    await page.getByRole('button', { name: STOP }).waitFor();
    const before = await numRecorded();
    publisher = play('ada');
    await eventually('more poses', async () => await numRecorded() > before);
    publisher.kill();
    const saved = page.waitForEvent('download');
    publisher = play('bob');
    assert.match((await saved).suggestedFilename(), /^furrow-ada-/);
    await page.locator('.chip').first().waitFor();
    assert(await page.getByRole('button', { name: 'Take', exact: true }).isDisabled()); // the take is ada's
    await page.context().close();
  } finally {
    publisher.kill();
    await quiet.stop('SIGKILL');
  }
});
