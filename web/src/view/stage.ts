// SPDX-License-Identifier: Apache-2.0
// The picture on the screen, or two pictures with a draggable divider.
import { text } from '../text';
import { h } from '../ui/dom';
import type { Picture } from './picture_stream';

export type Side = 'right' | 'left';

/** What a side shows. */
type Shown = Pick<Picture, 'bitmap' | 'width' | 'height'>;

/** Shown while a change takes longer than this, so that quick changes do not flicker. */
const BUSY_MS = 250;

export class Stage {
  readonly canvas = h('canvas', { class: 'picture', 'aria-hidden': 'true' });
  private readonly divider = h('div', { class: 'divider' });
  private readonly labels = { left: h('span', { class: 'wipe-label left' }), right: h('span', { class: 'wipe-label right' }) };
  private readonly slider = h('input', {
    type: 'range', min: 0, max: 1000, value: 500, class: 'wipe-slider', 'aria-label': text.stage.divider,
  });
  private readonly wipe = h('div', { class: 'wipe', hidden: true }, this.divider, this.labels.left, this.labels.right, this.slider);
  private readonly busy = h('p', { class: 'busy', hidden: true });
  /** A face in the colours of the picture, until there is one. index.html holds it, so that it is seen at once. */
  private readonly placeholder = document.querySelector('.placeholder') ?? h('div', { class: 'placeholder' });
  /** Receives the keys and pointers for the camera. */
  readonly surface = h('div', { class: 'surface', tabindex: 0, role: 'application', 'aria-label': text.stage.help }, this.canvas);
  readonly element = h('div', { class: 'stage', 'aria-busy': 'true' }, this.placeholder, this.surface, this.wipe, this.busy);
  private readonly shown: Record<Side, Shown | null> = { left: null, right: null };
  private split = false;
  private drawScheduled = false;
  private busyTimer: ReturnType<typeof setTimeout> | null = null;
  /** What the user has just chosen, for the label while it is drawn. */
  private wanted = '';

  constructor() {
    this.slider.addEventListener('input', () => this.place());
    new ResizeObserver(() => this.schedule()).observe(this.surface);
    this.place();
  }

  /** Takes ownership of the bitmap. */
  show(side: Side, picture: Picture): void {
    this.shown[side]?.bitmap.close();
    this.shown[side] = picture;
    this.schedule();
  }

  /** True if there is a picture on the canvas. */
  get hasPicture(): boolean {
    return this.shown.right !== null;
  }

  /** Names what is drawn next. */
  announce(name: string): void {
    this.wanted = name;
  }

  /** `isBusy`: the picture does not show the last change yet. */
  setBusy(isBusy: boolean): void {
    this.element.setAttribute('aria-busy', String(isBusy));
    if (!isBusy) {
      if (this.busyTimer !== null) clearTimeout(this.busyTimer);
      this.busyTimer = null;
      this.busy.hidden = true;
      this.wanted = '';
      return;
    }
    this.busyTimer ??= setTimeout(() => {
      this.busy.textContent = this.wanted === '' ? text.stage.drawing : text.stage.drawingView(this.wanted);
      this.busy.hidden = !this.hasPicture;
    }, BUSY_MS);
  }

  /** Sets the labels of both sides. Null: one picture without a divider. */
  setWipe(labels: { left: string; right: string } | null): void {
    this.split = labels !== null;
    this.wipe.hidden = !this.split;
    if (labels !== null) {
      this.labels.left.textContent = labels.left;
      this.labels.right.textContent = labels.right;
    } else {
      this.shown.left?.bitmap.close();
      this.shown.left = null;
    }
    this.schedule();
  }

  setDimmed(dimmed: boolean): void {
    this.element.classList.toggle('dimmed', dimmed);
  }

  private place(): void {
    const share = Number(this.slider.value) / 1000;
    this.wipe.style.setProperty('--split', String(share));
    this.slider.setAttribute('aria-valuetext', `${Math.round(share * 100)} %`);
    this.schedule();
  }

  private schedule(): void {
    if (this.drawScheduled) return;
    this.drawScheduled = true;
    requestAnimationFrame(() => {
      this.drawScheduled = false;
      this.draw();
    });
  }

  private draw(): void {
    const { clientWidth, clientHeight } = this.surface;
    const width = Math.max(1, Math.round(clientWidth * devicePixelRatio));
    const height = Math.max(1, Math.round(clientHeight * devicePixelRatio));
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    const { left, right } = this.shown;
    this.element.classList.toggle('has-picture', right !== null);
    if (right === null) return; // the canvas stays transparent above the placeholder
    const context = this.canvas.getContext('2d')!;
    context.imageSmoothingQuality = 'high';
    cover(context, right);
    if (!this.split || left === null) return;
    context.save();
    context.beginPath();
    context.rect(0, 0, (width * Number(this.slider.value)) / 1000, height);
    context.clip();
    cover(context, left);
    context.restore();
  }
}

/** Fills the canvas. Crops a picture of another aspect ratio, such as just after a resize, to its middle. */
function cover(context: CanvasRenderingContext2D, shown: Shown): void {
  const { width, height } = context.canvas;
  const scale = Math.max(width / shown.width, height / shown.height);
  const w = shown.width * scale;
  const h2 = shown.height * scale;
  context.drawImage(shown.bitmap, 0, 0, shown.width, shown.height, (width - w) / 2, (height - h2) / 2, w, h2);
}
