// SPDX-License-Identifier: Apache-2.0
// What arrives of each subject: rate, losses, jitter, clock, timecode, and names that are missing or move nothing.
import type { NamesInfo, StreamInfo } from '../api';
import { text } from '../text';
import { h } from '../ui/dom';

/** The words of a share of lost poses. */
export function lossOf(poses: number, lost: number): string {
  return lost > 0 ? `${((100 * lost) / (poses + lost)).toFixed(1)} %` : '0';
}

/** Empty: everything is used. */
export function namesOf(stream: StreamInfo): string {
  return text.sources.unused(stream.missing_joints.count + stream.missing_blend_shapes.count, stream.ignored_joints.count);
}

function list(words: string, { count, names }: NamesInfo): HTMLElement | null {
  if (count === 0) return null;
  const more = count > names.length ? ` ${text.sources.andMore(count - names.length)}` : '';
  return h('p', { class: 'fine' }, `${words} `, h('code', {}, names.join(', ')), more);
}

/** The rows stay while their subject does, so that an open list of names stays open. */
class StreamRows {
  private readonly where = h('small', {});
  private readonly timecode = h('small', { class: 'stream-timecode' });
  private readonly hz = h('td', { class: 'number' });
  private readonly lost = h('td', { class: 'number' });
  private readonly jitter = h('td', { class: 'number' });
  private readonly clock = h('td', { class: 'number' });
  private readonly names = h('td', { colspan: 5 });
  private readonly second = h('tr', { class: 'names' }, this.names);
  readonly element: HTMLTableSectionElement;
  private shown = '';

  constructor(name: string) {
    this.element = h('tbody', { 'data-stream': name },
      h('tr', {}, h('th', { scope: 'row' }, name, this.where, this.timecode), this.hz, this.lost, this.jitter, this.clock), this.second);
  }

  show(stream: StreamInfo): void {
    const t = text.sources;
    this.where.textContent = stream.input === '' ? [t.own, stream.source].filter(Boolean).join(', ') : t.names[stream.input];
    const { timecode, timecode_rate_hz: rateHz } = stream;
    this.timecode.textContent = timecode === null || rateHz === null ? '' : t.timecode(timecode, rateHz);
    this.timecode.hidden = timecode === null;
    this.hz.textContent = stream.rate_hz.toFixed(0);
    this.lost.textContent = lossOf(stream.poses, stream.lost);
    this.lost.title = text.session.losses(stream.lost, stream.late);
    this.jitter.textContent = stream.jitter_ms.toFixed(1);
    this.clock.textContent = stream.clock_offset_ms === null ? text.figures.none : stream.clock_offset_ms.toFixed(0);
    const now = JSON.stringify([stream.missing_joints, stream.missing_blend_shapes, stream.ignored_joints]);
    if (now === this.shown) return;
    this.shown = now;
    const words = namesOf(stream);
    this.second.hidden = words === '';
    this.names.replaceChildren(h('details', {}, h('summary', {}, words),
      ...[list(t.missingJoints, stream.missing_joints), list(t.missingShapes, stream.missing_blend_shapes),
        list(t.ignoredJoints, stream.ignored_joints)].filter((each) => each !== null)));
  }
}

export class StreamTable {
  private readonly table = h('table', { class: 'subjects streams' },
    h('thead', {}, h('tr', {}, ...text.sources.headings.map(([word, title]) => h('th', { scope: 'col', title }, word)))));
  private readonly note = h('p', { class: 'empty' });
  readonly element = h('section', { 'aria-label': text.sources.streams }, h('h2', {}, text.sources.streams), this.table, this.note);
  private rows = new Map<string, StreamRows>();

  show(streams: readonly StreamInfo[], more: number): void {
    const rows = new Map(streams.map((stream) => [stream.name, this.rows.get(stream.name) ?? new StreamRows(stream.name)]));
    streams.forEach((stream) => rows.get(stream.name)!.show(stream));
    const order = [...rows.keys()].join('\n');
    if (order !== [...this.rows.keys()].join('\n')) {
      for (const row of this.rows.values()) row.element.remove();
      this.table.append(...[...rows.values()].map((row) => row.element));
    }
    this.rows = rows;
    this.table.hidden = streams.length === 0;
    this.note.textContent = streams.length === 0 ? text.sources.noStreams : more > 0 ? text.sources.moreStreams(more) : '';
  }
}
