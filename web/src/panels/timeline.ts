// SPDX-License-Identifier: Apache-2.0
// Controls the recording that the daemon plays: play, pause, scrub, loop, speed, and the end of an
// uploaded one. Hidden if the daemon plays none.
import { api, ApiError, type Playback, wordsOf } from '../api';
import { text } from '../text';
import { clockText } from '../ui/clock';
import { button, h, select } from '../ui/dom';
import type { Toasts } from '../ui/toast';

const t = text.timeline;
const POLL_MS = 500;
const SCRUB_MS = 60;
const SPEEDS = ['0.1', '0.25', '0.5', '1', '2', '4'];

/** The position in the recording `elapsedS` after the daemon's reply, in [0, seconds]. */
export function positionAfter(playback: Playback, elapsedS: number): number {
  if (!playback.playing) return playback.position_s;
  const position = playback.position_s + elapsedS * playback.speed;
  if (position <= playback.seconds) return position;
  return playback.loop && playback.seconds > 0 ? position % playback.seconds : playback.seconds;
}

export class Timeline {
  readonly element: HTMLElement;
  private readonly play: HTMLButtonElement;
  private readonly scrub = h('input', { type: 'range', min: 0, max: 1, step: 0.001, value: 0, 'aria-label': t.position });
  private readonly position = h('span', {});
  private readonly duration = h('span', { class: 'duration' });
  private readonly time = h('output', { class: 'time' }, this.position, this.duration);
  private readonly loop = h('input', { type: 'checkbox' });
  private readonly speed: HTMLSelectElement;
  private readonly name = h('span', { class: 'file' });
  private readonly close: HTMLButtonElement;
  private state: Playback | null = null;
  private available = false;
  private askedMs = 0;
  /** Whether the daemon has answered the last question. Without an answer, nobody knows the position. */
  private isKnown = false;
  private scrubbing = false;
  private lastScrubMs = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** `close`: ends an uploaded recording. `onUploaded`: says whether the recording is one. */
  constructor(private readonly toasts: Toasts, close: () => void, private readonly onUploaded: (isUploaded: boolean) => void) {
    this.close = button('×', close, { class: 'small', 'aria-label': text.upload.close, title: text.upload.closeTitle, hidden: true });
    this.play = button(t.play, () => this.toggle(), { class: 'play', title: t.playTitle });
    this.speed = select(t.speed, SPEEDS.map((s) => [s, `${s}×`] as const), (value) => void this.patch({ speed: Number(value) }));
    this.speed.value = '1';
    this.loop.addEventListener('change', () => void this.patch({ loop: this.loop.checked }));
    this.scrub.addEventListener('input', () => this.onScrub());
    this.scrub.addEventListener('change', () => {
      this.scrubbing = false;
      void this.patch({ position_s: Number(this.scrub.value) });
    });
    this.element = h('section', { class: 'timeline', 'aria-label': t.group, hidden: true },
      this.play, this.scrub, this.time, h('label', { class: 'check' }, this.loop, t.loop), this.speed, this.name, this.close);
    this.tick();
  }

  /** The subject of a recording that is paused; empty: none is. */
  get pausedSubject(): string {
    return this.state !== null && !this.state.playing ? this.state.subject : '';
  }

  toggle(): void {
    if (this.state !== null) void this.patch({ playing: !this.state.playing });
  }

  /** States whether the daemon plays a recording, as reported in its status. */
  setAvailable(available: boolean): void {
    if (available === this.available) return;
    this.available = available;
    if (available) void this.poll();
    else this.show(null);
  }

  /** Another recording plays; null: ask which, if there is one. */
  onPlayback(playback: Playback | null): void {
    this.available = true;
    if (playback !== null) this.show(playback);
    void this.poll();
  }

  private async poll(): Promise<void> {
    clearTimeout(this.timer);
    if (!this.available) return;
    try {
      if (!document.hidden) {
        const playback = await api.playback();
        if (this.available) this.show(playback); // it may have been closed meanwhile
      }
    } catch (error) {
      this.isKnown = false; // the header reports the state of the connection
      if (error instanceof ApiError && error.status === 409) this.setAvailable(false); // it was closed
    }
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.poll(), POLL_MS);
  }

  private show(playback: Playback | null): void {
    this.state = playback;
    this.isKnown = playback !== null;
    this.askedMs = performance.now();
    this.element.hidden = playback === null;
    this.close.hidden = playback?.uploaded !== true;
    this.onUploaded(playback?.uploaded === true);
    if (playback === null) return;
    this.play.textContent = playback.playing ? t.pause : t.play;
    this.scrub.max = String(playback.seconds);
    this.loop.checked = playback.loop;
    this.name.textContent = playback.file;
    if (document.activeElement !== this.speed) this.speed.value = String(playback.speed);
    this.showPosition();
  }

  private tick(): void {
    if (this.isKnown && this.state?.playing === true) this.showPosition();
    requestAnimationFrame(() => this.tick());
  }

  private showPosition(): void {
    const playback = this.state!;
    const at = this.scrubbing ? Number(this.scrub.value) : positionAfter(playback, (performance.now() - this.askedMs) / 1000);
    if (!this.scrubbing) this.scrub.value = String(at);
    const [position, duration] = [clockText(at, 1), ` / ${clockText(playback.seconds, 1)}`];
    if (this.position.textContent === position && this.duration.textContent === duration) return;
    this.position.textContent = position;
    this.duration.textContent = duration;
    this.scrub.setAttribute('aria-valuetext', position + duration);
  }

  private onScrub(): void {
    this.scrubbing = true;
    this.showPosition();
    if (performance.now() - this.lastScrubMs < SCRUB_MS) return;
    this.lastScrubMs = performance.now();
    void this.patch({ position_s: Number(this.scrub.value) });
  }

  private async patch(values: Parameters<typeof api.patchPlayback>[0]): Promise<void> {
    try {
      this.show(await api.patchPlayback(values));
    } catch (error) {
      this.toasts.say(wordsOf(error), 'error');
    }
  }
}
