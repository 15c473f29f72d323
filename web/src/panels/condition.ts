// SPDX-License-Identifier: Apache-2.0
// Describes the state of the page in the one sentence that helps most. Pure, so every case has a test.
import type { SubjectInfo } from '../api';
import type { LinkState } from 'furrow/protocol';

export interface Situation {
  link: LinkState;
  everConnected: boolean;
  /** The daemon's reason for not rendering; empty if it renders. */
  notDrawn: string;
  renders: boolean;
  /** Null until the daemon has replied. */
  subjects: readonly Pick<SubjectInfo, 'name' | 'state' | 'age_ms'>[] | null;
  /** Empty: the oldest live subject. */
  wanted: string;
  /** True once a picture has arrived since the page was opened. */
  hasPicture: boolean;
}

export interface Condition {
  level: 'ok' | 'wait' | 'bad';
  text: string;
  /** What the user can do; may be empty. */
  advice: string;
}

const condition = (level: Condition['level'], text: string, advice = ''): Condition => ({ level, text, advice });

export function assess(situation: Situation): Condition {
  const { link, subjects, wanted } = situation;
  if (link === 'draining') return condition('bad', 'The daemon is shutting down', 'This page reconnects when the daemon is back.');
  if (link === 'lost') {
    return situation.everConnected
      ? condition('bad', 'Connection lost, reconnecting', 'Check that furrowd is running.')
      : condition('bad', 'No daemon responds at this address', 'Start furrowd; this page keeps trying to connect.');
  }
  if (link === 'connecting' || subjects === null) return condition('wait', 'Connecting');
  const subject = wanted === '' ? subjects.find((s) => s.state !== 'ended') : subjects.find((s) => s.name === wanted);
  if (subject === undefined || subject.state === 'ended') {
    return wanted === ''
      ? condition('wait', 'No subject is streaming yet', 'Start a publisher, for example: furrow play FILE --to HOST --loop')
      : condition('wait', `“${wanted}” is not streaming`, 'Wait, or choose another subject above.');
  }
  if (!situation.renders || situation.notDrawn !== '') {
    return condition('bad', 'This daemon does not render pictures', situation.notDrawn || 'Weights are still shown. Pictures need OpenGL 4.5 on the daemon’s machine.');
  }
  if (subject.state === 'no_face') {
    return condition('wait', `The tracker of “${subject.name}” sees no face`, 'Bring the face into the camera’s view.');
  }
  if (subject.state === 'waiting') return condition('wait', `“${subject.name}” has sent no pose yet`);
  if (subject.state === 'lost') {
    return condition('bad', `No data from “${subject.name}” for ${Math.round(subject.age_ms / 1000)} s`, 'Check its publisher and the network.');
  }
  if (!situation.hasPicture) return condition('wait', 'Waiting for the first picture', 'The daemon may be compiling shaders.');
  return condition('ok', `Live: ${subject.name}`);
}
