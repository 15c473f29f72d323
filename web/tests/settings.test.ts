// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { fromControl, labelOf, toControl } from '../src/panels/setting_binding';
import { layoutPairs, readAddress } from '../src/state/address';
import { PresetShelf } from '../src/state/presets';
import { assignments, sameValue, SettingsModel } from '../src/state/settings';
import { someSettings } from './some_settings';

function model(): SettingsModel {
  const settings = new SettingsModel();
  settings.setInfos(someSettings());
  return settings;
}

test('a value equal to the daemon’s is not an override', () => {
  const settings = model();
  settings.set('shadow.softness_mm', '5', 0);
  assert.deepEqual([...settings.overrides], [['shadow.softness_mm', '5']]);
  settings.set('shadow.softness_mm', '3.0', 5000);
  assert.deepEqual([...settings.overrides], []);
  assert.equal(settings.value('shadow.softness_mm'), '3');
});

test('equal settings of the daemon, which the page reads every few seconds, change nothing', () => {
  const settings = model();
  let told = 0;
  settings.changed.watch(() => ++told);
  settings.setInfos(someSettings());
  assert.equal(told, 0);
  settings.setInfos(someSettings().map((info) => (info.name === 'shadow.taps' ? { ...info, value: '17' } : info)));
  assert.equal(told, 1);
  assert.equal(settings.value('shadow.taps'), '17');
});

test('a drag is one undo step, a later change another', () => {
  const settings = model();
  for (let i = 0; i < 10; ++i) settings.set('shadow.taps', String(10 + i), 50 * i);
  settings.set('wrinkles', 'off', 500);
  settings.set('shadow.taps', '30', 600);
  settings.undo();
  assert.deepEqual(Object.fromEntries(settings.overrides), { 'shadow.taps': '19', wrinkles: 'off' });
  settings.undo();
  settings.undo();
  assert.equal(settings.overrides.size, 0);
  assert.equal(settings.canUndo, false);
  settings.redo();
  assert.deepEqual(Object.fromEntries(settings.overrides), { 'shadow.taps': '19' });
});

test('a slow drag is one undo step, and the next drag another', () => {
  const settings = model();
  settings.set('shadow.taps', '9', 0);
  settings.endStep();
  for (let i = 0; i < 3; ++i) settings.set('shadow.taps', String(10 + i), 300); // its time is that of its beginning
  settings.endStep();
  settings.set('shadow.taps', '20', 600);
  settings.undo();
  assert.equal(settings.value('shadow.taps'), '12');
  settings.undo();
  assert.equal(settings.value('shadow.taps'), '9');
});

test('a change after undo clears the redo steps', () => {
  const settings = model();
  settings.set('wrinkles', 'off', 0);
  settings.undo();
  settings.set('view', 'normal', 5000);
  assert.equal(settings.canRedo, false);
});

test('compare shows the values before the last step', () => {
  const settings = model();
  assert.deepEqual([...settings.previous], []);
  settings.set('wrinkles', 'off', 0);
  settings.set('view', 'normal', 5000);
  assert.deepEqual([...settings.previous], [['wrinkles', 'off']]);
});

test('a rejected change leaves no undo step', () => {
  const settings = model();
  settings.set('wrinkles', 'off', 0);
  const accepted = settings.overrides;
  settings.set('shadow.softness_mm', '99', 5000);
  settings.reject(accepted);
  assert.deepEqual([...settings.overrides], [['wrinkles', 'off']]);
  settings.undo();
  assert.equal(settings.overrides.size, 0);
});

test('unknown names are returned and not sent', () => {
  const settings = model();
  assert.deepEqual(settings.replace(new Map([['wrinkles', 'off'], ['no.such', '1']])), ['no.such']);
  assert.deepEqual(assignments(settings.overrides), ['wrinkles=off']);
});

test('the view is sent separately from the settings', () => {
  const settings = model();
  settings.set('view', 'normal', 0);
  assert.deepEqual(assignments(settings.overrides), []);
});

test('overrides from the URL last until the daemon has replied', () => {
  const settings = new SettingsModel();
  settings.setInfos([]);
  settings.set('wrinkles', 'off', 0);
  settings.setInfos(someSettings());
  assert.deepEqual([...settings.overrides], [['wrinkles', 'off']]);
});

test('values are compared by meaning', () => {
  const [, wrinkles, background, softness] = someSettings();
  assert(sameValue(wrinkles!, 'on', 'true'));
  assert(!sameValue(wrinkles!, 'on', 'off'));
  assert(sameValue(softness!, '1', '1.0'));
  assert(!sameValue(softness!, '1', '1.001'));
  assert(sameValue(background!, '0.1,0.2,0.3', '0.10, 0.2, 0.3'));
});

