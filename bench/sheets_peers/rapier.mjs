// Runs the scene in Rapier: node rapier.mjs SCENE RECORD STEPS_PER_FRAME
import rapier from '@dimforge/rapier3d-compat';
import { Recorder, scene } from './record.mjs';

const stepsPerFrame = Number(process.argv[4] ?? 1);
await rapier.init();
const world = new rapier.World({ x: 0, y: -9.81, z: 0 });
world.timestep = scene.frame / stepsPerFrame;
const [x, y, z] = scene.ball.center;
world.createCollider(
  rapier.ColliderDesc.ball(scene.ball.radius).setTranslation(x, y, z).setFriction(scene.friction));
world.createCollider(
  rapier.ColliderDesc.cuboid(50, 1, 50).setTranslation(0, -1, 0).setFriction(scene.friction));

const sheets = scene.corners.map(([cx, cy, cz]) => {
  const along = { x: scene.edge, y: 0, z: 0 }, across = { x: 0, y: 0, z: scene.edge };
  const sheet = rapier.SoftBodyDesc
    .cloth({ x: cx, y: cy, z: cz }, along, across, scene.columns, scene.columns)
    .setMass(scene.sheet_mass)
    .setParticleRadius(scene.thickness / 2)
    .setSelfContacts(true)
    .setCanSleep(false);
  return world.createSoftBody(sheet);
});

const triangles = [];
let first = 0;
for (const sheet of sheets) {
  const corners = sheet.boundary();
  for (let i = 0; i < corners.length; i += 3) {
    triangles.push([corners[i] + first, corners[i + 1] + first, corners[i + 2] + first]);
  }
  first += sheet.numParticles();
}
new Recorder(`Rapier ${rapier.version()}, ${stepsPerFrame} a frame`, triangles).run(
  () => { for (let i = 0; i < stepsPerFrame; i++) world.step(); },
  () => sheets.flatMap((sheet) => Array.from(sheet.particlePositions())));
