// SPDX-License-Identifier: Apache-2.0
// The debug strip: small live pictures of render targets beside the main picture.
import type { PictureRequest } from 'furrow/protocol';
import type { AppState } from '../state/app_state';
import { assignments } from '../state/settings';
import { text } from '../text';
import { button, h, readable, select, setOptions } from '../ui/dom';
import type { Signal } from '../ui/signal';
import { PictureStream } from '../view/picture_stream';
import type { Connection } from '../wire/connection';

const t = text.strip;
const MAX_THUMBNAILS = 6;
const CSS_WIDTH = 144;
const CSS_HEIGHT = 108;
const RATE_HZ = 8;

class Thumbnail {
  readonly element: HTMLElement;
  private readonly canvas: HTMLCanvasElement;
  private readonly enlarge: HTMLButtonElement;
  readonly stream: PictureStream;

  constructor(readonly view: string, connection: Connection, request: PictureRequest,
              onEnlarge: () => void, onRemove: () => void) {
    this.canvas = h('canvas', { width: request.width, height: request.height, 'aria-hidden': 'true' });
    this.enlarge = h('button', { type: 'button', class: 'thumb', onclick: onEnlarge, 'aria-label': t.enlarge(readable(view)) }, this.canvas);
    this.element = h('figure', { 'data-view': view }, this.enlarge,
      h('figcaption', {}, readable(view)),
      button('×', onRemove, { class: 'remove', 'aria-label': t.remove(readable(view)) }));
    this.stream = new PictureStream(connection, request, {
      onPicture: ({ bitmap }) => {
        this.canvas.getContext('2d', { alpha: false })!.drawImage(bitmap, 0, 0, this.canvas.width, this.canvas.height);
        bitmap.close();
      },
      onRefused: () => this.element.classList.add('refused'),
    });
    this.stream.start();
  }

  setEnlarged(on: boolean): void {
    this.enlarge.setAttribute('aria-pressed', String(on));
  }
}

export class DebugStrip {
  readonly element = h('aside', { class: 'strip', 'aria-label': t.group });
  /** The select that adds views. The bar below the picture shows it. */
  readonly adder: HTMLSelectElement;
  private readonly thumbnails = new Map<string, Thumbnail>();

  constructor(private readonly connection: Connection, private readonly state: AppState) {
    this.adder = select(t.add, [], (view) => this.add(view));
    const { strip, settings, camera, subject } = state;
    for (const signal of [strip, settings.changed, camera, subject]) {
      (signal as Signal<unknown>).watch(() => this.refresh());
    }
    this.refresh();
  }

  private add(view: string): void {
    this.adder.value = '';
    if (view === '' || this.state.strip.value.includes(view)) return;
    this.state.strip.set([...this.state.strip.value, view]);
  }

  private remove(view: string): void {
    this.state.strip.set(this.state.strip.value.filter((other) => other !== view));
  }

  private enlarge(view: string): void {
    const { settings } = this.state;
    settings.set('view', settings.value('view') === view ? 'final' : view, performance.now());
  }

  private request(view: string): PictureRequest | null {
    const camera = this.state.camera.value;
    if (camera === null) return null;
    return {
      subject: this.state.subject.value,
      width: CSS_WIDTH * Math.min(2, Math.ceil(devicePixelRatio)),
      height: CSS_HEIGHT * Math.min(2, Math.ceil(devicePixelRatio)),
      maxRateHz: RATE_HZ,
      view,
      camera,
      settings: assignments(this.state.settings.overrides),
    };
  }

  private refresh(): void {
    const choices = this.state.settings.info('view')?.choices ?? [];
    const wanted = this.state.strip.value.filter((view) => choices.includes(view)).slice(0, MAX_THUMBNAILS);
    for (const [view, thumbnail] of this.thumbnails) {
      if (wanted.includes(view)) continue;
      thumbnail.stream.stop();
      thumbnail.element.remove();
      this.thumbnails.delete(view);
    }
    for (const view of wanted) this.refreshOne(view);
    const free = choices.filter((view) => !wanted.includes(view));
    setOptions(this.adder, [['', t.none], ...free.map((view) => [view, readable(view)] as const)]);
    this.adder.disabled = wanted.length >= MAX_THUMBNAILS || choices.length === 0;
    this.element.hidden = wanted.length === 0;
  }

  private refreshOne(view: string): void {
    const request = this.request(view);
    if (request === null) return;
    let thumbnail = this.thumbnails.get(view);
    if (thumbnail === undefined) {
      thumbnail = new Thumbnail(view, this.connection, request, () => this.enlarge(view), () => this.remove(view));
      this.thumbnails.set(view, thumbnail);
      this.element.append(thumbnail.element);
    } else {
      thumbnail.stream.update(request);
    }
    thumbnail.setEnlarged(this.state.settings.value('view') === view);
  }
}
