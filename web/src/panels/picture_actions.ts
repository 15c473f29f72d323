// SPDX-License-Identifier: Apache-2.0
// Buttons on the picture: save it, alone or with the page, record it, and fill the screen with it.
import { pagePicture } from '../screenshot/page_picture';
import { text } from '../text';
import { clockText } from '../ui/clock';
import { button, copyPng, h, pngOf, saveBlob } from '../ui/dom';
import { icon } from '../ui/icons';
import type { Toasts } from '../ui/toast';

const FRAMES_HZ = 30;
/** Best first. */
const VIDEO_TYPES = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm'];

/** "furrow-ada-2026-11-27-101502", or without the subject: works as a file name everywhere. */
export function fileStem(date: Date, subject = ''): string {
  const two = (n: number): string => String(n).padStart(2, '0');
  const name = subject === '' ? '' : `${subject.replace(/[^\p{L}\p{N}._-]+/gu, '_')}-`;
  return `furrow-${name}${date.getFullYear()}-${two(date.getMonth() + 1)}-${two(date.getDate())}-` +
    `${two(date.getHours())}${two(date.getMinutes())}${two(date.getSeconds())}`;
}

export class PictureActions {
  readonly element: HTMLElement;
  private readonly record: HTMLButtonElement;
  private readonly fullscreen: HTMLButtonElement;
  private recorder: MediaRecorder | null = null;
  private beganMs = 0;
  private readonly clock = h('span', { class: 'record-clock', hidden: true });

  /** `canvas`: what is on the screen now; null: there is no picture yet. `root`: fills the screen. `caption`: of a picture of the page. */
  constructor(private readonly canvas: () => HTMLCanvasElement | null, private readonly root: HTMLElement, private readonly toasts: Toasts,
              private readonly caption: () => string[]) {
    const t = text.stage;
    const action = (name: Parameters<typeof icon>[0], label: string, run: () => void): HTMLButtonElement => {
      const made = button('', run, { 'aria-label': label, title: label });
      made.append(icon(name));
      return made;
    };
    this.record = action('record', t.record, () => this.toggleRecording());
    this.record.classList.add('record');
    this.fullscreen = action('fullscreen', t.fullscreen, () => this.toggleFullscreen());
    this.fullscreen.hidden = !document.fullscreenEnabled;
    this.element = h('div', { class: 'stage-actions', role: 'group', 'aria-label': t.actions },
      this.clock, action('camera', t.screenshot, () => void this.screenshot()),
      action('page', t.page, () => void this.pageScreenshot()), this.record, this.fullscreen);
    document.addEventListener('fullscreenchange', () =>
      this.fullscreen.setAttribute('aria-pressed', String(document.fullscreenElement !== null)));
  }

  async screenshot(): Promise<void> {
    const canvas = this.canvas();
    const blob = canvas === null ? null : await pngOf(canvas).catch(() => null);
    if (blob === null) {
      this.toasts.say(text.stage.noPicture, 'error');
      return;
    }
    const name = `${fileStem(new Date())}.png`;
    saveBlob(name, blob);
    this.toasts.say(text.stage.saved(name));
  }

  /** Also without a picture: what the page then says helps as well. */
  async pageScreenshot(): Promise<void> {
    this.canvas(); // a picture that this browser draws must be drawn in the same task
    const picture = pagePicture(this.root, this.caption());
    const copied = copyPng(picture); // at once, because browsers allow it just after a click only
    try {
      const name = `${fileStem(new Date(), 'page')}.png`;
      saveBlob(name, await picture);
      this.toasts.say(await copied ? text.stage.savedAndCopied(name) : text.stage.saved(name));
    } catch {
      this.toasts.say(text.stage.cannotDrawPage, 'error');
    }
  }

  toggleFullscreen(): void {
    if (document.fullscreenElement !== null) void document.exitFullscreen();
    else void this.root.requestFullscreen?.().catch(() => undefined);
  }

  toggleRecording(): void {
    if (this.recorder !== null) this.recorder.stop();
    else this.startRecording();
  }

  private startRecording(): void {
    const canvas = this.canvas();
    const type = VIDEO_TYPES.find((candidate) => typeof MediaRecorder === 'function' && MediaRecorder.isTypeSupported(candidate));
    if (canvas === null || type === undefined || typeof canvas.captureStream !== 'function') {
      this.toasts.say(canvas === null ? text.stage.noPicture : text.stage.cannotRecord, 'error');
      return;
    }
    const parts: Blob[] = [];
    const name = `${fileStem(new Date())}.webm`;
    const stream = canvas.captureStream(FRAMES_HZ);
    const recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: 8_000_000 });
    recorder.ondataavailable = ({ data }) => data.size > 0 && parts.push(data);
    recorder.onstop = () => {
      for (const track of stream.getTracks()) track.stop();
      this.recorder = null;
      this.showRecording();
      saveBlob(name, new Blob(parts, { type: 'video/webm' }));
      this.toasts.say(text.stage.saved(name));
    };
    recorder.start(1000); // in parts, so that a long recording does not grow in the encoder
    this.recorder = recorder;
    this.beganMs = performance.now();
    this.showRecording();
  }

  private showRecording(): void {
    const isOn = this.recorder !== null;
    const label = isOn ? text.stage.stop : text.stage.record;
    this.record.classList.toggle('recording', isOn);
    this.record.setAttribute('aria-label', label);
    this.record.title = label;
    this.record.replaceChildren(icon(isOn ? 'stop' : 'record'));
    this.clock.hidden = !isOn;
    if (!isOn) return;
    this.clock.textContent = clockText((performance.now() - this.beganMs) / 1000);
    setTimeout(() => this.showRecording(), 500);
  }
}
