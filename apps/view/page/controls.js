// What a person does, by pointer and by keys.
const kKeys = [['Space', 'Stop', ask_stop], ['r', 'let it move again after a stop', ask_reset], ['Enter', 'go to the goal proposed', accept], ['Escape', 'leave the goal proposed', () => { cancel_proposal(); show_card(null); }],
  ['u', 'undo the last goal', undo], ['p', 'pause or go on', () => element('pause').click()], ['.', 'a tick on', () => element('step').click()],
  ['ArrowLeft', 'a second back', () => { plays = false; choose(shown - Math.round(1 / hello.tick_s)); }], ['ArrowRight', 'a second on', () => { plays = false; choose(shown + Math.round(1 / hello.tick_s)); }],
  ['End', 'live', () => element('live').click()], ['+', 'nearer', () => zoom(1.3)], ['-', 'farther', () => zoom(1 / 1.3)], ['0', 'all of it', () => aim_at('whole')],
  ['f', 'keep the robot in the middle', () => aim_at('along')], ['w', 'map up', () => pan(0, step_m())], ['a', 'map left', () => pan(-step_m(), 0)], ['s', 'map down', () => pan(0, -step_m())],
  ['d', 'map right', () => pan(step_m(), 0)], ['l', 'legend', () => show_card('legend')], ['e', 'play with an endless world', show_world], ['n', 'night or day', () => show_theme(theme() === 'dark' ? 'light' : 'dark')], ['?', 'these keys', () => show_card('keys')]];
const step_m = () => map.height / view.scale / 8;

function set_paused(value) { paused = value; order({pause: value}); axis(); }
element('pause').onclick = () => { if (is_local()) play(!plays); else set_paused(!paused); };
element('step').onclick = () => {
  if (!follows || is_local()) { plays = false; return choose(shown + 1); }
  if (!paused) set_paused(true);
  order({step: true});
};
element('time').oninput = event => { plays = false; choose(Number(event.target.value)); };
const kButtons = {stop: ask_stop, reset: ask_reset, undo, go: accept, leave: cancel_proposal, nearer: () => zoom(1.3), farther: () => zoom(1 / 1.3),
  whole: () => aim_at('whole'), along: () => aim_at('along'), key: () => show_card('legend'), help: () => show_card('keys'),
  play: show_world, more: () => order({walkers: 1}), fewer: () => order({walkers: -1}), strike: () => order({fault: element('fault').selectedIndex}),
  live: () => { plays = false; shown = newest; follows = true; axis(); draw_soon(); }};
for (const id in kButtons) element(id).onclick = kButtons[id];
onkeydown = event => {
  if (event.ctrlKey || event.metaKey || event.altKey) return event.key === 'z' && undo();
  const key = event.key === ' ' ? 'Space' : event.key.length === 1 ? event.key.toLowerCase() : event.key, found = kKeys.find(row => row[0] === key);
  if (!found || (key === 'Enter' && document.activeElement.tagName === 'BUTTON')) return;
  event.preventDefault();
  if (view || key === 'Space') found[2]();
};

function show_card(which) {
  for (const name of ['legend', 'keys']) element(name).hidden = name !== which || !element(name).hidden;
  element('keys').innerHTML = kKeys.map(([key, what]) => `<kbd>${key}</kbd><span>${what}</span>`).join('') +
    '<kbd>tap</kbd><span>propose a goal; drag: with a heading</span><kbd>wheel, pinch</kbd><span>zoom</span><kbd>Shift and drag, two fingers</kbd><span>move the map</span>';
  element('legend').innerHTML = legend().map(([names, what, height]) => {
    const colours = [names].flat().map(name => ink(name).includes(',') ? `rgb(${ink(name)})` : ink(name));
    return `<i class="swatch" style="background:linear-gradient(90deg,${colours.join(',')},${colours[colours.length - 1]});height:${height || '12px'}"></i><span>${what}</span>`;
  }).join('');
}
const theme = () => document.documentElement.dataset.theme;
function show_theme(which) {
  document.documentElement.dataset.theme = which;
  inks.clear();
  pictures.ground = pictures.field = null;
  draw_soon();
}
const dark = matchMedia('(prefers-color-scheme: dark)');
dark.onchange = () => show_theme(dark.matches ? 'dark' : 'light');

