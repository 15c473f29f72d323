// SPDX-License-Identifier: Apache-2.0
// Records the poses of the subject and saves them as a take: all of them, or those of the time that the curves show.
import { wordsOf } from '../api';
import { PoseRecorder } from '../take/pose_recorder';
import { numMissed, PoseTape, type Reel } from '../take/pose_tape';
import type { takeFile, TakeSchemas } from '../take/take_file';
import { text } from '../text';
import { clockText } from '../ui/clock';
import { button, h, saveBlob } from '../ui/dom';
import { icon } from '../ui/icons';
import type { Toasts } from '../ui/toast';
import type { Connection } from '../wire/connection';
import { fileStem } from './picture_actions';

const t = text.take;
/** Memory that a recording may take. About 14 minutes of 81 joints at 60 poses per second. */
const MOST_BYTES = 96e6;
const TICK_MS = 500;

/** Writes takes. Few visitors need it. */
interface Writer {
  takeFile: typeof takeFile;
  takeSchemas: TakeSchemas;
}

async function loadWriter(): Promise<Writer> {
  const [file, schemas] = await Promise.all([import('../take/take_file'), import('../take/take_schemas')]);
  return { takeFile: file.takeFile, takeSchemas: schemas.takeSchemas };
}

export class TakeBar {
  private readonly record = button('', () => this.toggle(), { class: 'record-take' });
  private readonly clock = h('span', { class: 'take-clock', role: 'timer', title: t.recorded, hidden: true });
  private readonly save: HTMLButtonElement;
  readonly element: HTMLElement;
  private recorder: PoseRecorder | null = null;
  private tape: PoseTape | null = null;
  /** The recording has ended and is not saved as a whole. *Take* tries again. */
  private isUnsaved = false;
  private writer: Promise<Writer> | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** `span`: the time that the curves show, in seconds on the page's clock. `onToggled`: a recording began or ended. */
  constructor(private readonly connection: Connection, private readonly subject: () => string, private readonly span: () => [number, number],
              private readonly onToggled: () => void, private readonly toasts: Toasts) {
    this.save = button(t.save, () => this.onSave(), { disabled: true, title: t.saveTitle });
    this.element = h('div', { class: 'row span-buttons', role: 'group', 'aria-label': t.group }, this.record, this.clock, this.save);
    this.showRecording();
    addEventListener('beforeunload', (event) => {
      if (this.isRecording || this.isUnsaved) event.preventDefault(); // the browser asks the user
    });
  }

  get isRecording(): boolean {
    return this.recorder !== null;
  }

  /** The time of which there are poses of the subject that the curves show; null: there are none. */
  get range(): [number, number] | null {
    if (this.tape === null || ![this.tape.subject, ''].includes(this.subject())) return null;
    return this.tape.range;
  }

  /** Called whenever the curves show another time. */
  onSpan(): void {
    const { range } = this;
    const [from, to] = this.span();
    this.save.disabled = !this.isUnsaved && (range === null || range[1] < from || range[0] > to);
    if (this.isRecording && range !== null) this.clock.textContent = clockText(range[1] - range[0]);
  }

  /** Another subject is watched; '': none. A recording of another one ends. */
  onSubject(name: string): void {
    if (name !== '' && name !== this.tape?.subject) void this.finish();
    this.onSpan();
  }

  /** Ends the recording, if there is one, and saves it. */
  async finish(): Promise<void> {
    const { recorder } = this;
    if (recorder === null) return;
    recorder.close();
    this.recorder = null;
    this.showRecording();
    this.onToggled();
    await this.saveAll();
  }

  private toggle(): void {
    if (this.isRecording) return void this.finish();
    const subject = this.subject();
    if (subject === '') return this.toasts.say(t.noSubject, 'error');
    void this.loadedWriter().catch(() => {}); // the end tries again, and reports the error
    this.tape = new PoseTape(subject, Date.now() - performance.now(), MOST_BYTES);
    this.isUnsaved = false;
    this.recorder = new PoseRecorder(this.connection, this.tape, (refusal) => this.onEnd(refusal));
    this.clock.textContent = clockText(0);
    this.showRecording();
    this.onToggled();
    this.tick();
  }

  /** The daemon may be gone when a recording ends, so the page loads this when one begins. */
  private loadedWriter(): Promise<Writer> {
    this.writer ??= loadWriter().catch((error: unknown) => {
      this.writer = null;
      throw error;
    });
    return this.writer;
  }

  private onEnd(refusal: string): void {
    this.toasts.say(refusal === '' ? t.full(MOST_BYTES / 1e6) : refusal, 'error');
    void this.finish();
  }

  private showRecording(): void {
    const { isRecording } = this;
    const label = isRecording ? t.stop : t.record;
    this.record.classList.toggle('recording', isRecording);
    this.record.setAttribute('aria-label', label);
    this.record.title = label;
    this.record.replaceChildren(icon(isRecording ? 'stop' : 'take'), h('span', {}, isRecording ? t.stopWord : t.recordWord));
    this.clock.hidden = !isRecording;
  }

  /** Curves that stand still do not call onSpan(). */
  private tick(): void {
    this.onSpan();
    clearTimeout(this.timer);
    if (this.isRecording) this.timer = setTimeout(() => this.tick(), TICK_MS);
  }

  private onSave(): void {
    if (this.isUnsaved) void this.saveAll();
    else if (this.tape !== null) void this.saveReels(this.tape, this.tape.between(...this.span()), 0);
  }

  private async saveAll(): Promise<void> {
    const tape = this.tape!;
    this.isUnsaved = true;
    // The last poses that the daemon dropped leave no gap.
    const isSaved = await this.saveReels(tape, tape.between(-Infinity, Infinity), tape.numDropped);
    if (this.tape === tape) this.isUnsaved = !isSaved;
    this.onSpan();
  }

  /** False: it failed, and the user knows. */
  private async saveReels(tape: PoseTape, reels: readonly Reel[], leastMissed: number): Promise<boolean> {
    if (reels.length === 0) {
      this.toasts.say(t.nothing, 'error');
      return true;
    }
    try {
      const writer = await this.loadedWriter();
      const name = `${fileStem(new Date(), tape.subject)}.mcap`;
      const parts = writer.takeFile(tape.subject, reels, writer.takeSchemas, tape.originMs);
      saveBlob(name, new Blob(parts as BlobPart[], { type: 'application/octet-stream' }));
      const numPoses = reels.reduce((sum, { poses }) => sum + poses.length, 0);
      this.toasts.say(t.saved(name, numPoses, Math.max(leastMissed, numMissed(reels))));
      return true;
    } catch (error) {
      this.toasts.say(t.failed(wordsOf(error)), 'error');
      return false;
    }
  }
}
