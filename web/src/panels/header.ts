// SPDX-License-Identifier: Apache-2.0
// The bar at the top: subject, condition and picture statistics.
import type { AppState } from '../state/app_state';
import { button, h, select, setOptions } from '../ui/dom';
import type { Viewer } from '../view/viewer';
import type { Condition } from './condition';

const TIERS = ['best', 'medium', 'low'];

export class Header {
  readonly element: HTMLElement;
  private readonly subject: HTMLSelectElement;
  private readonly status = h('p', { class: 'condition wait', role: 'status' });
  private readonly open = h('p', { class: 'open', hidden: true,
    title: 'Everybody on the network may connect, publish and change settings (docs/SECURITY.md)' }, 'Open');
  private readonly numbers = new Map<string, HTMLOutputElement>();

  constructor(private readonly state: AppState, commands: { help: () => void; panel: () => void; dock: () => void }) {
    this.subject = select('Subject', [['', 'Any subject']], (name) => state.subject.set(name));
    this.element = h('header', {},
      h('h1', {}, 'Furrow'), this.subject, this.status, this.open, h('span', { class: 'space' }),
      h('div', { class: 'numbers', 'aria-label': 'Picture', role: 'group' },
        this.number('rate', 'Pictures', 'Pictures per second'),
        this.number('latency', 'Latency', 'Median time from the arrival of a pose at the daemon to this screen'),
        this.number('dropped', 'Dropped', 'Poses that were replaced by newer ones before they were shown'),
        this.number('tier', 'Quality', 'JPEG quality: best, medium or low; “still” is the refined picture of a pose at rest')),
      button('Curves', commands.dock, { title: 'Show or hide the curves (key G)' }),
      button('Panel', commands.panel, { title: 'Show or hide the side panel (key P)' }),
      button('?', commands.help, { title: 'Keyboard shortcuts (key ?)', 'aria-label': 'Help: keyboard shortcuts' }));
  }

  private number(id: string, label: string, title: string): HTMLElement {
    const output = h('output', { 'data-number': id }, '–');
    this.numbers.set(id, output);
    return h('span', { class: 'figure', title }, h('span', {}, label), output);
  }

  showSubjects(names: readonly string[]): void {
    const wanted = this.state.subject.value;
    const known = wanted === '' || names.includes(wanted) ? names : [...names, wanted];
    setOptions(this.subject, [['', 'Any subject'], ...known.map((name) => [name, name] as const)]);
    this.subject.value = wanted;
  }

  /** Whether everybody on the network is let in. */
  showOpen(open: boolean): void {
    this.open.hidden = !open;
  }

  showCondition({ level, text, advice }: Condition): void {
    const whole = advice === '' ? text : `${text}. ${advice}`;
    if (this.status.textContent === whole) return;
    this.status.className = `condition ${level}`;
    this.status.replaceChildren(h('strong', {}, text), advice === '' ? '' : `. ${advice}`);
  }

  showStats({ stats, drawing }: Viewer, nowS: number): void {
    const isHere = drawing.active.value;
    const latency = isHere ? null : stats.latencyMs();
    this.put('rate', `${(isHere ? drawing.rateHz(nowS) : stats.rateHz(nowS)).toFixed(0)} /s`);
    this.put('latency', latency === null ? '–' : `${latency.toFixed(0)} ms`);
    this.put('dropped', String(stats.dropped));
    this.put('tier', isHere ? 'drawn here' : stats.still ? 'still' : (TIERS[stats.tier] ?? '–'));
  }

  private put(id: string, text: string): void {
    const output = this.numbers.get(id)!;
    if (output.textContent !== text) output.textContent = text;
  }
}
