// From the map to the screen: all of it, along with the robot, or wherever a person has moved it.
const map = element('map'), strip = element('strip');
let view = null, box = null, aims = 'whole';  // pixels a metre and the map's point in the middle; what has to be seen
const kMargin_m = 0.5, kAlong_m = 12;

function fit(canvas) {
  const scale = devicePixelRatio || 1, box = canvas.getBoundingClientRect();
  const width = Math.round(box.width * scale), height = Math.round(box.height * scale);
  if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
  return scale;
}
// The walls where they are known; else what was seen so far.
function aim(frame) {
  const reach = (x, y) => { box = [Math.min(box[0], x), Math.min(box[1], y), Math.max(box[2], x), Math.max(box[3], y)]; };
  if (!box) {
    box = [frame.pose[0], frame.pose[1], frame.pose[0], frame.pose[1]];
    for (const w of hello.walls) { reach(w[0], w[1]); reach(w[2], w[3]); }
    const g = hello.ground && known_ground();
    if (g) { reach(g.x, g.y); reach(g.x + g.width_m, g.y + g.height_m); }
  }
  reach(frame.pose[0], frame.pose[1]);
  if (frame.goal) reach(frame.goal[0], frame.goal[1]);
  const hits = frame.scene.hits;
  if (!hello.walls.length && !hello.ground) for (let i = 0; i < hits.length; i += 2) reach(hits[i], hits[i + 1]);
  if (aims === 'free' && view) return;
  if (aims === 'along') view = {scale: view && view.along ? view.scale : Math.min(map.width, map.height) / kAlong_m, x: frame.pose[0], y: frame.pose[1], along: true};
  else view = {scale: Math.min(map.width / (box[2] - box[0] + 2 * kMargin_m), map.height / (box[3] - box[1] + 2 * kMargin_m)), x: (box[0] + box[2]) / 2, y: (box[1] + box[3]) / 2};
}
const to_screen = (x, y) => [map.width / 2 + (x - view.x) * view.scale, map.height / 2 - (y - view.y) * view.scale];
const to_map = event => {
  const box = map.getBoundingClientRect(), scale = map.width / box.width;
  return [view.x + ((event.clientX - box.left) * scale - map.width / 2) / view.scale, view.y - ((event.clientY - box.top) * scale - map.height / 2) / view.scale];
};
function zoom(by, at = [view.x, view.y]) {
  if (aims !== 'along') aims = 'free'; else at = [view.x, view.y];
  const scale = Math.max(0.5, Math.min(2000, view.scale * by)), kept = view.scale / scale;
  view = {...view, scale, x: at[0] + (view.x - at[0]) * kept, y: at[1] + (view.y - at[1]) * kept};
  draw_soon();
}
function pan(dx, dy) {  // m
  aims = 'free';
  view = {scale: view.scale, x: view.x + dx, y: view.y + dy};
  draw_soon();
}
function aim_at(what) { aims = what; view = null; box = null; draw_soon(); }

// A length of 1, 2 or 5 times a power of ten, at most 70 pixels.
function draw_scale(pen, scale) {
  const wanted = 70 * scale / view.scale, ten = 10 ** Math.floor(Math.log10(wanted));
  const length = [5, 2, 1].map(k => k * ten).find(l => l <= wanted) || ten, x = 12 * scale, y = map.height - 14 * scale;
  pen.strokeStyle = pen.fillStyle = ink('text'); pen.lineWidth = 1.5 * scale;
  pen.beginPath();
  pen.moveTo(x, y - 5 * scale); pen.lineTo(x, y); pen.lineTo(x + length * view.scale, y); pen.lineTo(x + length * view.scale, y - 5 * scale);
  pen.stroke();
  pen.font = `${12 * scale}px system-ui, sans-serif`; pen.textAlign = 'left';
  pen.fillText(length >= 1 ? `${length} m` : `${Math.round(length * 100)} cm`, x + 4 * scale, y - 6 * scale);
}
