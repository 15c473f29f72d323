// SPDX-License-Identifier: Apache-2.0
// Guided capture: asks the performer for one pose after the other, and captures each when it is clear and steady.
import { PoseFeed } from 'furrow/protocol';
import { api, ApiError, type Capture, wordsOf } from '../api';
import { text } from '../text';
import { button, h } from '../ui/dom';
import type { Connection } from '../wire/connection';
import { type Gesture, gesturesOf, NEUTRAL } from './gestures';
import { BODY, FACE, Guide, type Progress, type Taken } from './guide';
import { type Difference, Sampler } from './measure';

const t = text.guide;
const TICK_MS = 50;
/** A daemon that is asked too often says so; another request may follow after this time. */
const AGAIN_MS = 1100;
const MOST_TRIES = 8;

const isTooOften = (error: unknown): boolean => error instanceof ApiError && error.status === 429;

/** Repeats a request that the daemon takes too often from this host. For requests that do not depend on the moment. */
async function patiently<T>(ask: () => Promise<T>): Promise<T> {
  for (let tries = 1; ; ++tries) {
    try {
      return await ask();
    } catch (error) {
      if (!isTooOften(error) || tries === MOST_TRIES) throw error;
      await new Promise((resolve) => setTimeout(resolve, AGAIN_MS));
    }
  }
}

/** The part of a difference that a stream with these parts shows best. */
function words({ mm, shape }: Difference, hasJoints: boolean, hasShapes: boolean): string {
  return [...(hasJoints ? [t.mm(mm)] : []), ...(hasShapes ? [t.percent(shape)] : [])].join(', ');
}

class Gauge {
  private readonly bar = h('progress', { max: 1, value: 0 });
  private readonly figure = h('output', { 'aria-live': 'off' });
  readonly element: HTMLElement;

  constructor(label: string) {
    this.element = h('label', { class: 'gauge' }, h('span', {}, label), this.figure, this.bar);
  }

  show(value: number, figure: string): void {
    this.bar.value = value;
    this.bar.classList.toggle('full', value >= 1);
    if (this.figure.textContent !== figure) this.figure.textContent = figure;
  }
}

export class GuidePanel {
  readonly element = h('section', { class: 'guide', 'aria-label': t.start });
  /** Large words on the picture, for a performer who stands away from the screen. */
  readonly card = h('div', { class: 'guide-card', hidden: true, 'aria-hidden': 'true' });
  private readonly step = h('p', { class: 'fine' });
  private readonly ask = h('h2', {});
  private readonly phase = h('p', { class: 'guide-phase', role: 'status' });
  private readonly error = h('p', { class: 'error', role: 'alert' });
  private readonly gauges = { distance: new Gauge(t.distance), steadiness: new Gauge(t.steadiness), held: new Gauge(t.held) };
  private readonly automatic = h('input', { type: 'checkbox', checked: true });
  private readonly now = button(t.now, () => void this.take(), { class: 'primary' });
  private readonly backButton = button(t.back, () => this.move((guide, nowMs) => guide.back(nowMs)));
  private readonly cardWords = h('p', { class: 'guide-card-words' });
  private readonly cardPhase = h('p', { class: 'guide-card-phase' });
  private readonly cardBar = h('progress', { max: 1, value: 0 });
  private feed: PoseFeed | null = null;
  private sampler: { of: bigint; sampler: Sampler } | null = null;
  private guide: Guide | null = null;
  private gestures: Gesture[] = [];
  private anchor = '';
  private name = '';
  private timer: ReturnType<typeof setInterval> | null = null;
  private isBusy = false;
  /** The summary was asked for while a request was under way. */
  private wantsSummary = false;
  /** Poses of the present gesture that are still to be captured; null: all. */
  private pending: string[] | null = null;
  /** The daemon takes no request before. */
  private againMs = -Infinity;
  /** What was captured, oldest first, which "Undo all" takes back. */
  private made: Capture[] = [];

  /** `onChanged`: the rig of the daemon has changed. `onOpen`: whether the guide takes the panel. */
  constructor(private readonly connection: Connection, private readonly subject: () => string,
              private readonly events: { onChanged(): void; onOpen(isOpen: boolean): void; say(words: string): void; saveRig(): void }) {
    this.card.append(this.cardWords, this.cardPhase, this.cardBar);
    this.close();
  }

  /** Shows the button that starts the guide. */
  private close(): void {
    this.stop();
    this.element.replaceChildren(h('p', {}, t.intro), button(t.start, () => void this.start()), this.error);
    this.events.onOpen(false);
  }

  private stop(): void {
    this.feed?.close();
    this.feed = this.guide = this.sampler = null;
    this.wantsSummary = false;
    this.pause();
  }

  private pause(): void {
    if (this.timer !== null) clearInterval(this.timer);
    this.timer = null;
    this.card.hidden = true;
  }

