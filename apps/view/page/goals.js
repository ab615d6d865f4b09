// A tap proposes a goal, a drag one with a heading; a person then says Go or not. The last one can be taken back.
let drag = null, proposal = null, earlier = null;  // `earlier`: the goal before the last Go; false: there was none

function propose(x, y, heading) {
  const frame = frames.get(newest);
  if (!frame || !hello.takes_goals || over) return;
  const ground = ground_at(frame, x, y), way = ground === kWall || ground === kOutside ? [] : way_to(frame, [x, y]);
  proposal = {goal: heading === null ? [x, y] : [x, y, heading], ground, way};
  element('asked').textContent = question(proposal, frame);
  element('go').hidden = ground === kWall;
  element('ask').hidden = false;
  element(ground === kWall ? 'leave' : 'go').focus();
  draw_soon();
}
function question({goal, ground, way}, frame) {
  const round = value => (Math.round(value * 10) / 10 || 0).toFixed(1), place = `${round(goal[0])}, ${round(goal[1])} m` + (goal.length > 2 ? `, facing ${degrees(goal[2])}` : '');
  if (ground === kWall) return `${place} lies in a wall or too near one.`;
  if (ground === kOutside) return `${place} lies outside the known world. Go there all the same?`;
  if (!way.length) return `To ${place} no way is known. Go there all the same?`;
  const length = way.slice(1).reduce((sum, p, i) => sum + Math.hypot(p[0] - way[i][0], p[1] - way[i][1]), 0);
  const unseen = ground === kUnseen ? ' Nothing was ever seen there.' : '';
  return `Go to ${place}? About ${Math.max(length, Math.hypot(goal[0] - frame.pose[0], goal[1] - frame.pose[1])).toFixed(1)} m of way.${unseen}`;
}
function cancel_proposal() {
  proposal = drag = null;
  element('ask').hidden = true;
  draw_soon();
}
function accept() {
  if (!proposal || proposal.ground === kWall) return;
  const frame = frames.get(newest);
  if (is_lost()) return take_said({text: 'no connection: the goal was not sent'});
  earlier = frame.goal ? frame.goal.filter(value => value !== null) : false;
  order({goal: proposal.goal});
  element('undo').hidden = !earlier;
  cancel_proposal();
}
function undo() {
  if (proposal) return cancel_proposal();
  if (element('undo').hidden) return;
  element('undo').hidden = true;
  order({goal: earlier});
}
function draw_proposal(pen) {
  if (drag && !drag.pans) line(pen, [drag.from, drag.to], ink('path'), 3);
  if (!proposal) return;
  pen.setLineDash([8, 6]);
  if (proposal.way.length) line(pen, proposal.way, ink('path'), 3);
  pen.setLineDash([]);
  if (proposal.ground === kWall) disc(pen, ...proposal.goal, 0.3, tint('zone', 0.4), tint('zone', 1)); else draw_goal(pen, proposal.goal);
}