test('controls convert the daemon’s values both ways', () => {
  for (const info of someSettings()) {
    if (info.kind === 'colour') continue;
    const back = fromControl(info, toControl(info, info.value));
    assert(sameValue(info, back, info.value), `${info.name}: ${back}`);
  }
  const [, , background] = someSettings();
  // Byte 128 of sRGB is linear 0.2159 (IEC 61966-2-1).
  assert.equal(toControl(background!, '0.2159,0,1'), '#8000ff');
  assert.equal(fromControl(background!, '#8000ff'), '0.21586,0,1');
});

test('a label states its unit once', () => {
  assert.equal(labelOf(someSettings()[3]!), 'Softness (mm)');
  assert.equal(labelOf(someSettings()[4]!), 'Taps');
});

test('own presets are saved, built-in presets are not overwritten', () => {
  const kept = new Map<string, string>();
  const store = { getItem: (key: string) => kept.get(key) ?? null, setItem: (key: string, v: string) => void kept.set(key, v) };
  const shelf = PresetShelf.presets(store);
  assert.equal(shelf.save(PresetShelf.presets(null).all()[0]!.name, new Map()), false);
  assert.equal(shelf.save('', new Map()), false);
  assert(shelf.save('mine', new Map([['wrinkles', 'off']])));
  const again = PresetShelf.presets(store).all().find(({ name }) => name === 'mine')!;
  assert.deepEqual([...again.values], [['wrinkles', 'off']]);
  shelf.delete('mine');
  assert.equal(PresetShelf.presets(store).all().length, PresetShelf.presets(null).all().length);
  kept.set('furrow.presets', 'no JSON');
  assert.equal(PresetShelf.presets(store).all().length, PresetShelf.presets(null).all().length);
});

test('layouts are kept beside presets, and are parts of an address', () => {
  const kept = new Map<string, string>();
  const store = { getItem: (key: string) => kept.get(key) ?? null, setItem: (key: string, value: string) => void kept.set(key, value) };
  const shelf = PresetShelf.layouts(store);
  const built = shelf.all().length;
  const page = readAddress('#subject=ann&shading=skin&panel=wrinkles&curves=a,b&debug=normal&grid=1&dock=0&camera=eyes');
  const pairs = layoutPairs(page);
  assert.deepEqual(pairs, [['debug', 'normal'], ['curves', 'a,b'], ['panel', 'wrinkles'], ['grid', '1'], ['dock', '0']]);
  assert.equal(shelf.save('Usual', new Map(pairs)), false);
  assert.equal(shelf.save('mine', new Map(pairs)), true);
  assert.deepEqual(PresetShelf.layouts(store).all().at(-1)!.values, new Map(pairs));
  assert.equal(PresetShelf.layouts(store).all().length, built + 1);
  assert.equal(PresetShelf.presets(store).all().some(({ name }) => name === 'mine'), false);
  const other = PresetShelf.layouts(store); // another tab
  assert.equal(other.save('theirs', new Map()), true);
  assert.equal(shelf.save('constructor', new Map([['grid', '1']])), true);
  const own = (from: PresetShelf) => from.all().filter((preset) => preset.own).map(({ name }) => name);
  assert.deepEqual(own(shelf), ['mine', 'theirs', 'constructor']);
  shelf.delete('mine');
  assert.deepEqual(own(other), ['theirs', 'constructor']);
  kept.set('furrow.layouts', '{"a":null,"b":"x","c":[1],"d":{"grid":1}}');
  assert.equal(shelf.save('e', new Map()), true);
  assert.deepEqual(own(other), ['d', 'e']);
  kept.set('furrow.layouts', '[broken');
  assert.equal(PresetShelf.layouts(store).all().length, built);
});

test('settings that change together are one undo step', () => {
  const settings = model();
  settings.setMany(new Map([['shadow.taps', '9'], ['shadow.softness_mm', '4']]), 0);
  settings.setMany(new Map([['shadow.taps', '10'], ['shadow.softness_mm', '5']]), 100);
  assert.equal(settings.value('shadow.taps'), '10');
  settings.undo();
  assert.equal(settings.overrides.size, 0);
  assert.equal(settings.canUndo, false);
});

test('without room in the storage, presets last until the page is closed', () => {
  const full = { getItem: () => null, setItem: () => { throw new Error('quota exceeded'); } };
  const shelf = PresetShelf.presets(full);
  shelf.save('one', new Map());
  shelf.save('two', new Map());
  assert.deepEqual(shelf.all().filter(({ own }) => own).map(({ name }) => name), ['one', 'two']);
});
