// SPDX-License-Identifier: Apache-2.0
// furrow-three in Chromium, which draws in software here: the same normals as `furrow render`, and the example page.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { PNG } from 'pngjs';
import { changedShare, eventually, keep, launch, openPage } from './browser.mjs';
import { Daemon, recording } from './daemon.mjs';
import { serveModules } from './support/module_server.mjs';
import { beside, FRAMES, insideOf, posesOf, rendered, rmse, SIZE, solved } from './support/parity.mjs';

const MAX_RMSE = 3; // of 255

const PAGE = `<!doctype html><script type="importmap">{"imports": {
  "three": "/node_modules/three/build/three.module.js", "three/addons/": "/node_modules/three/examples/jsm/",
  "furrow-three": "/furrow-three/dist/index.js"}}</script>
<script type="module">
  import { LinearSRGBColorSpace, PerspectiveCamera, Scene, WebGLRenderer } from 'three';
  import { Follower, loadCharacter } from 'furrow-three';
  const renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.setSize(${SIZE}, ${SIZE}, false);
  renderer.outputColorSpace = LinearSRGBColorSpace; // the view has numbers, not colours
  const character = await loadCharacter('/share/default.glb', renderer);
  character.setView('normal');
  const scene = new Scene().add(character);
  const [camera, follower] = [new PerspectiveCamera(), new Follower(character)];
  window.draw = (pose, weights, place) => {
    character.setPose(pose);
    character.setWeights(weights);
    follower.place(camera, place, 1);
    renderer.render(scene, camera);
    return renderer.domElement.toDataURL('image/png');
  };
</script>`;

const server = await serveModules({ '/parity.html': PAGE });
const browser = await launch(['--enable-unsafe-swiftshader']);
after(async () => {
  await browser.close();
  server.close();
});

test('the normals of the face are those of furrow render', async (context) => {
  const folder = mkdtempSync(join(tmpdir(), 'furrow-three-'));
  context.after(() => rmSync(folder, { recursive: true }));
  const { poses, camera } = await posesOf(FRAMES);
  const weights = await solved(FRAMES);
  const page = await openPage(browser, `${server.address}/parity.html`);
  await page.waitForFunction(() => window.draw);
  const drawn = async (pose, weights) => {
    const url = await page.evaluate((input) => window.draw(...input), [pose, weights, camera]);
    return PNG.sync.read(Buffer.from(url.split(',')[1], 'base64'));
  };
  for (const [i, frame] of FRAMES.entries()) {
    const expected = await rendered(folder, frame, '--view', 'normal');
    const inside = insideOf(await rendered(folder, frame, '--view', 'material'));
    assert(inside.length > 0.2 * SIZE * SIZE, `${inside.length} pixels of skin`);
    const actual = await drawn(poses[i], weights[i]);
    writeFileSync(join(process.env.FURROW_ARTEFACTS, `three-normals-${frame}.png`), beside(expected, actual));
    const difference = rmse(expected, actual, inside);
    // What the same pose would differ by without wrinkles: the figure above must not hide their absence.
    const without = rmse(expected, await drawn(poses[i], { names: [], values: [] }), inside);
    context.diagnostic(`frame ${frame}: RMSE ${difference.toFixed(2)} of 255 inside the face, ${without.toFixed(2)} without wrinkles`);
    assert(difference <= MAX_RMSE, `frame ${frame}: ${difference}`);
    assert(without > difference + 1, `frame ${frame}: ${without} without wrinkles, ${difference} with them`);
  }
  assert.deepEqual(page.errors.filter((error) => !error.includes('404')), []);
  await page.context().close();
});

test('the example page moves with the performer', async (context) => {
  const config = mkdtempSync(join(tmpdir(), 'furrow-three-'));
  context.after(() => rmSync(config, { recursive: true }));
  const file = join(config, 'furrow.toml');
  writeFileSync(file, `[http]\nallow_origins = ["${server.address}"]\n`);
  const daemon = await Daemon.start(['--no-render', '--config', file, '--play', recording('performance')]);
  context.after(() => daemon.stop());
  const page = await openPage(browser, `${server.address}/example/?daemon=furrow://127.0.0.1:${daemon.ports.http}`);
  await page.locator('canvas').waitFor();
  const picture = async () => PNG.sync.read(await page.screenshot());
  const blank = await picture();
  let first = blank;
  await eventually('the character', async () => changedShare(blank, first = await picture()) > 0.1);
  await eventually('another pose', async () => changedShare(first, await picture()) > 0.01);
  await keep(page, 'three-example');
  assert.deepEqual(page.errors.filter((error) => !error.includes('404')), []);
  await page.context().close();
});
