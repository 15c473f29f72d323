// SPDX-License-Identifier: Apache-2.0
// The choice of the stream, and the decoder with a fake one.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Builder, ByteBuffer } from 'flatbuffers';
import { FrameAck } from '@wire/frame-ack';
import { Image } from '@wire/image';
import type { PictureMessage, PictureRequest, Subscriber } from 'furrow/protocol';
import { Signal } from '../src/ui/signal';
import { type Picture, PictureStream } from '../src/view/picture_stream';
import { type StreamKind, VideoChoice, type VideoSituation, whyNoVideo } from '../src/view/video_choice';
import { type VideoFailure, VideoReader } from '../src/view/video_reader';
import type { Connection } from '../src/wire/connection';

const GOOD: VideoSituation = { kind: 'auto', isSecure: true, hasDecoder: true, isSupported: true, failure: '' };

test('the page asks for video where it can', () => {
  assert.equal(whyNoVideo(GOOD), '');
  assert.equal(whyNoVideo({ ...GOOD, kind: 'h264' }), '');
  for (const change of [{ kind: 'jpeg' as const }, { isSecure: false }, { hasDecoder: false }, { isSupported: false }, { failure: 'late' }]) {
    assert.notEqual(whyNoVideo({ ...GOOD, ...change }), '', JSON.stringify(change));
  }
  assert.match(whyNoVideo({ ...GOOD, isSecure: false, hasDecoder: false }), /HTTPS/);
});

interface FakeChunk {
  type: string;
  timestamp: number;
}
interface FakeFrame {
  timestamp: number;
  close(): void;
}

/** Shows each picture at once, unless `keeps`. */
class FakeDecoder {
  static all: FakeDecoder[] = [];
  static keeps = false;
  static isSupported = true;
  state = 'unconfigured';
  readonly codecs: string[] = [];
  readonly chunks: string[] = [];
  numClosed = 0;
  constructor(readonly init: { output: (frame: FakeFrame) => void; error: (error: Error) => void }) {
    FakeDecoder.all.push(this);
  }
  static isConfigSupported(): Promise<{ supported: boolean }> {
    return Promise.resolve({ supported: FakeDecoder.isSupported });
  }
  configure({ codec }: { codec: string }): void {
    if (codec === 'bad') throw new TypeError('no such codec');
    this.state = 'configured';
    this.codecs.push(codec);
  }
  decode({ type, timestamp }: FakeChunk): void {
    if (this.chunks.length === 0) assert.equal(type, 'key');
    this.chunks.push(`${type} ${timestamp}`);
    if (!FakeDecoder.keeps) this.init.output({ timestamp, close: () => ++this.numClosed });
  }
  close(): void {
    this.state = 'closed';
  }
}

function install(): void {
  FakeDecoder.all = [];
  FakeDecoder.keeps = false;
  FakeDecoder.isSupported = true;
  Object.assign(globalThis, {
    VideoDecoder: FakeDecoder,
    EncodedVideoChunk: class {
      constructor(init: FakeChunk) {
        Object.assign(this, init);
      }
    },
    document: { hidden: false },
    createImageBitmap: () => Promise.resolve({ close: () => {} }),
    isSecureContext: true,
  });
}

const settled = (): Promise<void> => new Promise((resolve) => setTimeout(resolve, 0));

const picture = (number: number, key: boolean, codec = 'avc1.42c01e'): PictureMessage =>
  ({ number, key, codec, bytes: new Uint8Array([0, 0, 1]) }) as unknown as PictureMessage;

function reader(failures: VideoFailure[]): VideoReader {
  return new VideoReader({ onFailed: (failure) => failures.push(failure), isImpatient: () => true });
}

test('one picture in, one out', async () => {
  install();
  const video = reader([]);
  for (let number = 1; number < 5; ++number) {
    assert.equal((await video.decode(picture(number, number === 1)))!.timestamp, number);
  }
  assert.deepEqual(FakeDecoder.all[0]!.codecs, ['avc1.42c01e']);
  await video.decode(picture(5, true)); // of the same codec
  await video.decode(picture(6, true, 'avc1.42c01f'));
  assert.deepEqual(FakeDecoder.all[0]!.codecs, ['avc1.42c01e', 'avc1.42c01f']);
  assert.equal(FakeDecoder.all.length, 1);
  video.close();
  assert.equal(FakeDecoder.all[0]!.state, 'closed');
  assert.equal(await video.decode(picture(7, true)), null);
});

