// SPDX-License-Identifier: Apache-2.0
// What the statistics of pictures share, whoever draws them.

/** Rates are those of the last two seconds. */
export const WINDOW_S = 2;

/** Drops what is older than that from a list that ascends in time. */
export function dropOld(list: { atS: number }[], nowS: number): void {
  while (list.length > 0 && list[0]!.atS < nowS - WINDOW_S) list.shift();
}

/** Of one value or more; of an even number, the upper one of the two in the middle. */
export function median(values: readonly number[]): number {
  return [...values].sort((a, b) => a - b)[values.length >> 1]!;
}
