// SPDX-License-Identifier: Apache-2.0
// What is wrong, in words: the one sentence that helps most. Pure, so that each case is a test.
import type { SubjectInfo } from '../api';
import type { LinkState } from '../wire/connection';

export interface Situation {
  link: LinkState;
  everConnected: boolean;
  /** The daemon's sentence where it draws nothing; empty: it does. */
  notDrawn: string;
  renders: boolean;
  /** Null: the daemon was not asked yet. */
  subjects: readonly Pick<SubjectInfo, 'name' | 'state' | 'age_ms'>[] | null;
  /** Empty: whoever has been there longest. */
  wanted: string;
  /** A picture came since the page was opened. */
  hasPicture: boolean;
}

export interface Condition {
  level: 'ok' | 'wait' | 'bad';
  text: string;
  /** What to do about it; empty: nothing. */
  advice: string;
}

const condition = (level: Condition['level'], text: string, advice = ''): Condition => ({ level, text, advice });

export function assess(situation: Situation): Condition {
  const { link, subjects, wanted } = situation;
  if (link === 'draining') return condition('bad', 'The daemon is shutting down', 'This page reconnects when it is back.');
  if (link === 'lost') {
    return situation.everConnected
      ? condition('bad', 'Connection lost: trying again', 'Is furrowd still running?')
      : condition('bad', 'No daemon answers at this address', 'Start furrowd; this page keeps trying.');
  }
  if (link === 'connecting' || subjects === null) return condition('wait', 'Connecting');
  const subject = wanted === '' ? subjects.find((s) => s.state !== 'ended') : subjects.find((s) => s.name === wanted);
  if (subject === undefined || subject.state === 'ended') {
    return wanted === ''
      ? condition('wait', 'Nobody streams to this daemon yet', 'Start a publisher, e.g. furrow play FILE --to HOST --loop')
      : condition('wait', `“${wanted}” is not here`, 'Waiting for it; choose another subject above.');
  }
  if (!situation.renders || situation.notDrawn !== '') {
    return condition('bad', 'This daemon draws no pictures', situation.notDrawn || 'Weights are shown; start furrowd where OpenGL 4.5 can be had.');
  }
  if (subject.state === 'waiting') return condition('wait', `“${subject.name}” has sent no pose yet`);
  if (subject.state === 'lost') {
    return condition('bad', `“${subject.name}” has fallen silent for ${Math.round(subject.age_ms / 1000)} s`, 'Its publisher or the network stopped.');
  }
  if (!situation.hasPicture) return condition('wait', 'Waiting for the first picture', 'The daemon may be compiling shaders.');
  return condition('ok', `Live: ${subject.name}`);
}
