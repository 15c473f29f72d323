// SPDX-License-Identifier: Apache-2.0
// For a file whose tests share one daemon that plays the performance, and one browser.
import { after, before } from 'node:test';
import { launch } from './browser.mjs';
import { Daemon, recording } from './daemon.mjs';

export let daemon;
export let browser;

before(async () => {
  daemon = await Daemon.start(['--play', recording('performance')]);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await daemon?.stop();
});
