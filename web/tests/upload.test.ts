// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { refusalOf } from '../src/panels/upload';

const STATUS = { max_upload_bytes: 64_000_000, may: { publish: false, watch: true, direct: true, operate: false } };

test('a file that the daemon takes is not refused', () => {
  assert.equal(refusalOf([{ size: 0 }], false, STATUS), '');
  assert.equal(refusalOf([{ size: 64_000_000 }], false, STATUS), '');
});

test('each refusal says what to do', () => {
  assert.match(refusalOf([{ size: 64_000_001 }], false, STATUS), /65 MB.*takes 64 MB/);
  assert.match(refusalOf([], false, STATUS), /one recording/);
  assert.match(refusalOf([{ size: 1 }, { size: 1 }], false, STATUS), /one recording/);
  assert.match(refusalOf([{ size: 1 }], true, STATUS), /folder/);
  assert.match(refusalOf([{ size: 1 }], false, { ...STATUS, max_upload_bytes: 0 }), /takes no recordings/);
  assert.match(refusalOf([{ size: 1 }], false, { ...STATUS, may: { ...STATUS.may, direct: false } }), /direct/);
  assert.match(refusalOf([{ size: 1 }], false, null), /does not answer/);
});
