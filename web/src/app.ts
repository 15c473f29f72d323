// SPDX-License-Identifier: Apache-2.0
// Assembles the page and feeds it with the state of the daemon.
import { api, ApiError, type DaemonStatus, type SubjectInfo, wordsOf } from './api';
import { CapturePanel } from './panels/capture';
import { assess } from './panels/condition';
import { CurvesPanel } from './panels/curves';
import { ExplainPanel } from './panels/explain';
import { FaceMap } from './panels/face_map';
import { Header } from './panels/header';
import { SettingsMenu } from './panels/menu';
import { SessionPanel } from './panels/session';
import { SettingsText } from './panels/settings_text';
import { DebugStrip } from './panels/strip';
import { Timeline } from './panels/timeline';
import { ViewBar } from './panels/view_bar';
import { AppState } from './state/app_state';
import { setToken } from './state/token';
import { WeightHistory } from './state/weight_history';
import { h } from './ui/dom';
import { type Command, helpDialog, installKeys } from './ui/keys';
import { Tabs } from './ui/tabs';
import { Toasts } from './ui/toast';
import { TokenDialog } from './ui/token_dialog';
import { CameraInput } from './view/camera_input';
import { Viewer } from './view/viewer';
import { Connection } from './wire/connection';
import { WeightStream } from './wire/weight_stream';

const POLL_MS = 1000;
/** While the browser draws: polls until the page notices that another viewer changed the daemon's settings. */
const POLLS_PER_SETTINGS = 3;

export class App {
  private readonly state = new AppState(location.hash);
  private readonly toasts = new Toasts();
  private readonly connection: Connection;
  private readonly history = new WeightHistory();
  private readonly weights: WeightStream;
  private readonly viewer: Viewer;
  private readonly curves: CurvesPanel;
  private readonly faceMap: FaceMap;
  private readonly explain: ExplainPanel;
  private readonly capture: CapturePanel;
  private readonly session: SessionPanel;
  private readonly header: Header;
  private readonly viewBar: ViewBar;
  private readonly strip: DebugStrip;
  private readonly menu: SettingsMenu;
  private readonly timeline: Timeline;
  private readonly tabs: Tabs;
  private readonly token = new TokenDialog(setToken);
  private toldWhy = '';
  private readonly help: HTMLDialogElement;
  private readonly root = h('div', { class: 'app' });
  private subjects: SubjectInfo[] | null = null;
  private status: DaemonStatus | null = null;
  private daemonSession = '';
  private everConnected = false;
  private began = false;
  private numPolls = 0;

