// Ticks that are kept here, and the one that is shown. Everything is in metres, seconds and radians in the map.
const kMostFrames = 3000;  // two minutes at 25 a second; where the program keeps ticks, any other is asked for
const kMostStrip = 4000, kAsksAgain_ms = 1000;
let field = null;
const frames = new Map();  // by tick
const fields = new Map();  // by number
let past = [];             // [tick, t, wanted, permitted, speed, reasons, x, y] for strip and trail, in order
let first = 0, newest = -1, shown = -1;
let follows = true, plays = false, asked = -1, asked_at = 0;

function forget() {
  frames.clear(); fields.clear();
  past = []; first = 0; newest = shown = -1; follows = true; field = null;
  lose_stops();
}
function take_frame(frame) {
  if (frame.tick < newest) forget();  // the program was started anew
  frame.field = field;  // the potential of its time: an earlier tick is shown with its own
  keep(frame);
  newest = frame.tick;
  over = frame.ended !== '';
  paused = false;
  past.push([frame.tick, frame.t, frame.wanted[0], frame.permitted[0], frame.speed, frame.reasons, frame.pose[0], frame.pose[1]]);
  if (past.length > kMostStrip) past = past.filter((_, i) => i % 2 === 0);
  if (follows) shown = newest;
  hear_stops(frame);
  axis();
  draw_soon();
}
function keep(frame) {
  frames.set(frame.tick, frame);
  if (frames.size > kMostFrames) frames.delete(frames.keys().next().value);
  if (!hello || !hello.keeps_ticks) first = frames.keys().next().value;
}
// A tick that was asked for.
function take_then(message) {
  message.frame.field = message.field && field_of(message.field);
  keep(message.frame);
  asked = -1;
  if (follows) draw_soon(); else choose(shown);
}
function take_past(message) {
  const mine = message.ticks.map((row, i) => [i * message.step, ...row]), last = mine.length ? mine[mine.length - 1] : [-1];
  past = mine.concat(past.filter(row => row[0] > last[0]));
  newest = Math.max(newest, last[0]);
  if (shown < 0) choose(newest), follows = true;
  axis();
  draw_soon();
}
const closest = (items, off) => items.reduce((a, b) => a && Math.abs(off(a)) <= Math.abs(off(b)) ? a : b, null);
const nearest = tick => closest([...frames.values()], frame => frame.tick - tick);
const is_replay = () => hello && !hello.takes_goals && !hello.takes_pauses;
const is_local = () => hello && (over || !hello.takes_pauses);  // Pause and Play are the page's own
function choose(tick) {
  shown = Math.max(first, Math.min(newest, tick));
  follows = false;
  if (!frames.has(shown) && hello.keeps_ticks && asked < 0 && !is_lost()) { asked = shown; asked_at = performance.now(); order({tick: shown}); }
  axis();
  draw_soon();
}
// What was asked for and did not come does not keep others from being asked for.
function ask_again() {
  if (asked < 0 || performance.now() - asked_at < kAsksAgain_ms) return;
  asked = -1;
  if (!follows) choose(shown);
}
function axis() {
  const time = element('time');
  time.min = first; time.max = newest; time.value = shown;
  element('pause').textContent = is_local() ? (plays ? 'Pause' : 'Play') : paused ? 'Go on' : 'Pause';
}
function play(value) {
  plays = value;
  let at = shown, before = performance.now();
  const go = now => {
    if (!plays || shown !== Math.floor(at)) return;  // another tick was chosen
    at += (now - before) / 1000 / hello.tick_s;
    before = now;
    choose(Math.floor(at));
    if (shown >= newest) { plays = false; return axis(); }
    requestAnimationFrame(go);
  };
  if (plays) { if (shown >= newest) at = shown = first; requestAnimationFrame(go); }
  axis();
}
