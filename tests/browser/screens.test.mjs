// SPDX-License-Identifier: Apache-2.0
// The states of the picture, and three panels, at six sizes of screen: nothing is cut off, covered or too small, and the page is
// accessible. A page reaches its state once and is then resized, as by somebody who turns a phone or moves a window.
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
/**
 * `examined`: the widths at which axe runs, one for each kind of layout. Names, roles and colours are the same at the others.
 */
const DEVICES = [
  { options: { ...PHONE, deviceScaleFactor: 1 }, isPhone: true, sizes: [[390, 844], [844, 390]], examined: [390, 844] },
  { options: {}, isPhone: false, sizes: [[1280, 720], [1024, 768], [1920, 1080], [2560, 1440]], examined: [1280] },
];
const PLAY = ['--play', recording('performance')];
const inState = (page, state) => page.waitForSelector(`.app[data-state=${state}]`);
/** The page is told `part` instead of what the daemon's status says of it. */
const changeStatus = (page, part) => page.route('**/api/status', async (route) => {
  const response = await route.fetch();
  await route.fulfill({ response, json: { ...await response.json(), ...part } });
});
const isPicture = (message) => envelopeOf(message).kind === 'FIMG';

/**
 * How to reach each state. `options` of the daemon; `hash` of the address; `prepare(page)` before the page loads; `arrive(page)`
 * before `act(daemon, hold)`, which is done once for all devices, and `reach(page)` after it. `hold.pictures` keeps pictures
 * from the pages.
 */
const STATES = {
  empty: { options: [], reach: (page) => inState(page, 'empty') },
  loading: {
    hold: true,
    prepare: (page) => changeStatus(page, { drawing: { done: 2, passes: 12 } }),
    reach: (page) => page.locator('.notice-title', { hasText: 'step 3 of 12' }).waitFor(),
  },
  live: { reach: (page) => inState(page, 'live') },
  draft: {
    prepare: (page) => changeStatus(page, { starting: true }),
    reach: (page) => page.locator('.condition', { hasText: '(draft)' }).waitFor(),
  },
  paused: {
    act: (daemon) => daemon.hold(RAISED_S),
    reach: async (page) => {
      await inState(page, 'paused');
      await still(page);
    },
  },
  stale: {
    arrive: (page) => inState(page, 'live'),
    act: (daemon, hold) => (hold.pictures = true),
    reach: (page) => inState(page, 'stale'),
  },
  lost: {
    endsDaemon: true,
    arrive: (page) => inState(page, 'live'),
    act: (daemon) => daemon.stop('SIGKILL'),
    reach: (page) => inState(page, 'lost'),
  },
  off: { options: [...PLAY, '--no-render'], reach: (page) => inState(page, 'off') },
  explain: {
    hash: '#panel=wrinkles',
    act: (daemon) => daemon.hold(RAISED_S),
    reach: async (page) => {
      await still(page);
      await page.locator('.region').first().click();
      await page.locator('.explain article').first().waitFor();
    },
  },
  capture: {
    hash: '#panel=capture',
    act: (daemon) => daemon.hold(RAISED_S),
    reach: async (page) => {
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

/** Resizes the page to each size of its device, and returns what is wrong there. */
async function faultsOf(page, { sizes, isPhone, examined }, state) {
  const faults = [];
  for (const [width, height] of sizes) {
    await page.setViewportSize({ width, height });
    await eventually('the new size', () => page.evaluate((w) => innerWidth === w, width));
    // The page learns of the size of its picture with the next frame, and then asks for another one.
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
    if (DRAWN.includes(state)) await still(page);
    else if (['live', 'draft', 'sources'].includes(state)) await shown(page);
    await keep(page, `screen-${state}-${width}x${height}`);
    const found = [...await layoutFaults(page), ...(isPhone ? await smallTargets(page) : []),
      ...(examined.includes(width) ? await axeFindings(page) : [])];
    faults.push(...found.map((fault) => `${width}x${height}: ${fault}`));
  }
  return faults;
}

for (const [state, { options = PLAY, endsDaemon = false, hash = '', hold: holds = false, prepare, arrive, act, reach }] of Object.entries(STATES)) {
  test(`${state}: the layout is whole at every size`, async () => {
    const faults = [];
    // Without something to do for all of them, one after the other, because moving pictures of two pages take longer.
    for (const devices of act === undefined ? DEVICES.map((device) => [device]) : [DEVICES]) {
      const daemon = await daemonWith(options, endsDaemon);
      const hold = { pictures: holds };
      const pages = [];
      for (const { options: context, sizes: [[width, height]] } of devices) {
        const page = await openPage(browser, daemon.address + hash, { ...context, viewport: { width, height } }, async (opened) => {
          await filterMessages(opened, (message) => !(hold.pictures && isPicture(message)));
          await prepare?.(opened);
        });
        await arrive?.(page);
        pages.push(page);
      }
      await act?.(daemon, hold);
      for (const [i, page] of pages.entries()) {
        await reach(page);
        faults.push(...await faultsOf(page, devices[i], state));
        await page.unrouteAll({ behavior: 'ignoreErrors' });
        await page.context().close();
      }
    }
    assert.deepEqual(faults, []);
  });
}
