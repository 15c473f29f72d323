// SPDX-License-Identifier: Apache-2.0
// The states of the picture, and three panels, at several sizes of screen: nothing is cut off, covered or too small, and the
// page is accessible. The narrowest sizes by default; FURROW_ALL_SCREENS=1 adds the others, and takes three times as long.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { after, before, test } from 'node:test';
import { envelopeOf, eventually, filterMessages, keep, launch, openPage, PHONE, shown, still } from './browser.mjs';
import { Daemon, recording } from './daemon.mjs';
import { layoutFaults, smallTargets } from './support/layout_audit.mjs';

const AXE = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
/** A pose with raised brows. */
const RAISED_S = 2.0;
const isAll = (process.env.FURROW_ALL_SCREENS ?? '') !== '';
const SCREENS = [
  { options: { ...PHONE, deviceScaleFactor: 1 }, isPhone: true, sizes: [[390, 844], [844, 390]] },
  { options: {}, isPhone: false, sizes: isAll ? [[1024, 768], [1280, 720], [1920, 1080], [2560, 1440]] : [[1280, 720]] },
];
const PLAY = ['--play', recording('performance')];
const inState = (page, state) => page.waitForSelector(`.app[data-state=${state}]`);
const isPicture = (message) => envelopeOf(message).kind === 'FIMG';

/**
 * How to reach each state. `options` of the daemon; `hash` of the address; `prepare(page)` before the page loads;
 * `reach(page, daemon, hold)`, where `hold.pictures` keeps pictures from the page.
 */
const STATES = {
  empty: { options: [], reach: (page) => inState(page, 'empty') },
  loading: {
    hold: true,
    prepare: (page) => page.route('**/api/status', async (route) => {
      const response = await route.fetch();
      await route.fulfill({ response, json: { ...await response.json(), drawing: { done: 2, passes: 12 } } });
    }),
    reach: (page) => page.locator('.notice-title', { hasText: 'step 3 of 12' }).waitFor(),
  },
  live: { reach: (page) => inState(page, 'live') },
  paused: {
    reach: async (page, daemon) => {
      await daemon.hold(RAISED_S);
      await inState(page, 'paused');
      await still(page);
    },
  },
  stale: {
    reach: async (page, daemon, hold) => {
      await inState(page, 'live');
      hold.pictures = true;
      await inState(page, 'stale');
    },
  },
  lost: {
    endsDaemon: true,
    reach: async (page, daemon) => {
      await inState(page, 'live');
      await daemon.stop('SIGKILL');
      await inState(page, 'lost');
    },
  },
  off: { options: [...PLAY, '--no-render'], reach: (page) => inState(page, 'off') },
  explain: {
    hash: '#panel=wrinkles',
    reach: async (page, daemon) => {
      await daemon.hold(RAISED_S);
      await still(page);
      await page.locator('.region').first().click();
      await page.locator('.explain article').first().waitFor();
    },
  },
  capture: {
    hash: '#panel=capture',
    reach: async (page, daemon) => {
      await daemon.hold(RAISED_S);
      await still(page);
      await page.locator('.capture').waitFor();
    },
  },
  sources: {
    hash: '#panel=sources',
    options: [...PLAY, '--livelink-face', '0'],
    reach: async (page) => {
      await inState(page, 'live');
      await page.locator('.source').first().waitFor();
    },
  },
};
/** States of a resting pose: each size gets a picture of its own. */
const DRAWN = ['paused', 'explain', 'capture'];

let browser;
/** Running daemons, by their options. Each draws its first picture only once. */
const daemons = new Map();
before(async () => (browser = await launch()));
after(async () => {
  await browser?.close();
  await Promise.all([...daemons.values()].map((daemon) => daemon.stop('SIGKILL')));
});

async function daemonWith(options, isOwn) {
  const key = isOwn ? Symbol('own') : options.join(' ');
  if (!daemons.has(key)) daemons.set(key, await Daemon.start(options));
  const daemon = daemons.get(key);
  if (options.includes('--play')) await daemon.patch('api/playback', { playing: true });
  return daemon;
}

async function axeFindings(page) {
  await page.evaluate(AXE);
  const { violations } = await page.evaluate(() => globalThis.axe.run());
  return violations.map(({ id, nodes }) => `axe ${id}: ${nodes.map(({ html }) => html.slice(0, 120)).join(' | ')}`);
}

for (const [state, { options = PLAY, endsDaemon = false, hash = '', hold: holds = false, prepare, reach }] of Object.entries(STATES)) {
  test(`${state}: the layout is whole at every size`, async () => {
    const faults = [];
    for (const { options: context, isPhone, sizes } of SCREENS) {
      const daemon = await daemonWith(options, endsDaemon);
      const hold = { pictures: holds };
      const viewport = { width: sizes[0][0], height: sizes[0][1] };
      const page = await openPage(browser, daemon.address + hash, { ...context, viewport }, async (opened) => {
        await filterMessages(opened, (message) => !(hold.pictures && isPicture(message)));
        await prepare?.(opened);
      });
      await reach(page, daemon, hold);
      for (const [width, height] of sizes) {
        await page.setViewportSize({ width, height });
        await eventually('the new size', () => page.evaluate((w) => innerWidth === w, width));
        if (DRAWN.includes(state)) await still(page);
        else if (state === 'live' || state === 'sources') await shown(page);
        await keep(page, `screen-${state}-${width}x${height}`);
        const found = [...await layoutFaults(page), ...await axeFindings(page), ...(isPhone ? await smallTargets(page) : [])];
        faults.push(...found.map((fault) => `${width}x${height}: ${fault}`));
      }
      await page.unrouteAll({ behavior: 'ignoreErrors' });
      await page.context().close();
    }
    assert.deepEqual(faults, []);
  });
}
