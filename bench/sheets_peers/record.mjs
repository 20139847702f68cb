// Writes what a peer does as a record that `sheets_peers judge` reads. It is written frame by frame, so that
// a run which is ended early leaves what it came to.
import fs from 'node:fs';

export const scene = JSON.parse(fs.readFileSync(process.argv[2], 'utf8'));

export class Recorder {
  constructor(engine, triangles) {
    this.file = fs.openSync(process.argv[3], 'w');
    const lines = [`engine ${engine}`, `frames ${scene.frames}`];
    for (const triangle of triangles) lines.push(`triangle ${triangle.join(' ')}`);
    fs.writeSync(this.file, lines.join('\n') + '\n');
  }

  points(values) {
    fs.writeSync(this.file, `points ${values.join(' ')}\n`);
  }

  // Runs all frames and notes the processor time of each [ms]. `step` advances one, `points` returns x, y and z of all points, y up.
  run(step, points) {
    this.points(points());
    for (let i = 1; i <= scene.frames; i++) {
      const start = process.cpuUsage();
      step();
      const taken = process.cpuUsage(start);
      fs.writeSync(this.file, `step ${(taken.user + taken.system) / 1000}\n`);
      if (i % scene.check_every === 0 || i === scene.frames) this.points(points());
    }
  }
}
