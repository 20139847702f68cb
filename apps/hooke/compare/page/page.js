'use strict';
// Draws what `hooke compare` found: panels that move, plots that zoom, regions of stability. The page brings its data
// as JSON in the element 'data'. Functions up to 'the page' know no page, and are tested on their own.

const SVG = 'http://www.w3.org/2000/svg';

// Returns round values from low to high, about `count` of them.
function ticksOf(low, high, count) {
  const span = high - low;
  if (!(span > 0) || !isFinite(span)) return [];
  const raw = span / count;
  const decade = Math.pow(10, Math.floor(Math.log10(raw)));
  const step = [1, 2, 5, 10].map(m => m * decade).find(s => s >= raw * 0.999);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * span; ++i) ticks.push(i * step);
  return ticks;
}

// Returns powers of ten between two logarithms, thinned to about `count`.
function decadesOf(low, high, count) {
  const every = Math.max(1, Math.ceil((high - low) / count));
  const ticks = [];
  for (let i = Math.ceil(low - 1e-9); i <= high + 1e-9; ++i) if (i % every === 0) ticks.push(i);
  return ticks.length > 1 ? ticks : ticksOf(low, high, 3);
}

function numberText(value, digits = 4) {
  if (value === null || value === undefined || !isFinite(value)) return '-';
  if (value === 0) return '0';
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(digits - 2) : String(Number(value.toPrecision(digits)));
}

function powerText(exponent) {
  return Number.isInteger(exponent) ? '1e' + exponent : Math.pow(10, exponent).toPrecision(2);
}

// Returns the index of the value in an ascending list that is nearest to x, or -1 in an empty list.
function nearestIndex(list, x) {
  if (list.length === 0) return -1;
  let low = 0;
  let high = list.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (list[middle] <= x) low = middle; else high = middle;
  }
  return Math.abs(list[high] - x) < Math.abs(list[low] - x) ? high : low;
}

