// SPDX-License-Identifier: Apache-2.0
// Moves the camera by mouse, touch, wheel and keys on the picture.
import { type Camera, look, orbit, pan, walk, walkSpeed, zoom } from './camera';

export interface CameraHost {
  camera(): Camera | null;
  move(camera: Camera): void;
  /** Takes a plain drag, or an arrow key, instead of the camera, in heights of the picture. Returns false if it does not. */
  drag?(right: number, up: number): boolean;
}

const TURN_PER_HEIGHT = Math.PI; // radians for a drag across the height of the picture
const ARROW_STEP = Math.PI / 36;
const ARROWS: Readonly<Record<string, readonly [number, number]>> = { arrowleft: [-1, 0], arrowright: [1, 0], arrowup: [0, 1], arrowdown: [0, -1] };
const WALK_KEYS = new Set(['w', 'a', 's', 'd', 'q', 'e']);

/**
 * Drag: orbit. Shift, middle or right button: pan. Alt: look around. Wheel and pinch: zoom. Two fingers: pan.
 * w a s d q e: walk, faster at a larger distance. Arrows: orbit. + and -: zoom.
 */
export class CameraInput {
  private readonly pointers = new Map<number, { x: number; y: number }>();
  private readonly held = new Set<string>();
  private lastTickMs = 0;

  constructor(private readonly element: HTMLElement, private readonly host: CameraHost) {
    element.addEventListener('pointerdown', (event) => this.onDown(event));
    element.addEventListener('pointermove', (event) => this.onMove(event));
    for (const end of ['pointerup', 'pointercancel'] as const) {
      element.addEventListener(end, (event) => this.pointers.delete(event.pointerId));
    }
    element.addEventListener('contextmenu', (event) => event.preventDefault());
    element.addEventListener('wheel', (event) => this.onWheel(event), { passive: false });
    element.addEventListener('keydown', (event) => this.onKey(event));
    element.addEventListener('keyup', (event) => this.held.delete(event.key.toLowerCase()));
    element.addEventListener('blur', () => this.held.clear());
  }

  private change(by: (camera: Camera) => Camera): void {
    const camera = this.host.camera();
    if (camera !== null) this.host.move(by(camera));
  }

  private onDown(event: PointerEvent): void {
    this.element.focus({ preventScroll: true });
    this.element.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  }

  private onMove(event: PointerEvent): void {
    const last = this.pointers.get(event.pointerId);
    if (last === undefined) return;
    const height = this.element.clientHeight;
    const dx = (event.clientX - last.x) / height;
    const dy = (event.clientY - last.y) / height;
    if (this.pointers.size === 2) this.onPinch(event, dx, dy);
    last.x = event.clientX;
    last.y = event.clientY;
    if (this.pointers.size > 1) return;
    if (event.altKey) {
      this.change((camera) => look(camera, dx, -dy));
    } else if (event.shiftKey || (event.buttons & 6) !== 0) {
      this.change((camera) => pan(camera, dx, dy));
    } else if (this.host.drag?.(dx, -dy) !== true) {
      this.change((camera) => orbit(camera, -dx * TURN_PER_HEIGHT, dy * TURN_PER_HEIGHT));
    }
  }

  /** One of two fingers moved. Half of its movement pans, and the change of their distance zooms. */
  private onPinch(event: PointerEvent, dx: number, dy: number): void {
    const moved = this.pointers.get(event.pointerId)!;
    const other = [...this.pointers.entries()].find(([id]) => id !== event.pointerId)![1];
    const before = Math.hypot(moved.x - other.x, moved.y - other.y);
    const after = Math.hypot(event.clientX - other.x, event.clientY - other.y);
    this.change((camera) => zoom(pan(camera, dx / 2, dy / 2), before / Math.max(after, 1)));
  }

  private onWheel(event: WheelEvent): void {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
    this.change((camera) => zoom(camera, Math.exp(event.deltaY * lines * 0.0012)));
  }

  private onKey(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey) return;
    const step = event.shiftKey ? 4 * ARROW_STEP : ARROW_STEP;
    const key = event.key.toLowerCase();
    const actions: Record<string, (camera: Camera) => Camera> = {
      arrowleft: (camera) => orbit(camera, -step, 0),
      arrowright: (camera) => orbit(camera, step, 0),
      arrowup: (camera) => orbit(camera, 0, step),
      arrowdown: (camera) => orbit(camera, 0, -step),
      '+': (camera) => zoom(camera, 0.9),
      '=': (camera) => zoom(camera, 0.9),
      '-': (camera) => zoom(camera, 1 / 0.9),
    };
    const action = actions[key];
    const [right, up] = ARROWS[key] ?? [0, 0];
    const share = step / TURN_PER_HEIGHT;
    if (key in ARROWS && this.host.drag?.(right * share, up * share) === true) {
      // The host has used it.
    } else if (action !== undefined) {
      this.change(action);
    } else if (WALK_KEYS.has(key) && !event.altKey) {
      if (this.held.size === 0) this.startWalking();
      this.held.add(key);
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }

  private startWalking(): void {
    this.lastTickMs = performance.now();
    const tick = (nowMs: number): void => {
      if (this.held.size === 0) return;
      const seconds = Math.max(0, nowMs - this.lastTickMs) / 1000;
      this.lastTickMs = nowMs;
      const axis = (plus: string, minus: string): number =>
        Number(this.held.has(plus)) - Number(this.held.has(minus));
      this.change((camera) => {
        const way = walkSpeed(camera) * seconds;
        return walk(camera, way * axis('w', 's'), way * axis('d', 'a'), way * axis('e', 'q'));
      });
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }
}
