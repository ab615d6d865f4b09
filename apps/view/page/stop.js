// Stop goes both ways at once, by the WebSocket and by a plain POST, and again until it was heard: the loop counts stops
// in every frame, so that the page shows what the loop says, not what the page hopes.
const kHeardWithin_ms = 200, kAgain_ms = 500;
let stop = null, stops_said = null;

function ask_stop() {
  cancel_proposal();
  stop = {asked: performance.now(), before: stops_said, heard: null, taken: false, sent: 0};
  send_stop(stop);
  show_state();
}
function ask_reset() { order({reset: true}); }
function send_stop(mine) {
  mine.sent = performance.now();
  order({stop: true});
  fetch('stop' + location.search, {method: 'POST', signal: AbortSignal.timeout(2000)})
    .then(answer => answer.json())
    .then(said => { if (stop === mine) mine.taken = true; take_said(said); show_state(); }, () => {});
}
function hear_stops(frame) {
  stops_said = frame.stops;
  if (stop && stop.heard !== null && !is_latched(frame)) stop = null;
  if (!stop || stop.heard !== null) return;
  if (stop.before === null) stop = {...stop, before: stops_said, taken: false};
  if (stops_said !== stop.before) stop.heard = performance.now() - stop.asked;
}
// What was counted may be another program's, or have grown unseen: a stop that waits is sent anew.
function lose_stops() {
  stops_said = null;
  if (stop && stop.heard === null) stop.before = null;
}
const stop_waits_ms = () => stop && stop.heard === null ? performance.now() - stop.asked : 0;
function stop_alarm() {
  if (!stop || stop.heard !== null || over || stop_waits_ms() < kHeardWithin_ms) return '';
  if (stop.taken && paused) return '';
  if (stop.taken) return 'Stop was taken, but the loop has not said so. Use the emergency stop if it moves.';
  return `STOP NOT HEARD for ${(stop_waits_ms() / 1000).toFixed(1)} s, trying again. Use the emergency stop.`;
}
function show_stop() {
  const button = element('stop'), frame = frames.get(newest);
  if (stop && stop.heard === null && !stop.taken && !over && performance.now() - stop.sent > kAgain_ms) send_stop(stop);
  button.hidden = !hello || !hello.takes_goals || over;
  if (over) element('undo').hidden = true;
  element('reset').hidden = !frame || !hello.takes_goals || over || !is_latched(frame);
  const moves = frame && Math.abs(frame.speed) > 0.01;
  button.className = !stop ? '' : stop.heard !== null ? 'heard' : stop_alarm() ? 'unheard' : 'waits';
  button.textContent = !stop ? 'Stop' : stop.heard !== null ? (moves ? `Heard in ${Math.round(stop.heard)} ms, stopping` : 'Stopped \u2713') :
    stop.taken && paused ? 'Stop taken, paused' : stop_alarm() ? 'Stop again' : 'Stop \u2026';
}