test('a decoder that fails is reported once', async () => {
  install();
  const failures: VideoFailure[] = [];
  const video = reader(failures);
  assert.equal(await video.decode(picture(1, true, 'bad')), null);
  assert.equal(await video.decode(picture(2, true)), null);
  assert.deepEqual(failures, ['broken']);

  const other = reader(failures);
  FakeDecoder.keeps = true;
  const waiting = other.decode(picture(1, true));
  FakeDecoder.all.at(-1)!.init.error(new Error('broken'));
  assert.equal(await waiting, null);
  assert.deepEqual(failures, ['broken', 'broken']);
});

test('a decoder that worked and was taken away is lost, not broken', async () => {
  install();
  const failures: VideoFailure[] = [];
  const video = reader(failures);
  for (let number = 1; number <= 40; ++number) await video.decode(picture(number, number === 1));
  FakeDecoder.all[0]!.init.error(new Error('reclaimed'));
  assert.deepEqual(failures, ['lost']);
});

test('a decoder that the browser takes away at once is lost, too', async () => {
  install();
  const failures: VideoFailure[] = [];
  FakeDecoder.keeps = true;
  const waiting = reader(failures).decode(picture(1, true));
  FakeDecoder.all[0]!.init.error(Object.assign(new Error('reclaimed'), { name: 'QuotaExceededError' }));
  assert.equal(await waiting, null);
  assert.deepEqual(failures, ['lost']);
});

test('a decoder that keeps two pictures back is slow', async () => {
  install();
  const timers: (() => void)[] = [];
  const { setTimeout } = globalThis;
  Object.assign(globalThis, { setTimeout: (call: () => void) => timers.push(call) });
  const failures: VideoFailure[] = [];
  const video = reader(failures);
  FakeDecoder.keeps = true;
  const first = video.decode(picture(1, true));
  const second = video.decode(picture(2, false));
  Object.assign(globalThis, { setTimeout });
  assert.equal(timers.length, 2);
  timers[0]!();
  assert.deepEqual(failures, []);
  timers[1]!();
  assert.deepEqual([await first, await second], [null, null]);
  assert.deepEqual(failures, ['slow']);
});

test('a decoder is not late while the page is hidden', async () => {
  install();
  const timers: (() => void)[] = [];
  const { setTimeout } = globalThis;
  Object.assign(globalThis, { setTimeout: (call: () => void) => timers.push(call), document: { hidden: true } });
  const failures: VideoFailure[] = [];
  const video = reader(failures);
  FakeDecoder.keeps = true;
  const pictures = [video.decode(picture(1, true)), video.decode(picture(2, false))];
  for (let i = 0; i < 4; ++i) timers[i]!();
  assert.deepEqual(failures, []);
  assert.equal(timers.length, 6);
  Object.assign(globalThis, { document: { hidden: false } });
  timers[4]!();
  timers[5]!();
  Object.assign(globalThis, { setTimeout });
  assert.deepEqual(await Promise.all(pictures), [null, null]);
  assert.deepEqual(failures, ['slow']);
});

/** A stream with a fake connection, and what it sends and shows. */
function makeStream(failures: VideoFailure[] = []): {
  receive: (number: number, codec: string, key?: boolean) => void; acks: [number, boolean][]; shown: number[]; stream: PictureStream;
} {
  const acks: [number, boolean][] = [];
  const shown: number[] = [];
  let subscriber: Subscriber | null = null;
  const connection = {
    subscribe: (given: Subscriber) => {
      subscriber = given;
      given.request();
      return {
        send: (payload: Uint8Array) => {
          const ack = FrameAck.getRootAsFrameAck(new ByteBuffer(payload));
          acks.push([ack.number(), ack.needsKey()]);
          return 1;
        },
        close: () => {},
      };
    },
  } as unknown as Connection;
  const request: PictureRequest = {
    subject: '', width: 64, height: 64, maxRateHz: 0, view: 'final', settings: [], codecs: ['h264'],
    camera: { eye: [0, 0, 1], target: [0, 0, 0], fovDegrees: 30, follows: true },
  };
  const stream = new PictureStream(connection, request, {
    onPicture: ({ number, bitmap }: Picture) => {
      shown.push(number);
      bitmap.close();
    },
    onRefused: () => {},
    video: { onFailed: (failure) => failures.push(failure), isImpatient: () => true },
  });
  stream.start();
  const receive = (number: number, codec: string, key = false): void => {
    const builder = new Builder(64);
    const bytes = Image.createBytesVector(builder, [0, 0, 1]);
    const name = codec === '' ? 0 : builder.createString(codec);
    Image.startImage(builder);
    Image.addWidth(builder, 64);
    Image.addHeight(builder, 64);
    Image.addBytes(builder, bytes);
    Image.addNumber(builder, number);
    if (name !== 0) Image.addCodec(builder, name);
    Image.addKey(builder, key);
    Image.finishImageBuffer(builder, Image.endImage(builder));
    subscriber!.onMessage({ identifier: 'FIMG', sequence: number, payload: builder.asUint8Array() } as never);
  };
  return { receive, acks, shown, stream };
}

