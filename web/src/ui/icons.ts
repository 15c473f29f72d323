// SPDX-License-Identifier: Apache-2.0
// Line icons on a grid of 24 units, in the colour of the text.
import { svg } from './dom';

const PATHS = {
  view: 'M4 8V5h3M17 5h3v3M20 16v3h-3M7 19H4v-3M12 9.2a2.8 2.8 0 1 0 0 5.6 2.8 2.8 0 0 0 0-5.6',
  look: 'M4 7h9M17 7h3M4 17h3M11 17h9M15 4.8v4.4M9 14.8v4.4',
  wrinkles: 'M5 7c3-2 11-2 14 0M6 11.5c3-1.6 9-1.6 12 0M8 16c2-1.2 6-1.2 8 0',
  curves: 'M4 5v14h16M7 15l4-6 3 3 5-6',
  camera: 'M5 8h3l1.5-2h5L16 8h3v10H5zM12 10.2a2.8 2.8 0 1 0 0 5.6 2.8 2.8 0 0 0 0-5.6',
  page: 'M4 5h16v14H4zM4 8.5h16M14.5 8.5V19M7 16l2.2-3 3 4',
  capture: 'M12 4a8 8 0 1 0 0 16 8 8 0 0 0 0-16M9 9.5v1M15 9.5v1M8.8 14.2c2 1.8 4.4 1.8 6.4 0',
  sources: 'M9 3.5h6v17H9zM11.5 17.5h1M4 9v6M20 9v6',
  session: 'M5 19a7 7 0 0 1 14 0M12 5a3.4 3.4 0 1 0 0 6.8A3.4 3.4 0 0 0 12 5',
  light: 'M12 8.5a3.5 3.5 0 1 0 0 7 3.5 3.5 0 0 0 0-7M12 3v2.5M12 18.5V21M3 12h2.5M18.5 12H21M5.6 5.6l1.8 1.8M16.6 16.6l1.8 1.8M5.6 18.4l1.8-1.8M16.6 7.4l1.8-1.8',
  fullscreen: 'M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5',
  record: 'M12 6a6 6 0 1 0 0 12 6 6 0 0 0 0-12',
  take: 'M7.5 8a4 4 0 1 0 0 8 4 4 0 0 0 0-8M16.5 8a4 4 0 1 0 0 8 4 4 0 0 0 0-8M7.5 16h9',
  stop: 'M7 7h10v10H7z',
} as const;

export type IconName = keyof typeof PATHS;

export function icon(name: IconName): SVGSVGElement {
  return svg('svg', { viewBox: '0 0 24 24', class: 'icon', 'aria-hidden': 'true' }, svg('path', { d: PATHS[name] }));
}
