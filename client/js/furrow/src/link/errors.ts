// SPDX-License-Identifier: Apache-2.0

export type FurrowErrorCode = 'invalid-address' | 'unsupported' | 'invalid-argument';

/** Wrong use of the library. Networks and daemons never cause it: their errors arrive as events. */
export class FurrowError extends Error {
  constructor(readonly code: FurrowErrorCode, message: string) {
    super(message);
    this.name = 'FurrowError';
  }
}
