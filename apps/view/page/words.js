// The supervisor's reasons, from hello: {name: {says, fault}}; a fault stops the robot, others limit it or say what is so.
const reason_rows = () => (hello && hello.reasons) || {};
const reasons_of = text => text ? text.split('|') : [];
const words_of = text => reasons_of(text).map(name => (reason_rows()[name] || {says: name}).says).join(', ');
const has_fault = text => reasons_of(text).some(name => (reason_rows()[name] || {fault: true}).fault);
const is_latched = frame => reasons_of(frame.reasons).includes('latched');
const hundredths = value => Math.abs(value) < 0.005 ? '0.00' : value.toFixed(2);
const speed_of = value => `${hundredths(value)} m/s`;
const degrees = radians => `${Math.round(radians * 180 / Math.PI)}\u00B0`;
