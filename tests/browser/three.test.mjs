// SPDX-License-Identifier: Apache-2.0
// furrow-three in Chromium, which draws in software here: the same normals as `furrow render`, and the example page.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { after, test } from 'node:test';
import { PNG } from 'pngjs';
import { changedShare, eventually, keep, launch, openPage } from './browser.mjs';
import { Daemon, furrowOutput, recording, SHARE } from './daemon.mjs';
import { serveModules } from './module_server.mjs';

const { openWebSocket } = await import(pathToFileURL(join(process.env.FURROW_JS, 'furrow/dist/node.js')).href);

const SIZE = 448;
const RATE_HZ = 30; // of the recording
/** Frames of the performance: raised brows, a frown, a sneer. */
const FRAMES = [60, 195, 270];
const MAX_RMSE = 3; // of 255
/** Pixels at a silhouette show one surface or another, by the rounding of a device. */
const SILHOUETTE = 2;
/** What `--view material` shows for skin. */
const SKIN = [255, 0, 0];

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

/** Root of the mean squared difference over the pixels of `inside`, in steps of 255. */
function rmse(a, b, inside) {
  let sum = 0;
  for (const pixel of inside) {
    for (let c = 0; c < 3; ++c) sum += (a.data[4 * pixel + c] - b.data[4 * pixel + c]) ** 2;
  }
  return Math.sqrt(sum / (3 * inside.length));
}

/** The pixels of the skin that have nothing but skin around them. */
function insideOf(material) {
  const isSkin = (x, y) => SKIN.every((value, c) => material.data[4 * (y * SIZE + x) + c] === value);
  const pixels = [];
  for (let y = SILHOUETTE; y < SIZE - SILHOUETTE; ++y) {
    for (let x = SILHOUETTE; x < SIZE - SILHOUETTE; ++x) {
      let inside = true;
      for (let dy = -SILHOUETTE; dy <= SILHOUETTE && inside; ++dy) {
        for (let dx = -SILHOUETTE; dx <= SILHOUETTE && inside; ++dx) inside = isSkin(x + dx, y + dy);
      }
      if (inside) pixels.push(y * SIZE + x);
    }
  }
  return pixels;
}

/** What `furrow render` draws of a frame. */
async function rendered(folder, frame, ...options) {
  await furrowOutput('render', recording('performance'), '--frames', String(frame), '--size', `${SIZE}x${SIZE}`, '--out', folder, ...options);
  return PNG.sync.read(readFileSync(join(folder, `${String(frame).padStart(6, '0')}.png`)));
}

/** A pose as a value that crosses into the page: typed arrays become lists. */
function plain(pose) {
  return JSON.parse(JSON.stringify(pose, (_, value) => ArrayBuffer.isView(value) ? [...value] : typeof value === 'bigint' ? String(value) : value));
}

/** The poses of some frames, as the daemon sends them, and the daemon's camera `face`. */
async function posesOf(frames) {
  const daemon = await Daemon.start(['--play', recording('performance')]);
  const client = openWebSocket(`furrow://127.0.0.1:${daemon.ports.http}`, { poses: true });
  try {
    const { cameras } = await daemon.get('api/cameras');
    const { eye, target, fov_degrees: fovDegrees, follows } = cameras.find(({ name }) => name === 'face');
    const poses = [];
    for (const frame of frames) {
      await daemon.hold((frame + 0.01) / RATE_HZ);
      assert.equal((await daemon.get('api/playback')).frame, frame);
      // Poses that were under way when the recording was held are older than this one.
      const seen = client.pose()?.number ?? 0;
      await new Promise((resolve) => {
        const remove = client.on('pose', ({ number }) => number > seen + 5 && resolve(remove()));
      });
      poses.push(plain(client.pose()));
    }
    return { poses, camera: { eye, target, fovDegrees, follows } };
  } finally {
    client.close();
    await daemon.stop();
  }
}

/** Two pictures beside each other. */
function beside(a, b) {
  const both = new PNG({ width: 2 * SIZE, height: SIZE });
  PNG.bitblt(a, both, 0, 0, SIZE, SIZE, 0, 0);
  PNG.bitblt(b, both, 0, 0, SIZE, SIZE, SIZE, 0);
  return PNG.sync.write(both);
}

test('the normals of the face are those of furrow render', async (context) => {
  const folder = mkdtempSync(join(tmpdir(), 'furrow-three-'));
  context.after(() => rmSync(folder, { recursive: true }));
  const { poses, camera } = await posesOf(FRAMES);
  const csv = (await furrowOutput('solve', recording('performance'), '--rig', join(SHARE, 'default.rig.json'), '--format', 'csv'))
    .trim().split('\n').map((line) => line.split(','));
  const names = csv[0].slice(2);
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
    const values = csv.find(([number]) => Number(number) === frame).slice(2).map(Number);
    const actual = await drawn(poses[i], { names, values });
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
