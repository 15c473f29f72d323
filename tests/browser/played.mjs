// SPDX-License-Identifier: Apache-2.0
// One daemon that plays the performance, and one browser, for test files that share them. Both start before the
// first hook of the file, because the order of hooks from several modules depends on the version of the runner.
import { after } from 'node:test';
import { launch } from './browser.mjs';
import { Daemon, recording } from './daemon.mjs';

export const daemon = await Daemon.start(['--play', recording('performance')]);
export const browser = await launch().catch(async (error) => {
  await daemon.stop();
  throw error;
});

after(async () => {
  await browser.close();
  await daemon.stop();
});
