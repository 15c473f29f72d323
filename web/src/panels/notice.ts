// SPDX-License-Identifier: Apache-2.0
// The card in front of the picture: what the page waits for, what is wrong, and what to do about it.
import { text } from '../text';
import { button, command, copyText, h } from '../ui/dom';
import type { Toasts } from '../ui/toast';
import type { Condition, PictureState } from './condition';

/** States in which the picture needs no explanation. */
const QUIET: readonly PictureState[] = ['live', 'paused'];

export class Notice {
  readonly element: HTMLElement;
  private readonly badge = h('p', { class: 'badge', hidden: true });
  private readonly title = h('p', { class: 'notice-title' });
  private readonly advice = h('p', { class: 'notice-advice' });
  private readonly progress = h('progress', { 'aria-label': text.stage.progress, hidden: true });
  private readonly command = command(text.stage.command(location.hostname || 'localhost'));
  private readonly help: HTMLElement;
  private shown = '';

  /** `openSources`: shows how to connect a phone or a tracker. `openRecording`: lets the user choose a file. */
  constructor(toasts: Toasts, openSources: () => void, openRecording: () => void) {
    const copy = button(text.stage.copy, () => void this.copy(toasts));
    this.help = h('div', { class: 'notice-help' },
      h('div', { class: 'row command' }, this.command, copy),
      h('div', { class: 'row' }, button(text.upload.open, openRecording, { class: 'primary', title: text.upload.openTitle }),
        button(text.stage.sources, openSources)));
    this.element = h('div', { class: 'notice' }, this.badge,
      h('div', { class: 'card' }, this.title, this.progress, this.advice, this.help));
    this.show({ state: 'loading', text: text.condition.connecting, advice: '', progress: null }, false);
  }

  private async copy(toasts: Toasts): Promise<void> {
    if (await copyText(this.command.textContent!)) toasts.say(text.stage.copied);
    else getSelection()?.selectAllChildren(this.command);
  }

  /** `hasPicture`: there is a picture behind the card, perhaps an old one. */
  show(condition: Condition, hasPicture: boolean): void {
    const { state, text: words, advice, progress } = condition;
    const now = JSON.stringify([condition, hasPicture]);
    if (now === this.shown) return;
    this.shown = now;
    this.element.dataset.state = state;
    this.badge.textContent = text.state[state];
    this.badge.hidden = state === 'live' || !hasPicture;
    // The header announces the words already.
    this.title.textContent = words;
    this.advice.textContent = advice;
    this.advice.hidden = advice === '';
    this.progress.hidden = state !== 'loading';
    if (progress === null) this.progress.removeAttribute('value');
    else this.progress.value = progress;
    this.help.hidden = state !== 'empty';
    this.element.classList.toggle('quiet', QUIET.includes(state));
    // An old picture stays visible, so the card moves to its edge.
    this.element.classList.toggle('aside', hasPicture);
  }
}
