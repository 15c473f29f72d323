// SPDX-License-Identifier: Apache-2.0
// Plain JavaScript, because tools/ runs it without a build.

/**
 * Removes comments (`// ...` and slash-star) outside of texts.
 * @param {string} json
 * @returns {string}
 */
export function withoutComments(json) {
  return json.replace(/("(?:[^"\\]|\\.)*")|\/\/[^\n]*|\/\*[\s\S]*?\*\//g, (_, quoted) => quoted ?? '');
}
