// SPDX-License-Identifier: Apache-2.0
// The bar at the top: subject, condition and the figures of the picture.
import type { AppState } from '../state/app_state';
import { text } from '../text';
import { button, h, select, setOptions } from '../ui/dom';
import type { Limit } from '../view/limit';
import type { Condition, PictureState } from './condition';

/** What the page shows of the picture on the screen. */
export interface Figures {
  picturesHz: number;
  posesHz: number;
  /** Null: unknown. */
  ageMs: number | null;
  isAtRest: boolean;
  width: number;
  height: number;
  /** Share of the width and height that was drawn; below 100, the picture is enlarged. */
  drawnPercent: number;
  limit: Limit;
  /** How the pictures come; empty: this browser draws them. */
  stream: string;
  /** Why they come that way. */
  streamTitle: string;
}

const LEVELS: Record<PictureState, 'ok' | 'wait' | 'bad'> = {
  empty: 'wait', loading: 'wait', live: 'ok', paused: 'ok', stale: 'wait', lost: 'bad', off: 'bad',
};

/** "45 ms", "2.3 s" or "3 min". */
export function ageWords(ms: number): string {
  if (ms < 995) return `${Math.round(ms)} ms`;
  return ms < 100_000 ? `${(ms / 1000).toFixed(1)} s` : `${Math.round(ms / 60_000)} min`;
}

export class Header {
  readonly element: HTMLElement;
  private readonly subject: HTMLSelectElement;
  /** Of use where there are several subjects. */
  private readonly grid: HTMLButtonElement;
  private readonly status = h('p', { class: 'condition wait', role: 'status' });
  private readonly open = h('p', { class: 'open', hidden: true, title: text.header.openTitle }, text.header.open);
  private readonly figures = new Map<string, HTMLOutputElement>();

  constructor(private readonly state: AppState, commands: Record<'help' | 'panel' | 'dock' | 'layout', () => void>) {
    const t = text.header;
    this.grid = button(t.grid, () => state.grid.set(!state.grid.value), { title: t.gridTitle, hidden: true });
    state.grid.bind((on) => {
      this.grid.setAttribute('aria-pressed', String(on));
      if (on) this.grid.hidden = false;
    });
    this.subject = select(t.subject, [['', t.anySubject]], (name) => state.chooseSubject(name));
    this.element = h('header', {},
      h('h1', {}, 'Furrow'), this.subject, this.grid, this.status, this.open, h('span', { class: 'space' }),
      h('div', { class: 'numbers', 'aria-label': text.figures.group, role: 'group' },
        this.figure('rate'), this.figure('age'), this.figure('size'), this.figure('stream'), this.figure('limit')),
      button(t.layout, commands.layout, { title: t.layoutTitle, class: 'wide-only' }),
      button(t.curves, commands.dock, { title: t.curvesTitle, class: 'wide-only' }),
      button(t.panel, commands.panel, { title: t.panelTitle, class: 'wide-only' }),
      button('?', commands.help, { title: t.helpTitle, 'aria-label': t.help, class: 'help-button' }));
  }

  private figure(id: 'rate' | 'age' | 'size' | 'stream' | 'limit'): HTMLElement {
    const [label, title] = text.figures[id];
    // It changes several times per second, which a screen reader would read out.
    const output = h('output', { 'data-number': id, 'aria-live': 'off' }, text.figures.none);
    this.figures.set(id, output);
    return h('span', { class: 'figure', title }, h('span', {}, label), output);
  }

  showSubjects(names: readonly string[]): void {
    const wanted = this.state.subject.value;
    const known = wanted === '' || names.includes(wanted) ? names : [...names, wanted];
    setOptions(this.subject, [['', text.header.anySubject], ...known.map((name) => [name, name] as const)]);
    this.subject.value = wanted;
    this.grid.hidden = names.length < 2 && !this.state.grid.value;
  }

  /** Whether everybody on the network is let in. */
  showOpen(open: boolean): void {
    this.open.hidden = !open;
  }

  /** The advice is beside the picture, where there is room for it, and in the tooltip. */
  showCondition({ state, text: words, advice }: Condition): void {
    const title = advice === '' ? words : `${words}. ${advice}`;
    if (this.status.title === title && this.status.dataset.state === state) return;
    this.status.className = `condition ${LEVELS[state]}`;
    this.status.dataset.state = state;
    this.status.title = title;
    this.status.replaceChildren(h('strong', {}, words));
  }

  /** Null: there is no picture. */
  showFigures(figures: Figures | null): void {
    const t = text.figures;
    if (figures === null) {
      for (const id of this.figures.keys()) this.put(id, t.none);
      return;
    }
    const { picturesHz, posesHz, ageMs, isAtRest, width, height, drawnPercent, limit, stream, streamTitle } = figures;
    // Pictures of a pose at rest say nothing about the speed.
    this.put('rate', posesHz < 0.5 ? t.none : `${picturesHz.toFixed(0)} of ${posesHz.toFixed(0)} /s`);
    this.put('age', isAtRest ? t.atRest : ageMs === null ? t.none : ageWords(ageMs));
    const drawn = drawnPercent === 100 ? '' : t.drawn(drawnPercent);
    this.put('size', width === 0 ? t.none : `${width} × ${height}${drawn}`);
    this.put('stream', stream || t.none);
    this.figures.get('stream')!.title = streamTitle;
    this.put('limit', t.limits[limit]);
  }

  /** The condition and the figures in words, also those that a narrow screen hides. */
  words(): { condition: string; figures: (readonly [string, string])[] } {
    const figures = [...this.figures].map(([id, output]) => [text.figures[id as 'rate'][0], output.textContent ?? ''] as const);
    return { condition: this.status.textContent ?? '', figures };
  }

  private put(id: string, words: string): void {
    const output = this.figures.get(id)!;
    if (output.textContent !== words) output.textContent = words;
  }
}
