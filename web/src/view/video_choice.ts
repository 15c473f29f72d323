// SPDX-License-Identifier: Apache-2.0
// Decides whether this page asks for video or for a file per picture.
import { text } from '../text';
import { Signal } from '../ui/signal';

/** 'auto': video where it works. 'h264': also where it is slow. */
export type StreamKind = 'auto' | 'h264' | 'jpeg';

/** The name of the codec in a request (protocol/STANDARD.md section 9). */
const H264 = 'h264';
/** What the daemon sends for pictures up to 1280 x 720. Others differ in the level only. */
const USUAL_CODEC = 'avc1.42c01f';

export interface VideoSituation {
  kind: StreamKind;
  /** Browsers decode video only in pages of this computer and over HTTPS. */
  isSecure: boolean;
  hasDecoder: boolean;
  /** The answer of the browser; true until there is one. */
  isSupported: boolean;
  /** Why the decoder was given up; empty: it was not. */
  failure: string;
}

/** Why the page asks for JPEG; empty: it asks for video. Pure, so every case has a test. */
export function whyNoVideo(at: VideoSituation): string {
  const { why } = text.stream;
  if (at.kind === 'jpeg') return why.chosen;
  if (!at.isSecure) return why.insecure;
  if (!at.hasDecoder) return why.noDecoder;
  if (!at.isSupported) return why.unsupported;
  return at.failure;
}

export class VideoChoice {
  /** For requests. */
  readonly codecs = new Signal<readonly string[]>([]);
  /** Why there are none; empty if there are. */
  why = '';
  private isSupported = true;
  private failure = '';

  constructor(private readonly kind: Signal<StreamKind>) {
    kind.bind(() => this.retry());
    void this.ask();
  }

  /** True if a decoder that is late is given up. */
  get isImpatient(): boolean {
    return this.kind.value === 'auto';
  }

  /** Asks for JPEG from now on. */
  fail(why: string): void {
    this.failure = why;
    this.decide();
  }

  /** Asks for video again after a failure. */
  retry(): void {
    this.failure = '';
    this.decide();
  }

  private async ask(): Promise<void> {
    if (!('VideoDecoder' in globalThis)) return;
    try {
      const answer = await VideoDecoder.isConfigSupported({ codec: USUAL_CODEC, optimizeForLatency: true });
      this.isSupported = answer.supported === true;
    } catch {
      this.isSupported = false;
    }
    this.decide();
  }

  private decide(): void {
    this.why = whyNoVideo({
      kind: this.kind.value,
      isSecure: globalThis.isSecureContext === true,
      hasDecoder: 'VideoDecoder' in globalThis,
      isSupported: this.isSupported,
      failure: this.failure,
    });
    const codecs = this.why === '' ? [H264] : [];
    if (codecs.join() !== this.codecs.value.join()) this.codecs.set(codecs);
  }
}
