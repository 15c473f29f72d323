// SPDX-License-Identifier: Apache-2.0
// The style sheets of the page as one text, for a copy of the page that is drawn as an image.

/** In an image, animations begin at their first step, which is often invisible. */
const AT_REST = '*, *::before, *::after { animation: none !important; transition: none !important; }';

/**
 * An image has its own media: another pointer, colour scheme and resolution than the page. So the conditions are decided
 * here, and the text has only the rules that apply now.
 */
function textOf(rules: CSSRuleList): string {
  return Array.from(rules, (rule) => {
    if (!(rule instanceof CSSMediaRule)) return rule.cssText;
    return matchMedia(rule.media.mediaText).matches ? textOf(rule.cssRules) : '';
  }).join('\n');
}

export function styleText(sheets: StyleSheetList): string {
  return [...Array.from(sheets, (sheet) => textOf(sheet.cssRules)), AT_REST].join('\n');
}
