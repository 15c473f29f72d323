// SPDX-License-Identifier: Apache-2.0
import type { SettingInfo } from '../src/api';

const base = { unit: '', help: '', min: null, max: null };

/** One setting of each kind, as GET /api/settings gives them. */
export function someSettings(): SettingInfo[] {
  return [
    { ...base, name: 'view', group: 'picture', kind: 'choice', choices: ['final', 'normal'], default: 'final', value: 'final' },
    { ...base, name: 'wrinkles', group: 'picture', kind: 'bool', default: 'on', value: 'on' },
    { ...base, name: 'background', group: 'picture', kind: 'colour', default: '0.1,0.1,0.1', value: '0.1,0.1,0.1' },
    { ...base, name: 'shadow.softness_mm', group: 'shadow', unit: 'mm', kind: 'number', min: 0, max: 50, default: '3', value: '3' },
    { ...base, name: 'shadow.taps', group: 'shadow', kind: 'int', min: 1, max: 32, default: '8', value: '8' },
    { ...base, name: 'strip.views', group: 'strip', kind: 'list', choices: ['final', 'normal'], default: '', value: '' },
  ];
}
