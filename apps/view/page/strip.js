// The last minute before the tick that is shown: speed, wanted, permitted, and a band for the reasons.
const kStrip_s = 60;
let strip_hint = null;  // where a pointer is, in the canvas's own pixels

function draw_strip(frame) {
  const scale = fit(strip), pen = strip.getContext('2d'), w = strip.width, h = strip.height;
  const left = 44 * scale, foot = 18 * scale, top = 16 * scale, plot = h - foot - top;
  pen.fillStyle = ink('strip'); pen.fillRect(0, 0, w, h);
  const end = frame.t, rows = past.filter(row => row[1] > end - kStrip_s && row[1] <= end);
  const most = Math.max(0.1, hello.max_speed_mps * 1.1), at = t => left + (t - end + kStrip_s) / kStrip_s * (w - left - 4 * scale), up = v => top + plot * (1 - Math.abs(v) / most);
  pen.font = `${11 * scale}px system-ui, sans-serif`; pen.lineWidth = scale; pen.textAlign = 'right';
  for (const v of [0, hello.max_speed_mps]) {
    pen.strokeStyle = ink('edge'); pen.beginPath(); pen.moveTo(left, up(v)); pen.lineTo(w, up(v)); pen.stroke();
    pen.fillStyle = ink('quiet'); pen.fillText(v.toFixed(1), left - 4 * scale, up(v) + 4 * scale);
  }
  draw_reasons(pen, rows, at, h - foot + 2 * scale, foot - 4 * scale, scale);
  for (const [which, name, dash, width] of [[2, 'wanted', [], 5], [4, 'speed', [], 2], [3, 'permitted', [6, 6], 2]]) {
    pen.beginPath();
    for (const row of rows) pen.lineTo(at(row[1]), up(row[which]));
    pen.setLineDash(dash.map(d => d * scale)); pen.strokeStyle = ink(name); pen.lineWidth = width * scale; pen.stroke();
  }
  pen.setLineDash([]);
  draw_key(pen, left, scale, strip_hint === null ? null : closest(rows, row => at(row[1]) - strip_hint), end);
}
// Faults are red, limits amber; the words stand where they fit.
function draw_reasons(pen, rows, at, y, height, scale) {
  pen.textAlign = 'left';
  for (let i = 0; i < rows.length;) {
    let k = i;
    while (k + 1 < rows.length && rows[k + 1][5] === rows[i][5]) k++;
    const text = rows[i][5], x = at(rows[i][1]), width = Math.max(1, at(rows[Math.min(k + 1, rows.length - 1)][1]) - x);
    if (text) { pen.fillStyle = has_fault(text) ? ink('bad') : ink('warn'); pen.globalAlpha = 0.55; pen.fillRect(x, y, width, height); pen.globalAlpha = 1; }
    pen.fillStyle = ink('text');
    if (text && pen.measureText(words_of(text)).width < width - 4 * scale) pen.fillText(words_of(text), x + 3 * scale, y + height - 4 * scale);
    i = k + 1;
  }
}
// What the lines are; under a pointer, what they are there.
function draw_key(pen, left, scale, row, end) {
  let x = left + 4 * scale;
  pen.textAlign = 'left';
  for (const [which, name] of [[4, 'speed'], [2, 'wanted'], [3, 'permitted']]) {
    const text = row ? `${name} ${row[which].toFixed(2)}` : name;
    pen.fillStyle = ink(name); pen.fillRect(x, 6 * scale, 12 * scale, 3 * scale);
    pen.fillStyle = ink('text'); pen.fillText(text, x + 16 * scale, 12 * scale);
    x += pen.measureText(text).width + 30 * scale;
  }
  const note = row ? `m/s, ${(end - row[1]).toFixed(1)} s before${row[5] ? ': ' + words_of(row[5]) : ''}` : 'm/s, last minute';
  pen.fillStyle = ink('quiet'); pen.fillText(note, x, 12 * scale);
}
function tick_under(event) {
  const bounds = strip.getBoundingClientRect(), scale = strip.width / bounds.width, frame = frames.get(shown) || nearest(shown);
  if (!frame) return null;
  const left = 44 * scale, t = frame.t - kStrip_s + ((event.clientX - bounds.left) * scale - left) / (strip.width - left - 4 * scale) * kStrip_s;
  return closest(past, row => row[1] - t);
}
