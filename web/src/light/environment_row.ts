// SPDX-License-Identifier: Apache-2.0
// Swatches of environments: one click changes lamps, sky and exposure, and leaves all other settings.
import type { AppState } from '../state/app_state';
import { sameValue, type Values } from '../state/settings';
import { text } from '../text';
import { button, h } from '../ui/dom';
import { type Environment, ENVIRONMENT_SETTINGS, ENVIRONMENTS, swatchOf } from './environments';

const t = text.light;

export class EnvironmentRow {
  readonly element = h('div', { class: 'environments', role: 'group', 'aria-label': t.environments });
  private readonly buttons: readonly HTMLButtonElement[];
  /** What was set before the first environment; null: nothing but environments was chosen since the page was opened. */
  private former: Values | null = null;

  constructor(private readonly state: AppState) {
    this.buttons = ENVIRONMENTS.map((environment) => this.buttonOf(environment));
    this.element.append(...this.buttons);
    state.settings.changed.bind(() => this.show());
  }

  private buttonOf(environment: Environment): HTMLButtonElement {
    const [name, title] = t.environmentNames[environment.name];
    const swatch = h('span', { class: 'swatch', 'aria-hidden': 'true' });
    swatch.style.backgroundImage = swatchOf(environment.values);
    const made = button('', () => this.toggle(environment), { class: 'environment', title, 'aria-label': name, 'data-environment': environment.name });
    made.append(swatch, h('span', { class: 'environment-name', 'aria-hidden': 'true' }, name));
    return made;
  }

  private isShown({ values }: Environment): boolean {
    const { settings } = this.state;
    return [...values].every(([name, value]) => {
      const info = settings.info(name);
      return info !== undefined && sameValue(info, settings.value(name), value);
    });
  }

  /** The environment that is shown leads back to the light before it. */
  private toggle(environment: Environment): void {
    const { settings } = this.state;
    const now = new Map(ENVIRONMENT_SETTINGS.map((name) => [name, settings.value(name)]));
    const usual = new Map(ENVIRONMENT_SETTINGS.map((name) => [name, settings.info(name)?.value ?? '']));
    const isShown = this.isShown(environment);
    const next = isShown ? (this.former ?? usual) : environment.values;
    if (isShown) this.former = null;
    else if (!ENVIRONMENTS.some((other) => this.isShown(other))) this.former = now;
    settings.endStep(); // each click is an undo step, however soon it comes
    settings.setMany(next, performance.now());
    settings.endStep();
  }

  private show(): void {
    ENVIRONMENTS.forEach((environment, i) => this.buttons[i]!.setAttribute('aria-pressed', String(this.isShown(environment))));
  }
}
