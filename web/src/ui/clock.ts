// SPDX-License-Identifier: Apache-2.0

/** "1:05" for 65.9 s, or "1:05.9" with one digit. Never ahead of the time. */
export function clockText(seconds: number, digits = 0): string {
  const scale = 10 ** digits;
  const units = Math.floor(seconds * scale + 1e-6); // 0.3 * 10 is 2.9999999999999996
  const minutes = Math.floor(units / (60 * scale));
  const rest = (units - minutes * 60 * scale) / scale;
  return `${minutes}:${rest.toFixed(digits).padStart(digits === 0 ? 2 : 3 + digits, '0')}`;
}
