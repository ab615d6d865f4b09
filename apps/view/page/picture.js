// The map as it is drawn, in the colours of the theme.
const inks = new Map();
function ink(name) {
  if (!inks.has(name)) inks.set(name, getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim());
  return inks.get(name);
}
const tint = (name, alpha) => `rgba(${ink(name)},${alpha})`;
const legend = () => [
  ['wall', hello.walls.length ? 'walls of the world' : 'walls known before', '2px'], ['hit', 'where beams end, at the time of the scan', '4px'], [['near', 'far'], 'way to the goal: light is near it; pale was never seen; grey is not free, reddish without a known way'],
  ['mover', 'moving: number, its sampled futures, where it may be in 2 and 4 s'], ['still', 'does not move'], ['pedestrian', 'a standing pedestrian', '3px'],
  ['path', 'path and goal; dashed: a goal proposed', '3px'], ['trail', 'way driven', '2px'], ['chosen', 'trajectory chosen, for 6 s', '4px'], ['robot', 'the robot', '3px'], ['zone', 'its stop zone', '2px']];

function trace(pen, points) { points.forEach((p, i) => i ? pen.lineTo(...to_screen(p[0], p[1])) : pen.moveTo(...to_screen(p[0], p[1]))); }
function line(pen, points, colour, width) {
  pen.beginPath();
  trace(pen, points);
  pen.strokeStyle = colour; pen.lineWidth = width; pen.lineJoin = 'round'; pen.stroke();
}
function disc(pen, x, y, radius_m, fill, edge) {
  pen.beginPath();
  pen.arc(...to_screen(x, y), Math.max(1, radius_m * view.scale), 0, 2 * Math.PI);
  if (fill) { pen.fillStyle = fill; pen.fill(); }
  if (edge) { pen.strokeStyle = edge; pen.lineWidth = 1.5; pen.stroke(); }
}

// The planner's sampled futures: where each mover is now and in 1, 2, 3 and 4 s; discs at 2 and 4 s.
function draw_futures(pen, futures) {
  const times = 5, samples = futures.length ? (futures[0].length - 1) / 2 / times : 0;
  const at = (row, f, k) => [row[1 + 2 * (f * times + k)], row[2 + 2 * (f * times + k)]];
  pen.beginPath();
  for (const row of futures) for (let f = 0; f < samples; f++) trace(pen, [0, 1, 2, 3, 4].map(k => at(row, f, k)));
  pen.strokeStyle = tint('mover', 0.45); pen.lineWidth = 1; pen.stroke();
  for (const k of [2, 4]) {
    pen.beginPath();
    for (const row of futures) for (let f = 0; f < samples; f++) {
      const [x, y] = to_screen(...at(row, f, k)), r = row[0] * view.scale;
      pen.moveTo(x + r, y); pen.arc(x, y, r, 0, 2 * Math.PI);
    }
    pen.fillStyle = tint('mover', 0.12); pen.fill();
  }
}
function draw_tracks(pen, scene, scale) {
  for (const [x, y, radius] of scene.standing) disc(pen, x, y, radius, null, ink('pedestrian'));
  draw_futures(pen, scene.futures);
  for (const [x, y, radius] of scene.expected) disc(pen, x, y, radius, tint('mover', 0.15), tint('mover', 0.5));
  for (const [, x, y, radius, moves] of scene.tracks) disc(pen, x, y, radius, moves ? tint('mover', 0.8) : tint('still', 0.4));
  if (0.3 * view.scale < 4 * scale) return;  // too small for numbers
  pen.fillStyle = ink('text'); pen.textAlign = 'center'; pen.font = `${11 * scale}px system-ui, sans-serif`;
  for (const [id, x, y, radius, moves] of scene.tracks) if (moves) { const p = to_screen(x, y + radius); pen.fillText(id, p[0], p[1] - 3 * scale); }
}

function draw_robot(pen, frame) {
  frame.zone.forEach((corners, i) => line(pen, [...corners, corners[0]], tint('zone', i + 1 < frame.zone.length ? 0.35 : 1), 1.5));
  const [x, y, h] = frame.pose, c = Math.cos(h), s = Math.sin(h), f = hello.front_m, r = -hello.rear_m, w = hello.half_width_m;
  const line_of = corners => line(pen, corners.map(([a, b]) => [x + c * a - s * b, y + s * a + c * b]), ink('robot'), 2.5);
  line_of([[f, w], [f, -w], [r, -w], [r, w], [f, w]]);
  line_of([[0, 0], [f, 0]]);
}
function draw_goal(pen, [x, y, heading]) {
  disc(pen, x, y, 0.3, tint('goal', 0.25), ink('path'));
  if (heading !== null && heading !== undefined) line(pen, [[x, y], [x + Math.cos(heading), y + Math.sin(heading)]], ink('path'), 3);
}
function draw_raster(pen, name, raster, colour, fine) {
  if (!pictures[name] || pictures[name].raster !== raster) pictures[name] = painted(raster, colour, fine);
  pen.imageSmoothingEnabled = fine > 1; pen.imageSmoothingQuality = 'high';
  pen.drawImage(pictures[name].picture, ...to_screen(raster.x, raster.y + raster.height_m), raster.width_m * view.scale, raster.height_m * view.scale);
}

function draw_map(frame) {
  const scale = fit(map);
  if (!drag || !view) aim(frame);
  const pen = map.getContext('2d'), scene = frame.scene;
  pen.fillStyle = ink('page'); pen.fillRect(0, 0, map.width, map.height);
  if (hello.ground) draw_raster(pen, 'ground', known_ground(), ground_colour_of, 1);
  if (frame.field) draw_raster(pen, 'field', frame.field, colour_of, kFiner);
  pen.beginPath();
  for (const w of hello.walls) trace(pen, [[w[0], w[1]], [w[2], w[3]]]);
  pen.strokeStyle = ink('wall'); pen.lineWidth = 2; pen.stroke();
  pen.beginPath();
  for (let i = 0; i < scene.hits.length; i += 2) { const [x, y] = to_screen(scene.hits[i], scene.hits[i + 1]); pen.rect(x - 1, y - 1, 2.5, 2.5); }
  pen.fillStyle = ink('hit'); pen.fill();
  draw_tracks(pen, scene, scale);
  line(pen, past.filter(row => row[1] <= frame.t).map(row => [row[6], row[7]]), ink('trail'), 2 * scale);
  if (frame.goal) { line(pen, scene.path, ink('path'), 3); draw_goal(pen, frame.goal); line(pen, scene.chosen, ink('chosen'), 4 * scale); }
  draw_robot(pen, frame);
  draw_proposal(pen);
  draw_scale(pen, scale);
}

let drawing = false;
function draw_soon() {
  if (drawing) return;
  drawing = true;
  requestAnimationFrame(() => { drawing = false; draw(); });
}
function draw() {
  const frame = frames.get(shown) || nearest(shown);
  if (!hello || !frame) return;
  draw_map(frame);
  draw_strip(frame);
  const alarms = frame === frames.get(newest) && element('alarm').textContent.startsWith('Stopped: ');  // which has the reasons
  const why = frame.ended ? 'ended: ' + frame.ended : alarms ? '' : words_of(frame.reasons) || (frame.arrived && Math.abs(frame.speed) < 0.01 ? 'arrived: tap the next goal' : '');
  element('said').textContent = `${frame.t.toFixed(2)} s \u00B7 ${speed_of(frame.speed)}, wanted ${hundredths(frame.wanted[0])}, permitted ${hundredths(frame.permitted[0])}` +
    (why ? ` \u00B7 ${why}` : '');
}
