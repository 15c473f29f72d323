// SPDX-License-Identifier: Apache-2.0
// The live pose becomes the performer's neutral or one of the rig's reference poses.
import { api, type Capture, type CaptureResult, wordsOf } from '../api';
import { button, h, select, setOptions } from '../ui/dom';
import type { Toasts } from '../ui/toast';

const NEW = '+';

export class CapturePanel {
  readonly element: HTMLElement;
  private readonly pose: HTMLSelectElement;
  private readonly newName = h('input', { type: 'text', 'aria-label': 'Name of the new pose', placeholder: 'name', hidden: true, maxlength: 64 });
  private readonly undo: HTMLButtonElement;
  private readonly save: HTMLAnchorElement;
  private readonly error = h('p', { class: 'error', role: 'alert' });
  private readonly result = h('div', { class: 'capture-result', 'aria-live': 'polite' });
  private readonly done = h('ol', { class: 'captures', 'aria-label': 'Captures so far' });

  constructor(private readonly subject: () => string, private readonly toasts: Toasts, private readonly onChanged: () => void) {
    this.pose = select('What the pose becomes', [], () => {
      this.newName.hidden = this.pose.value !== NEW;
      if (!this.newName.hidden) this.newName.focus();
    });
    this.undo = button('Undo', () => void this.takeBack(), { disabled: true });
    this.save = h('a', { href: api.rigFile, download: 'rig.json', class: 'button' }, 'Download rig');
    this.element = h('div', { class: 'capture' },
      h('p', {}, 'Let the performer hold a face, then take it: as this performer\'s neutral, which all poses are measured from, or into the wrinkle rig as a pose that drivers aim at.'),
      h('div', { class: 'row' }, this.pose, this.newName),
      h('div', { class: 'row' },
        button('Preview', () => void this.take(true), { title: 'What the weights would become; nothing changes' }),
        button('Capture', () => void this.take(false), { class: 'primary' }), this.undo, this.save),
      this.error, this.result, this.done,
      h('p', { class: 'fine' }, 'A capture changes the rig of the running daemon for every subject. No file is written: download keeps it.'));
  }

  async load(): Promise<void> {
    const rig = await api.rig(this.subject());
    const poses = [...new Set(['neutral', ...rig.reference_poses])];
    setOptions(this.pose, [...poses.map((name) => [name, name] as const), [NEW, 'a new pose…']]);
    this.newName.hidden = this.pose.value !== NEW;
    this.showCaptures(rig.captures);
    this.save.textContent = rig.changed ? 'Download changed rig' : 'Download rig';
  }

  private async take(preview: boolean): Promise<void> {
    const pose = this.pose.value === NEW ? this.newName.value.trim() : this.pose.value;
    this.error.textContent = pose === '' ? 'A new pose needs a name.' : '';
    if (pose === '') return;
    try {
      const result = await api.capture(this.subject(), pose, preview);
      this.showResult(result);
      if (preview) return;
      this.toasts.say(`Captured as “${result.pose}”`);
      this.onChanged();
      await this.load();
    } catch (error) {
      this.error.textContent = wordsOf(error);
    }
  }

  private async takeBack(): Promise<void> {
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

  /** Only the weights that a capture changes by more than a hundredth. */
  private showResult(result: CaptureResult): void {
    const moved = result.weights.filter(({ before, after }) => Math.abs(after - before) > 0.01);
    const rows = moved.map(({ name, before, after }) =>
      h('tr', {}, h('th', { scope: 'row' }, name), h('td', { class: 'number' }, before.toFixed(2)), h('td', { class: 'number' }, after.toFixed(2))));
    const title = result.preview ? 'Preview: this pose would give' : 'This pose now gives';
    const note = result.added ? [h('p', { class: 'note' }, 'The pose is new: no driver of the rig aims at it yet.')] : [];
    this.result.replaceChildren(h('h3', {}, title), ...note, moved.length === 0
      ? h('p', { class: 'empty' }, 'No weight changes.')
      : h('table', {}, h('thead', {}, h('tr', {}, ...['Weight', 'Before', 'After'].map((word) => h('th', { scope: 'col' }, word)))), h('tbody', {}, ...rows)));
  }
}
