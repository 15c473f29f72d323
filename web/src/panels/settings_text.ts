// SPDX-License-Identifier: Apache-2.0
// A dialog with the settings as TOML, to copy, to paste and to set for all viewers.
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
      h('p', {}, 'The changes of this page as a file for ', h('code', {}, 'furrowd --render-settings'), '. Edit or paste to apply.'),
      this.text, this.error,
      h('div', { class: 'row' },
        h('label', { for: 'toml-everything', class: 'check' }, this.everything, 'Include unchanged settings')),
      h('div', { class: 'row end' },
        button('Copy', () => void this.copy()),
        button('Apply here', () => this.applyHere(), { title: 'Apply to this page only' }),
        button('Set for all viewers', () => void this.setForAll(), { title: 'Change the daemon’s settings, which every viewer starts with' }),
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
    this.text.value = toToml(settings.infos, values) || '# No settings were changed.\n';
    this.error.textContent = '';
  }

  private async copy(): Promise<void> {
    try {
      await navigator.clipboard.writeText(this.text.value);
    } catch {
      this.text.select(); // browsers forbid copying except on https and localhost
      this.error.textContent = 'This browser does not allow the page to copy. Press Ctrl+C.';
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

  private applyHere(): void {
    const values = this.read();
    if (values === null) return;
    const unknown = this.state.settings.replace(values);
    if (unknown.length > 0) this.error.textContent = `Unknown setting: ${unknown.join(', ')}`;
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
    this.toasts.say('Set for all viewers without their own value');
  }
}
