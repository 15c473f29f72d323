// SPDX-License-Identifier: Apache-2.0
// The datagrams of Live Link Face, the face tracker of phones.

const NUM_CURVES = 61;

/** One datagram of version 6, with all curves at 0. `rate`: frames per second, as a fraction. */
export function liveLinkFace(subject, frame, rate = [60, 1]) {
  const text = (words) => Buffer.concat([Buffer.from([0, 0, 0, words.length]), Buffer.from(words)]);
  const rest = Buffer.alloc(17 + 4 * NUM_CURVES);
  rest.writeInt32BE(frame, 0);
  rest.writeInt32BE(rate[0], 8);
  rest.writeInt32BE(rate[1], 12);
  rest.writeUInt8(NUM_CURVES, 16);
  return Buffer.concat([Buffer.from([6]), text('12345678-1234-1234-1234-123456789ABC'), text(subject), rest]);
}
