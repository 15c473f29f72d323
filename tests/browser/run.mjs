// SPDX-License-Identifier: Apache-2.0
// Usage: run.mjs FILE.test.mjs [PATTERN]. Runs one test file, or its tests whose names match the pattern, or prints SKIPPED
// and the reason.
import { spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { join } from 'node:path';
import { EXECUTABLE } from './chosen_browser.mjs';

const here = fileURLToPath(new URL('.', import.meta.url));
const needs = {
  [`the browser ${EXECUTABLE}`]: EXECUTABLE,
  'the packages of tests/browser/package-lock.json': join(here, 'node_modules/playwright-core'),
  'the built page': join(process.env.FURROW_SHARE, 'web/index.html'),
};
for (const [what, path] of Object.entries(needs)) {
  if (existsSync(path)) continue;
  console.log(`SKIPPED: missing ${what} (deploy/install-deps.sh installs what is needed)`);
  process.exit(0);
}
const [, , file, pattern] = process.argv;
const only = pattern === undefined ? [] : ['--test-name-pattern', pattern];
process.exit(spawnSync(process.execPath, ['--test', ...only, file], { stdio: 'inherit' }).status ?? 1);
