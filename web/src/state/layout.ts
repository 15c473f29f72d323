// SPDX-License-Identifier: Apache-2.0
// How the page arranges itself. On small screens, panels become sheets below or beside the picture, one at a time.
import { Signal } from '../ui/signal';

/** Follows a media query; false where there are none, as in unit tests. */
function matches(query: string): Signal<boolean> {
  const signal = new Signal(false);
  if (typeof matchMedia !== 'function') return signal;
  const list = matchMedia(query);
  signal.set(list.matches);
  list.addEventListener('change', () => signal.set(list.matches));
  return signal;
}

// style/layout.css has the second query, too.
/** True on small screens. */
export const isCompact = matches('(max-width: 900px), (max-height: 500px)');
/** True on a phone on its side, where the header lies on the picture. */
export const isAcross = matches('(max-height: 500px) and (min-aspect-ratio: 1)');
