// SPDX-License-Identifier: Apache-2.0
// Lists the streaming subjects with their statistics, and facts about the daemon.
import type { DaemonStatus, SubjectInfo } from '../api';
import { h } from '../ui/dom';

const HEADINGS: readonly (readonly [string, string])[] = [
  ['Subject', 'Name and source address'],
  ['State', ''],
  ['Hz', 'Poses in the last second'],
  ['Lost', 'Share of poses lost on the way'],
  ['Jitter', 'Arrival jitter against capture time, in ms'],
];

export class SessionPanel {
  private readonly rows = h('tbody', {});
  private readonly empty = h('p', { class: 'empty' }, 'No subject is streaming.');
  private readonly facts = h('dl', { class: 'facts' });
  readonly element = h('div', { class: 'session' },
    h('h3', {}, 'Subjects'),
    h('table', { class: 'subjects' },
      h('thead', {}, h('tr', {}, ...HEADINGS.map(([word, title]) => h('th', { scope: 'col', title }, word)))), this.rows),
    this.empty, h('h3', {}, 'Daemon'), this.facts);

  constructor(private readonly onChoose: (subject: string) => void) {}

  show(subjects: readonly SubjectInfo[], status: DaemonStatus, chosen: string): void {
    this.empty.hidden = subjects.length > 0;
    const focused = document.activeElement?.closest('tr')?.dataset.subject;
    this.rows.replaceChildren(...subjects.map((subject) => this.row(subject, subject.name === chosen)));
    if (focused !== undefined) this.rows.querySelector<HTMLElement>(`tr[data-subject="${CSS.escape(focused)}"] button`)?.focus();
    const facts: [string, string][] = [
      ['Version', status.version],
      ['Renderer', status.render ? status.renderer : 'none (weights only)'],
      ['Viewers', String(status.viewers)],
      ['Pictures', `${status.pictures_rendered} drawn, ${status.pictures_encoded} encoded, ${status.pictures_dropped} dropped`],
      ['Uptime', `${Math.round(status.uptime_s)} s`],
    ];
    this.facts.replaceChildren(...facts.flatMap(([name, value]) => [h('dt', {}, name), h('dd', {}, value)]));
  }

  private row(subject: SubjectInfo, isChosen: boolean): HTMLElement {
    const share = subject.poses + subject.lost === 0 ? 0 : subject.lost / (subject.poses + subject.lost);
    return h('tr', { 'data-subject': subject.name, class: isChosen ? 'chosen' : '' },
      h('th', { scope: 'row' },
        h('button', { type: 'button', class: 'link', onclick: () => this.onChoose(subject.name), 'aria-pressed': String(isChosen) }, subject.name),
        h('small', {}, subject.source)),
      h('td', {}, h('span', { class: `state ${subject.state}` }, subject.state.replace('_', ' '))),
      h('td', { class: 'number' }, subject.rate_hz.toFixed(0)),
      h('td', { class: 'number', title: `${subject.lost} lost, ${subject.late} late` }, share > 0 ? `${(100 * share).toFixed(1)} %` : '0'),
      h('td', { class: 'number', title: subject.buffer_ms > 0 ? `after a jitter buffer of ${subject.buffer_ms.toFixed(0)} ms` : '' },
        subject.jitter_ms.toFixed(1)));
  }
}
