// SPDX-License-Identifier: Apache-2.0
// The messages that the page sends and receives, as plain objects. Only this file uses FlatBuffers.
import { Builder, ByteBuffer } from 'flatbuffers';
import { Camera as WireCamera } from '@wire/camera';
import { Error as WireError } from '@wire/error';
import { FrameAck } from '@wire/frame-ack';
import { Goodbye } from '@wire/goodbye';
import { Image } from '@wire/image';
import { ImageFormat } from '@wire/image-format';
import { Ping } from '@wire/ping';
import { Pong } from '@wire/pong';
import { SubscribePictures } from '@wire/subscribe-pictures';
import { SubscribeReply } from '@wire/subscribe-reply';
import { SubscribeWeights } from '@wire/subscribe-weights';
import { Unsubscribe } from '@wire/unsubscribe';
import { UpdatePictures } from '@wire/update-pictures';
import { Weights } from '@wire/weights';
import type { Camera } from '../view/camera';

/** A viewer's request: the content of FSUP and FUPP. */
export interface PictureRequest {
  /** Empty: the oldest live subject. */
  subject: string;
  width: number;
  height: number;
  /** 0: every pose. */
  maxRateHz: number;
  view: string;
  camera: Camera;
  /** "name=value", override the daemon's settings. */
  settings: string[];
}

export interface PictureMessage {
  width: number;
  height: number;
  mimeType: string;
  /** A copy, which outlives the message. */
  bytes: Uint8Array<ArrayBuffer>;
  ageUs: number;
  number: number;
  tier: number;
  still: boolean;
  dropped: number;
  /** On the daemon's clock. */
  receivedUs: number;
  /** Sequence of the request that defined the view. */
  viewRequest: number;
}

export interface WeightsMessage {
  namesHash: bigint;
  ageUs: number;
  values: Float32Array;
}

export interface ReplyMessage {
  subject: string;
  namesHash: bigint;
  names: string[];
}

function writePictures(builder: Builder, request: PictureRequest): number {
  const subject = builder.createString(request.subject);
  const view = builder.createString(request.view);
  const settings = SubscribePictures.createSettingsVector(
    builder,
    request.settings.map((setting) => builder.createString(setting)),
  );
  SubscribePictures.startSubscribePictures(builder);
  SubscribePictures.addSubject(builder, subject);
  SubscribePictures.addWait(builder, true);
  SubscribePictures.addWidth(builder, request.width);
  SubscribePictures.addHeight(builder, request.height);
  SubscribePictures.addMaxRateHz(builder, request.maxRateHz);
  SubscribePictures.addView(builder, view);
  const { eye, target, fovDegrees, follows } = request.camera;
  SubscribePictures.addCamera(
    builder,
    WireCamera.createCamera(builder, ...eye, ...target, fovDegrees),
  );
  SubscribePictures.addAcknowledged(builder, true);
  SubscribePictures.addSettings(builder, settings);
  SubscribePictures.addCameraFollows(builder, follows);
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

export function subscribeWeights(subject: string, maxRateHz: number): Uint8Array {
  const builder = new Builder(128);
  const name = builder.createString(subject);
  SubscribeWeights.startSubscribeWeights(builder);
  SubscribeWeights.addSubject(builder, name);
  SubscribeWeights.addWait(builder, true);
  SubscribeWeights.addMaxRateHz(builder, maxRateHz);
  SubscribeWeights.finishSubscribeWeightsBuffer(
    builder,
    SubscribeWeights.endSubscribeWeights(builder),
  );
  return builder.asUint8Array();
}

export function unsubscribe(): Uint8Array {
  const builder = new Builder(32);
  Unsubscribe.startUnsubscribe(builder);
  Unsubscribe.finishUnsubscribeBuffer(builder, Unsubscribe.endUnsubscribe(builder));
  return builder.asUint8Array();
}

export function frameAck(number: number): Uint8Array {
  const builder = new Builder(32);
  FrameAck.finishFrameAckBuffer(builder, FrameAck.createFrameAck(builder, number));
  return builder.asUint8Array();
}

export function ping(timeUs: number): Uint8Array {
  const builder = new Builder(32);
  Ping.finishPingBuffer(builder, Ping.createPing(builder, BigInt(Math.round(timeUs))));
  return builder.asUint8Array();
}

export function readPicture(payload: Uint8Array): PictureMessage {
  const image = Image.getRootAsImage(new ByteBuffer(payload));
  return {
    width: image.width(),
    height: image.height(),
    mimeType: image.format() === ImageFormat.Png ? 'image/png' : 'image/jpeg',
    bytes: new Uint8Array(image.bytesArray() ?? []),
    ageUs: Number(image.ageUs()),
    number: image.number(),
    tier: image.tier(),
    still: image.still(),
    dropped: image.dropped(),
    receivedUs: Number(image.receivedUs()),
    viewRequest: image.viewRequest(),
  };
}

export function readWeights(payload: Uint8Array): WeightsMessage {
  const weights = Weights.getRootAsWeights(new ByteBuffer(payload));
  // Read one by one, because a vector on the wire may not be aligned for a Float32Array.
  const values = new Float32Array(weights.valuesLength());
  for (let i = 0; i < values.length; ++i) values[i] = weights.values(i) ?? 0;
  return { namesHash: weights.namesHash(), ageUs: Number(weights.ageUs()), values };
}

export function readReply(payload: Uint8Array): ReplyMessage {
  const reply = SubscribeReply.getRootAsSubscribeReply(new ByteBuffer(payload));
  const names = Array.from({ length: reply.namesLength() }, (_, i) => String(reply.names(i)));
  return { subject: reply.subject() ?? '', namesHash: reply.namesHash(), names };
}

export function readPong(payload: Uint8Array): { timeUs: number; serverTimeUs: number } {
  const pong = Pong.getRootAsPong(new ByteBuffer(payload));
  return { timeUs: Number(pong.timeUs()), serverTimeUs: Number(pong.serverTimeUs()) };
}

export function readError(payload: Uint8Array): { code: number; message: string } {
  const error = WireError.getRootAsError(new ByteBuffer(payload));
  return { code: error.code(), message: error.message() ?? '' };
}

/** 0 done, 1 subject gone, 2 draining, 3 timed out. */
export function readGoodbye(payload: Uint8Array): number {
  return Goodbye.getRootAsGoodbye(new ByteBuffer(payload)).reason();
}