test('files and pictures of a video alternate', async () => {
  install();
  const { receive, acks, shown } = makeStream();
  receive(1, 'avc1.42c01e', true);
  await settled();
  receive(2, '');
  await settled();
  receive(3, 'avc1.42c01e');
  await settled();
  assert.deepEqual(shown, [1, 2, 3]);
  assert.deepEqual(acks, [[1, false], [2, false], [3, false]]);
});

test('after a lost picture, nothing is decoded before a key picture', async () => {
  install();
  const { receive, acks, shown } = makeStream();
  receive(1, 'avc1.42c01e', true);
  await settled();
  receive(3, 'avc1.42c01e');
  await settled();
  receive(4, ''); // a file is shown all the same
  await settled();
  receive(5, 'avc1.42c01e');
  await settled();
  receive(6, 'avc1.42c01e', true);
  await settled();
  receive(7, 'avc1.42c01e');
  await settled();
  assert.deepEqual(shown, [1, 4, 6, 7]);
  assert.deepEqual(acks.map(([, needsKey]) => needsKey), [false, true, true, true, false, false]);
  assert.deepEqual(FakeDecoder.all[0]!.chunks, ['key 1', 'key 6', 'delta 7']);
});

test('a lost decoder is replaced, a broken one reported', async () => {
  install();
  const failures: VideoFailure[] = [];
  const { receive, acks, shown, stream } = makeStream(failures);
  for (let number = 1; number <= 40; ++number) {
    receive(number, 'avc1.42c01e', number === 1);
    await settled();
  }
  FakeDecoder.all[0]!.init.error(new Error('reclaimed'));
  receive(41, 'avc1.42c01e');
  await settled();
  assert.deepEqual(acks.at(-1), [41, true]);
  receive(42, 'avc1.42c01e', true);
  await settled();
  assert.equal(shown.at(-1), 42);
  assert.deepEqual(failures, []);
  FakeDecoder.all[1]!.init.error(new Error('again'));
  assert.deepEqual(failures, ['broken']);
  stream.stop();
});

test('a browser that takes every decoder away is given up', async () => {
  install();
  const failures: VideoFailure[] = [];
  const { receive, stream } = makeStream(failures);
  for (let number = 1; number <= 3; ++number) {
    assert.deepEqual(failures, []);
    receive(number, 'avc1.42c01e', true);
    await settled();
    FakeDecoder.all.at(-1)!.init.error(Object.assign(new Error('reclaimed'), { name: 'QuotaExceededError' }));
  }
  assert.equal(FakeDecoder.all.length, 3);
  assert.deepEqual(failures, ['broken']);
  stream.stop();
});

test('the choice follows the user, the browser and the decoder', async () => {
  install();
  const kind = new Signal<StreamKind>('auto');
  const choice = new VideoChoice(kind);
  assert.deepEqual(choice.codecs.value, ['h264']); // until the browser answers
  await settled();
  assert.deepEqual(choice.codecs.value, ['h264']);
  choice.fail('it was late');
  assert.deepEqual([choice.codecs.value, choice.why], [[], 'it was late']);
  choice.retry();
  assert.deepEqual([choice.codecs.value, choice.why], [['h264'], '']);
  choice.fail('it was late');
  kind.set('h264'); // try again
  assert.deepEqual(choice.codecs.value, ['h264']);
  assert.equal(choice.isImpatient, false);
  kind.set('jpeg');
  assert.deepEqual(choice.codecs.value, []);
  FakeDecoder.isSupported = false;
  const other = new VideoChoice(new Signal<StreamKind>('auto'));
  await settled();
  assert.deepEqual(other.codecs.value, []);
  assert.match(other.why, /H\.264/);
});

test('without a decoder the page asks for JPEG and says why', () => {
  install();
  Reflect.deleteProperty(globalThis, 'VideoDecoder');
  assert.match(new VideoChoice(new Signal<StreamKind>('auto')).why, /no video decoder/);
  Object.assign(globalThis, { isSecureContext: false });
  assert.match(new VideoChoice(new Signal<StreamKind>('auto')).why, /HTTPS/);
});