  /** Another subject is in focus. Captures would be of one that nobody sees. */
  onSubject(subject: string): void {
    if (subject !== '' && subject !== this.name) this.end(t.otherSubject(this.name));
  }

  /** Another daemon has none of the captures. */
  onRestart(): void {
    this.made = [];
    this.end(t.restarted);
  }

  /** Ends the walk, and says why. What was captured stays, and can be undone. */
  private end(why: string): void {
    if (this.feed === null) return;
    this.feed.close();
    this.feed = null;
    if (this.made.length === 0) this.close();
    else this.showSummary();
    this.error.textContent = why;
  }

  private async start(): Promise<void> {
    const name = this.subject();
    this.error.textContent = name === '' ? t.noSubject : '';
    if (name === '') return;
    try {
      const rig = await api.rig(name);
      if (name !== this.subject()) return; // the user has chosen another one meanwhile
      this.gestures = gesturesOf(rig);
      this.anchor = rig.anchor;
    } catch (error) {
      this.error.textContent = wordsOf(error);
      return;
    }
    this.stop();
    this.name = name;
    this.made = [];
    this.pending = null;
    this.feed = new PoseFeed(this.connection, { subject: name },
      { onPose: () => this.onPose(), onProblem: (problem) => (this.error.textContent = problem) });
    this.events.onOpen(true);
    this.showSteps();
  }

  private showSteps(): void {
    this.error.textContent = '';
    this.element.replaceChildren(this.step, this.ask, this.phase,
      this.gauges.distance.element, this.gauges.steadiness.element, this.gauges.held.element, this.error,
      h('div', { class: 'row' }, this.now, this.backButton, button(t.skip, () => this.move((guide, nowMs) => guide.skip(nowMs))),
        button(t.finish, () => this.showSummary())),
      h('label', { class: 'check' }, this.automatic, t.automatic),
      h('p', { class: 'fine' }, this.gestures.length > 1 ? text.capture.note : t.noPoses));
    this.timer ??= setInterval(() => this.tick(), TICK_MS);
    this.tick();
    this.now.focus();
  }

  private move(by: (guide: Guide, nowMs: number) => void): void {
    if (this.guide === null || this.isBusy) return;
    this.pending = null;
    by(this.guide, performance.now());
    this.tick();
  }

  private onPose(): void {
    const pose = this.feed?.pose() ?? null;
    if (pose === null) return;
    const nowMs = performance.now();
    const { hash } = pose.skeleton;
    if (this.sampler === null) {
      const sampler = new Sampler(pose.skeleton, this.anchor);
      this.sampler = { of: hash, sampler };
      this.guide = new Guide(this.gestures, sampler.rest(), sampler.isFace ? FACE : BODY, nowMs);
    } else if (this.sampler.of !== hash) {
      this.end(t.otherSkeleton); // samples of another skeleton cannot be compared
      return;
    }
    if (this.timer !== null) this.guide!.add(this.sampler.sampler.sample(pose), nowMs);
  }

  private tick(): void {
    if (this.feed === null) return;
    const nowMs = performance.now();
    const { guide } = this;
    this.card.hidden = false;
    if (guide === null) {
      this.show(this.gestures[0]!, 0, null);
      return;
    }
    if (guide.isOver || (guide.advance(nowMs) && guide.isOver)) {
      this.showSummary();
      return;
    }
    const progress = guide.progress(nowMs);
    this.show(guide.gesture!, guide.at, guide.isSilent(nowMs) ? null : progress);
    if (progress.phase === 'take' && this.automatic.checked && nowMs >= this.againMs) void this.take();
  }

  /** `progress`: null if no pose arrives. */
  private show(gesture: Gesture, at: number, progress: Progress | null): void {
    const put = (element: HTMLElement, now: string): void => {
      if (element.textContent !== now) element.textContent = now;
    };
    put(this.step, t.step(at + 1, this.gestures.length, this.name));
    put(this.ask, gesture.words);
    put(this.phase, progress === null ? t.silent : t.phases[progress.phase]);
    put(this.cardWords, gesture.words);
    put(this.cardPhase, progress === null ? t.silent : t.phases[progress.phase]);
    this.element.dataset.phase = this.card.dataset.phase = progress?.phase ?? 'silent';
    const isNeutral = gesture.poses.includes(NEUTRAL);
    this.gauges.distance.element.hidden = isNeutral;
    this.gauges.distance.show(progress?.far ?? 0, progress === null ? t.unknown : this.words(progress.distance));
    this.gauges.steadiness.show(progress?.steady ?? 0, progress?.wobble ? t.within(this.words(progress.wobble)) : t.unknown);
    const held = progress?.phase === 'good' ? 1 : (progress?.held ?? 0);
    this.gauges.held.show(held, '');
    this.cardBar.value = held;
    this.now.disabled = progress === null || this.isBusy || progress.phase === 'good';
    this.backButton.disabled = at === 0;
  }

