// SPDX-License-Identifier: Apache-2.0
// Assembles the page and feeds it with the state of the daemon.
import { api, ApiError, type DaemonStatus, type SubjectInfo, wordsOf } from './api';
import { Against } from './grid/against';
import { SubjectGrid } from './grid/subject_grid';
import { GuidePanel } from './guide/guide_panel';
import { LightBar } from './light/light_bar';
import { CapturePanel } from './panels/capture';
import { assess, type Condition, isDimmed, type PictureState } from './panels/condition';
import { CurvesPanel } from './panels/curves';
import { ExplainPanel } from './panels/explain';
import { FaceMap } from './panels/face_map';
import { Header } from './panels/header';
import { LayoutDialog } from './panels/layouts';
import { SettingsMenu } from './panels/menu';
import { Notice } from './panels/notice';
import { PictureActions } from './panels/picture_actions';
import { SessionPanel } from './panels/session';
import { SettingsText } from './panels/settings_text';
import { SourcesPanel } from './panels/sources';
import { DebugStrip } from './panels/strip';
import { TimecodeBadge } from './panels/timecode';
import { Timeline } from './panels/timeline';
import { UploadPanel } from './panels/upload';
import { ViewBar } from './panels/view_bar';
import { captionLines } from './screenshot/caption';
import { addressOf } from './state/address';
import { AppState } from './state/app_state';
import { Elsewhere } from './state/elsewhere';
import { isAcross, isCompact } from './state/layout';
import { browserStore } from './state/presets';
import { setToken } from './state/token';
import { type WeightFrame, WeightHistory } from './state/weight_history';
import { text } from './text';
import { button, h } from './ui/dom';
import { returnFocus } from './ui/focus';
import { type Command, helpDialog, installKeys } from './ui/keys';
import { kioskButton } from './ui/kiosk';
import { Tabs } from './ui/tabs';
import { Toasts } from './ui/toast';
import { TokenDialog } from './ui/token_dialog';
import { CameraInput } from './view/camera_input';
import { type Limit, limitOf } from './view/limit';
import type { ShownPicture } from './view/picture_stats';
import { isAtRest } from './view/rest';
import { Viewer } from './view/viewer';
import { Connection } from './wire/connection';
import { WeightStream } from './wire/weight_stream';

const POLL_MS = 1000;
/** Ages count up while they are read. */
const SHOW_MS = 250;
/** While the first picture is prepared. */
const LOADING_POLL_MS = 250;
/** While the browser draws: polls until the page notices that another viewer changed the daemon's settings. */
const POLLS_PER_SETTINGS = 3;

export class App {
  private readonly state = new AppState(addressOf(location));
  private readonly toasts = new Toasts();
  private readonly connection: Connection;
  private readonly history = new WeightHistory();
  private readonly elsewhere: Elsewhere;
  private readonly weights: WeightStream;
  private readonly viewer: Viewer;
  private readonly curves: CurvesPanel;
  private readonly faceMap: FaceMap;
  private readonly explain: ExplainPanel;
  private readonly capture: CapturePanel;
  private readonly guide: GuidePanel;
  private readonly session: SessionPanel;
  private readonly header: Header;
  private readonly viewBar: ViewBar;
  private readonly strip: DebugStrip;
  private readonly menu: SettingsMenu;
  private readonly timeline: Timeline;
  private readonly timecode = new TimecodeBadge();
  private readonly upload: UploadPanel;
  private readonly tabs: Tabs;
  private readonly notice: Notice;
  private readonly grid: SubjectGrid;
  private readonly against: Against;
  private readonly light: LightBar;
  private readonly layouts: LayoutDialog;
  private readonly actions: PictureActions;
  private readonly viewHolder = h('div', { class: 'view-holder' });
  private readonly curvesHolder = h('div', { class: 'curves-holder' });
  private readonly dock = h('footer', { class: 'dock', 'aria-label': text.app.dock });
  private readonly main = h('main', { 'aria-label': text.app.main });
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
  private pictureState: PictureState = 'loading';
  /** When the daemon last said how its subjects are. */
  private askedMs = 0;

