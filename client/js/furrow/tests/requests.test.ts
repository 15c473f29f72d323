// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { Builder, ByteBuffer } from 'flatbuffers';
import { Error as WireError } from '@wire/error';
import { FrameAck } from '@wire/frame-ack';
import { Hello } from '@wire/hello';
import { Image } from '@wire/image';
import { SubscribePictures } from '@wire/subscribe-pictures';
import { SubscribePoses } from '@wire/subscribe-poses';
import { SubscribeWeights } from '@wire/subscribe-weights';
import { UpdatePictures } from '@wire/update-pictures';
import { Weights } from '@wire/weights';
import { Backoff } from '../src/link/backoff.js';
import { ServerClock } from '../src/link/clock.js';
import { readMessage, writeMessage } from '../src/wire/envelope.js';
import { Malformed } from '../src/wire/flat_table.js';
import { readError, readPicture, readWeights } from '../src/wire/replies.js';
import {
  frameAck, hello, type PictureRequest, subscribePictures, subscribePoses, subscribeWeights, updatePictures,
} from '../src/wire/requests.js';

const REQUEST: PictureRequest = {
  subject: 'demo', width: 1280, height: 720, maxRateHz: 60, view: 'normal', settings: ['shading=skin', 'wrinkles=off'],
  camera: { eye: [0.5, 1.5, 1], target: [0, 1.5, 0], fovDegrees: 24, follows: true },
};

test('the envelope matches STANDARD.md section 2', () => {
  const bytes = writeMessage({ stream: 0x0102, session: 0x1122334455667788n, sequence: 7 }, frameAck(3));
  const head = [0x46, 0x52, 0x52, 0x57, 1, 0, 2, 1, 0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11, 7, 0, 0, 0];
  assert.deepEqual([...bytes.subarray(0, 20)], head);
  const view = new DataView(bytes.buffer);
  assert.equal(view.getUint32(20, true), bytes.length - 32);
  const message = readMessage(bytes);
  assert.equal(message.identifier, 'FACK');
  assert.equal(message.stream, 0x0102);
  assert.equal(message.sequence, 7);
});

test('bytes that are not a message are malformed', () => {
  const good = writeMessage({ stream: 0, session: 1n, sequence: 0 }, frameAck(1));
  for (let length = 0; length < good.length; ++length) {
    assert.throws(() => readMessage(good.slice(0, length)), Malformed, `of ${length} bytes`);
  }
  for (const at of [0, 4, 5, 20]) {
    const bad = good.slice();
    bad[at]! ^= 0xff;
    assert.throws(() => readMessage(bad), Malformed, `byte ${at}`);
  }
});

test('texts keep every character, a byte order mark too', () => {
  const builder = new Builder(64);
  const words = builder.createString('\ufeffada');
  WireError.finishErrorBuffer(builder, WireError.createError(builder, 5, words, 0, 0, 0, 0, false));
  assert.equal(readError(builder.asUint8Array()).message, '\ufeffada');
});

test('an error without a text gets the sentence of its code', () => {
  const builder = new Builder(64);
  WireError.finishErrorBuffer(builder, WireError.createError(builder, 15, 0, 0, 0, 0, 0, false));
  assert.equal(readError(builder.asUint8Array()).message, 'the daemon requires a token');
});

test('requests for weights and poses have all their fields, and wait for their subject', () => {
  const weights = SubscribeWeights.getRootAsSubscribeWeights(new ByteBuffer(
    subscribeWeights({ subject: 'ada', pattern: 'brow_*', maxRateHz: 60, eightBit: true, drivers: true })));
  assert.deepEqual([weights.subject(), weights.pattern(), weights.maxRateHz(), weights.format(), weights.source(), weights.wait()],
    ['ada', 'brow_*', 60, 1, 1, true]);
  const all = SubscribeWeights.getRootAsSubscribeWeights(new ByteBuffer(subscribeWeights({ subject: '' })));
  assert.deepEqual([all.subject(), all.pattern(), all.maxRateHz(), all.format()], ['', null, 0, 0]);
  const poses = SubscribePoses.getRootAsSubscribePoses(new ByteBuffer(subscribePoses({ subject: 'ada', maxRateHz: 30 })));
  assert.deepEqual([poses.subject(), poses.maxRateHz(), poses.wait(), poses.every()], ['ada', 30, true, false]);
  assert.equal(SubscribePoses.getRootAsSubscribePoses(new ByteBuffer(subscribePoses({ subject: '', every: true }))).every(), true);
});

test('the first hello is large enough to prove an address', () => {
  const first = hello('test 1.0', 0n, true);
  assert(32 + first.length >= 256);
  const second = Hello.getRootAsHello(new ByteBuffer(hello('test 1.0', 0xfedcba9876543210n, true)));
  assert.deepEqual([second.client(), second.token(), second.bundles()], ['test 1.0', 0xfedcba9876543210n, true]);
});

