// The ground: the potential of the plan, what was known before, and where the way to a goal might lead.
const bytes_of = base64 => Uint8Array.from(atob(base64), c => c.charCodeAt(0));
const kBlocked = 255, kNoWay = 254, kNeverSeen = 127;  // of a field's bytes; from kNeverSeen on nothing was ever seen
const kFiner = 3;  // a field's pixels along a cell's side
let ground = null;         // what was known before
const pictures = {};       // of ground and field, as they were drawn last

// Contours: one band in every eight.
function colour_of(cell) {
  if (cell === kBlocked) return ink('blocked').split(',').map(Number);
  if (cell === kNoWay) return [150, 120, 120, 40];
  const seen = cell < kNeverSeen, share = (seen ? cell : cell - kNeverSeen) / 126, dark = (cell >> 3) % 2 ? 10 : 0;
  const near = ink('near').split(','), far = ink('far').split(',');
  return [...near.map((n, i) => n * (1 - share) + far[i] * share - dark), seen ? 255 : 110];
}
function ground_colour_of(cell) {
  const c = ink('wall'), wall = [1, 3, 5].map(k => parseInt(c.length > 4 ? c.slice(k, k + 2) : c[(k + 1) / 2].repeat(2), 16));
  return cell === 2 ? [...wall, 255] : [128, 128, 128, cell === 1 ? 0 : 50];
}
// Rows come from the lowest y.
function raster_of(message) {
  const cells = bytes_of(message.cells), width = message.width, height = cells.length / width;
  return {cells, width, height, cell_m: message.cell_m, x: message.x, y: message.y, width_m: width * message.cell_m, height_m: height * message.cell_m};
}
function field_of(message) {
  if (!fields.has(message.number)) fields.set(message.number, raster_of(message));
  if (fields.size > 200) fields.delete(fields.keys().next().value);
  return fields.get(message.number);
}
const known_ground = () => ground = ground || raster_of(hello.ground);
// A field's bytes, `fine` times as many a side: the four cells around blended, of those the kind that weighs most.
function finer({cells, width, height}, fine) {
  const bytes = new Uint8Array(fine * fine * cells.length), kinds = cells.map(cell => cell >= kNoWay ? cell : Number(cell >= kNeverSeen));
  const within = (at, most) => Math.max(0, Math.min(most, (at + 0.5) / fine - 0.5)), shares = [0, 0, 0, 0], around = [0, 1, width, width + 1];
  for (let y = 0, n = 0; y < fine * height; y++) for (let x = 0; x < fine * width; x++, n++) {
    const px = within(x, width - 1), py = within(y, height - 1), i = Math.min(Math.floor(px), width - 2), j = Math.min(Math.floor(py), height - 2);
    const u = px - i, v = py - j, k = j * width + i;
    shares[0] = (1 - u) * (1 - v); shares[1] = u * (1 - v); shares[2] = (1 - u) * v; shares[3] = u * v;
    let most = 0;
    for (let q = 0; q < 4; q++) {
      let share = 0, sum = 0;
      for (let r = 0; r < 4; r++) if (kinds[k + around[r]] === kinds[k + around[q]]) { share += shares[r]; sum += shares[r] * cells[k + around[r]]; }
      if (share > most) { most = share; bytes[n] = Math.round(sum / share); }
    }
  }
  return bytes;
}
// Pictures begin at the top. `colour`: of a byte.
function painted(raster, colour, fine) {
  const picture = document.createElement('canvas'), width = picture.width = fine * raster.width, height = picture.height = fine * raster.height;
  const pixels = new ImageData(width, height), words = new Uint32Array(pixels.data.buffer), bytes = fine > 1 ? finer(raster, fine) : raster.cells;
  const colours = Uint32Array.from({length: 256}, (_, cell) => { const [r, g, b, a] = colour(cell); return r | g << 8 | b << 16 | a << 24; });
  for (let i = 0; i < bytes.length; i++) words[(height - 1 - Math.floor(i / width)) * width + i % width] = colours[bytes[i]];
  picture.getContext('2d').putImageData(pixels, 0, 0);
  return {raster, picture};
}
// A raster's byte at a place; null outside.
function byte_at(raster, x, y) {
  const i = Math.floor((x - raster.x) / raster.cell_m), j = Math.floor((y - raster.y) / raster.cell_m);
  return i >= 0 && j >= 0 && i < raster.width && j < raster.height ? raster.cells[j * raster.width + i] : null;
}
const from_wall = (w, x, y) => {
  const dx = w[2] - w[0], dy = w[3] - w[1], along = dx * dx + dy * dy;
  const share = along > 0 ? Math.max(0, Math.min(1, ((x - w[0]) * dx + (y - w[1]) * dy) / along)) : 0;
  return Math.hypot(x - w[0] - share * dx, y - w[1] - share * dy);
};
const kFree = 0, kWall = 1, kUnseen = 2, kOutside = 3;
function ground_at(frame, x, y) {
  const planned = frame.field ? byte_at(frame.field, x, y) : null, ground = hello.ground ? known_ground() : null;
  const known = ground ? byte_at(ground, x, y) : null;
  if (planned === kBlocked || known === 2 || hello.walls.some(w => from_wall(w, x, y) < hello.half_width_m)) return kWall;
  if (known === 1 || (planned !== null && planned < kNeverSeen) || planned === kNoWay) return kFree;
  const hits = frame.scene.hits;
  for (let i = 0; i < hits.length; i += 2) if (Math.hypot(x - hits[i], y - hits[i + 1]) < hello.half_width_m) return kWall;
  const within = hello.walls.length ? box && x >= box[0] && y >= box[1] && x <= box[2] && y <= box[3] : ground ? known !== null && known !== 0 : planned !== null || !frame.field;
  return within ? kUnseen : kOutside;
}

