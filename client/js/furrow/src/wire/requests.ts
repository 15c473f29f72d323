// SPDX-License-Identifier: Apache-2.0
// The messages that a client sends. Only this file uses FlatBuffers' generated code.
import { Builder } from 'flatbuffers';
import { Camera as WireCamera } from '@wire/camera';
import { FrameAck } from '@wire/frame-ack';
import { Hello } from '@wire/hello';
import { Ping } from '@wire/ping';
import { Pong } from '@wire/pong';
import { SubscribePictures } from '@wire/subscribe-pictures';
import { SubscribePoses } from '@wire/subscribe-poses';
import { SubscribeWeights } from '@wire/subscribe-weights';
import { Unsubscribe } from '@wire/unsubscribe';
import { UpdatePictures } from '@wire/update-pictures';

/** In metres in the character's model space, degrees. */
export interface PictureCamera {
  eye: readonly [number, number, number];
  target: readonly [number, number, number];
  fovDegrees: number;
  /** Goes with the subject, as presets do. */
  follows: boolean;
}

/** A viewer's request: the content of FSUP and FUPP. */
export interface PictureRequest {
  /** Empty: the oldest live subject. */
  subject: string;
  width: number;
  height: number;
  /** 0: every pose. */
  maxRateHz: number;
  view: string;
  camera: PictureCamera;
  /** "name=value", override the daemon's settings. */
  settings: string[];
  /** The video codecs that the caller decodes, 'h264'. Default: none, so every picture is a file. */
  codecs?: readonly string[];
}

/** What a viewer says about the picture that it acknowledges. */
export interface AckDetails {
  /** The pictures that follow cannot be decoded until one has `key`. */
  needsKey?: boolean;
  /** Time between the arrival of the picture and this message. */
  heldUs?: number;
}

/** The content of FSUW. All subscriptions of this library wait for their subject. */
export interface WeightsRequest {
  /** Empty: the oldest live subject. */
  subject: string;
  /** Comma-separated globs; empty: all. */
  pattern?: string;
  /** 0: every pose. */
  maxRateHz?: number;
  /** A quarter of the bytes; the error is at most 1/510. */
  eightBit?: boolean;
  /** Driver values, before modulation and filter, instead of wrinkle weights. */
  drivers?: boolean;
}

/** The content of FSPO. */
export interface PosesRequest {
  subject: string;
  maxRateHz?: number;
  /** For recorders over streams: poses queue instead of being replaced by newer ones. See readDropped(). */
  every?: boolean;
}

const HELLO_PADDING_BYTES = 224; // a Hello without a token has at least 256 bytes (section 4)

/** `token` 0n: the first step. `bundles`: UDP only. `access`: a connect token as text, TCP only. */
export function hello(client: string, token: bigint, bundles: boolean, access = ''): Uint8Array {
  const builder = new Builder(1024);
  const name = builder.createString(client);
  const shown = access === '' ? 0 : builder.createString(access);
  const padding = token === 0n ? Hello.createPaddingVector(builder, new Uint8Array(HELLO_PADDING_BYTES)) : 0;
  Hello.startHello(builder);
  Hello.addClient(builder, name);
  Hello.addToken(builder, token);
  if (padding !== 0) Hello.addPadding(builder, padding);
  Hello.addBundles(builder, bundles);
  if (shown !== 0) Hello.addAccess(builder, shown);
  Hello.finishHelloBuffer(builder, Hello.endHello(builder));
  return builder.asUint8Array();
}

