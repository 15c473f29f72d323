// SPDX-License-Identifier: Apache-2.0
// Describes the state of the page in the one sentence that helps most. Pure, so every case has a test.
import type { Drawing, SubjectInfo } from '../api';
import type { LinkState } from 'furrow/protocol';
import { text } from '../text';
import type { Limit } from '../view/limit';

/**
 * - empty: there is no pose to draw.
 * - loading: the first picture of this connection is on its way.
 * - live: the picture shows the newest pose, or is on its way to it.
 * - paused: the recording that the daemon plays is paused.
 * - stale: the picture is old although poses arrive, or the daemon does not answer.
 * - lost: there is no daemon, or the subject sends no more.
 * - off: the daemon draws no pictures.
 */
export type PictureState = 'empty' | 'loading' | 'live' | 'paused' | 'stale' | 'lost' | 'off';

export interface Situation {
  link: LinkState;
  /** Time without a message of the daemon. */
  silentMs: number;
  everConnected: boolean;
  /** The daemon's reason for not rendering; empty if it renders. */
  notDrawn: string;
  renders: boolean;
  /** The picture that the renderer draws now; null: none. */
  drawing: Drawing | null;
  /** The renderer draws drafts of the character. */
  isDraft: boolean;
  /** Null until the daemon has replied. */
  subjects: readonly Pick<SubjectInfo, 'name' | 'state' | 'age_ms'>[] | null;
  /** Empty: the oldest live subject. */
  wanted: string;
  /** True once a picture has arrived since the connection was made. */
  hasPicture: boolean;
  /** Time since the pose on the screen reached the daemon; null: unknown. */
  pictureMs: number | null;
  /** Time between pictures that were asked for; 0: every pose has one. */
  everyMs: number;
  /** The picture does not show the last change of the page yet. */
  isChanging: boolean;
  /** What keeps the pictures from following the poses. */
  limit: Limit;
  /** The subject has not moved since the pose on the screen. */
  isAtRest: boolean;
  /** The subject is a recording that the daemon plays, and it is paused. */
  isPaused: boolean;
}

export interface Condition {
  state: PictureState;
  text: string;
  /** What the user can do; may be empty. */
  advice: string;
  /** Share of the first picture that is done, in [0, 1]; null: unknown. */
  progress: number | null;
}

/** The daemon answers a ping every second. */
const SILENT_MS = 2500;
/** A picture older than this is stale, unless its pose rests. */
const STALE_MS = 2000;

export function isDimmed(state: PictureState): boolean {
  return state === 'stale' || state === 'lost' || state === 'empty';
}

const condition = (state: PictureState, words: string, advice = '', progress: number | null = null): Condition =>
  ({ state, text: words, advice, progress });
const seconds = (ms: number): string => `${Math.max(1, Math.round(ms / 1000))} s`;

export function assess(situation: Situation): Condition {
  const { link, subjects, wanted } = situation;
  const t = text.condition;
  if (link === 'draining') return condition('lost', t.draining, t.drainingAdvice);
  if (link === 'lost') {
    return situation.everConnected ? condition('lost', t.lost, t.lostAdvice) : condition('lost', t.noDaemon, t.noDaemonAdvice);
  }
  if (link === 'connecting' || subjects === null) return condition('loading', t.connecting);
  if (situation.silentMs > SILENT_MS) return condition('stale', t.silent(seconds(situation.silentMs)), t.silentAdvice);
  const subject = wanted === '' ? subjects.find((s) => s.state !== 'ended') : subjects.find((s) => s.name === wanted);
  if (subject === undefined || subject.state === 'ended') {
    return wanted === '' ? condition('empty', t.nobody, t.nobodyAdvice) : condition('empty', t.notHere(wanted), t.notHereAdvice);
  }
  if (!situation.renders || situation.notDrawn !== '') return condition('off', t.noPictures, situation.notDrawn || t.noPicturesAdvice);
  if (subject.state === 'no_face') return condition('stale', t.noFace(subject.name), t.noFaceAdvice);
  if (subject.state === 'waiting') return condition('empty', t.noPose(subject.name));
  if (subject.state === 'lost') return condition('lost', t.noData(subject.name, seconds(subject.age_ms)), t.noDataAdvice);
  if (!situation.hasPicture) return firstPicture(situation.drawing);
  if (situation.isPaused) return condition('paused', t.paused(subject.name));
  if (!situation.isAtRest && situation.pictureMs !== null && situation.pictureMs > STALE_MS + situation.everyMs) {
    const old = t.stale(seconds(situation.pictureMs));
    const { drawing } = situation;
    if (!situation.isChanging || drawing === null) return condition('stale', old, t.staleAdvice[situation.limit]);
    return condition('stale', old, t.changing(drawing.done, drawing.passes));
  }
  return situation.isDraft ? condition('live', t.draft(subject.name), t.draftAdvice) : condition('live', t.live(subject.name));
}

function firstPicture(drawing: Drawing | null): Condition {
  const t = text.condition;
  if (drawing === null || drawing.passes === 0) return condition('loading', t.firstPicture);
  const { done, passes } = drawing;
  return condition('loading', t.compiling(done, passes), t.compilingAdvice, done / passes);
}