  constructor(parent: HTMLElement) {
    const { state, toasts } = this;
    const subject = (): string => this.weights.subject.value || state.subject.value;
    this.connection = new Connection(new URL('ws', document.baseURI.replace(/^http/, 'ws').replace(/#.*$/, '')).href);
    this.curves = new CurvesPanel(state, this.history);
    this.explain = new ExplainPanel(subject, () => this.faceMap.setChosen(''));
    this.faceMap = new FaceMap(this.history, (region, weights) => this.explainRegion(region, weights));
    this.weights = new WeightStream(this.connection, state.subject.value, this.history, () => this.onWeights());
    this.viewer = new Viewer(this.connection, state, (text) => toasts.say(text, 'error'));
    this.capture = new CapturePanel(subject, toasts, () => void this.readRig());
    this.session = new SessionPanel((name) => state.subject.set(name));
    const text = new SettingsText(state, toasts);
    this.menu = new SettingsMenu(state, toasts, () => text.open());
    this.timeline = new Timeline(toasts);
    this.strip = new DebugStrip(this.connection, state);
    this.viewBar = new ViewBar(state, this.strip.adder, this.viewer.drawing);
    const commands = this.commands();
    this.help = helpDialog(commands);
    this.header = new Header(state, {
      help: () => this.help.showModal(), panel: () => this.togglePanel(), dock: () => this.toggleDock(),
    });
    this.tabs = new Tabs([
      { id: 'look', label: 'Look', content: this.menu.element },
      { id: 'wrinkles', label: 'Wrinkles', content: h('div', { class: 'wrinkles' }, this.faceMap.map, this.explain.element, this.faceMap.list) },
      { id: 'capture', label: 'Capture', content: this.capture.element },
      { id: 'session', label: 'Session', content: this.session.element },
    ], (id) => this.began && state.panel.set(id));
    this.buildLayout(parent, text.element);
    installKeys(commands);
    this.connectSignals();
    void this.poll();
  }

  private buildLayout(parent: HTMLElement, dialog: HTMLElement): void {
    this.root.append(
      this.header.element,
      this.strip.element,
      h('main', { 'aria-label': 'Picture' }, this.viewer.stage.element, this.viewBar.element),
      h('footer', { class: 'dock', 'aria-label': 'Curves and recording' }, this.curves.element, this.timeline.element),
      h('aside', { class: 'side', 'aria-label': 'Panels' }, this.tabs.list, this.tabs.panels),
      dialog, this.help, this.token.element, this.toasts.element);
    parent.replaceChildren(this.root);
    if (this.state.panel.value !== '') this.tabs.choose(this.state.panel.value);
    this.state.panel.bind((panel) => this.root.classList.toggle('no-panel', panel === ''));
  }

  private connectSignals(): void {
    const { state } = this;
    new CameraInput(this.viewer.stage.surface, {
      camera: () => state.camera.value, move: (camera) => state.camera.set(camera),
    });
    state.subject.watch((subject) => this.weights.choose(subject));
    this.weights.subject.watch(() => void this.readRig());
    this.connection.link.watch((link) => {
      if (link === 'open') {
        this.everConnected = true;
        void this.askDaemon().then(() => this.showCondition());
        void this.readDaemon();
      }
      this.showCondition();
    });
    this.viewer.notDrawn.watch(() => this.showCondition());
    window.addEventListener('hashchange', () => location.reload()); // the user entered another URL
  }

  private commands(): Command[] {
    const { state } = this;
    const command = (key: string, words: string, run: () => void, release?: () => void): Command =>
      ({ key, words, run, ...(release ? { release } : {}) });
    return [
      ...Array.from({ length: 9 }, (_, i) => command(String(i + 1), i === 0 ? 'choose framing 1 to 9' : '', () => this.viewBar.choose(i))),
      command('0', 'first framing', () => this.viewBar.choose(0)),
      command('space', 'play or pause the recording', () => this.timeline.toggle()),
      command('c', 'hold to see the picture without the last change', () => state.comparing.set(true), () => state.comparing.set(false)),
      command('x', 'change the wipe: wrinkles, shading, none', () => this.viewBar.nextWipe()),
      command('escape', 'leave a debug view', () => state.settings.set('view', 'final', performance.now())),
      command('/', 'search the settings', () => this.openMenu()),
      command('ctrl+z', 'undo the last change', () => state.settings.undo()),
      command('ctrl+y', 'redo', () => state.settings.redo()),
      command('p', 'show or hide the side panel', () => this.togglePanel()),
      command('g', 'show or hide the curves', () => this.toggleDock()),
      command('?', 'show this list', () => this.help.showModal()),
    ];
  }

  private openMenu(): void {
    this.tabs.choose('look');
    this.menu.focusSearch();
  }

  private togglePanel(): void {
    this.state.panel.set(this.state.panel.value === '' ? this.tabs.current : '');
  }

  private toggleDock(): void {
    this.root.classList.toggle('no-curves');
  }

  private explainRegion(region: string, weights: string[]): void {
    this.faceMap.setChosen(region);
    this.explain.show(region, weights);
  }

  private onWeights(): void {
    this.curves.onFrame();
    this.faceMap.onFrame();
  }

  /** Reads settings and cameras on the first connection and after every restart of the daemon. */
  private async readDaemon(): Promise<void> {
    try {
      const [settings, cameras] = await Promise.all([api.settings(), api.cameras().catch(() => [])]);
      this.state.settings.setInfos(settings);
      if (this.began) {
        this.state.setPresets(cameras);
      } else {
        const unknown = this.state.begin(cameras);
        this.began = true;
        if (unknown.length > 0) this.toasts.say(`Unknown to this daemon and ignored: ${unknown.join(', ')}`, 'error');
      }
    } catch (error) {
      this.toasts.say(wordsOf(error), 'error');
    }
    await this.readRig();
  }

  /** The browser draws the default settings only, so it must know those of the daemon. */
  private async readSettings(): Promise<void> {
    try {
      this.state.settings.setInfos(await api.settings());
    } catch {
      // The header reports the state of the connection.
    }
  }

  private async readRig(): Promise<void> {
    try {
      await this.faceMap.load(this.weights.subject.value);
      await this.capture.load();
    } catch {
      // There is no subject yet, or the daemon left. The rig is read again once the subject is known.
    }
  }

  private async poll(): Promise<void> {
    const nowS = performance.now() / 1000;
    if (!document.hidden) await this.askDaemon();
    if (!document.hidden && this.connection.link.value === 'lost') await this.askForToken();
    const shown = this.subjects?.find(({ name }) => name === this.weights.subject.value);
    this.viewer.observeRate(shown?.rate_hz ?? 0, nowS);
    this.viewer.drawing.observe(shown, this.viewer.stats.rateHz(nowS));
    this.header.showStats(this.viewer, nowS);
    if (this.viewer.drawing.active.value && this.numPolls++ % POLLS_PER_SETTINGS === 0) void this.readSettings();
    this.showCondition();
    setTimeout(() => void this.poll(), POLL_MS);
  }

  private async askDaemon(): Promise<void> {
    if (this.connection.link.value !== 'open') return;
    try {
      [this.subjects, this.status] = await Promise.all([api.subjects(), api.status()]);
      this.showDaemon();
    } catch {
      // The header already reports the state of the connection.
    }
  }

  /** A WebSocket that is refused says nothing; a request does. */
  private async askForToken(): Promise<void> {
    try {
      await api.status();
    } catch (error) {
      if (!(error instanceof ApiError)) return;
      if (error.status === 401) this.token.ask(error.message);
      // The daemon takes no token from this computer, where it would travel in clear text.
      if (error.status === 403 && error.message !== this.toldWhy) {
        this.toldWhy = error.message;
        this.toasts.say(error.message, 'error');
      }
    }
  }

  private showDaemon(): void {
    const status = this.status!;
    this.timeline.setAvailable(status.playback);
    const subjects = this.subjects!;
    this.session.show(subjects, status, this.weights.subject.value);
    this.header.showOpen(status.open);
    this.header.showSubjects(subjects.map(({ name }) => name));
    if (this.daemonSession !== '' && status.session !== this.daemonSession) {
      this.toasts.say('The daemon was restarted; this page keeps its settings');
    }
    this.daemonSession = status.session;
  }

  private showCondition(): void {
    this.header.showCondition(assess({
      link: this.connection.link.value,
      everConnected: this.everConnected,
      notDrawn: this.viewer.notDrawn.value,
      renders: this.status?.render ?? true,
      subjects: this.subjects,
      wanted: this.state.subject.value,
      hasPicture: this.viewer.stats.shown > 0,
    }));
  }
}
