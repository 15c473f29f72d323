// SPDX-License-Identifier: Apache-2.0
// The settings as TOML in a dialog: to copy, to paste, and to set for everybody.
import { api, wordsOf } from '../api';
import type { AppState } from '../state/app_state';
import { fromToml, toToml } from '../state/toml';
import { button, h } from '../ui/dom';
import type { Toasts } from '../ui/toast';

export class SettingsText {
  readonly element: HTMLDialogElement;
  private readonly text = h('textarea', { rows: 14, spellcheck: 'false', 'aria-label': 'Settings as TOML' });
  private readonly error = h('p', { class: 'error', role: 'alert' });
  private readonly everything = h('input', { type: 'checkbox', id: 'toml-everything' });

  constructor(private readonly state: AppState, private readonly toasts: Toasts) {
    this.everything.addEventListener('change', () => this.fill());
    this.element = h('dialog', { 'aria-labelledby': 'toml-title', class: 'settings-text' },
      h('h2', { id: 'toml-title' }, 'Settings as text'),
      h('p', {}, 'What this page has changed, as a file for ', h('code', {}, 'furrowd --render-settings'), '. Edit or paste to apply.'),
      this.text, this.error,
      h('div', { class: 'row' },
        h('label', { for: 'toml-everything', class: 'check' }, this.everything, 'All settings, not the changed alone')),
      h('div', { class: 'row end' },
        button('Copy', () => void this.copy()),
        button('Use here', () => this.useHere(), { title: 'For this page alone' }),
        button('Set for everybody', () => void this.setForAll(), { title: 'Changes the daemon’s own settings, which every viewer starts from' }),
        button('Close', () => this.element.close(), { class: 'primary' })));
  }

  open(): void {
    this.fill();
    this.element.showModal();
    this.text.focus();
  }

  private fill(): void {
    const { settings } = this.state;
    const values = this.everything.checked
      ? new Map(settings.infos.map((info) => [info.name, settings.value(info.name)]))
      : settings.overrides;
    this.text.value = toToml(settings.infos, values) || '# Nothing was changed here.\n';
    this.error.textContent = '';
  }

  private async copy(): Promise<void> {
    try {
      await navigator.clipboard.writeText(this.text.value);
    } catch {
      this.text.select(); // not allowed outside of https and localhost: leave it selected for Ctrl+C
      this.error.textContent = 'This browser does not let the page copy: press Ctrl+C.';
      return;
    }
    this.toasts.say('Copied');
  }

  private read(): Map<string, string> | null {
    try {
      this.error.textContent = '';
      return fromToml(this.text.value);
    } catch (error) {
      this.error.textContent = wordsOf(error);
      return null;
    }
  }

  private useHere(): void {
    const values = this.read();
    if (values === null) return;
    const unknown = this.state.settings.replace(values);
    if (unknown.length > 0) this.error.textContent = `No such setting: ${unknown.join(', ')}`;
    else this.element.close();
  }

  private async setForAll(): Promise<void> {
    const values = this.read();
    if (values === null) return;
    try {
      this.state.settings.setInfos(await api.patchSettings(Object.fromEntries(values)));
    } catch (error) {
      this.error.textContent = wordsOf(error);
      return;
    }
    this.element.close();
    this.toasts.say('Set for everybody who has nothing else chosen');
  }
}
