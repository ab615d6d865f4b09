// The connection: opens again by itself, and says at once when nothing comes.
const kSilent_ms = 300;   // frames come every 40 ms, and every 100 ms while a person has paused the run
const kLook_ms = 100, kLooks = 20;  // a connection that is silent in so many looks is opened anew; a browser that is held up looks less
const kOpensAgain_ms = 500;
const element = id => document.getElementById(id);
const url = new URL('ws' + location.search, location.href.replace(/^http/, 'ws'));
let socket = null, heard_at = performance.now(), silent_looks = 0, hello = null, over = false, paused = false;

function connect() {
  const mine = socket = new WebSocket(url);
  let ended = false;
  silent_looks = 0;
  const again = () => { if (!ended) { ended = true; lose(mine); } };
  mine.onmessage = event => { if (!ended) hear(JSON.parse(event.data)); };
  mine.onclose = again;
  mine.give_up = () => { again(); mine.close(); };
}
function lose(mine) {
  if (mine !== socket) return;
  socket = null;
  asked = -1;
  lose_stops();
  show_state();
  setTimeout(connect, kOpensAgain_ms);
}
function order(message) { if (socket && socket.readyState === 1) socket.send(JSON.stringify(message)); }
function hear(message) {
  heard_at = performance.now();
  silent_looks = 0;
  const take = {hello: take_hello, field: m => { field = field_of(m); }, frame: take_frame, then: take_then, past: take_past, said: take_said,
                paused: () => { paused = true; axis(); }}[message.kind];
  if (take) take(message);
  show_state();
}
function take_hello(message) {
  hello = message;
  over = message.over === true;
  element('title').textContent = document.title = message.title;
  ground = null;
  offer_world();
  if (message.keeps_ticks) order({past: true});
}
let forgets = 0;
function take_said(message) {
  element('answer').textContent = message.text.trim();
  clearTimeout(forgets);
  forgets = setTimeout(() => { element('answer').textContent = ''; }, 8000);
}

// What a person must know of the picture: whether it is of now.
const silent_ms = () => performance.now() - heard_at;
const is_lost = () => !socket || socket.readyState !== 1;
const is_old = () => !over && (is_lost() || silent_ms() > kSilent_ms);
function show_state() {
  const state = element('state'), since = (silent_ms() / 1000).toFixed(1);
  const frame = frames.get(newest);
  let alarm = '';
  if (is_old() && (hello || silent_ms() > kLook_ms * kLooks)) alarm = is_lost() ? `No connection for ${since} s: this picture is old. Trying again.` : `Nothing heard for ${since} s: this picture is old.`;
  if (!alarm && frame && has_fault(frame.reasons)) alarm = 'Stopped: ' + words_of(frame.reasons) + '.';
  alarm = stop_alarm() || alarm;
  element('alarm').hidden = !alarm;
  element('alarm').textContent = alarm;
  state.className = is_old() ? 'bad' : '';
  element('end').hidden = !over || is_replay();
  element('end').textContent = `Ended: ${frame && frame.ended || 'see the program'}. ${is_lost() ? 'Its program has ended, too.' : 'The time axis shows any moment.'}`;
  state.textContent = hello && is_replay() && !is_lost() ? 'replay' : over ? (is_lost() ? 'ended, program gone' : 'ended') : is_lost() ? (hello ? 'lost' : 'connecting') : silent_ms() > kSilent_ms ? 'frozen' : paused ? 'paused' : follows ? 'live' : 'earlier';
  show_stop();
}
setInterval(() => {
  if (!over && socket && ++silent_looks > kLooks) socket.give_up();
  ask_again();
  show_state();
}, kLook_ms);
