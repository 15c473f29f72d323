// SPDX-License-Identifier: Apache-2.0
// Explains a region: the drivers and poses behind its weights, refreshed while the panel is shown.
import { api, type Contribution, type Explanation, wordsOf } from '../api';
import { isCompact } from '../state/layout';
import { text } from '../text';
import { button, h, regionWords } from '../ui/dom';

const t = text.explain;
const REFRESH_MS = 400;
/** Blend shapes of a driver that are named; they come strongest first. */
const MOST_SHAPES = 4;

/** Shares below this are shown as 0. */
const LEAST = 0.005;

const fixed = (x: number): string => x.toFixed(2);

/** Describes how a driver computed its value. */
export function contributionWords(item: Contribution): string {
  const parts: string[] = [];
  if (item.pose !== null) {
    const goal = item.reference_pose ? t.pose(item.reference_pose) : t.itsPose;
    const percent = Math.round(item.pose.along * 100);
    parts.push(percent < 0 ? t.away(goal) : t.along(percent, goal));
    if (item.pose.falloff < 0.995) parts.push(t.falloff(Math.round(item.pose.falloff * 100)));
  }
  for (const { what, degrees } of item.angles ?? []) parts.push(`${what} ${degrees.toFixed(1)}°`);
  if (item.strain !== null) {
    parts.push(t.strain(Math.round(item.strain.smallest * 100), Math.round(item.strain.largest * 100)));
  }
  const moved = (item.blend_shapes ?? []).filter(({ coefficient }) => Math.abs(coefficient) >= 0.005);
  for (const { name, coefficient } of moved.slice(0, MOST_SHAPES)) parts.push(`${name} ${fixed(coefficient)}`);
  if (moved.length > MOST_SHAPES) parts.push(t.moreShapes(moved.length - MOST_SHAPES));
  return parts.length > 0 ? parts.join(', ') : t.coefficient;
}

/** Describes the steps after the drivers were combined. Empty if those steps changed nothing. */
export function afterwardsWords(explanation: Explanation): string[] {
  const words: string[] = [];
  if (Math.abs(explanation.modulated - explanation.combined) > 0.005) {
    words.push(t.modulation(fixed(explanation.combined), fixed(explanation.modulated)));
  }
  for (const { weight, other, factor } of explanation.conflicts) {
    if (factor < 0.995) words.push(t.conflict(weight, fixed(other), fixed(factor)));
  }
  if (Math.abs(explanation.live - explanation.result) > 0.02) {
    words.push(t.filter(fixed(explanation.live), fixed(explanation.result)));
  }
  return words;
}

export class ExplainPanel {
  readonly element = h('section', { class: 'explain', 'aria-label': t.label, hidden: true });
  private readonly title = h('h2', {});
  private readonly body = h('div', { class: 'explain-body' });
  private weights: string[] = [];
  private timer: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly subject: () => string, private readonly onClose: () => void) {
    this.element.append(
      h('div', { class: 'row' }, this.title, h('span', { class: 'space' }), button(t.close, () => this.close())), this.body);
  }

  show(region: string, weights: string[]): void {
    this.weights = weights;
    this.title.textContent = t.title(regionWords(region));
    this.element.hidden = false;
    this.body.replaceChildren(h('p', { class: 'empty' }, t.loading));
    // A sheet shows little, and the answer matters more than the map above it.
    this.element.scrollIntoView({ block: isCompact.value ? 'start' : 'nearest' });
    if (this.timer !== null) clearTimeout(this.timer);
    void this.ask();
  }

  close(): void {
    this.element.hidden = true;
    this.weights = [];
    this.onClose();
  }

  private async ask(): Promise<void> {
    this.timer = null;
    const asked = this.weights;
    if (asked.length === 0) return;
    try {
      if (this.element.closest('[role=tabpanel][hidden]') === null && !document.hidden) {
        const answers = await Promise.all(asked.map((weight) => api.explain(this.subject(), weight)));
        if (asked !== this.weights) return;
        this.body.replaceChildren(...answers.map(explanationElement));
      }
    } catch (error) {
      if (asked !== this.weights) return;
      this.body.replaceChildren(h('p', { class: 'error' }, wordsOf(error)));
    }
    this.timer = setTimeout(() => void this.ask(), REFRESH_MS);
  }
}

function explanationElement(explanation: Explanation): HTMLElement {
  // Drivers that add nothing are named in one line, so that the answer stands alone.
  const idle = explanation.contributions.filter((item) => Math.abs(item.product) < LEAST);
  const rows = explanation.contributions.filter((item) => !idle.includes(item)).sort((a, b) => b.product - a.product).map((item) => {
    return h('tr', {},
      h('th', { scope: 'row' }, item.value, h('small', {}, contributionWords(item))),
      h('td', { class: 'number' }, item.gain === 1 ? fixed(item.driver_value) : `${fixed(item.driver_value)} × ${fixed(item.gain)}`),
      h('td', { class: 'number' }, fixed(item.product)));
  });
  return h('article', { 'data-weight': explanation.weight },
    h('h3', {}, explanation.weight, h('output', {}, fixed(explanation.live))),
    rows.length === 0 ? null : h('table', {}, h('thead', {}, h('tr', {}, ...t.columns.map((word) => h('th', { scope: 'col' }, word)))),
      h('tbody', {}, ...rows)),
    idle.length === 0 ? null : h('p', { class: 'rest' }, t.idle(idle.map(({ value }) => value), rows.length === 0)),
    ...afterwardsWords(explanation).map((words) => h('p', { class: 'note' }, words)));
}
