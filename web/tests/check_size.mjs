// SPDX-License-Identifier: Apache-2.0
// Measures what a browser loads before the first paint: index.html and the files it names, compressed. At most 300 kB.
// None of them may refer to another host.
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';

const LIMIT = 300_000;
const root = process.argv[2];
const html = readFileSync(join(root, 'index.html'), 'utf8');
const named = [...html.matchAll(/(?:src|href)="([^"]+)"/g)].map(([, path]) => path);
const foreign = named.filter((path) => /^(https?:)?\/\//.test(path));
if (foreign.length > 0) {
  console.error(`index.html names other addresses: ${foreign.join(', ')}`);
  process.exit(1);
}
const files = named.filter((path) => existsSync(join(root, path)));
if (!files.some((path) => path.endsWith('.js')) || !files.some((path) => path.endsWith('.css'))) {
  console.error(`index.html names no script or no style: ${named.join(', ')}`);
  process.exit(1);
}
const bytes = ['index.html', ...files].map((path) => gzipSync(readFileSync(join(root, path))).length);
const total = bytes.reduce((sum, size) => sum + size, 0);
console.log(`first paint: ${total} bytes compressed, limit ${LIMIT}`);
process.exit(total <= LIMIT ? 0 : 1);
