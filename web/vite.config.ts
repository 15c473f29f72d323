// SPDX-License-Identifier: Apache-2.0
// CMake runs this file and passes the folders of the npm packages' sources and builds, and of the built page.
import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

function setting(name: string): string {
  const value = process.env[name];
  if (value === undefined) throw new Error(`${name} is not set: build with CMake (target furrow_web)`);
  return value;
}

export default defineConfig({
  assetsInclude: ['**/*.bfbs'],
  base: './', // relative, because a proxy may serve the page below a path
  cacheDir: `${setting('FURROW_WEB_BUILD')}/vite-cache`,
  resolve: {
    alias: {
      '@wire': `${setting('FURROW_JS_BUILD')}/wire/furrow/protocol/wire`,
      '@take-schemas': setting('FURROW_TAKE_SCHEMAS'),
      '@shaders': `${setting('FURROW_JS_BUILD')}/shaders.ts`,
      'furrow/protocol': `${setting('FURROW_JS_SOURCE')}/furrow/src/protocol.ts`,
      'furrow-three/settings': `${setting('FURROW_JS_SOURCE')}/furrow-three/src/settings.ts`,
      'furrow-three': `${setting('FURROW_JS_SOURCE')}/furrow-three/src/index.ts`,
      'three/addons': `${setting('FURROW_JS_SOURCE')}/node_modules/three/examples/jsm`,
      three: `${setting('FURROW_JS_SOURCE')}/node_modules/three/build/three.module.js`,
      flatbuffers: fileURLToPath(new URL('./node_modules/flatbuffers/mjs/flatbuffers.js', import.meta.url)),
    },
  },
  build: {
    outDir: setting('FURROW_WEB_OUT'),
    emptyOutDir: true,
    modulePreload: { polyfill: false },
    target: 'es2022',
    chunkSizeWarningLimit: 1000, // three.js, which is loaded only if this browser draws
    assetsInlineLimit: 0,
  },
});
