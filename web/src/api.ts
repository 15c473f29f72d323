// SPDX-License-Identifier: Apache-2.0
// Typed access to the daemon's JSON (docs/HTTP-API.md). Rejected requests throw an ApiError.
import { tokenHeaders } from './state/token';
import { text } from './text';
import type { CameraPreset } from './view/camera';

export interface SettingInfo {
  name: string;
  group: string;
  unit: string;
  help: string;
  kind: 'choice' | 'list' | 'bool' | 'int' | 'number' | 'colour';
  choices?: string[];
  min: number | null;
  max: number | null;
  default: string;
  value: string;
}

export interface SubjectInfo {
  name: string;
  state: 'waiting' | 'live' | 'no_face' | 'lost' | 'ended';
  source: string;
  joints: number;
  blend_shapes: number;
  sequence: number;
  rate_hz: number;
  poses: number;
  lost: number;
  late: number;
  /** Delay of the subject's jitter buffer; 0: none. */
  buffer_ms: number;
  jitter_ms: number;
  age_ms: number;
  /** Time since the subject last moved visibly; null: unknown, because nobody watches. */
  moved_ms: number | null;
  /** SMPTE timecode of the last pose, "10:00:00;00", and its frames per second; null: the source sends none. */
  timecode: string | null;
  timecode_rate_hz: number | null;
  /** A neutral pose was captured. */
  neutral: boolean;
}

/** The passes of the picture that the renderer draws now. The first one compiles shaders. */
export interface Drawing {
  done: number;
  passes: number;
}

export interface DaemonStatus {
  version: string;
  session: string;
  uptime_s: number;
  render: boolean;
  renderer: string;
  /** The renderer draws on the processor. */
  software: boolean;
  /** The character is being loaded: pictures in motion are drafts, and others wait. */
  starting: boolean;
  /** Null: nothing is being drawn. */
  drawing: Drawing | null;
  /** H.264; null: the daemon draws nothing. */
  video: { library: string; encoders: number; max_encoders: number; why: string } | null;
  viewers: number;
  subjects: number;
  pictures_rendered: number;
  pictures_encoded: number;
  pictures_dropped: number;
  playback: boolean;
  /** Of a recording that the page may upload; 0: none. */
  max_upload_bytes: number;
  draining: boolean;
  /** Everybody on the network may connect, without a token. */
  open: boolean;
  /** The roles of this page. */
  may: { publish: boolean; watch: boolean; direct: boolean; operate: boolean };
}

/** A port for phones and trackers. */
export interface MocapInputInfo {
  name: 'livelink_face' | 'vmc';
  /** The option of furrowd that opens it. */
  option: string;
  /** Null: it is off. */
  port: number | null;
  usual_port: number;
  packets: number;
  malformed: number;
  /** Packets of senders that may not send now. */
  rejected: number;
  /** Understood packets in the last second. */
  rate_hz: number;
  /** The only sender that may send now; empty: anybody who is allowed. */
  holder: string;
  /** The address of the last sender whose packet was understood; empty: none. */
  sender: string;
  /** Times since the last packet of each kind; null: none. */
  age_ms: number | null;
  malformed_sender: string;
  malformed_age_ms: number | null;
  rejected_sender: string;
  rejected_age_ms: number | null;
}

/** At most 32 names; `count` has all. */
export interface NamesInfo {
  count: number;
  names: string[];
}

/** What arrives of a subject, and what of it is used. */
export interface StreamInfo {
  name: string;
  /** The wire of others that it comes by; empty: Furrow's own. */
  input: MocapInputInfo['name'] | '';
  source: string;
  rate_hz: number;
  poses: number;
  lost: number;
  late: number;
  jitter_ms: number;
  age_ms: number;
  /** The daemon's clock minus the sender's, plus the network delay; null: unknown, or the sender's does not count from 1970. */
  clock_offset_ms: number | null;
  /** As in SubjectInfo. */
  timecode: string | null;
  timecode_rate_hz: number | null;
  joints: number;
  blend_shapes: number;
  /** Move neither weights nor pictures. */
  ignored_joints: NamesInfo;
  /** The rig reads them, and the stream does not have them. */
  missing_joints: NamesInfo;
  missing_blend_shapes: NamesInfo;
}

export interface SourcesInfo {
  /** The address that the daemon listens on. */
  bind: string;
  /** Only this computer can reach that address. */
  loopback: boolean;
  /** Addresses of the daemon's computer in its networks. */
  addresses: string[];
  /** The only senders that may send; empty: any. */
  allow: string[];
  inputs: MocapInputInfo[];
  /** At most 64. */
  subjects: StreamInfo[];
  more_subjects: number;
}

export interface RigInfo {
  name: string;
  /** The joint in whose space positions of a face are measured. */
  anchor: string;
  drivers: { name: string; values: { name: string; reference_pose?: string }[] }[];
  regions: { name: string; neighbours: string[]; weights: { name: string; map: string }[] }[];
  reference_poses: string[];
  captures: Capture[];
  changed: boolean;
}

export interface Capture {
  pose: string;
  subject: string;
}

export type NeutralPart = 'face' | 'body' | 'both';

export interface CaptureResult {
  pose: string;
  part?: NeutralPart;
  preview: boolean;
  added: boolean;
  weights: { name: string; before: number; after: number }[];
  captures: Capture[];
}

export interface Explanation {
  subject: string;
  sequence: number;
  weight: string;
  live: number;
  result: number;
  combined: number;
  modulated: number;
  contributions: Contribution[];
  conflicts: { weight: string; other: number; factor: number }[];
}

