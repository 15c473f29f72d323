// SPDX-License-Identifier: Apache-2.0
// The connect token of this page (docs/TOKENS.md), until its tab is closed. A daemon that is open needs none.

const NAME = 'furrow.token';
let token = read();

/** Browsers may forbid the storage; then the token lasts until the page is loaded again. */
function read(): string {
  try {
    return sessionStorage.getItem(NAME) ?? '';
  } catch {
    return '';
  }
}

export function currentToken(): string {
  return token;
}

export function setToken(text: string): void {
  token = text.trim();
  try {
    sessionStorage.setItem(NAME, token);
  } catch {
    // See read().
  }
}

/** The header that shows the token; none without one. */
export function tokenHeaders(): Record<string, string> {
  return token === '' ? {} : { Authorization: `Bearer ${token}` };
}