test('a picture request has all its fields', () => {
  const wanted = SubscribePictures.getRootAsSubscribePictures(new ByteBuffer(subscribePictures(REQUEST)));
  assert.equal(wanted.subject(), 'demo');
  assert.equal(wanted.wait(), true);
  assert.equal(wanted.acknowledged(), true);
  assert.equal(wanted.cameraFollows(), true);
  assert.deepEqual([wanted.width(), wanted.height(), wanted.maxRateHz(), wanted.view()], [1280, 720, 60, 'normal']);
  assert.deepEqual([0, 1].map((i) => wanted.settings(i)), REQUEST.settings);
  const camera = wanted.camera()!;
  assert.deepEqual([camera.eye()!.x(), camera.eye()!.y(), camera.target()!.y(), camera.verticalFovDegrees()], [0.5, 1.5, 1.5, 24]);
  const update = UpdatePictures.getRootAsUpdatePictures(new ByteBuffer(updatePictures(REQUEST)));
  assert.equal(update.pictures()!.settings(1), 'wrinkles=off');
  assert.equal(wanted.codecsLength(), 0);
  const video = SubscribePictures.getRootAsSubscribePictures(
    new ByteBuffer(subscribePictures({ ...REQUEST, codecs: ['h264'] })));
  assert.deepEqual([video.codecsLength(), video.codecs(0)], [1, 'h264']);
});

test('an acknowledgement tells how long it took and whether a key picture is needed', () => {
  const read = (bytes: Uint8Array): unknown[] => {
    const ack = FrameAck.getRootAsFrameAck(new ByteBuffer(bytes));
    return [ack.number(), ack.needsKey(), ack.heldUs()];
  };
  assert.deepEqual(read(frameAck(12)), [12, false, 0]);
  assert.deepEqual(read(frameAck(13, { needsKey: true, heldUs: 4200.4 })), [13, true, 4200]);
  assert.deepEqual(read(frameAck(14, { heldUs: 1e15 })), [14, false, 0xffffffff]);
});

test('contradictory pictures are refused', () => {
  const payload = (codec: string, key: boolean, still: boolean): Uint8Array => {
    const builder = new Builder(64);
    const bytes = Image.createBytesVector(builder, [0, 0, 1, 0x65]);
    const name = codec === '' ? 0 : builder.createString(codec);
    Image.startImage(builder);
    Image.addWidth(builder, 64);
    Image.addHeight(builder, 64);
    Image.addBytes(builder, bytes);
    Image.addStill(builder, still);
    if (name !== 0) Image.addCodec(builder, name);
    Image.addKey(builder, key);
    Image.finishImageBuffer(builder, Image.endImage(builder));
    return builder.asUint8Array();
  };
  const { codec, key } = readPicture(payload('avc1.42c01f', true, false));
  assert.deepEqual([codec, key], ['avc1.42c01f', true]);
  assert.throws(() => readPicture(payload('', true, false)), Malformed);
  assert.throws(() => readPicture(payload('avc1.42c01f', false, true)), Malformed);
  assert.throws(() => readPicture(payload('a'.repeat(33), true, false)), Malformed);
});

test('a picture is copied out of its message', () => {
  const builder = new Builder(64);
  const bytes = Image.createBytesVector(builder, [9, 8, 7]);
  Image.startImage(builder);
  Image.addWidth(builder, 640);
  Image.addHeight(builder, 480);
  Image.addBytes(builder, bytes);
  Image.addNumber(builder, 12);
  Image.addStill(builder, true);
  Image.addReceivedUs(builder, 5_000_000_000n);
  Image.finishImageBuffer(builder, Image.endImage(builder));
  const payload = builder.asUint8Array();
  const picture = readPicture(payload);
  payload.fill(0);
  assert.deepEqual([...picture.bytes], [9, 8, 7]);
  assert.deepEqual([picture.width, picture.number, picture.still, picture.receivedUs], [640, 12, true, 5e9]);
});

test('weights are read at any alignment', () => {
  const builder = new Builder(64);
  const values = Weights.createValuesVector(builder, [0.25, 1]);
  Weights.startWeights(builder);
  Weights.addNamesHash(builder, 77n);
  Weights.addAgeUs(builder, 5n);
  Weights.addValues(builder, values);
  Weights.finishWeightsBuffer(builder, Weights.endWeights(builder));
  const payload = builder.asUint8Array();
  for (let shift = 0; shift < 4; ++shift) {
    const moved = new Uint8Array(payload.length + shift);
    moved.set(payload, shift);
    const read = readWeights(moved.subarray(shift));
    assert.deepEqual([...read.values], [0.25, 1]);
    assert.equal(read.namesHash, 77n);
  }
});

test('the clock uses the shortest recent round trip', () => {
  const clock = new ServerClock(3);
  assert.equal(clock.offsetUs(), null);
  clock.add(1000, 1200, 51_100); // offset 50,000 in 200
  clock.add(2000, 6000, 59_000); // slow: 55,000 in 4,000
  assert.equal(clock.offsetUs(), 50_000);
  assert.equal(clock.roundTripUs(), 200);
  clock.add(7000, 6000, 0); // received before it was sent
  clock.add(8000, 8400, 68_200); // offset 60,000 in 400
  clock.add(9000, 9400, 69_200);
  assert.equal(clock.offsetUs(), 60_000); // the first measurement is dropped, because clocks drift
});

test('pauses between attempts grow, and stay below a second', () => {
  for (const random of [0, 0.5, 0.999]) {
    const backoff = new Backoff(() => random);
    const pauses = Array.from({ length: 12 }, () => backoff.failed());
    assert(pauses[0]! <= 50 && pauses.at(-1)! <= 800 && pauses.at(-1)! >= 400);
    assert(pauses.every((pause, i) => i === 0 || pause >= pauses[i - 1]!));
    backoff.succeeded();
    assert(backoff.failed() <= 50);
  }
});