// The cheapest way over a grid of what is known here: an estimate, for a person to look at; the planner finds its own.
const kMostSide = 400, kStraight = 5, kDiagonal = 7, kUnseenCosts = 3;
function way_to(frame, goal) {
  const from = frame.pose, rasters = [frame.field, hello.ground && known_ground()].filter(r => r);
  const xs = [from[0], goal[0], ...rasters.flatMap(r => [r.x, r.x + r.width_m]), ...hello.walls.flatMap(w => [w[0], w[2]])];
  const ys = [from[1], goal[1], ...rasters.flatMap(r => [r.y, r.y + r.height_m]), ...hello.walls.flatMap(w => [w[1], w[3]])];
  const least = a => a.reduce((b, c) => Math.min(b, c)), most = a => a.reduce((b, c) => Math.max(b, c));
  const x0 = least(xs) - 1, y0 = least(ys) - 1, cell = Math.max(0.1, (most(xs) - x0 + 1) / kMostSide, (most(ys) - y0 + 1) / kMostSide);
  const width = Math.ceil((most(xs) - x0 + 1) / cell), height = Math.ceil((most(ys) - y0 + 1) / cell);
  const kinds = new Uint8Array(width * height), at = (x, y) => Math.floor((y - y0) / cell) * width + Math.floor((x - x0) / cell);
  for (let j = 0; j < height; j++) for (let i = 0; i < width; i++) {
    const x = x0 + (i + 0.5) * cell, y = y0 + (j + 0.5) * cell, planned = frame.field ? byte_at(frame.field, x, y) : null;
    const known = rasters.length && hello.ground ? byte_at(known_ground(), x, y) : null;
    kinds[j * width + i] = planned === kBlocked || known === 2 ? kWall : known === 1 || (planned !== null && planned < kNeverSeen) ? kFree : kUnseen;
  }
  const wide = Math.ceil(hello.half_width_m / cell - 0.5);
  for (const w of hello.walls) for (let n = Math.ceil(Math.hypot(w[2] - w[0], w[3] - w[1]) / cell * 2), k = 0; k <= n; k++) {
    const share = n ? k / n : 0, c = at(w[0] + share * (w[2] - w[0]), w[1] + share * (w[3] - w[1]));
    for (let j = -wide; j <= wide; j++) for (let i = -wide; i <= wide; i++) kinds[c + j * width + i] = kWall;
  }
  return cheapest(kinds, width, at(from[0], from[1]), at(goal[0], goal[1]))
    .map(c => [x0 + (c % width + 0.5) * cell, y0 + (Math.floor(c / width) + 0.5) * cell]);
}
// Cells from `start` to `end`; none where there is no way. Costs are integers: a bucket each.
function cheapest(kinds, width, start, end) {
  const cost = new Uint32Array(kinds.length).fill(0xffffffff), buckets = [[end]];
  cost[end] = 0;
  const steps = [1, -1, width, -width].map(d => [d, kStraight]).concat([width + 1, width - 1, 1 - width, -1 - width].map(d => [d, kDiagonal]));
  for (let b = 0; b < buckets.length; b++) for (const c of buckets[b] || []) {
    if (cost[c] !== b) continue;
    if (c === start) return descent(cost, steps, start);
    for (const [d, length] of steps) {
      const n = c + d, sum = b + length * (kinds[n] === kUnseen ? kUnseenCosts : 1);
      if (n < width || n >= kinds.length - width || n % width === 0 || (kinds[n] === kWall && n !== start) || sum >= cost[n]) continue;
      cost[n] = sum;
      (buckets[sum] = buckets[sum] || []).push(n);
    }
  }
  return [];
}
function descent(cost, steps, start) {
  const way = [start];
  for (let c = start; cost[c] > 0;) { c = steps.map(([d]) => c + d).reduce((a, b) => cost[b] < cost[a] ? b : a); way.push(c); }
  return way;
}
