// SPDX-License-Identifier: Apache-2.0
// Opens a recording: a file that is dropped on the page, or chosen with a button. The daemon plays it instead of what it plays.
import { api, ApiError, type DaemonStatus, type Upload, uploadRecording, wordsOf } from '../api';
import { text } from '../text';
import { button, h } from '../ui/dom';
import type { Toasts } from '../ui/toast';

const t = text.upload;
/** What furrowd --play reads. Browsers offer these files first. */
const TYPES = '.bvh,.fbx,.glb,.gltf,.vrma,.mcap,.csv,.dae';
const MB = 1e6;

/** Why the daemon would refuse the file; '': it may take it. Asking before the upload spares the user a long wait. */
export function refusalOf(files: readonly Pick<File, 'size'>[], isFolder: boolean, status: Pick<DaemonStatus, 'max_upload_bytes' | 'may'> | null): string {
  if (isFolder) return t.folder;
  if (files.length !== 1) return t.several;
  if (status === null) return text.api.silent;
  if (!status.may.direct) return t.forbidden;
  if (status.max_upload_bytes === 0) return t.off;
  const { size } = files[0]!;
  return size > status.max_upload_bytes ? t.tooLarge(Math.ceil(size / MB), Math.floor(status.max_upload_bytes / MB)) : '';
}

function hasFiles(event: DragEvent): boolean {
  return event.dataTransfer?.types.includes('Files') ?? false;
}

export interface UploadActions {
  status(): DaemonStatus | null;
  /** The subject that the user has chosen; '': any. */
  chosen(): string;
  choose(subject: string): void;
  /** Another recording plays from now on; null: the daemon says which. */
  onPlayback(playback: Upload | null): void;
}

export class UploadPanel {
  private readonly input = h('input', { type: 'file', accept: TYPES, hidden: true, 'aria-label': t.open });
  private readonly close = button(t.close, () => void this.closeRecording(), { title: t.closeTitle, hidden: true });
  /** For the side panel. */
  readonly element: HTMLElement;
  private readonly bar = h('progress', { max: 1, 'aria-label': t.progress });
  private readonly words = h('span', {});
  /** Covers the page while a file is dragged over it. */
  readonly target = h('div', { class: 'drop-target', hidden: true }, h('p', {}, t.drop));
  private readonly stop = button(t.cancel, () => this.cancel?.());
  /** What is under way. For the place of the messages. */
  readonly progress = h('div', { class: 'upload-progress', hidden: true },
    this.words, this.bar, this.stop);
  private cancel: (() => void) | null = null;
  /** The subject that was chosen before the recording, and that of the recording. */
  private before: { chosen: string; uploaded: string } | null = null;

  constructor(private readonly actions: UploadActions, private readonly toasts: Toasts) {
    this.input.addEventListener('change', () => {
      const files = Array.from(this.input.files ?? []);
      this.input.value = ''; // so that the same file can be chosen again
      if (files.length > 0) void this.open(files, false);
    });
    this.element = h('div', { class: 'upload' },
      h('h2', {}, t.title), h('div', { class: 'row' }, button(t.open, () => this.choose(), { title: t.openTitle }), this.close),
      this.input, h('p', { class: 'fine' }, t.hint));
  }

  /** Lets the user choose a file. */
  choose(): void {
    this.input.click();
  }

  /** `isUploaded`: the daemon plays an uploaded recording. */
  show(isUploaded: boolean): void {
    this.close.hidden = !isUploaded;
  }

  async closeRecording(): Promise<void> {
    try {
      await api.closeRecording();
    } catch (error) {
      this.toasts.say(wordsOf(error), 'error');
    }
    this.show(false);
    if (this.before !== null && this.before.uploaded === this.actions.chosen()) this.actions.choose(this.before.chosen);
    this.before = null;
    this.actions.onPlayback(null);
  }

  /** Takes files that are dropped anywhere on the page. */
  takeDrops(): void {
    // Entering a child comes before leaving its parent, so the elements are counted.
    let depth = 0;
    const end = (): void => {
      depth = 0;
      this.target.hidden = true;
    };
    addEventListener('dragenter', (event) => {
      if (!hasFiles(event)) return;
      event.preventDefault();
      ++depth;
      this.target.hidden = false;
    });
    addEventListener('dragover', (event) => {
      if (!hasFiles(event)) return;
      event.preventDefault(); // otherwise the browser leaves the page and opens the file
      event.dataTransfer!.dropEffect = 'copy';
    });
    addEventListener('dragleave', (event) => {
      if (hasFiles(event) && --depth <= 0) end();
    });
    addEventListener('dragend', end);
    addEventListener('drop', (event) => {
      end();
      if (!hasFiles(event)) return;
      event.preventDefault();
      const { files, items } = event.dataTransfer!;
      const isFolder = Array.from(items).some((item) => item.webkitGetAsEntry?.()?.isDirectory === true);
      void this.open(Array.from(files), isFolder);
    });
  }

  private async open(files: readonly File[], isFolder: boolean): Promise<void> {
    const refusal = this.cancel !== null ? t.busy : refusalOf(files, isFolder, this.actions.status());
    if (refusal !== '') return this.toasts.say(refusal, 'error');
    const file = files[0]!;
    this.showProgress(file.name, 0);
    const request = uploadRecording(file, (share) => this.showProgress(file.name, share));
    this.cancel = request.cancel;
    try {
      this.onPlays(await request.reply);
    } catch (error) {
      if (error instanceof ApiError) this.toasts.say(t.failed(file.name, wordsOf(error)), 'error');
      else this.toasts.say(t.cancelled(file.name));
    }
    this.cancel = null;
    this.progress.hidden = true;
  }

  /** `share`: of the file that has been sent, 0 to 1. */
  private showProgress(name: string, share: number): void {
    this.progress.hidden = false;
    this.words.textContent = share < 1 ? t.sending(name) : t.reading(name);
    this.stop.hidden = share >= 1; // the daemon has it all
    if (share < 1) this.bar.value = share;
    else this.bar.removeAttribute('value'); // nobody knows how long the daemon reads it
  }

  private onPlays(playback: Upload): void {
    const { chosen, choose, onPlayback } = this.actions;
    if (this.before === null) this.before = { chosen: chosen(), uploaded: playback.subject };
    else this.before.uploaded = playback.subject;
    this.show(true);
    onPlayback(playback);
    choose(playback.subject);
    this.toasts.say(t.plays(playback.file));
    for (const warning of playback.warnings) this.toasts.say(warning);
  }
}
