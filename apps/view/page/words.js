// What the supervisor's reasons mean; those of kFaults stop the robot, the others limit it or say what is so.
const kWords = {
  stop_zone: 'something stands in its way', scan_stale: 'the laser is late', scan_invalid: 'the laser cannot be trusted',
  scan_frozen: 'the laser shows the same again and again', wheels_stale: 'the wheels are late', plan_stale: 'no way is known',
  emergency_stop: 'emergency stop', missed_ticks: 'the computer was held up', speed_limit: 'faster than allowed',
  not_finite: 'a command that is no number', latched: 'waits for a reset', unwatched: 'cannot see where it would go',
  no_goal: 'has no goal', bus: 'the bus to the drives fails', drive: 'a drive is in trouble', turn_blocked: 'no room to turn',
  touched: 'something touches it', wheels_invalid: 'the wheels say no number', sight_lost: 'too many beams are lost',
  wheels_disobey: 'the wheels do not obey', motion_mismatch: 'scans and wheels differ', stop_unconfirmed: 'a stop was not confirmed',
  foreign_master: 'another program commands the drives', not_recorded: 'the disk takes no more', speed_zone: 'a slow zone of the map',
  pose_doubtful: 'not sure where it is'
};
const kNoFaults = new Set(['stop_zone', 'plan_stale', 'speed_limit', 'latched', 'unwatched', 'no_goal', 'touched', 'turn_blocked', 'not_recorded', 'speed_zone']);
const reasons_of = text => text ? text.split('|') : [];
const words_of = text => reasons_of(text).map(name => kWords[name] || name).join(', ');
const has_fault = text => reasons_of(text).some(name => !kNoFaults.has(name));
const is_latched = frame => reasons_of(frame.reasons).includes('latched');
const metres = value => `${value.toFixed(1)} m`;
const speed_of = value => `${Math.abs(value) < 0.005 ? '0.00' : value.toFixed(2)} m/s`;
const degrees = radians => `${Math.round(radians * 180 / Math.PI)}\u00B0`;