export interface Contribution {
  value: string;
  kind: string;
  reference_pose?: string | null;
  driver_value: number;
  gain: number;
  product: number;
  pose: { along: number; perpendicular: number; falloff: number } | null;
  angles: { what: string; degrees: number }[] | null;
  strain: { smallest: number; largest: number; degrees: number } | null;
  blend_shapes: { name: string; coefficient: number }[] | null;
}

export interface Playback {
  file: string;
  subject: string;
  /** A client has uploaded it. */
  uploaded: boolean;
  frames: number;
  seconds: number;
  rate_hz: number;
  position_s: number;
  frame: number;
  playing: boolean;
  loop: boolean;
  speed: number;
}

/** The reply to an upload. */
export interface Upload extends Playback {
  /** What the reader tolerated. */
  warnings: string[];
}

/** The daemon's reason for rejecting a request. `status` is 0 if the daemon did not reply. */
export class ApiError extends Error {
  constructor(
    readonly status: number,
    readonly field: string,
    message: string,
    readonly hint = '',
  ) {
    super(message);
  }

  /** One human-readable sentence. */
  words(): string {
    const where = this.field !== '' ? `${this.field}: ` : '';
    return `${where}${this.message}${this.hint !== '' ? ` (${this.hint})` : ''}`;
  }
}

function errorOf(status: number, body: string): ApiError {
  try {
    const { error } = JSON.parse(body);
    return new ApiError(status, error.field, error.message, error.hint);
  } catch {
    return new ApiError(status, '', text.api.status(status));
  }
}

/** A daemon that is stuck must not keep the page waiting for ever. */
const PATIENCE_MS = 10_000;

async function ask(path: string, method = 'GET', body?: unknown): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(path, {
      method,
      cache: 'no-store',
      signal: AbortSignal.timeout(PATIENCE_MS),
      headers: {
        ...tokenHeaders(),
        ...(body === undefined ? {} : { 'Content-Type': 'application/json' }),
      },
      ...(body === undefined ? {} : { body: JSON.stringify(body) }),
    });
  } catch {
    throw new ApiError(0, '', text.api.silent);
  }
  if (!response.ok) throw errorOf(response.status, await response.text());
  return response;
}

async function call<T>(path: string, method = 'GET', body?: unknown): Promise<T> {
  return (await (await ask(path, method, body)).json()) as T;
}

function query(values: Record<string, string>): string {
  return new URLSearchParams(values).toString();
}

export const api = {
  status: () => call<DaemonStatus>('api/status'),
  sources: () => call<SourcesInfo>('api/sources'),
  /** The sender holds the port of the input from now on. */
  acceptSender: (input: MocapInputInfo['name'], sender: string) => call<SourcesInfo>('api/sources', 'POST', { input, sender }),
  subjects: async () => (await call<{ subjects: SubjectInfo[] }>('api/subjects')).subjects,
  settings: async () => (await call<{ settings: SettingInfo[] }>('api/settings')).settings,
  patchSettings: async (values: Record<string, string>) =>
    (await call<{ settings: SettingInfo[] }>('api/settings', 'PATCH', values)).settings,
  cameras: async () => (await call<{ cameras: CameraPreset[] }>('api/cameras')).cameras,
  rig: (subject: string) => call<RigInfo>(`api/rig?${query({ subject })}`),
  explain: (subject: string, weight: string) =>
    call<Explanation>(`api/explain?${query({ subject, weight })}`),
  /** `part` belongs to the pose 'neutral'; undefined: the daemon chooses. */
  capture: (subject: string, pose: string, preview: boolean, part?: NeutralPart) =>
    call<CaptureResult>('api/capture', 'POST', { subject, pose, preview, ...(part ? { part } : {}) }),
  undoCapture: () => call<{ captures: Capture[] }>('api/capture/undo', 'POST', {}),
  playback: () => call<Playback>('api/playback'),
  patchPlayback: (values: Partial<Pick<Playback, 'playing' | 'loop' | 'speed' | 'position_s'>>) =>
    call<Playback>('api/playback', 'PATCH', values),
  /** Ends the uploaded recording. */
  closeRecording: () => call<object>('api/playback', 'DELETE'),
  /** The current rig as the text of a file. */
  rigFile: async () => (await ask('api/rig.json')).text(),
};

/** Sends a recording, which the daemon then plays. `onProgress`: the share that has been sent. fetch() does not report it. */
export function uploadRecording(file: File, onProgress: (share: number) => void): { reply: Promise<Upload>; cancel: () => void } {
  const request = new XMLHttpRequest();
  const reply = new Promise<Upload>((resolve, reject) => {
    request.upload.addEventListener('progress', ({ loaded, total }) => onProgress(total > 0 ? loaded / total : 1));
    request.addEventListener('load', () => {
      if (request.status === 200) resolve(JSON.parse(request.responseText) as Upload);
      else reject(errorOf(request.status, request.responseText));
    });
    request.addEventListener('error', () => reject(new ApiError(0, '', text.upload.broken)));
    request.addEventListener('abort', () => reject(new DOMException('cancelled', 'AbortError')));
  });
  request.open('POST', `api/playback?${query({ name: file.name })}`);
  for (const [name, value] of Object.entries(tokenHeaders())) request.setRequestHeader(name, value);
  request.setRequestHeader('Content-Type', 'application/octet-stream');
  request.send(file);
  return { reply, cancel: () => request.abort() };
}

/** The sentence to show for any thrown value. */
export function wordsOf(error: unknown): string {
  if (error instanceof ApiError) return error.words();
  return error instanceof Error ? error.message : String(error);
}
