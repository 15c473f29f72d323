// SPDX-License-Identifier: Apache-2.0
// Vite turns these imports into links of the page.
declare module '*.css';

/** A file as a data URL in base64. */
declare module '*.bfbs?inline' {
  const url: string;
  export default url;
}

/** A file as text. */
declare module '*.toml?raw' {
  const toml: string;
  export default toml;
}
