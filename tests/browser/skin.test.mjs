// SPDX-License-Identifier: Apache-2.0
// Skin shading by furrow-three in Chromium, which draws in software here, beside `furrow render --shading skin`.
import assert from 'node:assert/strict';
import { copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { PNG } from 'pngjs';
import { changedShare, difference, launch, openPage } from './browser.mjs';
import { SHARE } from './daemon.mjs';
import { serveModules } from './support/module_server.mjs';
import { beside, FRAMES, insideOf, posesOf, rendered, rmse, SIZE, solved } from './support/parity.mjs';

/** Of 255, inside the skin of the face. Measured: 0.8 to 1.1. */
const MAX_RMSE = 2;
/** The daemon's way without a GPU, and the browser's. */
const ONE_SAMPLE = ['--set', 'anti_aliasing.samples=1', '--set', 'anti_aliasing.fxaa=on'];

const PAGE = `<!doctype html><script type="importmap">{"imports": {
  "three": "/node_modules/three/build/three.module.js", "three/addons/": "/node_modules/three/examples/jsm/",
  "furrow-three": "/furrow-three/dist/index.js", "furrow-three/settings": "/furrow-three/dist/settings.js"}}</script>
<script type="module">
  import { PerspectiveCamera, WebGLRenderer } from 'three';
  import { Follower, loadCharacter, StudioView } from 'furrow-three';
  import { readSettings } from 'furrow-three/settings';
  // Counts the objects of the GPU that exist.
  const living = {};
  for (const kind of ['Texture', 'Framebuffer', 'Renderbuffer', 'Buffer', 'VertexArray', 'Program']) {
    living[kind] = new Set();
    const { prototype } = WebGL2RenderingContext;
    const [make, remove] = [prototype['create' + kind], prototype['delete' + kind]];
    prototype['create' + kind] = function (...rest) {
      const made = make.apply(this, rest);
      living[kind].add(made);
      return made;
    };
    prototype['delete' + kind] = function (object) {
      living[kind].delete(object);
      return remove.call(this, object);
    };
  }
  const query = new URLSearchParams(location.search);
  if (query.has('no-floats')) {
    const { prototype } = WebGL2RenderingContext;
    const { getExtension } = prototype;
    prototype.getExtension = function (name) {
      return name === 'EXT_color_buffer_float' ? null : getExtension.call(this, name);
    };
  }
  const renderer = new WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
  renderer.setSize(${SIZE}, ${SIZE}, false);
  const load = () => loadCharacter('/share/default.web.glb', renderer, { skin: !query.has('no-skin') });
  const characters = [await loadCharacter(query.get('character') ?? '/share/default.glb', renderer, { skin: !query.has('no-skin') })];
  let view = new StudioView(renderer);
  const [camera, follower] = [new PerspectiveCamera(), new Follower(characters[0])];
  window.page = {
    draw({ pose, weights, place, settings = {}, shown = characters.map((_, i) => i) }) {
      const { settings: read, unsupported } = readSettings(Object.entries(settings).map(([name, value]) => [name, String(value)]));
      if (unsupported.length > 0) throw new Error('unsupported: ' + unsupported);
      view.settings = read;
      for (const character of characters) {
        if (pose) character.setPose(pose);
        if (weights) character.setWeights(weights);
      }
      view.render(shown.map((i) => characters[i]), camera, follower.place(camera, place, 1));
      return renderer.domElement.toDataURL('image/png');
    },
    why: () => view.whyNoSkin(characters),
    living: () => Object.fromEntries(Object.entries(living).map(([kind, set]) => [kind, set.size])),
    newView() {
      view.dispose();
      view = new StudioView(renderer);
    },
    async addCharacter(x) {
      const second = await load();
      second.position.x = x;
      characters.push(second);
    },
    removeCharacter(i) {
      characters.splice(i, 1)[0].dispose();
    },
  };
</script>`;

const server = await serveModules({ '/skin.html': PAGE });
const browser = await launch(['--enable-unsafe-swiftshader']);
const folder = mkdtempSync(join(tmpdir(), 'furrow-skin-'));
let moments;
before(async () => {
  const { poses, camera } = await posesOf(FRAMES);
  const weights = await solved(FRAMES);
  moments = FRAMES.map((frame, i) => ({ frame, pose: poses[i], weights: weights[i], place: camera }));
});
after(async () => {
  rmSync(folder, { recursive: true });
  await browser.close();
  server.close();
});

/** `files`: bytes that the page may load, by path. */
async function open(query = '', files = {}) {
  const page = await openPage(browser, 'about:blank');
  for (const [path, body] of Object.entries(files)) await page.route((url) => url.pathname === path, (route) => route.fulfill({ body }));
  await page.goto(`${server.address}/skin.html${query}`);
  await page.waitForFunction(() => window.page);
  return page;
}

async function drawn(page, input) {
  const url = await page.evaluate((what) => window.page.draw(what), input);
  return PNG.sync.read(Buffer.from(url.split(',')[1], 'base64'));
}

/** The pictures without messages of files that may be missing. */
async function close(page) {
  assert.deepEqual(page.errors.filter((error) => !error.includes('404')), []);
  await page.context().close();
}

const toOptions = (settings) => Object.entries(settings).flatMap(([name, value]) => ['--set', `${name}=${value}`]);

/** Mean of a channel, or of what `value` makes of a pixel. */
function mean(picture, pixels, value) {
  return pixels.reduce((sum, pixel) => sum + value(...picture.data.subarray(4 * pixel, 4 * pixel + 3)), 0) / pixels.length;
}

test('the skin of the face is that of furrow render', async (context) => {
  const page = await open();
  const skin = { shading: 'skin' };
  for (const { frame, ...moment } of moments) {
    const expected = await rendered(folder, frame, '--shading', 'skin', ...ONE_SAMPLE);
    const inside = insideOf(await rendered(folder, frame, '--view', 'material'));
    assert(inside.length > 0.2 * SIZE * SIZE, `${inside.length} pixels of skin`);
    const actual = await drawn(page, { ...moment, settings: skin });
    writeFileSync(join(process.env.FURROW_ARTEFACTS, `skin-${frame}.png`), beside(expected, actual));
    const apart = rmse(expected, actual, inside);
    // What its parts contribute: the figure above must not hide their absence.
    const without = {};
    for (const [what, off] of Object.entries({ scattering: { 'subsurface.method': 'off' }, shadows: { 'shadow.filter': 'off' } })) {
      without[what] = rmse(expected, await drawn(page, { ...moment, settings: { ...skin, ...off } }), inside);
    }
    const bare = rmse(expected, await drawn(page, { ...moment, weights: { names: [], values: [] }, settings: skin }), inside);
    const smooth = rmse(await rendered(folder, frame, '--shading', 'skin'), actual, inside);
    context.diagnostic(`frame ${frame}: RMSE ${apart.toFixed(2)} of 255 inside the skin (${smooth.toFixed(2)} from four samples per pixel); ${without.scattering.toFixed(2)} without scattering, ` +
      `${without.shadows.toFixed(2)} without shadows, ${bare.toFixed(2)} without wrinkles`);
    assert(apart <= MAX_RMSE, `frame ${frame}: ${apart}`);
    assert(without.scattering > apart + 0.5, `frame ${frame}: ${without.scattering} without scattering`);
    assert(without.shadows > apart + 5, `frame ${frame}: ${without.shadows} without shadows`);
    assert(bare > apart + 0.5, `frame ${frame}: ${bare} without wrinkles`);
  }
  await close(page);
});

test('settings change the picture as they change the daemon\'s', async (context) => {
  const page = await open();
  const [{ frame, ...moment }] = moments;
  const inside = insideOf(await rendered(folder, frame, '--view', 'material'));
  const usual = await drawn(page, { ...moment, settings: { shading: 'skin' } });
  for (const change of [
    { 'lights.preset': 'hard', 'shadow.filter': 'pcss' },
    { 'lights.preset': 'thesis', 'shadow.lamps': 1, 'occlusion.method': 'ssao' },
    { 'lights.turn_degrees': 40, 'lights.tilt_degrees': 15, 'lights.rim': '0,0,0', 'lights.sky': '0.2,0.5,1' },
    { 'shadow.filter': 'off', 'occlusion.method': 'off', 'bloom.strength': 0.5, 'bloom.threshold': 0.4 },
    { 'subsurface.width': 2, 'subsurface.taps': 25, 'subsurface.mix': 1, 'translucency.strength': 4 },
    { 'specular.mode': 'gems', 'specular.roughness': 0.7, 'specular.conserve_energy': 'off', 'specular.widen': 'off' },
    { exposure: 1.5, tone_map: 'clip', wrinkle_strength: 2, 'wrinkle_maps.blood_flow': 3, 'wrinkle_maps.cavity': 2 },
    { view: 'shadow' },
    { view: 'translucency', 'translucency.strength': 8 },
  ]) {
    const settings = { shading: 'skin', ...change };
    const expected = await rendered(folder, frame, ...ONE_SAMPLE, ...toOptions(settings));
    const actual = await drawn(page, { ...moment, settings });
    const [apart, changes] = [rmse(expected, actual, inside), rmse(usual, actual, inside)];
    context.diagnostic(`${JSON.stringify(change)}: RMSE ${apart.toFixed(2)} of 255, where the settings change the picture by ${changes.toFixed(2)}`);
    // The edges of shadows are binary in the view "shadow": a pixel of difference counts 255.
    assert(apart <= (change.view === 'shadow' ? 12 : 2 * MAX_RMSE), JSON.stringify(change));
    assert(changes > 1.5 * apart, JSON.stringify(change));
  }
  await close(page);
});

/** A .glb file with a change of its JSON. */
function changedGlb(path, change) {
  const file = readFileSync(path);
  const end = 20 + file.readUInt32LE(12);
  const json = JSON.parse(file.toString('utf8', 20, end));
  change(json);
  const text = Buffer.from(JSON.stringify(json));
  const padded = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, ' ')]);
  const head = Buffer.from(file.subarray(0, 20));
  head.writeUInt32LE(20 + padded.length + file.length - end, 8);
  head.writeUInt32LE(padded.length, 12);
  return Buffer.concat([head, padded, file.subarray(end)]);
}

