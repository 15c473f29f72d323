// SPDX-License-Identifier: Apache-2.0
// Curves of wrinkle weights: live, or any span of what is kept, with markers.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import type { AppState } from '../state/app_state';
import { CurveSpan, type Kept } from '../state/curve_span';
import type { WeightFrame, WeightHistory } from '../state/weight_history';
import { text } from '../text';
import { button, download, h } from '../ui/dom';
import type { Toasts } from '../ui/toast';
import type { Connection } from '../wire/connection';
import { TakeBar } from './take_bar';

const t = text.curves;
const AUTOMATIC = 5;
const REDRAW_MS = 50;
/** Seconds for which an automatic choice is kept, so that curves do not flicker. */
const CHOICE_S = 4;
const ZOOM = 1.5;
/** Share of the span that a key or a button moves. */
const STEP = 0.2;
/** Pointers that move less have clicked. */
const CLICK_PX = 4;
/** Distinguishable on a dark background, also with colour blindness (Okabe and Ito, lightened). */
const ON_DARK = ['#f0b43c', '#62bdf0', '#3fcf9e', '#f3ec6c', '#7aa5ff', '#ff8a5c', '#e09fcb', '#e6e6e6'];
/** The same on a light background (Okabe and Ito, darkened). */
const ON_LIGHT = ['#b07400', '#2f86b8', '#007a59', '#8a8200', '#0058a3', '#b84a00', '#a8598b', '#000000'];

export class CurvesPanel {
  readonly element: HTMLElement;
  readonly take: TakeBar;
  private readonly plotHolder = h('div', { class: 'plot', role: 'application', tabindex: 0, 'aria-label': t.plot });
  private readonly chips = h('div', { class: 'chips', role: 'group', 'aria-label': t.shown });
  private readonly moment = h('output', { class: 'moment', 'aria-live': 'off' });
  private readonly marks = h('div', { class: 'marks', role: 'group', 'aria-label': t.markers });
  private readonly hint = h('p', { class: 'empty curves-hint' }, t.empty);
  private readonly picker = h('details', { class: 'picker' });
  private readonly bar: HTMLElement;
  private readonly freeze: HTMLButtonElement;
  private readonly span: CurveSpan;
  private plot: uPlot | null = null;
  private shown: string[] = [];
  /** The frames of the plot, oldest first. */
  private frames: readonly WeightFrame[] = [];
  /** Of the weights of these frames. */
  private names: readonly string[] = [];
  /** Index of the frame under the pointer; null: none. */
  private hovered: number | null = null;
  private chosenAtS = -Infinity;
  private readonly light = matchMedia('(prefers-color-scheme: light)');
  private drawnMs = 0;
  private pickerNames = '';

  constructor(private readonly state: AppState, private readonly history: WeightHistory,
              connection: Connection, subject: () => string, toasts: Toasts) {
    this.span = new CurveSpan(history.seconds);
    this.take = new TakeBar(connection, subject, () => this.span.range(this.kept()), () => this.showEmpty(), toasts);
    this.freeze = button(t.freeze, () => this.change(() => (this.span.isLive ? this.span.stop(this.kept()) : this.span.live())),
      { 'aria-pressed': 'false', title: t.freezeTitle });
    this.picker.append(h('summary', {}, t.choose));
    this.picker.addEventListener('toggle', () => this.fillPicker());
    const move = (label: string, title: string, by: () => void): HTMLButtonElement =>
      button(label, () => this.change(by), { class: 'small', title, 'aria-label': title });
    this.bar = h('div', { class: 'row bar-row' }, this.chips, this.moment,
      h('div', { class: 'row span-buttons', role: 'group', 'aria-label': t.span },
        move('◀', t.earlier, () => this.pan(-STEP)), move('▶', t.later, () => this.pan(STEP)),
        move('−', t.zoomOut, () => this.zoom(ZOOM)), move('+', t.zoomIn, () => this.zoom(1 / ZOOM)),
        button(t.mark, () => this.mark(), { title: t.markTitle })),
      this.picker, this.freeze, button(t.csv, () => this.save(), { title: t.csvTitle }), this.take.element);
    this.element = h('section', { class: 'curves', 'aria-label': t.group },
      this.bar, this.marks, this.plotHolder, this.hint);
    this.showEmpty();
    this.light.addEventListener('change', () => this.plot !== null && this.build());
    state.curves.watch(() => {
      this.choose();
      this.redraw();
    });
    this.plotHolder.addEventListener('keydown', (event) => this.onKey(event));
    new ResizeObserver(() => this.plot?.setSize(this.size())).observe(this.plotHolder);
  }

