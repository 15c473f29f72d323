// SPDX-License-Identifier: Apache-2.0
// The settings of this page's picture: the daemon's settings and this page's overrides.
import type { SettingInfo } from '../api';
import { Signal } from '../ui/signal';

/** Values in the daemon's text form, by name. */
export type Values = ReadonlyMap<string, string>;

/** Changes of one setting within this time form one undo step. */
const ONE_STEP_MS = 800;
const MAX_STEPS = 200;

/** True if two texts mean the same value of a setting, such as "1" and "1.0", or "on" and "true". */
export function sameValue(info: SettingInfo, a: string, b: string): boolean {
  if (a === b) return true;
  if (info.kind === 'bool') return isOn(a) === isOn(b);
  if (info.kind !== 'int' && info.kind !== 'number' && info.kind !== 'colour') return false;
  const [left, right] = [a, b].map((text) => text.split(',').map(Number));
  return left!.length === right!.length &&
    left!.every((x, i) => Math.abs(x - right![i]!) <= 1e-6 * Math.max(1, Math.abs(x)));
}

export function isOn(text: string): boolean {
  return text === 'on' || text === 'true';
}

export class SettingsModel {
  /** Notifies of every change of values, infos or undo steps. */
  readonly changed = new Signal(0);
  private infos_: SettingInfo[] = [];
  private byName = new Map<string, SettingInfo>();
  private own: Values = new Map();
  private undoSteps: Values[] = [];
  private redoSteps: Values[] = [];
  private lastChange = { name: '', atMs: -Infinity };

  get infos(): readonly SettingInfo[] {
    return this.infos_;
  }
  info(name: string): SettingInfo | undefined {
    return this.byName.get(name);
  }
  /** The values of this page that differ from the daemon's. */
  get overrides(): Values {
    return this.own;
  }
  get canUndo(): boolean {
    return this.undoSteps.length > 0;
  }
  get canRedo(): boolean {
    return this.redoSteps.length > 0;
  }

  /** The overrides before the last undo step, which "Compare" shows. */
  get previous(): Values {
    return this.undoSteps.at(-1) ?? this.own;
  }

  value(name: string): string {
    return this.own.get(name) ?? this.byName.get(name)?.value ?? '';
  }

  /** Sets the daemon's settings, also after a reconnection or a PATCH. Undo steps remain. Equal ones change nothing. */
  setInfos(infos: SettingInfo[]): void {
    if (JSON.stringify(infos) === JSON.stringify(this.infos_)) return;
    this.infos_ = infos;
    this.byName = new Map(infos.map((info) => [info.name, info]));
    this.own = this.normalised(this.own);
    this.tell();
  }

  set(name: string, value: string, nowMs: number): void {
    this.setMany(new Map([[name, value]]), nowMs);
  }

  /** Several values that change together, as one does: quick changes of the same ones are one undo step. */
  setMany(values: Values, nowMs: number): void {
    if ([...values].every(([name, value]) => this.value(name) === value)) return;
    const name = [...values.keys()].join();
    const sameStep = name === this.lastChange.name && nowMs - this.lastChange.atMs < ONE_STEP_MS;
    this.lastChange = { name, atMs: nowMs };
    this.change(new Map([...this.own, ...values]), sameStep);
  }

  /** The next change is an undo step of its own, however soon it comes. */
  endStep(): void {
    this.lastChange = { name: '', atMs: -Infinity };
  }

  /** Resets a setting to the daemon's value. */
  reset(name: string): void {
    const next = new Map(this.own);
    if (next.delete(name)) this.change(next, false);
  }

  /** Like replace(), but without an undo step. For the start of the page. */
  begin(values: Values): string[] {
    const unknown = this.replace(values);
    this.undoSteps = [];
    this.tell();
    return unknown;
  }

  /** Replaces all overrides in one undo step. Ignores unknown names and returns them. */
  replace(values: Values): string[] {
    const known = new Map<string, string>();
    const unknown: string[] = [];
    for (const [name, value] of values) {
      if (this.byName.has(name)) known.set(name, value);
      else unknown.push(name);
    }
    this.change(known, false);
    return unknown;
  }

  undo(): void {
    this.step(this.undoSteps, this.redoSteps);
  }
  redo(): void {
    this.step(this.redoSteps, this.undoSteps);
  }

  /** Returns to `accepted` after the daemon rejected the current values. Leaves no undo step. */
  reject(accepted: Values): void {
    if (this.undoSteps.length > 0) this.undoSteps.pop();
    this.own = this.normalised(accepted);
    this.tell();
  }

  private step(from: Values[], to: Values[]): void {
    const next = from.pop();
    if (next === undefined) return;
    to.push(this.own);
    this.own = this.normalised(next);
    this.endStep();
    this.tell();
  }

  private change(next: Values, sameStep: boolean): void {
    if (!sameStep) {
      this.undoSteps.push(this.own);
      if (this.undoSteps.length > MAX_STEPS) this.undoSteps.shift();
    }
    this.redoSteps = [];
    this.own = this.normalised(next);
    this.tell();
  }

  private normalised(values: Values): Values {
    if (this.byName.size === 0) return values;
    return new Map(
      [...values].filter(([name, value]) => {
        const info = this.byName.get(name);
        return info !== undefined && !sameValue(info, info.value, value);
      }),
    );
  }

  private tell(): void {
    this.changed.set(this.changed.value + 1);
  }
}

/** Settings as "name=value" for the wire, except the view, which has its own field. */
export function assignments(values: Values): string[] {
  return [...values].filter(([name]) => name !== 'view').map(([name, v]) => `${name}=${v}`);
}
