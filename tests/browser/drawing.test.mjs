// SPDX-License-Identifier: Apache-2.0
// The page draws the picture itself, in software here, and the daemon's picture comes first and returns when it must.
import assert from 'node:assert/strict';
import { copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { PNG } from 'pngjs';
import { changedShare, difference, eventually, launch, openPage, shown, still } from './browser.mjs';
import { Daemon, recording, SHARE } from './daemon.mjs';

const FROWN_S = 6.5;
const SMALL = { viewport: { width: 910, height: 510 } }; // large pictures take seconds in software
/** A character with a package for browsers. */
const SHIPPED = ['--character', join(SHARE, 'default.glb'), '--play', recording('performance')];
let daemon;
let browser;

before(async () => {
  daemon = await Daemon.start(SHIPPED);
  browser = await launch(['--enable-unsafe-swiftshader']);
});
after(async () => {
  await browser?.close();
  await daemon?.stop();
});

/** What is on the screen, whoever draws it. */
async function screen(page) {
  return PNG.sync.read(await page.locator('.surface').screenshot());
}

const drawnBy = (page, who) => page.waitForSelector(`.stage[data-drawn-by=${who}]`, { timeout: 120_000 });
const whyOf = (page) => page.locator('select[aria-label="Drawn by"]').getAttribute('title');

test('the browser draws the daemon\'s picture, and it moves', async (context) => {
  await daemon.patch('api/playback', { playing: true });
  const page = await openPage(browser, `${daemon.address}#drawn=browser&panel=`, SMALL);
  await page.keyboard.press('g'); // without the curves, the picture is larger
  await shown(page); // the daemon's picture is shown while the character loads
  await eventually('the rate of the daemon', async () => Number.parseInt(await page.locator('[data-number=rate]').textContent(), 10) > 0);
  const daemonHz = await page.locator('[data-number=rate]').textContent();
  await drawnBy(page, 'browser');
  assert.equal(await whyOf(page), 'This browser draws the picture');
  const first = await screen(page);
  await eventually('another pose', async () => changedShare(first, await screen(page)) > 0.005);
  const rendered = async () => (await daemon.get('api/status')).pictures_rendered;
  const drawn = await rendered();
  await eventually('the rate of the browser', async () => Number.parseInt(await page.locator('[data-number=rate]').textContent(), 10) > 0);
  const { width, height } = await page.locator('.surface').boundingBox();
  context.diagnostic(`pictures of ${width} x ${height}: the daemon ${daemonHz}, this browser in software ` +
    `${await page.locator('[data-number=rate]').textContent()}`);
  assert((await rendered()) - drawn <= 2, 'the daemon draws nothing for this page');

  await daemon.hold(FROWN_S);
  assert((await fromDaemons(page, 'drawn', context)) > 0, 'two pictures, not one');
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

/** The picture on the screen, once it stays. */
async function resting(page) {
  let here = await screen(page);
  await eventually('a picture at rest', async () => {
    const former = here;
    here = await screen(page);
    return difference(former, here) === 0;
  });
  return here;
}

/** The mean difference of the browser's picture from the daemon's, which draws from then on. Keeps both as NAME-by-....png. */
async function fromDaemons(page, name, context) {
  const keep = (by, picture) => writeFileSync(join(process.env.FURROW_ARTEFACTS, `${name}-by-${by}.png`), PNG.sync.write(picture));
  const here = await resting(page);
  keep('browser', here);
  await page.selectOption('select[aria-label="Drawn by"]', 'daemon');
  await drawnBy(page, 'daemon');
  await still(page);
  const there = await screen(page);
  keep('daemon', there);
  const mean = difference(here, there);
  context.diagnostic(`mean difference from the daemon's picture: ${mean.toFixed(2)} of 255`);
  assert(mean < 4, `${mean} of 255`);
  return mean;
}

test('the browser draws skin shading by the page\'s settings', async (context) => {
  await daemon.hold(FROWN_S);
  const page = await openPage(browser, `${daemon.address}#drawn=browser&panel=&shading=skin`, SMALL);
  await page.keyboard.press('g'); // without the curves, the picture is larger
  await drawnBy(page, 'browser');
  assert.equal(await whyOf(page), 'This browser draws the picture');
  await fromDaemons(page, 'skin', context);
  await page.context().close();
});

test('a pose at rest is drawn once, however often it arrives', async () => {
  await daemon.hold(FROWN_S);
  const page = await openPage(browser, `${daemon.address}#drawn=browser&panel=`, SMALL, (opened) => opened.addInitScript(() => {
    window.calls = 0;
    const { prototype } = WebGL2RenderingContext;
    for (const name of ['drawElements', 'drawArrays']) {
      const draw = prototype[name];
      prototype[name] = function (...rest) {
        ++window.calls;
        return draw.apply(this, rest);
      };
    }
  }));
  await drawnBy(page, 'browser');
  const calls = () => page.evaluate(() => window.calls);
  const received = async () => (await daemon.get('api/subjects')).subjects[0].poses;
  const more = async (count) => {
    const poses = await received();
    await eventually(`${count} more poses`, async () => (await received()) >= poses + count);
  };
  await eventually('the filtered weights are at rest', async () => {
    const before = await calls();
    await more(60); // in software, a picture takes as long as many poses
    return (await calls()) === before;
  });
  const drawn = await calls();
  await more(20);
  assert.equal(await calls(), drawn);
  assert.equal(await page.locator('.stage').getAttribute('data-drawn-by'), 'browser');
  await page.keyboard.press('3');
  await eventually('another camera', async () => (await calls()) > drawn);
  await page.context().close();
});

test('a change of the settings changes the picture that the browser draws', async () => {
  await daemon.hold(FROWN_S);
  const page = await openPage(browser, `${daemon.address}#drawn=browser&shading=skin`, { viewport: { width: 1100, height: 510 } });
  await page.keyboard.press('g');
  await drawnBy(page, 'browser');
  const usual = await resting(page);
  const choose = async (setting, word) => {
    await page.fill('#settings-search', setting);
    await page.locator(`[data-setting="${setting}"] select`).selectOption({ label: word });
  };
  // Shadows off: another picture, still the browser's. Another method of scattering: the daemon's.
  await choose('shadow.filter', 'Off');
  await eventually('a picture without shadows', async () => changedShare(usual, await screen(page)) > 0.005);
  await drawnBy(page, 'browser');
  await choose('subsurface.method', 'Burley');
  await drawnBy(page, 'daemon');
  assert.match(await whyOf(page), /only the daemon draws/);
  await choose('subsurface.method', 'Separable');
  await drawnBy(page, 'browser');
  // Another shading: both are measured again.
  await choose('shading', 'Diffuse');
  await eventually('a plain picture', async () => changedShare(usual, await screen(page)) > 0.02);
  await drawnBy(page, 'browser');
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test('the daemon draws what the browser cannot', async () => {
  await daemon.hold(FROWN_S);
  const page = await openPage(browser, `${daemon.address}#drawn=browser&panel=`, SMALL);
  await drawnBy(page, 'browser');
  await page.selectOption('select[aria-label="Split the picture"]', 'wrinkles');
  await drawnBy(page, 'daemon');
  assert.match(await whyOf(page), /only the daemon draws/);
  await page.selectOption('select[aria-label="Split the picture"]', 'none');
  await drawnBy(page, 'browser');
  // The GPU goes away, as after a driver's restart.
  await page.evaluate(() => document.querySelector('.drawn-here canvas').getContext('webgl2').getExtension('WEBGL_lose_context').loseContext());
  await drawnBy(page, 'daemon');
  await still(page);
  assert(await page.locator('.drawn-here').isHidden());
  await page.context().close();
});

test('after a restart the page asks for the character again', async (context) => {
  const folder = mkdtempSync(join(tmpdir(), 'furrow-drawing-'));
  context.after(() => rmSync(folder, { recursive: true }));
  // The same character without a package for browsers.
  for (const [name, copy] of [['default.glb', 'other.glb'], ['default.rig.json', 'other.rig.json']]) {
    copyFileSync(join(SHARE, name), join(folder, copy));
  }
  const first = await Daemon.start(SHIPPED);
  context.after(() => first.stop('SIGKILL'));
  const page = await openPage(browser, `${first.address}#drawn=browser&panel=`, SMALL);
  await drawnBy(page, 'browser');
  await first.stop('SIGKILL');
  await drawnBy(page, 'daemon');
  const second = await Daemon.start(['--character', join(folder, 'other.glb'), '--play', recording('performance')], first.ports);
  context.after(() => second.stop());
  await shown(page);
  await eventually('the reason', async () => /no character for browsers/.test(await whyOf(page)));
  await page.context().close();
});

test('by default a browser in software leaves the drawing to the daemon', async () => {
  const page = await openPage(browser, `${daemon.address}#panel=`, SMALL);
  await still(page);
  assert.match(await whyOf(page), /this browser draws in software/);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test('without WebGL the daemon draws', async () => {
  const poor = await launch(['--disable-3d-apis']);
  try {
    const page = await openPage(poor, `${daemon.address}#drawn=browser&panel=`, SMALL);
    await still(page);
    assert.match(await whyOf(page), /no WebGL 2/);
  } finally {
    await poor.close();
  }
});

test('a picture of the page has what the browser has drawn', async () => {
  await daemon.hold(FROWN_S);
  const page = await openPage(browser, `${daemon.address}#drawn=browser&camera=eyes`, SMALL);
  await drawnBy(page, 'browser');
  // Below it lies the last picture of the daemon, which is the same.
  await page.evaluate(() => {
    const { canvas } = document.querySelector('canvas.picture').getContext('2d');
    canvas.getContext('2d').clearRect(0, 0, canvas.width, canvas.height);
  });
  const drawn = await screen(page);
  const [file] = await Promise.all([page.waitForEvent('download'), page.keyboard.press('i')]);
  const { x, y } = await page.locator('.surface').boundingBox();
  const saved = new PNG({ width: drawn.width, height: drawn.height });
  PNG.bitblt(PNG.sync.read(readFileSync(await file.path())), saved, Math.round(x), Math.round(y), drawn.width, drawn.height, 0, 0);
  assert(changedShare(saved, drawn) < 0.02, `${changedShare(saved, drawn)}`);
  await page.context().close();
});
