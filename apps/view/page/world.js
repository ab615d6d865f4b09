// A simulated world that a person plays with: the speed of time, walkers, faults.
const kPaces = [0.25, 0.5, 1, 2, 4, 8];
function offer_world() {
  const offered = hello.faults.length > 0;
  element('play').hidden = !offered;
  if (!offered || element('fault').length) return;
  for (const name of hello.faults) element('fault').add(new Option(name.replace(/_/g, ' ')));
  for (const pace of kPaces) element('pace').add(new Option(`${pace}\u00D7`, pace, false, pace === 1));
  element('pace').onchange = event => order({pace: Number(event.target.value)});
}
function show_world() { element('world').hidden = !hello || !hello.faults.length || !element('world').hidden; }
