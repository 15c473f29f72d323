// SPDX-License-Identifier: Apache-2.0
// The same moments of a recording, drawn by `furrow render` and in a page, and how far two pictures differ.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { PNG } from 'pngjs';
import { Daemon, furrowOutput, recording, SHARE } from '../daemon.mjs';

const { openWebSocket } = await import(pathToFileURL(join(process.env.FURROW_JS, 'furrow/dist/node.js')).href);

export const SIZE = 448;
const RATE_HZ = 30; // of the recording
/** Frames of the performance: raised brows, a frown, a sneer. */
export const FRAMES = [60, 195, 270];
/** Pixels at a silhouette show one surface or another, by the rounding of a device. */
const SILHOUETTE = 2;
/** What `--view material` shows for skin. */
const SKIN = [255, 0, 0];

/** Root of the mean squared difference over the pixels of `inside`, in steps of 255. */
export function rmse(a, b, inside) {
  let sum = 0;
  for (const pixel of inside) {
    for (let c = 0; c < 3; ++c) sum += (a.data[4 * pixel + c] - b.data[4 * pixel + c]) ** 2;
  }
  return Math.sqrt(sum / (3 * inside.length));
}

/** The pixels of the skin that have nothing but skin around them. */
export function insideOf(material) {
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
export async function rendered(folder, frame, ...options) {
  await furrowOutput('render', recording('performance'), '--frames', String(frame), '--size', `${SIZE}x${SIZE}`, '--out', folder, ...options);
  return PNG.sync.read(readFileSync(join(folder, `${String(frame).padStart(6, '0')}.png`)));
}

/** A pose as a value that crosses into the page: typed arrays become lists. */
function plain(pose) {
  return JSON.parse(JSON.stringify(pose, (_, value) => ArrayBuffer.isView(value) ? [...value] : typeof value === 'bigint' ? String(value) : value));
}

/** The poses of some frames, as the daemon sends them, and the daemon's camera `face`. */
export async function posesOf(frames) {
  const daemon = await Daemon.startAsShipped(['--play', recording('performance')]);
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
export function beside(a, b) {
  const both = new PNG({ width: 2 * SIZE, height: SIZE });
  PNG.bitblt(a, both, 0, 0, SIZE, SIZE, 0, 0);
  PNG.bitblt(b, both, 0, 0, SIZE, SIZE, SIZE, 0);
  return PNG.sync.write(both);
}

/** The wrinkle weights of some frames, as `furrow solve` prints them. */
export async function solved(frames) {
  const csv = (await furrowOutput('solve', recording('performance'), '--rig', join(SHARE, 'default.rig.json'), '--format', 'csv'))
    .trim().split('\n').map((line) => line.split(','));
  const names = csv[0].slice(2);
  return frames.map((frame) => ({ names, values: csv.find(([number]) => Number(number) === frame).slice(2).map(Number) }));
}
