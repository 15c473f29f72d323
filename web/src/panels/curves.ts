// SPDX-License-Identifier: Apache-2.0
// Live curves of wrinkle weights over the last seconds.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import type { AppState } from '../state/app_state';
import type { WeightHistory } from '../state/weight_history';
import { text } from '../text';
import { button, download, h } from '../ui/dom';

const t = text.curves;
const SHOWN_S = 10;
const AUTOMATIC = 5;
const REDRAW_MS = 50;
/** Seconds for which an automatic choice is kept, so that curves do not flicker. */
const CHOICE_S = 4;
/** Distinguishable on a dark background, also with colour blindness (Okabe and Ito, lightened). */
const ON_DARK = ['#f0b43c', '#62bdf0', '#3fcf9e', '#f3ec6c', '#7aa5ff', '#ff8a5c', '#e09fcb', '#e6e6e6'];
/** The same on a light background (Okabe and Ito, darkened). */
const ON_LIGHT = ['#b07400', '#2f86b8', '#007a59', '#8a8200', '#0058a3', '#b84a00', '#a8598b', '#000000'];

export class CurvesPanel {
  readonly element: HTMLElement;
  private readonly plotHolder = h('div', { class: 'plot', role: 'img', 'aria-label': t.plot });
  private readonly chips = h('div', { class: 'chips', role: 'group', 'aria-label': t.shown });
  private readonly picker = h('details', { class: 'picker' });
  private readonly freeze: HTMLButtonElement;
  private plot: uPlot | null = null;
  private shown: string[] = [];
  private chosenAtS = -Infinity;
  private readonly light = matchMedia('(prefers-color-scheme: light)');
  private frozen = false;
  private drawnMs = 0;
  private pickerNames = '';

  constructor(private readonly state: AppState, private readonly history: WeightHistory) {
    this.freeze = button(t.freeze, () => this.toggleFrozen(), { 'aria-pressed': 'false' });
    this.picker.append(h('summary', {}, t.choose));
    this.picker.addEventListener('toggle', () => this.fillPicker());
    this.element = h('section', { class: 'curves', 'aria-label': t.group },
      h('div', { class: 'row bar-row' }, this.chips, this.picker, this.freeze,
        button(t.csv, () => this.save(), { title: t.csvTitle })),
      this.plotHolder);
    this.light.addEventListener('change', () => this.plot !== null && this.build());
    state.curves.watch(() => {
      this.choose();
      this.redraw();
    });
    new ResizeObserver(() => this.plot?.setSize(this.size())).observe(this.plotHolder);
  }

  /** Called for each new frame of weights. */
  onFrame(): void {
    const nowMs = performance.now();
    if (this.frozen || nowMs - this.drawnMs < REDRAW_MS || !this.element.isConnected) return;
    this.drawnMs = nowMs;
    if (nowMs / 1000 - this.chosenAtS > CHOICE_S || this.shown.length === 0) this.choose();
    this.redraw();
  }

  private choose(): void {
    this.chosenAtS = performance.now() / 1000;
    const picked = this.state.curves.value.filter((name) => this.history.indexOf(name) >= 0);
    const next = picked.length > 0 ? picked.slice(0, ON_DARK.length) : this.history.mostActive(AUTOMATIC);
    if (next.join() === this.shown.join() && this.plot !== null) return;
    this.shown = next;
    this.build();
  }

  private size(): { width: number; height: number } {
    return { width: Math.max(120, this.plotHolder.clientWidth), height: Math.max(60, this.plotHolder.clientHeight) };
  }

  private build(): void {
    this.plot?.destroy();
    const style = getComputedStyle(this.element);
    const [words, grid] = ['--dim', '--grid'].map((name) => style.getPropertyValue(name).trim() || '#888') as [string, string];
    const colours = this.light.matches ? ON_LIGHT : ON_DARK;
    const axis = { stroke: words, grid: { stroke: grid, width: 1 }, ticks: { stroke: grid }, font: '11px system-ui' };
    this.plot = new uPlot({
      ...this.size(),
      legend: { show: false },
      cursor: { y: false },
      padding: [6, 8, 0, 0],
      scales: { x: { time: false, range: [-SHOWN_S, 0] }, y: { range: [0, 1] } },
      axes: [{ ...axis, values: (_, ticks) => ticks.map((tick) => `${tick} s`), size: 24 }, { ...axis, size: 42, splits: [0, 0.25, 0.5, 0.75, 1] }],
      series: [{}, ...this.shown.map((name, i) => ({ label: name, stroke: colours[i]!, width: 1.6, points: { show: false } }))],
    }, [[], ...this.shown.map(() => [])], this.plotHolder);
    this.chips.replaceChildren(...this.shown.map((name, i) =>
      h('span', { class: 'chip', style: `--colour:${colours[i]!}`, 'data-name': name }, name, h('output', {}, '–'))));
  }

  private redraw(): void {
    if (this.plot === null) return;
    // The curves end with the pose on the screen, so that both show the same moment.
    const newest = this.history.current?.atS ?? 0;
    const frames = this.history.shown.filter((frame) => newest - frame.atS <= SHOWN_S);
    const columns = this.shown.map((name) => this.history.indexOf(name));
    this.plot.setData([
      frames.map((frame) => frame.atS - newest),
      ...columns.map((column) => frames.map((frame) => frame.values[column] ?? null)),
    ]);
    this.chips.querySelectorAll('output').forEach((output, i) => {
      output.textContent = this.history.value(this.shown[i]!).toFixed(2);
    });
  }

  private fillPicker(): void {
    if (!this.picker.open || this.pickerNames === this.history.names.join()) return;
    this.pickerNames = this.history.names.join();
    const boxes = this.history.names.map((name) => {
      const box = h('input', { type: 'checkbox', checked: this.state.curves.value.includes(name) });
      box.addEventListener('change', () => this.pick(name, box.checked));
      return h('label', { class: 'check' }, box, name);
    });
    const automatic = button(t.mostActive, () => {
      this.picker.querySelectorAll('input').forEach((box) => (box.checked = false));
      this.state.curves.set([]);
    });
    this.picker.replaceChildren(this.picker.firstElementChild!, h('div', { class: 'picker-list' }, automatic, ...boxes));
  }

  private pick(name: string, on: boolean): void {
    const rest = this.state.curves.value.filter((other) => other !== name);
    this.state.curves.set(on ? [...rest, name] : rest);
  }

  private toggleFrozen(): void {
    this.frozen = !this.frozen;
    this.freeze.setAttribute('aria-pressed', String(this.frozen));
  }

  private save(): void {
    download('weights.csv', 'text/csv', this.history.toCsv());
  }
}
