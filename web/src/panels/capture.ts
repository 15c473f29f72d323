// SPDX-License-Identifier: Apache-2.0
// Captures the live pose as the performer's neutral pose or as a reference pose of the rig.
import { api, type Capture, type CaptureResult, type NeutralPart, type RigInfo, wordsOf } from '../api';
import { text } from '../text';
import { button, download, h, select, setOptions } from '../ui/dom';
import type { Toasts } from '../ui/toast';

const NEW = '+';
const NEUTRAL = 'neutral';
const AUTO = '';
const t = text.capture;

export class CapturePanel {
  readonly element: HTMLElement;
  private readonly pose: HTMLSelectElement;
  private readonly newName = h('input', { type: 'text', 'aria-label': t.newName, placeholder: t.newNamePlaceholder, hidden: true, maxlength: 64 });
  private readonly part: HTMLSelectElement;
  private readonly partLabel: HTMLElement;
  private readonly note = h('p', { class: 'fine' });
  private readonly undo: HTMLButtonElement;
  private readonly save: HTMLButtonElement;
  private readonly error = h('p', { class: 'error', role: 'alert' });
  private readonly result = h('div', { class: 'capture-result', 'aria-live': 'polite' });
  private readonly done = h('ol', { class: 'captures', 'aria-label': t.done });

  constructor(private readonly subject: () => string, private readonly toasts: Toasts, private readonly onChanged: () => void) {
    this.pose = select(t.saveAs, [], () => {
      this.showChoice();
      if (!this.newName.hidden) this.newName.focus();
    });
    this.part = select(t.part, [[AUTO, t.parts.auto], ['face', t.parts.face], ['body', t.parts.body], ['both', t.parts.both]], () => undefined);
    this.partLabel = h('label', { class: 'labelled' }, t.part, this.part);
    this.undo = button(t.undo, () => void this.undoCapture(), { disabled: true });
    this.save = button(t.download, () => void this.saveRig());
    this.element = h('div', { class: 'capture' },
      h('p', {}, t.intro),
      h('div', { class: 'row capture-choices' },
        h('label', { class: 'labelled' }, t.saveAs, this.pose), this.newName, this.partLabel),
      h('div', { class: 'row' },
        button(t.preview, () => void this.capturePose(true), { title: t.previewTitle }),
        button(t.capture, () => void this.capturePose(false), { class: 'primary' }), this.undo, this.save),
      this.error, this.result, this.done,
      this.note);
  }

  async saveRig(): Promise<void> {
    try {
      download('rig.json', 'application/json', await api.rigFile());
    } catch (error) {
      this.toasts.say(wordsOf(error), 'error');
    }
  }

  showRig(rig: RigInfo): void {
    const poses = [...new Set([NEUTRAL, ...rig.reference_poses])];
    setOptions(this.pose, [...poses.map((name) => [name, name === NEUTRAL ? t.neutral : name] as const), [NEW, t.newPose]]);
    this.showChoice();
    this.showCaptures(rig.captures);
    this.save.textContent = rig.changed ? t.downloadChanged : t.download;
  }

  /** The fields and the note of the pose that is chosen. */
  private showChoice(): void {
    const isNeutral = this.pose.value === NEUTRAL;
    this.newName.hidden = this.pose.value !== NEW;
    this.partLabel.hidden = !isNeutral;
    this.note.textContent = isNeutral ? t.neutralNote : t.note;
  }

  private async capturePose(preview: boolean): Promise<void> {
    const pose = this.pose.value === NEW ? this.newName.value.trim() : this.pose.value;
    this.error.textContent = pose === '' ? t.nameMissing : '';
    if (pose === '') return;
    try {
      const part = pose === NEUTRAL && this.part.value !== AUTO ? (this.part.value as NeutralPart) : undefined;
      const result = await api.capture(this.subject(), pose, preview, part);
      this.showResult(result);
      if (preview) return;
      this.toasts.say(t.captured(result.pose, result.part));
      this.onChanged();
    } catch (error) {
      this.error.textContent = wordsOf(error);
    }
  }

  private async undoCapture(): Promise<void> {
    try {
      this.showCaptures((await api.undoCapture()).captures);
      this.result.replaceChildren();
      this.onChanged();
    } catch (error) {
      this.error.textContent = wordsOf(error);
    }
  }

  private showCaptures(captures: readonly Capture[]): void {
    this.undo.disabled = captures.length === 0;
    this.done.replaceChildren(...captures.map(({ pose }) => h('li', {}, pose)));
  }

  /** Lists only the weights that a capture changes by more than 0.01. */
  private showResult(result: CaptureResult): void {
    const moved = result.weights.filter(({ before, after }) => Math.abs(after - before) > 0.01);
    const rows = moved.map(({ name, before, after }) =>
      h('tr', {}, h('th', { scope: 'row' }, name), h('td', { class: 'number' }, before.toFixed(2)), h('td', { class: 'number' }, after.toFixed(2))));
    const title = result.preview ? t.previewOf : t.resultOf;
    const note = result.added ? [h('p', { class: 'note' }, t.isNew)] : [];
    this.result.replaceChildren(h('h2', {}, title), ...note, moved.length === 0
      ? h('p', { class: 'empty' }, t.nothing)
      : h('table', {}, h('thead', {}, h('tr', {}, ...t.columns.map((word) => h('th', { scope: 'col' }, word)))), h('tbody', {}, ...rows)));
  }
}
