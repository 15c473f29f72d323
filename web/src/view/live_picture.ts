// SPDX-License-Identifier: Apache-2.0
// A canvas with the live picture of one subject, for places beside the stage.
import type { PictureRequest } from 'furrow/protocol';
import { h } from '../ui/dom';
import { Signal } from '../ui/signal';
import type { Connection } from '../wire/connection';
import { PictureStats, type ShownPicture } from './picture_stats';
import { type Picture, PictureStream } from './picture_stream';

/** A daemon that has refused is asked again after this time. */
const AGAIN_MS = 5000;

export class LivePicture {
  readonly canvas = h('canvas', { 'aria-hidden': 'true' });
  /** False: what is on the canvas, if anything, is not the subject's. */
  readonly hasPicture = new Signal(false);
  private readonly stats = new PictureStats();
  private stream: PictureStream | null = null;
  private againMs = -Infinity;
  private readonly unwatch: () => void;

  constructor(private readonly connection: Connection) {
    this.unwatch = connection.link.watch((link) => link === 'lost' && this.forget());
  }

  /** Ends it; it cannot be used again. */
  close(): void {
    this.end();
    this.unwatch();
  }

  /** Null: no picture is wanted. Called again and again while one is, because the daemon may refuse for a while. */
  request(wanted: PictureRequest | null, nowMs = performance.now()): void {
    if (wanted === null) {
      this.end();
    } else if (this.stream !== null) {
      if (this.stream.view.subject !== wanted.subject) this.forget();
      this.stream.update(wanted);
    } else if (nowMs >= this.againMs) {
      this.stream = new PictureStream(this.connection, wanted, {
        onPicture: (picture) => this.show(picture),
        onRefused: () => {
          this.againMs = performance.now() + AGAIN_MS;
          this.end(); // there is no subscription that an update could change
        },
      });
      this.stream.start();
    }
  }

  /** The pose on the canvas; null: none. */
  picture(): ShownPicture | null {
    return this.stats.picture(this.connection.nowUs(), this.connection.clock.offsetUs());
  }

  /** True while its pose does not move. */
  get isResting(): boolean {
    return this.stats.resting;
  }

  /** True until the picture shows the last change. */
  get isChanging(): boolean {
    return this.stream?.pending.value === true;
  }

  private show(picture: Picture): void {
    const { bitmap, width, height } = picture;
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    this.canvas.getContext('2d', { alpha: false })!.drawImage(bitmap, 0, 0, width, height, 0, 0, width, height);
    bitmap.close();
    this.stats.add(picture, this.connection.nowUs(), this.connection.clock.offsetUs());
    this.hasPicture.set(true);
  }

  private end(): void {
    if (this.stream === null) return;
    this.stream.stop();
    this.stream = null;
    this.forget();
  }

  private forget(): void {
    this.stats.reset();
    this.hasPicture.set(false);
  }
}