  constructor(parent: HTMLElement) {
    const { state, toasts } = this;
    const subject = (): string => this.weights.subject.value || state.subject.value;
    this.connection = new Connection(new URL('ws', document.baseURI.replace(/^http/, 'ws').replace(/#.*$/, '')).href);
    this.curves = new CurvesPanel(state, this.history, this.connection, subject, toasts);
    this.explain = new ExplainPanel(subject, () => this.faceMap.setChosen(''));
    this.faceMap = new FaceMap(this.history, (region, weights) => this.explainRegion(region, weights));
    this.elsewhere = new Elsewhere(location.hash, {
      link: () => state.link(), go: (url) => void this.curves.take.finish().then(() => location.assign(url)), say: (words, kind) => toasts.say(words, kind),
    });
    this.weights = new WeightStream(this.connection, state.subject.value, this.history, () => this.onWeights(), (web) => this.elsewhere.follow(web));
    this.viewer = new Viewer(this.connection, state, (words) => toasts.say(words, 'error'), () => this.onPicture());
    this.grid = new SubjectGrid(this.connection, state, this.viewer);
    this.against = new Against(this.connection, state, this.viewer);
    this.light = new LightBar(state, this.viewer, toasts);
    this.layouts = new LayoutDialog(state, toasts, browserStore());
    this.actions = new PictureActions(() => this.viewer.canvas(), this.root, toasts, () => this.caption());
    this.notice = new Notice(toasts, () => this.tabs.choose('sources'), () => this.upload.choose());
    this.capture = new CapturePanel(subject, toasts, () => void this.readRig());
    this.guide = new GuidePanel(this.connection, subject, {
      onChanged: () => void this.readRig(),
      onOpen: (isOpen) => {
        this.capture.element.hidden = isOpen;
        if (isOpen) state.follows.set(false); // the guide stays with one subject
      },
      say: (words) => toasts.say(words),
      saveRig: () => void this.capture.saveRig(),
    });
    this.session = new SessionPanel((name) => state.chooseSubject(name), state.stream);
    const settingsText = new SettingsText(state, toasts);
    this.menu = new SettingsMenu(state, toasts, () => settingsText.open());
    this.upload = new UploadPanel({
      status: () => this.status, chosen: () => state.subject.value, choose: (name) => state.chooseSubject(name),
      onPlayback: (playback) => this.timeline.onPlayback(playback),
    }, toasts);
    this.timeline = new Timeline(toasts, () => void this.upload.closeRecording(), (isUploaded) => this.upload.show(isUploaded));
    this.strip = new DebugStrip(this.connection, state);
    this.viewBar = new ViewBar(state, this.strip.adder, this.viewer.drawing);
    const commands = this.commands();
    this.help = helpDialog(commands);
    this.header = new Header(state, {
      help: () => this.help.showModal(), panel: () => this.togglePanel(), dock: () => this.toggleDock(),
      layout: () => this.layouts.open(),
    });
    const wrinkles = h('div', { class: 'wrinkles' }, this.faceMap.map, this.explain.element, this.faceMap.list);
    this.tabs = new Tabs([
      { id: 'view', label: text.tabs.view, icon: 'view', content: this.viewHolder, isForSheets: true },
      { id: 'look', label: text.tabs.look, icon: 'look', content: this.menu.element },
      { id: 'wrinkles', label: text.tabs.wrinkles, icon: 'wrinkles', content: wrinkles },
      { id: 'curves', label: text.tabs.curves, icon: 'curves', content: this.curvesHolder, isForSheets: true },
      { id: 'capture', label: text.tabs.capture, icon: 'capture', content: h('div', {}, this.guide.element, this.capture.element) },
      { id: 'sources', label: text.tabs.sources, icon: 'sources', content: new SourcesPanel(toasts).element },
      { id: 'session', label: text.tabs.session, icon: 'session', content: h('div', {}, this.upload.element, this.session.element) },
    ], (id) => state.panel.set(id));
    this.buildLayout(parent, settingsText.element);
    installKeys(commands);
    this.connectSignals();
    void this.poll();
    // Not with the poll, which waits for a daemon that may be stuck.
    setInterval(() => this.showNow(), SHOW_MS);
  }

  private showNow(): void {
    this.showFigures(performance.now() / 1000);
    this.showCondition();
  }

  private buildLayout(parent: HTMLElement, dialog: HTMLElement): void {
    const { stage } = this.viewer;
    stage.element.append(this.notice.element, this.guide.card, this.light.element, this.actions.element, this.timecode.element,
      this.against.nameOfFocus);
    this.actions.element.prepend(this.light.toggleButton);
    this.viewHolder.append(button(text.header.layout, () => this.layouts.open(), { title: text.header.layoutTitle }));
    const pair = h('div', { class: 'pair' }, stage.element, this.against.element);
    this.main.append(h('div', { class: 'panes' }, pair, this.grid.element));
    this.root.append(
      this.header.element, this.strip.element, this.main, this.dock,
      h('aside', { class: 'side', 'aria-label': text.tabs.list }, this.tabs.list, this.tabs.panels),
      this.upload.target, dialog, this.help, this.layouts.element, this.token.element, this.toasts.element, kioskButton(this.root, this.state.kiosk));
    parent.replaceChildren(this.root);
    isCompact.bind((compact) => this.arrange(compact));
    isAcross.bind((across) => this.header.element.classList.toggle('on-picture', across));
    this.state.panel.bind((panel) => {
      if (panel !== '' && panel !== this.tabs.current) this.tabs.choose(panel);
      this.root.classList.toggle('no-panel', panel === '');
      this.tabs.setOpen(panel !== '');
    });
    this.state.dock.bind((shown) => this.root.classList.toggle('no-curves', !shown));
    // /embed is the page in a frame of another page.
    const isEmbedded = location.pathname.endsWith('/embed');
    this.state.kiosk.bind((kiosk) => this.root.classList.toggle('bare', kiosk || isEmbedded));
    if (!isEmbedded) this.upload.takeDrops();
    this.toasts.element.append(this.upload.progress);
    returnFocus(this.root, stage.surface);
  }

  /** On small screens, the bars around the picture become sheets. */
  private arrange(compact: boolean): void {
    this.root.classList.toggle('compact', compact);
    if (compact) this.viewHolder.prepend(this.viewBar.element);
    else this.main.append(this.viewBar.element);
    (compact ? this.curvesHolder : this.dock).prepend(this.curves.element);
    this.dock.append(this.timeline.element);
  }

  private connectSignals(): void {
    const { state } = this;
    new CameraInput(this.viewer.stage.surface, {
      camera: () => state.camera.value, move: (camera) => state.moveCamera(camera),
      drag: (right, up) => this.light.drag(right, up),
    });
    state.subject.watch((subject) => {
      this.elsewhere.reset();
      this.weights.choose(subject);
    });
    state.grid.watch((on) => on && void this.askDaemon().then(() => this.showCondition()));
    this.weights.subject.watch((name) => {
      if (name !== '') this.elsewhere.reset();
      this.curves.reset();
      this.timecode.show(this.timed);
      this.guide.onSubject(name);
      this.curves.take.onSubject(name);
      void this.readRig();
    });
    this.connection.link.watch((link) => {
      if (link === 'open') {
        this.everConnected = true;
        void this.askDaemon().then(() => this.showCondition());
        void this.readDaemon();
      }
      this.showNow();
    });
    this.viewer.notDrawn.watch(() => this.showCondition());
    window.addEventListener('hashchange', () => void this.curves.take.finish().then(() => location.reload())); // the user entered another URL
  }

  private commands(): Command[] {
    const { state } = this;
    const k = text.keys;
    const command = (key: string, words: string, run: () => void, release?: () => void): Command =>
      ({ key, words, run, ...(release ? { release } : {}) });
    return [
      ...Array.from({ length: 9 }, (_, i) => command(String(i + 1), i === 0 ? k.framing : '', () => this.viewBar.choose(i))),
      command('0', k.first, () => this.viewBar.choose(0)),
      command('f', k.fullscreen, () => this.actions.toggleFullscreen()),
      command('k', k.kiosk, () => state.kiosk.set(!state.kiosk.value)),
      command('b', k.screenshot, () => void this.actions.screenshot()),
      command('i', k.page, () => void this.actions.pageScreenshot()),
      command('r', k.record, () => this.actions.toggleRecording()),
      command('space', k.play, () => this.timeline.toggle()),
      command('u', k.open, () => this.upload.choose()),
      command('c', k.compare, () => state.comparing.set(true), () => state.comparing.set(false)),
      command('x', k.wipe, () => this.viewBar.nextWipe()),
      command('escape', k.leave, () => state.settings.set('view', 'final', performance.now())),
      command('/', k.search, () => this.openMenu()),
      command('ctrl+z', k.undo, () => state.settings.undo()),
      command('ctrl+y', k.redo, () => state.settings.redo()),
      command('p', k.panel, () => this.togglePanel()),
      command('g', k.curves, () => this.toggleDock()),
      command('o', k.layout, () => this.layouts.open()),
      command('l', k.light, () => this.light.toggle()),
      command('t', k.turntable, () => this.light.toggleTurntable()),
      command('m', k.mark, () => this.curves.mark()),
      command('v', k.grid, () => state.grid.set(!state.grid.value)),
      command('?', k.help, () => this.help.showModal()),
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
    this.state.dock.set(!this.state.dock.value);
  }

  private explainRegion(region: string, weights: string[]): void {
    this.faceMap.setChosen(region);
    this.explain.show(region, weights);
  }

  /** The frame whose timecode the page shows. Pictures of a pose at rest end, and its timecode goes on. */
  private get timed(): WeightFrame | undefined {
    return this.isAtRest() ? this.history.latest : this.history.current;
  }

  private onWeights(): void {
    this.timecode.show(this.timed);
    this.curves.onFrame();
    this.faceMap.onFrame();
  }

  /** The weights beside the picture are those of its pose. */
  private onPicture(): void {
    this.history.pinned = this.viewer.picture()?.sequence ?? null;
    this.onWeights();
    if (this.pictureState !== 'live' && this.pictureState !== 'paused') this.showCondition();
  }

  /** Reads settings and cameras on the first connection and after every restart of the daemon. */
  private async readDaemon(): Promise<void> {
    try {
      const [settings, cameras, status] = await Promise.all([api.settings(), api.cameras().catch(() => []), api.status()]);
      this.viewer.setRenderer(status.software);
      this.state.settings.setInfos(settings);
      if (this.began) {
        this.state.setPresets(cameras);
      } else {
        const unknown = this.state.begin(cameras);
        this.began = true;
        if (unknown.length > 0) this.toasts.say(text.menu.unknown(unknown), 'error');
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
    const subject = this.weights.subject.value;
    try {
      const rig = await api.rig(subject);
      if (subject !== this.weights.subject.value) return; // another answer follows
      this.faceMap.showRig(rig);
      this.capture.showRig(rig);
    } catch {
      // There is no subject yet, or the daemon left. The rig is read again once the subject is known.
    }
  }

  private async poll(): Promise<void> {
    const nowS = performance.now() / 1000;
    if (!document.hidden) await this.askDaemon();
    if (!document.hidden && this.connection.link.value === 'lost') await this.askForToken();
    const shown = this.shownSubject();
    this.viewer.observeRate(shown?.rate_hz ?? 0, nowS);
    this.viewer.drawing.observe(shown, this.viewer.stats.rateHz(nowS));
    const isHere = this.viewer.drawing.active.value;
    this.against.observe(this.pictureState);
    this.grid.observe(this.pictureState, isHere ? this.viewer.drawing.rateHz(nowS) : this.viewer.stats.rateHz(nowS), shown?.rate_hz ?? 0, this.isAtRest());
    if (isHere && this.numPolls++ % POLLS_PER_SETTINGS === 0) void this.readSettings();
    setTimeout(() => void this.poll(), this.pictureState === 'loading' ? LOADING_POLL_MS : POLL_MS);
  }

  private shownSubject(): SubjectInfo | undefined {
    return this.subjects?.find(({ name }) => name === this.weights.subject.value);
  }

  /** True if the subject has not moved since the pose on the screen. */
  private isAtRest(): boolean {
    return isAtRest(this.viewer.picture(), this.shownSubject(), performance.now() - this.askedMs);
  }

  private showFigures(nowS: number): void {
    const { stats, drawing } = this.viewer;
    const picture = this.viewer.picture();
    if (picture === null) {
      this.header.showFigures(null);
      return;
    }
    const isHere = drawing.active.value;
    const picturesHz = isHere ? drawing.rateHz(nowS) : stats.rateHz(nowS);
    const posesHz = this.shownSubject()?.rate_hz ?? 0;
    const isAtRest = this.isAtRest();
    this.header.showFigures({
      picturesHz, posesHz, isAtRest, ageMs: picture.ageMs, width: picture.width, height: picture.height,
      drawnPercent: picture.drawnPercent,
      ...this.streamFigures(nowS),
      limit: this.limit(nowS),
    });
  }

  private limit(nowS: number): Limit {
    const { stats, drawing } = this.viewer;
    const isHere = drawing.active.value;
    return limitOf({
      posesHz: this.shownSubject()?.rate_hz ?? 0,
      picturesHz: isHere ? drawing.rateHz(nowS) : stats.rateHz(nowS),
      waitedHz: stats.waitedHz(nowS),
      isDrawing: (this.status?.drawing ?? null) !== null,
      decodeMs: stats.decodeMs(),
      isAtRest: this.isAtRest(),
      isHere,
    });
  }

  /** Below a picture of the page. */
  private caption(): string[] {
    const { history } = this;
    return captionLines({
      date: new Date(), host: location.host, version: this.status?.version ?? '', userAgent: navigator.userAgent,
      width: innerWidth, height: innerHeight, density: devicePixelRatio, ...this.header.words(),
      sequence: this.viewer.picture()?.sequence ?? null,
      timecode: this.timed?.timecode?.text ?? '',
      weights: history.names.map((name) => [name, history.value(name)] as const),
      fragment: /#(.*)$/.exec(this.state.link())?.[1] ?? '',
    });
  }

  private streamFigures(nowS: number): { stream: string; streamTitle: string } {
    const { stats, video, drawing } = this.viewer;
    const t = text.stream;
    if (drawing.active.value || this.viewer.picture() === null) return { stream: '', streamTitle: '' };
    const isVideo = stats.codec !== '';
    const daemon = this.status?.video ?? null;
    const whyDaemon = daemon === null || daemon.why === '' ? t.why.full : t.why.daemon(daemon.why);
    const title = isVideo ? t.isVideo : t.isFiles(video.why || whyDaemon);
    if (stats.still) return { stream: t.still, streamTitle: `${t.stillTitle} ${title}` };
    return {
      stream: t.rate(isVideo ? t.h264 : t.jpeg, stats.mbitPerS(nowS).toFixed(2)),
      streamTitle: title,
    };
  }

  private quality(): string {
    const { stats, drawing } = this.viewer;
    const t = text.session;
    if (drawing.active.value) return t.here;
    if (stats.still) return t.still;
    return stats.codec === '' ? (t.tiers[stats.tier] ?? text.figures.none) : t.video;
  }

  private async askDaemon(): Promise<void> {
    if (this.connection.link.value !== 'open') return;
    try {
      [this.subjects, this.status] = await Promise.all([api.subjects(), api.status()]);
      this.askedMs = performance.now();
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
    const { stats, drawing } = this.viewer;
    const isHere = drawing.active.value;
    this.session.show(subjects, status, this.weights.subject.value, {
      latencyMs: isHere ? null : stats.latencyMs(),
      skipped: stats.dropped,
      quality: this.quality(),
      ...this.streamFigures(performance.now() / 1000),
    });
    this.header.showOpen(status.open);
    this.header.showSubjects(subjects.map(({ name }) => name));
    this.grid.setSubjects(subjects, this.weights.subject.value || this.state.subject.value);
    if (this.daemonSession !== '' && status.session !== this.daemonSession) {
      this.toasts.say(text.app.restarted);
      this.guide.onRestart();
    }
    this.daemonSession = status.session;
  }

  /** How a picture is. `wanted`: the subject that was asked for; `subject`: the one that is drawn. */
  private conditionOf(wanted: string, subject: string, picture: ShownPicture | null, isChanging: boolean, everyMs = 0): Condition {
    const info = this.subjects?.find(({ name }) => name === subject);
    return assess({
      link: this.connection.link.value,
      silentMs: document.hidden ? 0 : this.connection.silentMs,
      everConnected: this.everConnected,
      notDrawn: this.viewer.notDrawn.value,
      renders: this.status?.render ?? true,
      drawing: this.status?.drawing ?? null,
      isDraft: this.status?.starting ?? false,
      subjects: this.subjects,
      wanted,
      hasPicture: picture !== null,
      pictureMs: picture?.ageMs ?? null,
      everyMs,
      isChanging,
      limit: this.limit(performance.now() / 1000),
      isAtRest: isAtRest(picture, info, performance.now() - this.askedMs),
      isPaused: subject !== '' && this.timeline.pausedSubject === subject,
    });
  }

  private showCondition(): void {
    const picture = this.viewer.picture();
    const subject = this.weights.subject.value;
    const condition = this.conditionOf(this.state.subject.value, subject, picture, this.viewer.isChanging);
    const against = this.state.against.value;
    const beside = against === '' ? null : this.conditionOf(against, against, this.against.live.picture(), this.against.live.isChanging);
    if (beside !== null) this.against.show(beside, subject);
    this.grid.show((name, shown, everyMs) =>
      (name === subject ? condition : name === against ? beside! : this.conditionOf(name, name, shown, false, everyMs)));
    this.pictureState = condition.state;
    const { stage } = this.viewer;
    const hasPicture = picture !== null || stage.hasPicture;
    // Also the picture of a former connection, until there is another.
    stage.setDimmed(stage.hasPicture && (isDimmed(condition.state) || picture === null));
    this.header.showCondition(condition);
    this.notice.show(condition, hasPicture);
    this.root.dataset.state = condition.state;
  }
}
