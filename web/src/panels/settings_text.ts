// SPDX-License-Identifier: Apache-2.0
// A dialog with the settings as TOML, to copy, to paste and to set for all viewers.
import { api, wordsOf } from '../api';
import type { AppState } from '../state/app_state';
import { fromToml, toToml } from '../state/toml';
import { text } from '../text';
import { button, copyText, h } from '../ui/dom';
import type { Toasts } from '../ui/toast';

const t = text.settingsText;

export class SettingsText {
  readonly element: HTMLDialogElement;
  private readonly text = h('textarea', { rows: 14, spellcheck: 'false', 'aria-label': t.label });
  private readonly error = h('p', { class: 'error', role: 'alert' });
  private readonly everything = h('input', { type: 'checkbox', id: 'toml-everything' });

  constructor(private readonly state: AppState, private readonly toasts: Toasts) {
    this.everything.addEventListener('change', () => this.fill());
    this.element = h('dialog', { 'aria-labelledby': 'toml-title', class: 'settings-text' },
      h('h2', { id: 'toml-title' }, t.title),
      h('p', {}, t.intro, h('code', {}, 'furrowd --render-settings'), t.introEnd),
      this.text, this.error,
      h('div', { class: 'row' },
        h('label', { for: 'toml-everything', class: 'check' }, this.everything, t.everything)),
      h('div', { class: 'row end' },
        button(t.copy, () => void this.copy()),
        button(t.apply, () => this.applyHere(), { title: t.applyTitle }),
        button(t.setForAll, () => void this.setForAll(), { title: t.setForAllTitle }),
        button(t.close, () => this.element.close(), { class: 'primary' })));
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
    this.text.value = toToml(settings.infos, values) || t.unchanged;
    this.error.textContent = '';
  }

  private async copy(): Promise<void> {
    if (await copyText(this.text.value)) return this.toasts.say(t.copied);
    this.text.select();
    this.error.textContent = t.cannotCopy;
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
    if (unknown.length > 0) this.error.textContent = t.unknown(unknown);
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
    this.toasts.say(t.done);
  }
}