// Returns the smallest and largest of the finite values of lists, or null if there are none.
function rangeOf(lists) {
  let low = Infinity;
  let high = -Infinity;
  for (const list of lists) {
    for (const value of list) {
      if (value === null || !isFinite(value)) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return low <= high ? [low, high] : null;
}

function widened(range, share, least) {
  const more = share * Math.max(range[1] - range[0], least);
  return [range[0] - more, range[1] + more];
}

// Returns the logarithms of positive values, and null for all others.
function logarithms(values) {
  return values.map(value => value > 0 ? Math.log10(value) : null);
}

// Returns what a drag from one place to another, in shares of the picture from its lower left, makes of a view
// {x: [low, high], y: [low, high]}. A drag that is nearly level keeps the heights; a tiny one changes nothing.
function zoomed(view, from, to, least = 0.015) {
  const wide = Math.abs(to.x - from.x) >= least;
  const high = Math.abs(to.y - from.y) >= 3 * least;
  const part = (range, a, b) => {
    const size = range[1] - range[0];
    return [range[0] + size * Math.max(0, Math.min(a, b)), range[0] + size * Math.min(1, Math.max(a, b))];
  };
  return {x: wide ? part(view.x, from.x, to.x) : view.x, y: high ? part(view.y, from.y, to.y) : view.y};
}

// Returns a path through points in pixels, lifted where a value is missing. Far places are drawn near the picture's
// edge, as SVG does not bear large numbers.
function pathOf(xs, ys, toX, toY) {
  const near = value => Math.max(-2e4, Math.min(2e4, value)).toFixed(1);
  let text = '';
  let down = false;
  for (let i = 0; i < xs.length; ++i) {
    if (xs[i] === null || ys[i] === null || ys[i] === undefined) { down = false; continue; }
    text += (down ? 'L' : 'M') + near(toX(xs[i])) + ' ' + near(toY(ys[i]));
    down = true;
  }
  return text;
}

// Returns the frame of a run at a frame's number, and whether the run had ended before.
function frameAt(run, index) {
  const last = run.frames.length - 1;
  return {frame: run.frames[Math.min(index, last)], gone: index > last};
}

// Returns the path that fills where a method is stable, both halves, in pixels.
function regionPath(spans, height, toX, toY) {
  let text = '';
  for (const [imaginary, from, to] of spans) {
    for (const sign of [1, -1]) {
      const [left, right] = [toX(from).toFixed(1), toX(to).toFixed(1)];
      const top = toY(sign * imaginary + height / 2 + 0.003).toFixed(1);
      const bottom = toY(sign * imaginary - height / 2 - 0.003).toFixed(1);
      text += `M${left} ${top}H${right}V${bottom}H${left}Z`;
    }
  }
  return text;
}

if (typeof module !== 'undefined') {
  module.exports = {ticksOf, decadesOf, numberText, nearestIndex, rangeOf, widened, logarithms, zoomed, pathOf, frameAt,
                    regionPath};
}

// The page.

function node(name, attributes, parent, text) {
  const html = !['svg', 'path', 'line', 'rect', 'circle', 'text', 'g', 'clipPath', 'defs', 'title'].includes(name);
  const element = html ? document.createElement(name) : document.createElementNS(SVG, name);
  for (const key in attributes || {}) element.setAttribute(key, attributes[key]);
  if (text !== undefined) element.textContent = text;
  if (parent) parent.appendChild(element);
  return element;
}

// Remembers which runs are shown, and tells all that draw them.
class Choice {
  constructor() { this.hidden = new Set(); this.listeners = []; }
  shows(name) { return !this.hidden.has(name); }
  set(name, shown) {
    if (shown) this.hidden.delete(name); else this.hidden.add(name);
    this.listeners.forEach(listener => listener());
  }
}

function addLegend(host, runs, choice) {
  const legend = node('div', {class: 'legend'}, host);
  for (const run of runs) {
    const label = node('label', {}, legend);
    const box = node('input', {type: 'checkbox'}, label);
    box.checked = choice.shows(run.name);
    box.addEventListener('change', () => choice.set(run.name, box.checked));
    choice.listeners.push(() => { box.checked = choice.shows(run.name); });
    const style = `border-color:${run.color};border-top-style:${run.dashed ? 'dashed' : 'solid'}`;
    node('span', {class: 'swatch', style}, label);
    label.appendChild(document.createTextNode(run.name));
  }
}

const MARGIN = {left: 78, right: 16, top: 14, bottom: 46};
const PLOT_HEIGHT = 400;

// A plot of runs. A quantity has name, xLabel, yLabel, x(run), y(run), range(runs) and may be logarithmic or equal.
class Plot {
  constructor(host, runs, quantities, choice, line) {
    Object.assign(this, {runs, quantities, choice, line, quantity: quantities[0], view: null, all: false, time: null});
    this.addControls(host);
    addLegend(host, runs, choice);
    const box = node('div', {class: 'plot'}, host);
    this.svg = node('svg', {role: 'img', height: PLOT_HEIGHT}, box);
    this.readout = node('div', {class: 'readout'}, host, this.hint());
    this.addPointer();
    choice.listeners.push(() => this.draw());
    if (typeof ResizeObserver !== 'undefined') new ResizeObserver(() => this.draw()).observe(box);
    this.draw();
  }

  hint() {
    return 'Point at the plot for values. Drag to zoom in, double click to go back.';
  }

  addControls(host) {
    const controls = node('div', {class: 'controls'}, host);
    if (this.quantities.length > 1) {
      const select = node('select', {'aria-label': 'quantity'}, controls);
      this.quantities.forEach((quantity, i) => node('option', {value: i}, select, quantity.name));
      select.addEventListener('change', () => {
        this.quantity = this.quantities[Number(select.value)];
        this.view = null;
        this.draw();
      });
    }
    const label = node('label', {}, controls);
    const fit = node('input', {type: 'checkbox'}, label);
    label.appendChild(document.createTextNode(' fit all curves, also those that leave'));
    fit.addEventListener('change', () => { this.all = fit.checked; this.view = null; this.draw(); });
    this.back = node('button', {type: 'button'}, controls, 'Whole plot');
    this.back.addEventListener('click', () => { this.view = null; this.draw(); });
  }

  shown() { return this.runs.filter(run => this.choice.shows(run.name)); }

  values(run) {
    const y = this.quantity.y(run);
    return this.quantity.logarithmic ? logarithms(y) : y;
  }

  // Returns the view that is drawn when nobody has zoomed.
  wholeView() {
    const runs = this.shown();
    const fitted = runs.length > 0 ? runs : this.runs;
    const all = [rangeOf(fitted.map(run => this.quantity.x(run))), rangeOf(fitted.map(run => this.values(run)))];
    const own = this.all ? null : this.quantity.range(this.runs);
    const x = (own && own.x) || all[0] || [0, 1];
    const y = (own && own.y) || widened(all[1] || [0, 1], 0.04, 1e-12);
    const view = {x: x[1] > x[0] ? x : [x[0] - 1, x[0] + 1], y: y[1] > y[0] ? y : [y[0] - 1, y[0] + 1]};
    return this.quantity.equal ? this.withEqualScales(view) : view;
  }

  withEqualScales(view) {
    const inner = this.inner();
    const scale = Math.max((view.x[1] - view.x[0]) / inner.width, (view.y[1] - view.y[0]) / inner.height);
    const around = (range, pixels) => {
      const middle = (range[0] + range[1]) / 2;
      return [middle - scale * pixels / 2, middle + scale * pixels / 2];
    };
    return {x: around(view.x, inner.width), y: around(view.y, inner.height)};
  }

  inner() {
    const width = Math.max(320, this.svg.clientWidth || 860);
    return {width: width - MARGIN.left - MARGIN.right, height: PLOT_HEIGHT - MARGIN.top - MARGIN.bottom, whole: width};
  }

  draw() {
    const inner = this.inner();
    const view = this.view || this.wholeView();
    const toX = x => MARGIN.left + inner.width * (x - view.x[0]) / (view.x[1] - view.x[0]);
    const toY = y => MARGIN.top + inner.height * (view.y[1] - y) / (view.y[1] - view.y[0]);
    Object.assign(this, {current: view, toX, toY});
    this.svg.replaceChildren();
    this.svg.setAttribute('viewBox', `0 0 ${inner.whole} ${PLOT_HEIGHT}`);
    this.svg.setAttribute('aria-label', this.quantity.name);
    this.drawAxes(inner, view);
    const clip = 'clip' + Plot.count++;
    const defs = node('defs', {}, this.svg);
    const box = {x: MARGIN.left, y: MARGIN.top, width: inner.width, height: inner.height};
    node('rect', box, node('clipPath', {id: clip}, defs));
    const curves = node('g', {'clip-path': `url(#${clip})`, fill: 'none', 'stroke-linejoin': 'round'}, this.svg);
    for (const run of this.shown()) {
      node('path', {d: pathOf(this.quantity.x(run), this.values(run), toX, toY), stroke: run.color,
                    'stroke-width': run.dashed ? 1.6 : 2.2, 'stroke-dasharray': run.dashed ? '6 4' : 'none'}, curves);
    }
    if (this.line) this.drawLine(curves, inner);
    this.marker = node('line', {y1: MARGIN.top, y2: MARGIN.top + inner.height, stroke: '#555', 'stroke-width': 1,
                                'stroke-dasharray': '2 3', visibility: 'hidden'}, curves);
    this.cursor = node('g', {}, curves);
    this.drag = node('rect', {fill: '#0072B2', 'fill-opacity': 0.15, stroke: '#0072B2', visibility: 'hidden'}, curves);
    this.back.disabled = this.view === null;
    this.showTime(this.time);
  }

  drawLine(parent, inner) {
    const x = this.toX(this.line.x);
    node('line', {x1: x, x2: x, y1: MARGIN.top, y2: MARGIN.top + inner.height, stroke: '#a30018', 'stroke-width': 1.5,
                  'stroke-dasharray': '5 4'}, parent);
    node('text', {x: x + 5, y: MARGIN.top + 15, 'font-size': 13, style: 'fill:#a30018'}, parent, this.line.text);
  }

  drawAxes(inner, view) {
    const bottom = MARGIN.top + inner.height;
    const grid = {stroke: '#ddd', 'stroke-width': 1};
    for (const tick of ticksOf(view.x[0], view.x[1], Math.max(3, inner.width / 90))) {
      node('line', {x1: this.toX(tick), x2: this.toX(tick), y1: MARGIN.top, y2: bottom, ...grid}, this.svg);
      node('text', {x: this.toX(tick), y: bottom + 18, 'text-anchor': 'middle', 'font-size': 13}, this.svg,
           numberText(tick));
    }
    const log = this.quantity.logarithmic;
    for (const tick of (log ? decadesOf : ticksOf)(view.y[0], view.y[1], 7)) {
      node('line', {x1: MARGIN.left, x2: MARGIN.left + inner.width, y1: this.toY(tick), y2: this.toY(tick), ...grid},
           this.svg);
      node('text', {x: MARGIN.left - 7, y: this.toY(tick) + 4, 'text-anchor': 'end', 'font-size': 13}, this.svg,
           log ? powerText(tick) : numberText(tick));
    }
    node('rect', {x: MARGIN.left, y: MARGIN.top, width: inner.width, height: inner.height, fill: 'none', stroke: '#777'},
         this.svg);
    node('text', {x: MARGIN.left + inner.width / 2, y: PLOT_HEIGHT - 8, 'text-anchor': 'middle', 'font-size': 14},
         this.svg, this.quantity.xLabel);
    node('text', {x: 16, y: MARGIN.top + inner.height / 2, 'text-anchor': 'middle', 'font-size': 14,
                  transform: `rotate(-90 16 ${MARGIN.top + inner.height / 2})`}, this.svg, this.quantity.yLabel);
  }

  // Returns where a pointer is, in shares of the inner picture from its lower left.
  shareOf(event) {
    const box = this.svg.getBoundingClientRect();
    const inner = this.inner();
    const scale = inner.whole / box.width;
    return {x: ((event.clientX - box.left) * scale - MARGIN.left) / inner.width,
            y: 1 - ((event.clientY - box.top) * scale - MARGIN.top) / inner.height};
  }

  addPointer() {
    let from = null;
    this.svg.addEventListener('pointerdown', event => {
      from = this.shareOf(event);
      if (this.svg.setPointerCapture) this.svg.setPointerCapture(event.pointerId);
    });
    this.svg.addEventListener('pointermove', event => {
      const at = this.shareOf(event);
      this.point(at);
      if (from) this.showDrag(from, at);
    });
    this.svg.addEventListener('pointerup', event => {
      if (!from) return;
      const view = zoomed(this.current, from, this.shareOf(event));
      from = null;
      this.drag.setAttribute('visibility', 'hidden');
      const same = view.x === this.current.x && view.y === this.current.y;
      if (!same) { this.view = view; this.draw(); }
    });
    this.svg.addEventListener('pointerleave', () => {
      if (from) return;
      this.cursor.replaceChildren();
      this.readout.textContent = this.hint();
    });
    this.svg.addEventListener('dblclick', () => { this.view = null; this.draw(); });
  }

  showDrag(from, to) {
    const inner = this.inner();
    const level = Math.abs(to.y - from.y) < 0.045;
    const [low, high] = level ? [0, 1] : [Math.min(from.y, to.y), Math.max(from.y, to.y)];
    this.drag.setAttribute('x', MARGIN.left + inner.width * Math.min(from.x, to.x));
    this.drag.setAttribute('width', inner.width * Math.abs(to.x - from.x));
    this.drag.setAttribute('y', MARGIN.top + inner.height * (1 - high));
    this.drag.setAttribute('height', inner.height * (high - low));
    this.drag.setAttribute('visibility', 'visible');
  }

  // Shows the values of all shown runs where the pointer is.
  point(at) {
    this.cursor.replaceChildren();
    this.readout.replaceChildren();
    if (at.x < 0 || at.x > 1 || at.y < 0 || at.y > 1) { this.readout.textContent = this.hint(); return; }
    const view = this.current;
    const x = view.x[0] + at.x * (view.x[1] - view.x[0]);
    const y = view.y[0] + at.y * (view.y[1] - view.y[0]);
    const here = `${this.quantity.xLabel} ${numberText(x)}`;
    if (this.quantity.equal) {
      this.readout.textContent = `${here}, ${this.quantity.yLabel} ${numberText(y)}`;
      return;
    }
    node('span', {}, this.readout, here + ':');
    for (const run of this.shown()) {
      const xs = this.quantity.x(run);
      const i = nearestIndex(xs, x);
      if (i < 0) continue;
      const past = x > xs[i] + 0.02 * (view.x[1] - view.x[0]) && i === xs.length - 1;
      const value = this.quantity.y(run)[i];
      const text = past ? 'gone' : numberText(value, 5);
      node('span', {}, this.readout, `${run.name} ${text}`);
      const drawn = this.values(run)[i];
      if (past || drawn === null || drawn === undefined) continue;
      node('circle', {cx: this.toX(xs[i]), cy: Math.max(-9, Math.min(2e3, this.toY(drawn))), r: 4, fill: run.color},
           this.cursor);
    }
    const line = this.toX(x);
    node('line', {x1: line, x2: line, y1: MARGIN.top, y2: PLOT_HEIGHT - MARGIN.bottom, stroke: '#777'}, this.cursor);
  }

  // Marks the time of the panels that move, where x is time.
  showTime(time) {
    this.time = time;
    if (time === null || !this.quantity.timed) return;
    const x = Math.max(-10, Math.min(1e5, this.toX(time)));
    this.marker.setAttribute('x1', x);
    this.marker.setAttribute('x2', x);
    this.marker.setAttribute('visibility', 'visible');
  }
}
Plot.count = 0;

// Panels side by side, one for each run, all at the same time.
class Panels {
  constructor(host, data, choice, onTime) {
    Object.assign(this, {motion: data.motion, onTime, choice, index: 0, playing: false, speed: 1});
    this.full = data.motion.count;
    this.addControls(host);
    const grid = node('div', {class: 'panels'}, host);
    this.panels = data.runs.filter(run => run.frames.length > 0).map(run => this.addPanel(grid, run));
    choice.listeners.push(() => this.panels.forEach(panel => {
      panel.box.style.display = choice.shows(panel.run.name) ? '' : 'none';
    }));
    this.show(0);
  }

  addControls(host) {
    const controls = node('div', {class: 'controls'}, host);
    this.button = node('button', {type: 'button'}, controls, 'Play');
    this.button.addEventListener('click', () => this.play(!this.playing));
    const back = node('button', {type: 'button', title: 'one frame back'}, controls, '\u2212');
    back.addEventListener('click', () => { this.play(false); this.show(this.index - 1); });
    const on = node('button', {type: 'button', title: 'one frame on'}, controls, '+');
    on.addEventListener('click', () => { this.play(false); this.show(this.index + 1); });
    const label = node('label', {}, controls, 'speed ');
    const select = node('select', {}, label);
    for (const speed of [0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 4]) {
      const option = node('option', {value: speed}, select, speed + ' \u00d7');
      if (speed === 1) option.setAttribute('selected', '');
    }
    select.addEventListener('change', () => { this.speed = Number(select.value); });
    this.slider = node('input', {type: 'range', min: 0, max: this.full - 1, value: 0, step: 1, 'aria-label': 'time'},
                       controls);
    this.slider.addEventListener('input', () => { this.play(false); this.show(Number(this.slider.value)); });
    this.clock = node('output', {}, controls);
  }

  addPanel(grid, run) {
    const box = node('div', {class: 'panel'}, grid);
    node('div', {class: 'name'}, box, run.name);
    const [left, bottom, right, top] = this.motion.box;
    const view = `${left} ${-top} ${right - left} ${top - bottom}`;
    const svg = node('svg', {viewBox: view, role: 'img', 'aria-label': run.name}, box);
    const size = Math.max(right - left, top - bottom);
    const trail = node('path', {fill: 'none', stroke: run.color, 'stroke-opacity': 0.45, 'stroke-width': size / 200}, svg);
    const lines = node('path', {fill: 'none', stroke: '#333', 'stroke-width': size / 150, 'stroke-linecap': 'round'}, svg);
    const dots = node('path', {fill: 'none', stroke: '#333', 'stroke-width': size / 60, 'stroke-linecap': 'round'}, svg);
    const bob = node('circle', {r: size / 45, fill: run.color, stroke: '#222', 'stroke-width': size / 400}, svg);
    return {run, box, trail, lines, dots, bob, state: node('div', {class: 'state'}, box)};
  }

  play(on) {
    if (on && this.index >= this.full - 1) this.show(0);
    if (on && !this.playing) {
      this.started = {at: null, index: this.index};
      requestAnimationFrame(now => this.tick(now));
    }
    this.playing = on;
    this.button.textContent = on ? 'Pause' : 'Play';
  }

  tick(now) {
    if (!this.playing) return;
    if (this.started.at === null || this.started.speed !== this.speed) {
      this.started = {at: now, index: this.index, speed: this.speed};
    }
    const index = this.started.index + Math.floor((now - this.started.at) / 1000 * this.speed / this.motion.dt);
    if (index !== this.index) this.show(index);
    if (this.index >= this.full - 1) this.play(false);
    else requestAnimationFrame(next => this.tick(next));
  }

  show(index) {
    this.index = Math.max(0, Math.min(this.full - 1, index));
    const time = this.index * this.motion.dt;
    this.slider.value = this.index;
    this.clock.textContent = `t = ${time.toFixed(3)} s`;
    for (const panel of this.panels) this.drawPanel(panel);
    this.onTime(time);
  }

  drawPanel(panel) {
    const {frame, gone} = frameAt(panel.run, this.index);
    const at = i => `${frame[2 * i]} ${-frame[2 * i + 1]}`;
    const watched = this.motion.watched;
    panel.lines.setAttribute('d', this.motion.lines.map(([a, b]) => `M${at(a)}L${at(b)}`).join(''));
    let dots = '';
    for (let i = 0; i < frame.length / 2; ++i) dots += `M${at(i)}h0`;
    panel.dots.setAttribute('d', dots);
    panel.bob.setAttribute('cx', frame[2 * watched]);
    panel.bob.setAttribute('cy', -frame[2 * watched + 1]);
    const end = Math.min(this.index, panel.run.frames.length - 1);
    let trail = '';
    for (let i = Math.max(0, end - 150); i <= end; ++i) {
      const f = panel.run.frames[i];
      trail += (trail ? 'L' : 'M') + f[2 * watched] + ' ' + -f[2 * watched + 1];
    }
    panel.trail.setAttribute('d', trail);
    panel.box.style.opacity = gone ? 0.75 : 1;
    const left = panel.run.gone !== null && this.index * this.motion.dt >= panel.run.gone;
    panel.state.className = left ? 'state bad' : 'state';
    panel.state.textContent = left ? `gone at ${numberText(panel.run.gone, 3)} s` : '';
  }
}

// Draws where a method is stable, with the scene's eigenvalues times the step.
function drawRegion(host, method, stability) {
  const {left, right, top, height} = stability.window;
  const [width, tall, pad] = [360, 360 * 2 * top / (right - left), 24];
  const toX = x => pad + (width - 2 * pad) * (x - left) / (right - left);
  const toY = y => pad + (tall - 2 * pad) * (top - y) / (2 * top);
  const svg = node('svg', {viewBox: `0 0 ${width} ${tall.toFixed(0)}`, role: 'img',
                           'aria-label': `where ${method.name} is stable`}, host);
  node('path', {d: regionPath(method.spans, height, toX, toY), fill: '#cfe6f5'}, svg);
  const axis = {stroke: '#555', 'stroke-width': 1};
  node('line', {x1: toX(left), x2: toX(right), y1: toY(0), y2: toY(0), ...axis}, svg);
  node('line', {x1: toX(0), x2: toX(0), y1: toY(-top), y2: toY(top), ...axis}, svg);
  for (let x = Math.ceil(left); x <= right; ++x) {
    if (x !== 0) node('text', {x: toX(x), y: toY(0) + 15, 'text-anchor': 'middle', 'font-size': 12}, svg, x);
  }
  for (let y = -Math.floor(top) + 1; y < top; ++y) {
    if (y !== 0) node('text', {x: toX(0) + 6, y: toY(y) + 4, 'font-size': 12}, svg, y + 'i');
  }
  node('text', {x: toX(left), y: 16, 'font-size': 12}, svg, 'h \u03bb; blue: stable; dots: this scene');
  for (const [re, im] of stability.z) {
    for (const sign of im > 0 ? [1, -1] : [1]) drawEigenvalue(svg, re, sign * im, stability.window, toX, toY);
  }
}

// A value outside of the picture is drawn at its edge, hollow.
function drawEigenvalue(svg, re, im, {left, right, top}, toX, toY) {
  const x = Math.max(left, Math.min(right, re));
  const y = Math.max(-top, Math.min(top, im));
  const outside = x !== re || y !== im;
  const dot = node('circle', {cx: toX(x), cy: toY(y), r: 4.5, fill: outside ? '#fff' : '#D55E00', stroke: '#7a2f00',
                              'stroke-width': 1.5}, svg);
  node('title', {}, dot, `h \u03bb = ${numberText(re)} ${im < 0 ? '\u2212' : '+'} ${numberText(Math.abs(im))}i` +
                         (outside ? ', outside of the picture' : ''));
}

// Returns what of runs can be plotted over time, and the path.
function quantitiesOf(data) {
  const timed = (name, yLabel, y, more) =>
    ({name, xLabel: 'time [s]', yLabel, y, x: run => run.t, timed: true,
      range: runs => ({x: [0, data.seconds], y: guideRange(runs, y)}), ...more});
  const guideRange = (runs, y) => {
    const guide = runs.find(run => run.name === data.guide);
    const range = guide && rangeOf([y(guide)]);
    return range && widened(range, 0.4, 0.05 * Math.max(Math.abs(range[0]), Math.abs(range[1]), 1e-9));
  };
  const across = 'xyz'[data.motion.axis];
  const list = [
    timed('total energy', 'total energy [J]', run => run.energy),
    timed('kinetic energy', 'kinetic energy [J]', run => run.kinetic),
    timed('potential energy', 'potential energy [J]', run => run.potential),
    timed('elastic energy', 'elastic energy [J]', run => run.elastic),
  ];
  if (data.reference) {
    list.unshift(timed('error', 'distance from the reference [m]', run => run.error || [],
                       {logarithmic: true, range: () => ({x: [0, data.seconds], y: null})}));
  }
  for (const axis of ['x', 'y', 'z']) list.push(timed('position ' + axis, axis + ' [m]', run => run[axis]));
  list.push({name: 'path', xLabel: across + ' [m]', yLabel: 'y [m]', x: run => run[across], y: run => run.y, equal: true,
             range: runs => {
               const guide = runs.find(run => run.name === data.guide) || runs[0];
               const ranges = [rangeOf([guide[across]]), rangeOf([guide.y])];
               return {x: widened(ranges[0] || [0, 1], 0.3, data.extent), y: widened(ranges[1] || [0, 1], 0.3, data.extent)};
             }});
  return list;
}

function start() {
  const data = JSON.parse(document.getElementById('data').textContent);
  for (const run of data.runs) run.t = run.x.map((_, i) => i * run.every);
  const choice = new Choice();
  const plots = [];
  const onTime = time => plots.forEach(plot => plot.showTime(time));
  const quantities = quantitiesOf(data);
  if (data.runs.length > 0) {
    const first = Math.max(0, quantities.findIndex(quantity => quantity.name === 'total energy'));
    const ordered = [quantities[first], ...quantities.filter((_, i) => i !== first)];
    plots.push(new Plot(document.getElementById('plot-1'), data.runs, ordered, choice, null));
    plots.push(new Plot(document.getElementById('plot-2'), data.runs, quantities, choice, null));
    new Panels(document.getElementById('motion'), data, choice, onTime);
  }
  const curves = data.stability.methods.filter(method => method.curve.length > 0)
    .map(method => ({name: method.name, color: method.color, dashed: false, curve: method.curve}));
  const here = data.stability.omega_dt;
  if (curves.length > 0) {
    const growth = {name: 'growth per step', xLabel: 'h \u03c9', yLabel: 'factor per step', x: run => run.curve.map(p => p[0]),
                    y: run => run.curve.map(p => p[1]), range: () => ({x: [0, 4], y: [0, 2.2]})};
    new Plot(document.getElementById('growth'), curves, [growth], choice,
             here > 0 && here <= 4 ? {x: here, text: 'this scene'} : null);
  }
  for (const host of document.querySelectorAll('.region')) {
    const method = data.stability.methods.find(one => one.name === host.dataset.method);
    if (method && method.spans.length > 0) drawRegion(host, method, data.stability);
  }
}

if (typeof document !== 'undefined') start();
