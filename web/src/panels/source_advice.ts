// SPDX-License-Identifier: Apache-2.0
// Says whether a source can reach the daemon, what has arrived from it, and what blocks it. Pure, so every case has a
// test.
import type { MocapInputInfo, SourcesInfo } from '../api';
import { text } from '../text';

export interface SourceAdvice {
  /** 'off': the daemon does not listen. 'blocked': nothing can arrive, or what arrives is refused. */
  state: 'off' | 'blocked' | 'waiting' | 'receiving';
  /** One sentence. */
  words: string;
  /** How to mend it; empty: there is nothing to mend. */
  todo: string;
  /** A command for `todo`; empty: none. */
  command: string;
  /** A sender that is refused because another one holds the port; empty: none. */
  accept: string;
}

/** A sender that sends once per second is still there. */
const RECENT_MS = 2000;

export function adviseOn(input: MocapInputInfo, sources: SourcesInfo): SourceAdvice {
  const t = text.sources;
  const advice = (state: SourceAdvice['state'], words: string, todo = '', command = '', accept = ''): SourceAdvice =>
    ({ state, words, todo, command, accept });
  const port = input.port ?? input.usual_port;
  const start = `furrowd --bind 0.0.0.0 --open ${input.option} ${port}`;
  if (input.port === null) return advice('off', t.off, t.offTodo(input.option), start);
  const isReceiving = input.age_ms !== null && input.age_ms < RECENT_MS;
  const refused = input.rejected_sender;
  // The last packet of a sender that has just been accepted was refused.
  const isRejecting = input.rejected_age_ms !== null && input.rejected_age_ms < RECENT_MS && refused !== input.holder;
  const mayAccept = isRejecting && (sources.allow.length === 0 || sources.allow.includes(refused));
  if (isReceiving) {
    const words = t.receiving(input.sender, Math.round(input.rate_hz));
    return mayAccept ? advice('receiving', words, t.alsoSends(refused), '', refused) : advice('receiving', words);
  }
  if (isRejecting) {
    return mayAccept
      ? advice('blocked', t.held(refused), t.heldTodo, '', refused)
      : advice('blocked', t.notAllowed(refused), t.notAllowedTodo, `--mocap-allow ${refused}`);
  }
  if (input.malformed_age_ms !== null && input.malformed_age_ms < RECENT_MS) {
    return advice('blocked', t.malformed(input.malformed_sender), t.malformedTodo(t.names[input.name]));
  }
  if (sources.loopback) return advice('blocked', t.loopback(sources.bind), t.loopbackTodo, start);
  if (input.packets > 0) return advice('waiting', t.stopped(input.sender), t.stoppedTodo);
  return advice('waiting', t.nothing, t.nothingTodo);
}
