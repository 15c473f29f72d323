// SPDX-License-Identifier: Apache-2.0
// Faults of a layout that a reader sees: parts that are cut off, covered or too small for a finger.

/** Least width and height of a target for fingers, in CSS pixels. */
export const FINGER_PX = 44;

/** Controls that are visible, and smaller than a finger. A label of a checkbox counts with it. */
export function smallTargets(page) {
  return page.evaluate((least) => {
    const found = [];
    for (const element of document.querySelectorAll('button, select, input, summary, [role=tab], a')) {
      if (!element.checkVisibility({ visibilityProperty: true, opacityProperty: true }) || element.closest('svg') !== null) continue;
      const target = element.matches('input[type=checkbox]') ? element.closest('label') ?? element : element;
      // A slider is as high as a finger; its track is narrower than that.
      const { width, height } = target.getBoundingClientRect();
      if (width === 0 || height >= least - 0.5 && width >= least - 0.5) continue;
      found.push(`${element.outerHTML.slice(0, 100)}: ${Math.round(width)} x ${Math.round(height)}`);
    }
    return found;
  }, FINGER_PX);
}

/** Describes each part of the page that is cut off, clipped or covered by another part. Empty if the layout is whole. */
export function layoutFaults(page) {
  return page.evaluate(() => {
    const CONTROLS = 'button, select, input, summary, [role=tab], a, progress';
    const faults = [];
    const name = (element) => `<${element.tagName.toLowerCase()} ${element.className || element.id}> "${(element.getAttribute('aria-label') ?? element.textContent).trim().slice(0, 50)}"`;
    const scrolls = (style, axis) => ['auto', 'scroll'].includes(axis === 'x' ? style.overflowX : style.overflowY);
    const isSeen = (element) => element.checkVisibility({ visibilityProperty: true, opacityProperty: true });

    /** The part of the element that scrolling ancestors show. Null: none. */
    function seenPart(element) {
      let { left, top, right, bottom } = element.getBoundingClientRect();
      for (let parent = element.parentElement; parent !== null; parent = parent.parentElement) {
        const style = getComputedStyle(parent);
        if (style.overflowX === 'visible' && style.overflowY === 'visible') continue;
        const box = parent.getBoundingClientRect();
        [left, right] = [Math.max(left, box.left), Math.min(right, box.right)];
        [top, bottom] = [Math.max(top, box.top), Math.min(bottom, box.bottom)];
      }
      return right - left < 1 || bottom - top < 1 ? null : { left, top, right, bottom };
    }

    /** Whether a scroll bar leads to what is cut off. */
    const canScrollTo = (element, axis) => {
      for (let parent = element.parentElement; parent !== null; parent = parent.parentElement) {
        if (scrolls(getComputedStyle(parent), axis)) return true;
      }
      return false;
    };

    const texts = [...document.body.querySelectorAll('*')].filter((element) => element.closest('svg, .uplot, noscript, script, option') === null &&
      [...element.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.data.trim() !== ''));
    const parts = [...new Set([...document.body.querySelectorAll(CONTROLS), ...texts])].filter((element) => isSeen(element) && element.closest('svg') === null);

    if (document.documentElement.scrollWidth > innerWidth) faults.push(`the page is ${document.documentElement.scrollWidth} px wide`);
    for (const element of parts) {
      const { left, top, right, bottom, width, height } = element.getBoundingClientRect();
      if (width <= 1 || height <= 1) continue; // also what only screen readers get
      const seen = seenPart(element);
      if (seen === null) {
        if (!canScrollTo(element, 'y') && !canScrollTo(element, 'x')) faults.push(`cut off entirely: ${name(element)}`);
        continue;
      }
      const cutX = Math.max(seen.left - left, right - seen.right, -left, right - innerWidth);
      const cutY = Math.max(seen.top - top, bottom - seen.bottom, -top, bottom - innerHeight);
      if (cutX > 1 && !canScrollTo(element, 'x')) faults.push(`${Math.round(cutX)} px cut off at a side: ${name(element)}`);
      if (cutY > 1 && !canScrollTo(element, 'y')) faults.push(`${Math.round(cutY)} px cut off above or below: ${name(element)}`);
      const style = getComputedStyle(element);
      if (style.display !== 'inline' && style.overflowY !== 'visible' && !scrolls(style, 'y') && element.scrollHeight > element.clientHeight + 1) {
        faults.push(`text needs a height of ${element.scrollHeight} px and has ${element.clientHeight}: ${name(element)}`);
      }
      if (style.display !== 'inline' && style.overflowX !== 'visible' && !scrolls(style, 'x') && element.scrollWidth > element.clientWidth + 1) {
        faults.push(`text needs ${element.scrollWidth} px and has ${element.clientWidth}: ${name(element)}`);
      }
    }

    const pen = document.createElement('canvas').getContext('2d');
    for (const list of document.querySelectorAll('select')) {
      if (!isSeen(list) || list.selectedOptions.length === 0) continue;
      const style = getComputedStyle(list);
      pen.font = style.font;
      const needs = pen.measureText(list.selectedOptions[0].textContent).width + 16; // with the arrow
      const has = list.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
      if (needs > has + 1) faults.push(`"${list.selectedOptions[0].textContent}" needs ${Math.round(needs)} px and has ${Math.round(has)}: ${name(list)}`);
    }

    // Dialogs and open lists cover what is below them, and so does what sticks to the edge of a panel that scrolls.
    const covers = (element) => element.closest('dialog, .picker-list, .toasts') !== null || getComputedStyle(element).position === 'sticky';
    const boxes = parts.filter((element) => !covers(element))
      .map((element) => ({ element, box: seenPart(element) })).filter(({ box }) => box !== null);
    for (let i = 0; i < boxes.length; ++i) {
      for (let j = i + 1; j < boxes.length; ++j) {
        const [a, b] = [boxes[i], boxes[j]];
        if (a.element.contains(b.element) || b.element.contains(a.element)) continue;
        const wide = Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left);
        const high = Math.min(a.box.bottom, b.box.bottom) - Math.max(a.box.top, b.box.top);
        if (wide > 2 && high > 2) faults.push(`${name(a.element)} and ${name(b.element)} overlap by ${Math.round(wide)} x ${Math.round(high)} px`);
      }
    }
    return faults;
  });
}