// One pointer that taps or drags is a goal; two, Shift or another button move the map.
const touches = new Map();
map.onpointerdown = event => {
  if (!view) return;
  map.setPointerCapture(event.pointerId);
  touches.set(event.pointerId, event);
  const pans = event.shiftKey || event.button !== 0 || touches.size > 1;
  drag = pans || hello.takes_goals && !over ? {from: to_map(event), to: to_map(event), pans, x: event.clientX, y: event.clientY} : null;
};
map.onpointermove = event => {
  const before = touches.get(event.pointerId);
  if (!before) return hover(event);
  if (touches.size > 1) pinch(event, before);
  else if (drag && drag.pans) { const a = to_map(before), b = to_map(event); pan(a[0] - b[0], a[1] - b[1]); }
  else if (drag) drag.to = to_map(event);
  touches.set(event.pointerId, event);
  draw_soon();
};
function pinch(event, before) {
  const other = [...touches.values()].find(touch => touch.pointerId !== event.pointerId);
  const was = Math.hypot(before.clientX - other.clientX, before.clientY - other.clientY), is = Math.hypot(event.clientX - other.clientX, event.clientY - other.clientY);
  const a = to_map(before), b = to_map(event);
  pan((a[0] - b[0]) / 2, (a[1] - b[1]) / 2);
  if (was > 10 && is > 10) zoom(is / was, to_map(other));
}
map.onpointercancel = event => { touches.delete(event.pointerId); drag = null; };
map.onpointerup = event => {
  touches.delete(event.pointerId);
  const mine = drag;
  if (!mine || mine.pans) { if (!touches.size) drag = null; return; }
  drag = null;
  const dx = mine.to[0] - mine.from[0], dy = mine.to[1] - mine.from[1];  // a short drag is a tap
  propose(...mine.from, Math.hypot(event.clientX - mine.x, event.clientY - mine.y) > 12 ? Math.atan2(dy, dx) : null);
};
map.onwheel = event => { event.preventDefault(); if (view) zoom(Math.exp(-event.deltaY / 500), to_map(event)); };
map.oncontextmenu = event => event.preventDefault();
map.onpointerleave = () => { element('tip').hidden = true; };
function hover(event) {
  const frame = frames.get(shown), tip = element('tip');
  if (!frame || !view || event.pointerType === 'touch') return;
  const [x, y] = to_map(event), near = frame.scene.tracks.map(k => [Math.hypot(k[1] - x, k[2] - y) - k[3], k]).sort((a, b) => a[0] - b[0])[0];
  const track = near && near[0] < Math.max(0.1, 8 / view.scale) ? near[1] : null, robot = Math.hypot(frame.pose[0] - x, frame.pose[1] - y) < hello.front_m;
  tip.textContent = track ? `${track[0]}: ${track[4] ? 'moves, ' + speed_of(Math.hypot(track[5], track[6])) : track[7] ? 'stands, has walked' : 'has not moved'}\nradius ${track[3].toFixed(2)} m` :
    robot ? `robot, ${speed_of(frame.speed)}\nheading ${degrees(frame.pose[2])}` : `${x.toFixed(2)}, ${y.toFixed(2)} m`;
  const box = map.getBoundingClientRect(), right = event.clientX - box.left > box.width - 180;
  tip.style.left = `${event.clientX - box.left + (right ? -170 : 14)}px`;
  tip.style.top = `${Math.min(event.clientY - box.top + 14, box.height - 50)}px`;
  tip.hidden = false;
}
strip.onpointermove = event => { strip_hint = event.offsetX * strip.width / strip.getBoundingClientRect().width; draw_soon(); };
strip.onpointerleave = () => { strip_hint = null; draw_soon(); };
strip.onclick = event => { const row = tick_under(event); if (row) { plays = false; choose(row[0]); } };
onresize = draw_soon;
onpagehide = () => socket && socket.close();  // a browser may keep the page, and with it the connection
onpageshow = event => { if (event.persisted) location.reload(); };
show_theme(dark.matches ? 'dark' : 'light');
connect();
