// SPDX-License-Identifier: Apache-2.0
// Captures the live pose as the performer's neutral pose or as a reference pose of the rig.
import { api, type Capture, type CaptureResult, type NeutralPart, wordsOf } from '../api';
import { button, download, h, select, setOptions } from '../ui/dom';
import type { Toasts } from '../ui/toast';

const NEW = '+';
const NEUTRAL = 'neutral';
const AUTO = '';

export class CapturePanel {
  readonly element: HTMLElement;
  private readonly pose: HTMLSelectElement;
  private readonly newName = h('input', { type: 'text', 'aria-label': 'Name of the new pose', placeholder: 'name', hidden: true, maxlength: 64 });
  private readonly part: HTMLSelectElement;
  private readonly undo: HTMLButtonElement;
  private readonly save: HTMLButtonElement;
  private readonly error = h('p', { class: 'error', role: 'alert' });
  private readonly result = h('div', { class: 'capture-result', 'aria-live': 'polite' });
  private readonly done = h('ol', { class: 'captures', 'aria-label': 'Captures so far' });

  constructor(private readonly subject: () => string, private readonly toasts: Toasts, private readonly onChanged: () => void) {
    this.pose = select('Save the pose as', [], () => {
      this.newName.hidden = this.pose.value !== NEW;
      if (!this.newName.hidden) this.newName.focus();
      this.part.hidden = this.pose.value !== NEUTRAL;
    });
    this.part = select('Part of the performer', [[AUTO, 'face if there is one'], ['face', 'face only'], ['body', 'body only'], ['both', 'face and body']], () => undefined);
    this.undo = button('Undo', () => void this.undoCapture(), { disabled: true });
    this.save = button('Download rig', () => void this.saveRig());
    this.element = h('div', { class: 'capture' },
      h('p', {}, 'Hold the expression, then click Capture. The pose becomes the neutral pose of this performer, from which all poses are measured, or a reference pose of the wrinkle rig, which its drivers use.'),
      h('div', { class: 'row' }, this.pose, this.newName, this.part),
      h('div', { class: 'row' },
        button('Preview', () => void this.capturePose(true), { title: 'Show the resulting weights without changing anything' }),
        button('Capture', () => void this.capturePose(false), { class: 'primary' }), this.undo, this.save),
      this.error, this.result, this.done,
      h('p', { class: 'fine' }, 'A capture changes the rig of the running daemon for every subject. It is not written to a file: download the rig to keep it.'));
  }

  private async saveRig(): Promise<void> {
    try {
      download('rig.json', 'application/json', await api.rigFile());
    } catch (error) {
      this.toasts.say(wordsOf(error), 'error');
    }
  }

  async load(): Promise<void> {
    const rig = await api.rig(this.subject());
    const poses = [...new Set([NEUTRAL, ...rig.reference_poses])];
    setOptions(this.pose, [...poses.map((name) => [name, name] as const), [NEW, 'a new pose…']]);
    this.newName.hidden = this.pose.value !== NEW;
    this.part.hidden = this.pose.value !== NEUTRAL;
    this.showCaptures(rig.captures);
    this.save.textContent = rig.changed ? 'Download changed rig' : 'Download rig';
  }

  private async capturePose(preview: boolean): Promise<void> {
    const pose = this.pose.value === NEW ? this.newName.value.trim() : this.pose.value;
    this.error.textContent = pose === '' ? 'Enter a name for the new pose.' : '';
    if (pose === '') return;
    try {
      const part = pose === NEUTRAL && this.part.value !== AUTO ? (this.part.value as NeutralPart) : undefined;
      const result = await api.capture(this.subject(), pose, preview, part);
      this.showResult(result);
      if (preview) return;
      this.toasts.say(result.part ? `Captured as “${result.pose}” (${result.part})` : `Captured as “${result.pose}”`);
      this.onChanged();
      await this.load();
    } catch (error) {
      this.error.textContent = wordsOf(error);
    }
  }

  private async undoCapture(): Promise<void> {
    try {
      this.showCaptures((await api.undoCapture()).captures);
      this.result.replaceChildren();
      this.onChanged();
      await this.load();
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
    const title = result.preview ? 'Preview: weights with this pose' : 'Weights with the captured pose';
    const note = result.added ? [h('p', { class: 'note' }, 'This pose is new: no driver of the rig uses it yet.')] : [];
    this.result.replaceChildren(h('h3', {}, title), ...note, moved.length === 0
      ? h('p', { class: 'empty' }, 'No weight changes.')
      : h('table', {}, h('thead', {}, h('tr', {}, ...['Weight', 'Before', 'After'].map((word) => h('th', { scope: 'col' }, word)))), h('tbody', {}, ...rows)));
  }
}