test('a face that glows does so here, too', async (context) => {
  const glowing = changedGlb(join(SHARE, 'default.glb'), ({ materials }) => {
    for (const material of materials) if (material.name === 'skin' || material.name === 'cloth') material.emissiveFactor = [0, 0.1, 0.3];
  });
  writeFileSync(join(folder, 'glowing.glb'), glowing);
  copyFileSync(join(SHARE, 'default.rig.json'), join(folder, 'glowing.rig.json'));
  const [{ frame, ...moment }] = moments;
  const character = ['--character', join(folder, 'glowing.glb')];
  const expected = await rendered(folder, frame, '--shading', 'skin', ...ONE_SAMPLE, ...character);
  const inside = insideOf(await rendered(folder, frame, '--view', 'material'));
  const page = await open('?character=/glowing.glb', { '/glowing.glb': glowing, '/glowing.rig.json': readFileSync(join(folder, 'glowing.rig.json')) });
  const actual = await drawn(page, { ...moment, settings: { shading: 'skin' } });
  const apart = rmse(expected, actual, inside);
  const plain = rmse(expected, await rendered(folder, frame, '--shading', 'skin', ...ONE_SAMPLE), inside);
  context.diagnostic(`RMSE ${apart.toFixed(2)} of 255; the light changes the picture by ${plain.toFixed(2)}`);
  assert(apart <= MAX_RMSE, `${apart}`);
  assert(plain > 10, `${plain}`);
  await close(page);
});

