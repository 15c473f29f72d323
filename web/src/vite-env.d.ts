// SPDX-License-Identifier: Apache-2.0
// Vite turns these imports into links of the page.
declare module '*.css';