function writePictures(builder: Builder, request: PictureRequest): number {
  const subject = builder.createString(request.subject);
  const view = builder.createString(request.view);
  const settings = SubscribePictures.createSettingsVector(
    builder,
    request.settings.map((setting) => builder.createString(setting)),
  );
  const { codecs } = request;
  const names = codecs && codecs.length > 0
    ? SubscribePictures.createCodecsVector(builder, codecs.map((codec) => builder.createString(codec)))
    : 0;
  SubscribePictures.startSubscribePictures(builder);
  SubscribePictures.addSubject(builder, subject);
  SubscribePictures.addWait(builder, true);
  SubscribePictures.addWidth(builder, request.width);
  SubscribePictures.addHeight(builder, request.height);
  SubscribePictures.addMaxRateHz(builder, request.maxRateHz);
  SubscribePictures.addView(builder, view);
  const { eye, target, fovDegrees, follows } = request.camera;
  SubscribePictures.addCamera(builder, WireCamera.createCamera(builder, ...eye, ...target, fovDegrees));
  SubscribePictures.addAcknowledged(builder, true);
  SubscribePictures.addSettings(builder, settings);
  SubscribePictures.addCameraFollows(builder, follows);
  if (names !== 0) SubscribePictures.addCodecs(builder, names);
  return SubscribePictures.endSubscribePictures(builder);
}

export function subscribePictures(request: PictureRequest): Uint8Array {
  const builder = new Builder(512);
  SubscribePictures.finishSubscribePicturesBuffer(builder, writePictures(builder, request));
  return builder.asUint8Array();
}

export function updatePictures(request: PictureRequest): Uint8Array {
  const builder = new Builder(512);
  const pictures = writePictures(builder, request);
  UpdatePictures.startUpdatePictures(builder);
  UpdatePictures.addPictures(builder, pictures);
  UpdatePictures.finishUpdatePicturesBuffer(builder, UpdatePictures.endUpdatePictures(builder));
  return builder.asUint8Array();
}

export function subscribeWeights(request: WeightsRequest): Uint8Array {
  const builder = new Builder(128);
  const subject = builder.createString(request.subject);
  const pattern = request.pattern ? builder.createString(request.pattern) : 0;
  SubscribeWeights.startSubscribeWeights(builder);
  SubscribeWeights.addSubject(builder, subject);
  SubscribeWeights.addWait(builder, true);
  if (pattern !== 0) SubscribeWeights.addPattern(builder, pattern);
  SubscribeWeights.addMaxRateHz(builder, request.maxRateHz ?? 0);
  SubscribeWeights.addFormat(builder, request.eightBit ? 1 : 0);
  SubscribeWeights.addSource(builder, request.drivers ? 1 : 0);
  SubscribeWeights.finishSubscribeWeightsBuffer(builder, SubscribeWeights.endSubscribeWeights(builder));
  return builder.asUint8Array();
}

export function subscribePoses(request: PosesRequest): Uint8Array {
  const builder = new Builder(128);
  const subject = builder.createString(request.subject);
  SubscribePoses.startSubscribePoses(builder);
  SubscribePoses.addSubject(builder, subject);
  SubscribePoses.addWait(builder, true);
  SubscribePoses.addMaxRateHz(builder, request.maxRateHz ?? 0);
  SubscribePoses.addEvery(builder, request.every ?? false);
  SubscribePoses.finishSubscribePosesBuffer(builder, SubscribePoses.endSubscribePoses(builder));
  return builder.asUint8Array();
}

export function unsubscribe(): Uint8Array {
  const builder = new Builder(32);
  Unsubscribe.startUnsubscribe(builder);
  Unsubscribe.finishUnsubscribeBuffer(builder, Unsubscribe.endUnsubscribe(builder));
  return builder.asUint8Array();
}

const MAX_U32 = 0xffffffff;

export function frameAck(number: number, details: AckDetails = {}): Uint8Array {
  const builder = new Builder(32);
  const heldUs = Math.min(MAX_U32, Math.max(0, Math.round(details.heldUs ?? 0)));
  FrameAck.finishFrameAckBuffer(builder, FrameAck.createFrameAck(builder, number, details.needsKey ?? false, heldUs));
  return builder.asUint8Array();
}

/** The answer to a Ping of the daemon with this time. */
export function pong(timeUs: bigint): Uint8Array {
  const builder = new Builder(64);
  Pong.finishPongBuffer(builder, Pong.createPong(builder, timeUs, 0n));
  return builder.asUint8Array();
}

/** `timeUs`: on the client's clock. */
export function ping(timeUs: number): Uint8Array {
  const builder = new Builder(32);
  Ping.finishPingBuffer(builder, Ping.createPing(builder, BigInt(Math.round(timeUs))));
  return builder.asUint8Array();
}
