// SPDX-License-Identifier: Apache-2.0
// All subjects as tiles beside the large picture. A tile out of sight asks for no picture.
import type { SubjectInfo } from '../api';
import type { Condition, PictureState } from '../panels/condition';
import type { AppState } from '../state/app_state';
import { text } from '../text';
import { button, h, select, setOptions } from '../ui/dom';
import type { Signal } from '../ui/signal';
import type { ShownPicture } from '../view/picture_stats';
import type { Viewer } from '../view/viewer';
import type { Connection } from '../wire/connection';
import { neighbour, TileBudget, tilesOf, whoMoves } from './plan';
import { Tile } from './tile';

const t = text.grid;
/** A drag of the camera would otherwise make a request per tile and mouse event. */
const REFRESH_MS = 200;

/** `everyMs`: the time between pictures that were asked for. */
export type ConditionOf = (subject: string, picture: ShownPicture | null, everyMs: number) => Condition;

export class SubjectGrid {
  readonly element: HTMLElement;
  private readonly tiles = new Map<string, Tile>();
  private readonly list = h('div', { class: 'tiles', role: 'group', 'aria-label': t.tiles });
  private readonly count = h('span', { class: 'fine tile-count', role: 'status' });
  private readonly against: HTMLSelectElement;
  private readonly sight: IntersectionObserver;
  private readonly budget = new TileBudget();
  private focus = '';
  /** Of one tile. */
  private rateHz = 1;
  /** The large picture has been there, so the tiles may ask for theirs. */
  private isStarted = false;
  private timer: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly connection: Connection, private readonly state: AppState, private readonly viewer: Viewer) {
    const follow = button(t.follow, () => state.follows.set(!state.follows.value), { title: t.followTitle });
    this.against = select(t.compare, [['', t.compareNone]], (name) => state.against.set(name));
    this.element = h('section', { class: 'grid', 'aria-label': t.group, hidden: true },
      h('div', { class: 'row grid-bar' }, follow, this.against, this.count), this.list);
    this.sight = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        const tile = this.tiles.get((target as HTMLElement).dataset.subject ?? '');
        if (tile !== undefined) tile.isVisible = isIntersecting;
      }
      this.refresh();
    });
    this.list.addEventListener('keydown', (event) => this.onKey(event));
    const { grid, follows, against, settings, camera, comparing } = state;
    follows.bind((on) => follow.setAttribute('aria-pressed', String(on)));
    grid.bind((on) => {
      this.element.hidden = !on;
      if (!on) this.clear();
    });
    for (const signal of [settings.changed, camera, comparing]) (signal as Signal<unknown>).watch(() => this.refreshSoon());
    against.watch(() => {
      this.offerComparison();
      this.refresh();
    });
    new ResizeObserver(() => this.refreshSoon()).observe(this.list);
  }

  /** What the daemon says of its subjects. `focus`: the subject of the large picture. */
  setSubjects(subjects: readonly SubjectInfo[], focus: string): void {
    this.focus = focus;
    if (!this.state.grid.value) return;
    const shown = tilesOf(subjects, focus);
    this.reconcile(shown.map(({ name }) => name));
    const numPresent = subjects.filter(({ state }) => state !== 'ended').length;
    const words = t.count(shown.length, numPresent);
    if (this.count.textContent !== words) this.count.textContent = words;
    this.offerComparison();
    if (!this.state.follows.value) return;
    const mover = whoMoves(shown.filter(({ name }) => name !== this.state.against.value), focus);
    if (mover !== focus) this.state.subject.set(mover);
  }

  /** Called once per second: how the large picture is. */
  observe(state: PictureState, picturesHz: number, posesHz: number, isAtRest: boolean): void {
    this.isStarted ||= state !== 'loading';
    this.budget.observe(state, picturesHz, posesHz, isAtRest);
    this.refresh();
  }

  /** Says how each subject is. Called several times per second, because ages grow. */
  show(conditionOf: ConditionOf): void {
    for (const [name, tile] of this.tiles) {
      tile.show(conditionOf(name, tile.live.picture(), 1000 / this.rateHz), name === this.focus, this.isLarge(name));
    }
  }

  private choose(name: string): void {
    const { against } = this.state;
    if (name === against.value) against.set(this.focus);
    this.focus = name;
    this.state.chooseSubject(name);
    this.refresh();
  }

  private reconcile(names: readonly string[]): void {
    for (const [name, tile] of this.tiles) {
      if (names.includes(name)) continue;
      this.sight.unobserve(tile.element);
      tile.live.close();
      tile.element.remove();
      this.tiles.delete(name);
    }
    for (const name of names) {
      if (this.tiles.has(name)) continue;
      const tile = new Tile(name, this.connection, () => this.choose(name));
      this.tiles.set(name, tile);
      this.list.append(tile.element);
      this.sight.observe(tile.element);
    }
    if (this.list.querySelector('[tabindex="0"]') === null) this.list.querySelector('button')?.setAttribute('tabindex', '0');
    this.refresh();
  }

  private clear(): void {
    this.reconcile([]);
  }

  private refreshSoon(): void {
    this.timer ??= setTimeout(() => {
      this.timer = null;
      this.refresh();
    }, REFRESH_MS);
  }

  private isLarge(name: string): boolean {
    return name === this.focus || name === this.state.against.value;
  }

  /** Subjects with a large picture need no small one. */
  private refresh(): void {
    const asks = [...this.tiles.values()].filter(({ name, isVisible }) => isVisible && this.isStarted && !this.isLarge(name));
    this.rateHz = this.budget.rateHz(asks.length);
    for (const tile of this.tiles.values()) {
      tile.live.request(asks.includes(tile) ? this.viewer.requestOf(tile.name, tile.element, 1, this.rateHz) : null);
    }
  }

  private offerComparison(): void {
    const { against } = this.state;
    const names = [...this.tiles.keys()].filter((name) => name !== this.focus && name !== against.value);
    const all = against.value === '' ? names : [against.value, ...names];
    setOptions(this.against, [['', t.compareNone], ...all.map((name) => [name, t.compareWith(name)] as const)]);
    this.against.value = against.value;
  }

  private onKey(event: KeyboardEvent): void {
    const buttons = [...this.list.querySelectorAll<HTMLButtonElement>('button')];
    const at = buttons.indexOf(document.activeElement as HTMLButtonElement);
    if (at < 0) return;
    const columns = buttons.filter(({ offsetTop }) => offsetTop === buttons[0]!.offsetTop).length;
    const to = neighbour(event.key, at, buttons.length, columns);
    if (to < 0) return;
    event.preventDefault();
    for (const each of buttons) each.tabIndex = -1;
    buttons[to]!.tabIndex = 0;
    buttons[to]!.focus();
  }
}
