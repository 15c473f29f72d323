// SPDX-License-Identifier: Apache-2.0
// The page's connection to the daemon: that of the package `furrow`, with its state as a signal.
import { browserSocket, Connection as Link, type LinkState } from 'furrow/protocol';
import { currentToken } from '../state/token';
import { Signal } from '../ui/signal';

export class Connection extends Link {
  readonly link = new Signal<LinkState>(this.state);

  constructor(url: string) {
    super(browserSocket(url, currentToken), { program: 'furrow page' });
    this.onState((state) => this.link.set(state));
  }
}
