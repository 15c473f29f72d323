#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Measures how long furrow-three takes per picture in Debian's chromium, by shading. Prints a table in Markdown. Needs the
// packages of tests/browser/package-lock.json and an otherwise idle machine.
//
//   frame_times.mjs [BUILD]     BUILD: build folder (default: build/release)
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = join(dirname(fileURLToPath(import.meta.url)), '../..');
const build = resolve(process.argv[2] ?? join(root, 'build/release'));
process.env.FURROW_JS ??= join(build, 'client/js');
process.env.FURROW_SHARE ??= join(build, 'share/furrow');
process.env.FURROW_ARTEFACTS ??= join(build, 'artefacts/bench');
const { launch, openPage } = await import('../../tests/browser/browser.mjs');
const { serveModules } = await import('../../tests/browser/support/module_server.mjs');

const SIZES = [[448, 448], [640, 480], [1280, 720]];
const WAYS = {
  'diffuse': { shading: 'diffuse' },
  'skin': { shading: 'skin' },
  'skin without shadows': { shading: 'skin', 'shadow.filter': 'off' },
  'skin without scattering': { shading: 'skin', 'subsurface.method': 'off' },
  'skin without occlusion': { shading: 'skin', 'occlusion.method': 'off' },
};
/** The first pictures compile shaders and upload textures. */
const [WARM_UP, MEASURED] = [2, 9];
/** The daemon's camera `face`, nearly. */
const PLACE = { eye: [0, 1.636, 0.723], target: [0, 1.636, 0.018], fovDegrees: 24, follows: true };

const PAGE = `<!doctype html><script type="importmap">{"imports": {
  "three": "/node_modules/three/build/three.module.js", "three/addons/": "/node_modules/three/examples/jsm/",
  "furrow-three": "/furrow-three/dist/index.js", "furrow-three/settings": "/furrow-three/dist/settings.js"}}</script>
<script type="module">
  import { PerspectiveCamera, WebGLRenderer } from 'three';
  import { Follower, loadCharacter, StudioView } from 'furrow-three';
  import { readSettings } from 'furrow-three/settings';
  const renderer = new WebGLRenderer({ antialias: true });
  const character = await loadCharacter('/share/default.web.glb', renderer);
  const view = new StudioView(renderer);
  const [camera, follower] = [new PerspectiveCamera(), new Follower(character)];
  window.measure = ({ size: [width, height], settings, place, times }) => {
    renderer.setSize(width, height, false);
    view.settings = readSettings(Object.entries(settings)).settings;
    const gl = renderer.getContext();
    const names = gl.getExtension('WEBGL_debug_renderer_info');
    return { gpu: gl.getParameter(names === null ? gl.RENDERER : names.UNMASKED_RENDERER_WEBGL), ms: Array.from({ length: times }, () => {
      const began = performance.now();
      view.render([character], camera, follower.place(camera, place, width / height));
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits
      return performance.now() - began;
    }) };
  };
</script>`;

const server = await serveModules({ '/times.html': PAGE });
const browser = await launch(['--enable-unsafe-swiftshader']);
const page = await openPage(browser, `${server.address}/times.html`);
await page.waitForFunction(() => window.measure, null, { timeout: 120_000 });
const rows = [];
let gpu = '';
for (const [what, settings] of Object.entries(WAYS)) {
  const cells = [];
  for (const size of SIZES) {
    const measured = await page.evaluate((input) => window.measure(input), { size, settings, place: PLACE, times: WARM_UP + MEASURED });
    gpu = measured.gpu;
    const sorted = measured.ms.slice(WARM_UP).sort((a, b) => a - b);
    cells.push(`${sorted[MEASURED >> 1].toFixed(0)} (${sorted[0].toFixed(0)})`);
  }
  rows.push(`| ${what} | ${cells.join(' | ')} |`);
}
console.log(`Milliseconds per picture (median of ${MEASURED}, and the fastest), ${gpu}:\n`);
console.log(`| shading | ${SIZES.map(([width, height]) => `${width} x ${height}`).join(' | ')} |\n|---|${SIZES.map(() => '---').join('|')}|`);
console.log(rows.join('\n'));
await browser.close();
server.close();
