// SPDX-License-Identifier: Apache-2.0
import './style/base.css';
import './style/layout.css';
import './style/panels.css';
import { App } from './app';

new App(document.body);