test('shadows fall, and red light bleeds into their edges', async (context) => {
  const page = await open();
  const [moment] = moments;
  const picture = (settings) => drawn(page, { ...moment, settings: { shading: 'skin', 'lights.preset': 'hard', 'bloom.strength': 0, ...settings } });
  const lamps = await picture({ view: 'shadow' });
  const inside = insideOf(await rendered(folder, moment.frame, '--view', 'material'));
  const [lit, unlit, sharp] = [await picture({}), await picture({ 'shadow.filter': 'off' }), await picture({ 'subsurface.method': 'off' })];
  // The shadows of the brow, the nose and the chin: the lamp would shine on these pixels if nothing were in between.
  const free = await picture({ view: 'shadow', 'shadow.filter': 'off' });
  const shadow = inside.filter((pixel) => free.data[4 * pixel] === 255 && lamps.data[4 * pixel] === 0);
  const light = inside.filter((pixel) => lamps.data[4 * pixel] === 255);
  assert(shadow.length > 500 && light.length > 5000, `${shadow.length} pixels in the shadow, ${light.length} in the light`);
  const green = (r, g) => g;
  const [with_, without] = [mean(lit, shadow, green), mean(unlit, shadow, green)];
  context.diagnostic(`${shadow.length} pixels of shadow: green ${with_.toFixed(1)} with shadows, ${without.toFixed(1)} without`);
  assert(with_ < 0.6 * without, `${with_}, ${without}`);
  assert(Math.abs(mean(lit, light, green) - mean(unlit, light, green)) < 0.06 * mean(unlit, light, green), 'lit skin stays');
  // The dark side of the edge, up to three pixels, which are 2 mm here.
  const edge = shadow.filter((pixel) => [1, 2, 3].some((d) => [pixel - d, pixel + d, pixel - d * SIZE, pixel + d * SIZE].some((other) => lamps.data[4 * other] === 255)));
  const redness = (r, g) => r / Math.max(g, 1);
  const [scattered, cut] = [mean(lit, edge, redness), mean(sharp, edge, redness)];
  context.diagnostic(`${edge.length} pixels at the shadow's edge: red over green ${scattered.toFixed(3)} with scattering, ${cut.toFixed(3)} without`);
  assert(edge.length > 100, `${edge.length} pixels`);
  assert(scattered > 1.1 * cut, `${scattered}, ${cut}`);
  // Far from edges, light scatters as much out of a pixel as into it.
  const flat = light.filter((pixel) => [-12, 12, -12 * SIZE, 12 * SIZE].every((d) => lamps.data[4 * (pixel + d)] === 255));
  assert(Math.abs(mean(lit, flat, redness) - mean(sharp, flat, redness)) < 0.02, 'even light stays');
  await close(page);
});

