// SPDX-License-Identifier: Apache-2.0
// Where phones and trackers send to, what has arrived from them and from other senders, and what blocks them.
import { api, type MocapInputInfo, type SourcesInfo, wordsOf } from '../api';
import { text } from '../text';
import { button, command as commandOf, copyText, h } from '../ui/dom';
import type { Toasts } from '../ui/toast';
import { qrCode } from '../ui/qr';
import { adviseOn } from './source_advice';
import { StreamTable } from './stream_table';

const REFRESH_MS = 1000;

export class SourcesPanel {
  private readonly cards = h('div', { class: 'source-cards' });
  private readonly code = h('figure', { class: 'source-code', hidden: true });
  private readonly error = h('p', { class: 'error', role: 'alert' });
  private readonly streams = new StreamTable();
  readonly element = h('div', { class: 'sources' }, h('p', {}, text.sources.intro), this.error, this.cards,
    this.streams.element, this.code);
  private shown = '';
  private codeOf = '';

  private isVisible = false;

  constructor(private readonly toasts: Toasts) {
    new IntersectionObserver((entries) => {
      this.isVisible = entries.at(-1)!.isIntersecting;
      if (this.isVisible) void this.refresh();
    }).observe(this.element);
    setInterval(() => this.isVisible && !document.hidden && void this.refresh(), REFRESH_MS);
  }

  private async refresh(): Promise<void> {
    try {
      this.show(await api.sources());
      this.error.textContent = '';
    } catch (error) {
      this.error.textContent = wordsOf(error);
    }
  }

  private show(sources: SourcesInfo): void {
    const addresses = sources.loopback ? [] : sources.addresses;
    // What changes every second changes in place, so that buttons keep the focus.
    const now = JSON.stringify(sources.inputs.map((input) => [{ ...adviseOn(input, sources), words: '' }, input.port, addresses]));
    if (now !== this.shown) {
      this.shown = now;
      this.cards.replaceChildren(...sources.inputs.map((input) => this.card(input, sources, addresses)));
    }
    sources.inputs.forEach((input, i) => this.update(this.cards.children[i]!, input, sources));
    this.streams.show(sources.subjects, sources.more_subjects);
    void this.showCode(addresses[0] ?? '');
  }

  /** The page's address, for the phone: it shows the address and the port to enter there. */
  private async showCode(address: string): Promise<void> {
    const host = address.includes(':') ? `[${address}]` : address;
    const url = address === '' ? '' : `${location.protocol}//${host}:${location.port || (location.protocol === 'https:' ? '443' : '80')}/#panel=sources`;
    if (url === this.codeOf) return;
    this.codeOf = url;
    this.code.hidden = url === '';
    if (url === '') return;
    this.code.replaceChildren(await qrCode(url, text.sources.code(url)), h('figcaption', {}, text.sources.codeHelp, h('code', {}, url)));
  }

  private card(input: MocapInputInfo, sources: SourcesInfo, addresses: readonly string[]): HTMLElement {
    const t = text.sources;
    const { state, todo, command, accept } = adviseOn(input, sources);
    const target = input.port === null || addresses.length === 0 ? null : h('dl', { class: 'facts target' },
      h('dt', {}, t.address), h('dd', {}, ...addresses.map((address) => h('code', {}, address))),
      h('dt', {}, t.port), h('dd', {}, h('code', {}, String(input.port))));
    return h('section', { class: `source ${state}`, 'data-source': input.name, 'data-state': state, 'aria-label': t.names[input.name] },
      h('h2', {}, t.names[input.name], h('small', {}, t.apps[input.name])),
      h('p', { class: 'source-state' }),
      target,
      todo === '' ? null : h('p', { class: 'fine' }, todo),
      command === '' ? null : h('div', { class: 'row command' }, commandOf(command), button(text.stage.copy, () => void this.copy(command))),
      accept === '' ? null : button(t.accept(accept), () => void this.accept(input.name, accept)),
      h('p', { class: 'fine source-counts' }));
  }

  private update(card: Element, input: MocapInputInfo, sources: SourcesInfo): void {
    card.querySelector('.source-state')!.textContent = adviseOn(input, sources).words;
    const counts = card.querySelector<HTMLElement>('.source-counts')!;
    counts.hidden = input.port === null || input.packets === 0;
    counts.textContent = text.sources.counts(input.packets, input.malformed, input.rejected);
  }

  private async accept(input: MocapInputInfo['name'], sender: string): Promise<void> {
    try {
      this.show(await api.acceptSender(input, sender));
      this.toasts.say(text.sources.accepted(sender));
    } catch (error) {
      this.toasts.say(wordsOf(error), 'error');
    }
  }

  private async copy(words: string): Promise<void> {
    if (await copyText(words)) this.toasts.say(text.stage.copied);
    else this.toasts.say(text.sources.cannotCopy, 'error');
  }
}
