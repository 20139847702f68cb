'use strict';
// Runs the script of a page of `hooke compare` on a document that only remembers: compare_page_test.js PAGE.html.

const assert = require('node:assert');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');

const page = fs.readFileSync(process.argv[2], 'utf8');
const data = /<script type="application\/json" id="data">([^]*?)<\/script>/.exec(page)[1];
const script = /<script>\n([^]*)<\/script>/.exec(page)[1];
const file = path.join(fs.mkdtempSync(path.join(os.tmpdir(), 'page-')), 'page.js');
fs.writeFileSync(file, script);

class Element {
  constructor(name) {
    Object.assign(this, {name, attributes: {}, children: [], listeners: {}, style: {}, dataset: {}, textContent: '',
                         clientWidth: 900});
  }
  setAttribute(key, value) {
    this.attributes[key] = String(value);
    assert.doesNotMatch(String(value), /NaN|Infinity|undefined/, `${this.name} ${key}`);
  }
  appendChild(child) { this.children.push(child); return child; }
  replaceChildren() { this.children = []; }
  addEventListener(event, call) { this.listeners[event] = call; }
  getBoundingClientRect() { return {left: 0, top: 0, width: 900, height: 400}; }
  all(name) { return this.children.flatMap(child => [...(child.name === name ? [child] : []), ...child.all(name)]); }
}

const hosts = {data: new Element('script')};
hosts.data.textContent = data;
const regions = JSON.parse(data).stability.methods.map(method => {
  const region = new Element('div');
  region.dataset.method = method.name;
  return region;
});
let frame = null;
global.requestAnimationFrame = call => { frame = call; };
global.document = {
  createElement: name => new Element(name),
  createElementNS: (_, name) => new Element(name),
  createTextNode: text => Object.assign(new Element('#text'), {textContent: text}),
  getElementById: id => hosts[id] || (hosts[id] = new Element('div')),
  querySelectorAll: () => regions,
};
const lib = require(file);

// Functions that know no page.
assert.deepEqual(lib.ticksOf(0, 1, 5).map(tick => Number(tick.toFixed(9))), [0, 0.2, 0.4, 0.6, 0.8, 1]);
assert.deepEqual(lib.ticksOf(1, 1, 5), []);
assert.deepEqual(lib.decadesOf(-3.2, 0.1, 7), [-3, -2, -1, 0]);
assert.equal(lib.nearestIndex([0, 1, 2, 3], 1.6), 2);
assert.equal(lib.nearestIndex([], 1), -1);
assert.deepEqual(lib.rangeOf([[1, null, 3], [NaN, -2]]), [-2, 3]);
assert.deepEqual(lib.logarithms([100, 0, -1]), [2, null, null]);
const view = {x: [0, 10], y: [0, 4]};
assert.deepEqual(lib.zoomed(view, {x: 0.2, y: 0.5}, {x: 0.6, y: 0.5}), {x: [2, 6], y: [0, 4]});
assert.deepEqual(lib.zoomed(view, {x: 0.6, y: 0.75}, {x: 0.2, y: 0.25}), {x: [2, 6], y: [1, 3]});
assert.equal(lib.zoomed(view, {x: 0.5, y: 0.5}, {x: 0.5, y: 0.5}).x, view.x);
assert.equal(lib.pathOf([0, 1, 2], [5, null, 7], x => x, y => y), 'M0.0 5.0M2.0 7.0');
assert.deepEqual(lib.frameAt({frames: [[1], [2]]}, 5), {frame: [2], gone: true});

// The page: curves of all runs, panels in step, zoom and back, choice, regions.
const runs = JSON.parse(data).runs;
const curves = host => hosts[host].all('path').map(curve => curve.attributes.d);
assert.equal(curves('plot-1').length, runs.length);
const whole = curves('plot-1');
const svg = hosts['plot-1'].all('svg')[0];
const at = (x, y) => ({clientX: x, clientY: y, pointerId: 1});
svg.listeners.pointerdown(at(300, 100));
svg.listeners.pointermove(at(600, 300));
svg.listeners.pointerup(at(600, 300));
assert.notDeepEqual(curves('plot-1'), whole, 'a drag zooms in');
svg.listeners.dblclick();
assert.deepEqual(curves('plot-1'), whole, 'a double click goes back');
svg.listeners.pointermove(at(500, 200));
const spans = hosts['plot-1'].all('span').map(span => span.textContent);
for (const run of runs) assert(spans.some(text => text.startsWith(run.name + ' ')), `a value of ${run.name}`);
assert(spans.includes('euler gone'));

const box = hosts['plot-1'].all('input').filter(input => input.attributes.type === 'checkbox')[1];
box.checked = false;
box.listeners.change();
assert.equal(curves('plot-1').length, runs.length - 1);
const erring = runs.filter(run => run.error).length;
assert(erring < runs.length, 'the reference has no error');
assert.equal(curves('plot-2').filter(curve => curve).length, erring - 1);
box.checked = true;
box.listeners.change();

const [play] = hosts.motion.all('button');
const states = () => hosts.motion.all('div').filter(div => /^state/.test(div.className || div.attributes.class || ''))
  .map(div => div.textContent);
const before = hosts.motion.all('circle').map(circle => circle.attributes.cx);
play.listeners.click();
frame(1000);
frame(3000);
const after = hosts.motion.all('circle').map(circle => circle.attributes.cx);
after.forEach((cx, i) => assert.notEqual(cx, before[i], 'every panel moves'));
assert(states().some(text => text.startsWith('gone at ')));
const [slider] = hosts.motion.all('input');
slider.value = 0;
slider.listeners.input();
assert.deepEqual(hosts.motion.all('circle').map(circle => circle.attributes.cx), before);
assert(states().every(text => text === ''));
for (const region of regions) {
  assert(region.all('path')[0].attributes.d.length > 100);
  assert(region.all('circle').length >= 2, 'a pair of eigenvalues');
}
console.log('page: ok');