  /** Called for each new frame of weights. */
  onFrame(): void {
    const nowMs = performance.now();
    if (nowMs - this.drawnMs < REDRAW_MS || !this.element.isConnected) return;
    this.drawnMs = nowMs;
    if (this.span.forget(this.kept())) this.showMarkers();
    if (!this.span.isLive && this.plot !== null) return;
    this.showEmpty();
    if (nowMs / 1000 - this.chosenAtS > CHOICE_S || this.shown.length === 0) this.choose();
    this.redraw();
  }

  /** Without weights, a line of words takes the place of axes and buttons. */
  private showEmpty(): void {
    const isEmpty = this.history.frames.length === 0;
    this.hint.hidden = !isEmpty;
    this.plotHolder.hidden = isEmpty;
    this.bar.hidden = isEmpty && !this.take.isRecording; // it has the button that stops
  }

  /** Another subject is watched. */
  reset(): void {
    this.hovered = null;
    this.change(() => this.span.reset());
    this.showEmpty();
  }

  /** Marks the pose under the pointer, or else the last one that is shown. */
  mark(): void {
    const frame = this.frames[this.hovered ?? this.frames.length - 1];
    if (frame === undefined) return;
    this.change(() => this.span.mark(frame.atS, frame.sequence));
  }

  /** The curves end with the pose on the screen, so that both show the same moment. Curves that stand still keep what they show. */
  private kept(): Kept {
    const newestS = this.history.current?.atS ?? 0;
    const shownS = this.span.isLive ? Infinity : (this.frames[0]?.atS ?? Infinity);
    return { oldestS: Math.min(shownS, this.history.frames[0]?.atS ?? newestS), newestS };
  }

  private change(by: () => void): void {
    by();
    this.plotHolder.dataset.span = this.span.lengthS.toFixed(1);
    this.freeze.setAttribute('aria-pressed', String(!this.span.isLive));
    this.showMarkers();
    this.redraw();
  }

  private pan(share: number): void {
    this.span.pan(share * this.span.lengthS, this.kept());
  }

  private zoom(factor: number, share = 0.5): void {
    this.span.zoom(factor, share, this.kept());
  }