  private words(difference: Difference): string {
    const sampler = this.sampler!.sampler;
    return words(difference, sampler.hasJoints, sampler.hasShapes);
  }

  private async take(): Promise<void> {
    const { guide } = this;
    if (guide === null || guide.isOver || this.isBusy || guide.isPraising) return;
    this.isBusy = true;
    const isHeld = guide.progress(performance.now()).phase === 'take';
    const { name: subject } = this;
    const pending = (this.pending ??= [...guide.gesture!.poses]);
    const numMade = this.made.length;
    let problem = '';
    try {
      // The daemon captures what is live when it answers, so nothing is repeated without another look at the performer.
      while (pending.length > 0) {
        const pose = pending[0]!;
        await api.capture(subject, pose, false);
        if (this.guide !== guide) return;
        this.made.push({ pose, subject });
        pending.shift();
      }
      this.pending = null;
      const nowMs = performance.now();
      if (isHeld && guide.progress(nowMs).phase !== 'take') problem = t.moved;
      else guide.accept(nowMs);
    } catch (error) {
      problem = this.onFailed(error, guide);
    } finally {
      this.isBusy = false;
      if (this.guide === guide) {
        if (this.made.length > numMade) this.events.onChanged();
        if (this.feed === null) this.showSummary(); // the walk has ended meanwhile, and says why
        else this.error.textContent = problem;
        if (this.wantsSummary) this.showSummary();
      }
    }
  }

  /** A capture has failed. Returns what to say. */
  private onFailed(error: unknown, guide: Guide): string {
    if (isTooOften(error)) {
      const nowMs = performance.now();
      this.againMs = nowMs + AGAIN_MS;
      // Only while it is still held, what was captured already is of this expression.
      if (guide.progress(nowMs).phase !== 'take') this.pending = null;
      return this.automatic.checked ? t.busy : t.busyNow;
    }
    guide.refuse(performance.now());
    this.automatic.checked = false; // or it would be tried again and again
    return wordsOf(error);
  }

  private showSummary(): void {
    const { guide } = this;
    this.wantsSummary = this.isBusy;
    if (this.isBusy) return;
    this.pause();
    const row = ({ words: said }: Gesture, at: number): HTMLElement => {
      const taken = guide?.taken[at] ?? null;
      return h('tr', { 'data-taken': String(taken !== null) }, h('th', { scope: 'row' }, said), ...this.quality(taken),
        h('td', {}, guide === null || this.feed === null ? null : button(taken === null ? t.take : t.again, () => this.again(at), { 'aria-label': t.againNamed(said) })));
    };
    const undo = button(t.undoAll, () => void this.undoAll(), { disabled: this.made.length === 0 });
    const done = button(t.done, () => this.close(), { class: 'primary' });
    this.element.replaceChildren(h('h2', {}, t.summary(this.name)),
      this.error, h('div', { class: 'row' }, done, undo, button(text.capture.download, () => this.events.saveRig())),
      h('table', { class: 'guide-summary' }, h('thead', {}, h('tr', {}, ...t.columns.map((word) => h('th', { scope: 'col' }, word)))),
        h('tbody', {}, ...this.gestures.map(row))),
      h('p', { class: 'fine' }, text.capture.note));
    done.focus();
  }

  private quality(taken: Taken | null): HTMLElement[] {
    if (taken === null) return [h('td', { colspan: 2 }, t.skipped)];
    const { distance, wobble } = taken;
    return [h('td', { class: 'number' }, distance === null ? t.unknown : this.words(distance)),
      h('td', { class: 'number' }, wobble === null ? t.unknown : t.within(this.words(wobble)))];
  }

  private again(at: number): void {
    if (this.isBusy) return;
    this.guide?.goTo(at, performance.now());
    this.pending = null;
    this.showSteps();
  }

  private async undoAll(): Promise<void> {
    if (this.isBusy) return;
    this.isBusy = true;
    let count = 0;
    try {
      let { captures } = await api.rig(this.name);
      for (let ours = this.made.at(-1); ours !== undefined; ours = this.made.at(-1)) {
        const last = captures.at(-1);
        if (last === undefined) throw new Error(t.exhausted(this.made.length));
        if (last.pose !== ours.pose || last.subject !== ours.subject) throw new Error(t.notOurs);
        ({ captures } = await patiently(() => api.undoCapture()));
        this.made.pop();
        ++count;
      }
      this.events.say(t.undone(count));
      this.isBusy = false;
      this.close();
    } catch (error) {
      this.error.textContent = wordsOf(error);
    }
    this.isBusy = false;
    if (this.wantsSummary) this.showSummary();
    this.events.onChanged();
  }
}
