// SPDX-License-Identifier: Apache-2.0
// Lists the streaming subjects with their statistics, and facts about the picture and the daemon.
import type { DaemonStatus, SubjectInfo } from '../api';
import { text } from '../text';
import type { Signal } from '../ui/signal';
import { h, select } from '../ui/dom';
import type { StreamKind } from '../view/video_choice';
import { lossOf } from './stream_table';

/** Of the picture on the screen. */
export interface PictureFigures {
  latencyMs: number | null;
  skipped: number;
  quality: string;
  /** Format and data rate; empty: this browser draws. */
  stream: string;
  /** Why the pictures come that way. */
  streamTitle: string;
}

const { kinds } = text.stream;
const STREAMS: readonly (readonly [StreamKind, string])[] = [
  ['auto', kinds.auto], ['h264', kinds.h264], ['jpeg', kinds.jpeg],
];

export class SessionPanel {
  private readonly rows = h('tbody', {});
  private readonly empty = h('p', { class: 'empty' }, text.session.nobody);
  private readonly picture = h('dl', { class: 'facts' });
  private readonly stream: HTMLSelectElement;
  private readonly streamWhy = h('p', { class: 'fine' });
  private readonly facts = h('dl', { class: 'facts' });
  readonly element: HTMLElement;

  constructor(private readonly onChoose: (subject: string) => void, stream: Signal<StreamKind>) {
    const t = text.session;
    this.stream = select(text.stream.label, STREAMS, (value) => stream.set(value as StreamKind));
    stream.bind((kind) => (this.stream.value = kind));
    this.element = h('div', { class: 'session' },
      h('h2', {}, t.subjects),
      h('table', { class: 'subjects' },
        h('thead', {}, h('tr', {}, ...t.headings.map(([word, title]) => h('th', { scope: 'col', title }, word)))), this.rows),
      this.empty, h('h2', {}, t.picture), this.picture, this.stream, this.streamWhy, h('h2', {}, t.daemon), this.facts);
  }

  show(subjects: readonly SubjectInfo[], status: DaemonStatus, chosen: string, picture: PictureFigures): void {
    const t = text.session;
    this.showFacts(this.picture, [
      [t.latency, picture.latencyMs === null ? text.figures.none : `${picture.latencyMs.toFixed(0)} ms`],
      [t.dropped, t.steps(picture.skipped)],
      [t.quality, picture.quality],
      [text.figures.stream, picture.stream || text.figures.none],
    ]);
    this.stream.title = this.streamWhy.textContent = picture.streamTitle;
    this.streamWhy.hidden = picture.streamTitle === '';
    this.empty.hidden = subjects.length > 0;
    const focused = document.activeElement?.closest('tr')?.dataset.subject;
    this.rows.replaceChildren(...subjects.map((subject) => this.row(subject, subject.name === chosen)));
    if (focused !== undefined) this.rows.querySelector<HTMLElement>(`tr[data-subject="${CSS.escape(focused)}"] button`)?.focus();
    this.showFacts(this.facts, [
      [[t.version, ''], status.version],
      [[t.renderer, ''], status.render ? status.renderer : t.noRenderer],
      [[t.viewers, ''], String(status.viewers)],
      [[t.pictures, ''], t.picturesOf(status.pictures_rendered, status.pictures_encoded, status.pictures_dropped)],
      [[t.uptime, ''], `${Math.round(status.uptime_s)} s`],
    ]);
  }

  private showFacts(list: HTMLElement, facts: readonly (readonly [readonly [string, string], string])[]): void {
    list.replaceChildren(...facts.flatMap(([[name, title], value]) =>
      [h('dt', { title: title === '' ? undefined : title }, name), h('dd', {}, value)]));
  }

  private row(subject: SubjectInfo, isChosen: boolean): HTMLElement {
    return h('tr', { 'data-subject': subject.name, class: isChosen ? 'chosen' : '' },
      h('th', { scope: 'row' },
        h('button', { type: 'button', class: 'link', onclick: () => this.onChoose(subject.name), 'aria-pressed': String(isChosen) }, subject.name),
        h('small', {}, subject.source)),
      h('td', {}, h('span', { class: `state ${subject.state}` }, text.session.states[subject.state])),
      h('td', { class: 'number' }, subject.rate_hz.toFixed(0)),
      h('td', { class: 'number', title: text.session.losses(subject.lost, subject.late) }, lossOf(subject.poses, subject.lost)),
      h('td', { class: 'number', title: subject.buffer_ms > 0 ? text.session.buffer(subject.buffer_ms.toFixed(0)) : '' },
        subject.jitter_ms.toFixed(1)));
  }
}