  private onKey(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const actions: Record<string, () => void> = {
      ArrowLeft: () => this.pan(-STEP), ArrowRight: () => this.pan(STEP), '+': () => this.zoom(1 / ZOOM), '=': () => this.zoom(1 / ZOOM),
      '-': () => this.zoom(ZOOM), Home: () => this.span.pan(-this.history.seconds, this.kept()), End: () => this.span.live(),
    };
    const action = actions[event.key];
    if (action === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    this.change(action);
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
      cursor: { y: false, drag: { x: false, y: false, setScale: false } },
      padding: [6, 8, 0, 0],
      scales: { x: { time: false, range: () => this.axisRange() }, y: { range: [0, 1] } },
      axes: [{ ...axis, values: (_, ticks) => ticks.map((tick) => `${Number(tick.toFixed(2))} s`), size: 24, space: 64 }, { ...axis, size: 42, splits: [0, 0.25, 0.5, 0.75, 1] }],
      series: [{}, ...this.shown.map((name, i) => ({ label: name, stroke: colours[i]!, width: 1.6, points: { show: false } }))],
      hooks: { setCursor: [(plot) => this.onHover(plot)], draw: [(plot) => this.drawMarkers(plot, words)] },
    }, [[], ...this.shown.map(() => [])], this.plotHolder);
    this.chips.replaceChildren(...this.shown.map((name, i) =>
      h('span', { class: 'chip', style: `--colour:${colours[i]!}`, 'data-name': name }, name, h('output', {}, '–'))));
    this.listen(this.plot.over);
  }

  /** Wheel: zoom at the pointer. Drag: pan. */
  private listen(over: HTMLElement): void {
    let last: { x: number; began: number } | null = null;
    over.style.touchAction = 'pan-y';
    over.addEventListener('wheel', (event) => {
      event.preventDefault();
      const { left, width } = over.getBoundingClientRect();
      this.change(() => this.zoom(Math.exp(event.deltaY * 0.0015), (event.clientX - left) / Math.max(1, width)));
    }, { passive: false });
    over.addEventListener('pointerdown', (event) => {
      this.plotHolder.focus({ preventScroll: true });
      over.setPointerCapture(event.pointerId);
      last = { x: event.clientX, began: event.clientX };
    });
    over.addEventListener('pointermove', (event) => {
      if (last === null) return;
      const { x, began } = last;
      if (Math.abs(event.clientX - began) < CLICK_PX && x === began) return;
      last.x = event.clientX;
      this.change(() => this.pan((x - event.clientX) / Math.max(1, over.clientWidth)));
    });
    for (const end of ['pointerup', 'pointercancel'] as const) over.addEventListener(end, () => (last = null));
  }

  /** On the axis, which counts from zero(). */
  private axisRange(): [number, number] {
    const kept = this.kept();
    const zero = this.span.zero(kept);
    const [from, to] = this.span.range(kept);
    return [from - zero, to - zero];
  }

  private redraw(): void {
    if (this.plot === null) return;
    const kept = this.kept();
    const zero = this.span.zero(kept);
    const range = this.span.range(kept);
    const { history } = this;
    // Curves that stand still outlive what the history keeps.
    const isStill = !this.span.isLive && this.names === history.names;
    this.frames = isStill ? history.betweenAndShown(this.frames, ...range) : history.between(...range);
    this.names = history.names;
    const columns = this.shown.map((name) => this.history.indexOf(name));
    this.plot.setData([
      this.frames.map((frame) => frame.atS - zero),
      ...columns.map((column) => this.frames.map((frame) => frame.values[column] ?? null)),
    ]);
    this.showValues();
    this.take.onSpan();
  }

  private onHover(plot: uPlot): void {
    const { idx, left } = plot.cursor;
    this.hovered = left === undefined || left < 0 ? null : (idx ?? null);
    this.showValues();
  }

  /** The values under the pointer, or else those of the last moment that is shown. */
  private showValues(): void {
    const frame = this.frames[this.hovered ?? this.frames.length - 1];
    this.chips.querySelectorAll('output').forEach((output, i) => {
      const value = frame?.values[this.history.indexOf(this.shown[i]!)];
      output.textContent = value === undefined ? text.figures.none : value.toFixed(2);
    });
    const zero = this.span.zero(this.kept());
    this.moment.textContent = this.hovered === null || frame === undefined ? '' : t.moment((frame.atS - zero).toFixed(2), frame.sequence, frame.timecode?.text ?? '');
  }

  private drawMarkers(plot: uPlot, colour: string): void {
    const zero = this.span.zero(this.kept());
    const { ctx } = plot;
    const { left, top, width, height } = plot.bbox;
    ctx.save();
    ctx.strokeStyle = ctx.fillStyle = colour;
    ctx.font = `${11 * devicePixelRatio}px system-ui`;
    for (const { number, atS } of this.span.markers) {
      const x = plot.valToPos(atS - zero, 'x', true);
      if (x < left || x > left + width) continue;
      ctx.setLineDash([4 * devicePixelRatio, 3 * devicePixelRatio]);
      ctx.beginPath();
      ctx.moveTo(x, top);
      ctx.lineTo(x, top + height);
      ctx.stroke();
      ctx.fillText(String(number), x + 3 * devicePixelRatio, top + 11 * devicePixelRatio);
    }
    this.drawTake(plot, zero);
    ctx.restore();
  }

  /** A line along the upper edge where a take has poses. */
  private drawTake(plot: uPlot, zero: number): void {
    const { range } = this.take;
    if (range === null) return;
    const { left, top, width } = plot.bbox;
    const [from, to] = range.map((atS) => Math.min(left + width, Math.max(left, plot.valToPos(atS - zero, 'x', true)))) as [number, number];
    plot.ctx.fillStyle = getComputedStyle(this.element).getPropertyValue('--bad');
    plot.ctx.fillRect(from, top, to - from, 3 * devicePixelRatio);
  }

  private showMarkers(): void {
    const { markers } = this.span;
    const now = markers.map(({ number }) => number).join();
    this.marks.hidden = markers.length === 0;
    if (this.marks.dataset.numbers === now) return;
    this.marks.dataset.numbers = now;
    this.marks.replaceChildren(...markers.map(({ number, atS, sequence }) => h('span', { class: 'mark' },
      button(String(number), () => this.change(() => this.span.show(atS, this.kept())), { title: t.showMarker(number, sequence) }),
      button('×', () => this.change(() => this.span.unmark(number)), { 'aria-label': t.unmark(number), title: t.unmark(number) }))));
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

  private save(): void {
    download('weights.csv', 'text/csv', this.history.toCsv(this.frames, this.names));
  }
}