test('dispose() frees the memory of the GPU', async () => {
  const page = await open();
  const [moment] = moments;
  const living = () => page.evaluate(() => window.page.living());
  const freed = () => page.evaluate(() => window.page.newView());
  const first = await drawn(page, { ...moment, settings: { shading: 'skin' } });
  const busy = await living();
  await freed();
  const idle = await living();
  // Facets, light, scattering, occlusion, bloom, shadows and a table; three keeps textures of its own.
  assert(busy.Texture - idle.Texture >= 15, `${busy.Texture} textures, then ${idle.Texture}`);
  assert(busy.Framebuffer - idle.Framebuffer >= 10, `${busy.Framebuffer} framebuffers, then ${idle.Framebuffer}`);
  assert(busy.Program - idle.Program >= 9, `${busy.Program} programs, then ${idle.Program}`);
  // Another view gives the same picture, and nothing adds up.
  assert.equal(difference(first, await drawn(page, { ...moment, settings: { shading: 'skin' } })), 0);
  assert.deepEqual(await living(), busy);
  // Another size of its targets replaces them.
  await drawn(page, { ...moment, settings: { shading: 'skin', 'occlusion.half_resolution': 'off', 'shadow.fit': 'off', 'shadow.resolution': 256 } });
  await freed();
  assert.deepEqual(await living(), idle);
  await close(page);
});

test('two characters share a picture', async () => {
  const page = await open('?character=/share/default.web.glb');
  const [moment] = moments;
  const settings = { shading: 'skin' };
  const alone = await drawn(page, { ...moment, settings });
  const before_ = await page.evaluate(() => window.page.living());
  await page.evaluate(() => window.page.addCharacter(0.16));
  const both = await drawn(page, { ...moment, settings });
  const second = await drawn(page, { ...moment, settings, shown: [1] });
  writeFileSync(join(process.env.FURROW_ARTEFACTS, 'skin-two.png'), PNG.sync.write(both));
  assert(changedShare(alone, both) > 0.1);
  assert(changedShare(second, both) > 0.1);
  // Left of the second one, the first one stays as it is; it only gets less light from the right.
  const left = Array.from({ length: SIZE * SIZE }, (_, i) => i).filter((i) => i % SIZE > 0.25 * SIZE && i % SIZE < 0.4 * SIZE);
  assert(rmse(alone, both, left) < 6, `${rmse(alone, both, left)}`);
  await page.evaluate(() => window.page.removeCharacter(1));
  assert.equal(difference(alone, await drawn(page, { ...moment, settings })), 0, 'the first one is as before');
  const { Texture: textures } = await page.evaluate(() => window.page.living());
  assert.equal(textures, before_.Texture);
  await close(page);
});

test('without float targets, or by choice, the face has no skin shading, and the view says why', async () => {
  const [moment] = moments;
  for (const [query, why] of [['?no-floats&character=/share/default.web.glb', /EXT_color_buffer_float/], ['?no-skin&character=/share/default.web.glb', /without skin shading/]]) {
    const page = await open(query);
    assert.match(await page.evaluate(() => window.page.why()), why);
    const skin = await drawn(page, { ...moment, settings: { shading: 'skin' } });
    assert.equal(difference(skin, await drawn(page, { ...moment, settings: { shading: 'diffuse' } })), 0);
    assert(changedShare(skin, new PNG({ width: SIZE, height: SIZE })) > 0.5, 'a picture');
    await close(page);
  }
});
