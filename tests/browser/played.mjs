// SPDX-License-Identifier: Apache-2.0
// For a file whose tests share one daemon that plays the performance, and one browser. Both are there before the
// first hook of the file runs, whatever order a version of the runner gives to the hooks of several modules.
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
