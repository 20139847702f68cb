// Runs the scene in MuJoCo: node mujoco.mjs SCENE RECORD STEPS_PER_FRAME. MuJoCo's z is up.
import load from '@mujoco/mujoco';
import { Recorder, scene } from './record.mjs';

const stepsPerFrame = Number(process.argv[4] ?? 3);
const mujoco = await load();

// A plate of Young's modulus e and thickness t has the scene's stiffness e t and flexural rigidity
// e t^3 / (12 (1 - nu^2)).
const poisson = 0.2;
const thickness = Math.sqrt(12 * (1 - poisson ** 2) * scene.bending / scene.stiffness);
const half = scene.edge * (scene.columns - 1) / 2;
const sheets = scene.corners.map(([x, y, z], i) => `
  <flexcomp name="sheet${i}" type="grid" dim="2" count="${scene.columns} ${scene.columns} 1"
      spacing="${scene.edge} ${scene.edge} 1" pos="${x + half} ${-(z + half)} ${y}"
      radius="${scene.thickness / 2}" mass="${scene.sheet_mass}">
    <elasticity young="${scene.stiffness / thickness}" poisson="${poisson}" thickness="${thickness}"
        elastic2d="both" damping="0.001"/>
    <contact selfcollide="auto" internal="false" passive="true" condim="3" friction="${scene.friction}"/>
  </flexcomp>`).join('');
const [bx, by, bz] = scene.ball.center;
const model = mujoco.MjModel.from_xml_string(`<mujoco>
  <option timestep="${scene.frame / stepsPerFrame}" gravity="0 0 -9.81" integrator="discrete" solver="CG">
    <flag ipc="enable"/>
  </option>
  <size memory="1500M"/>
  <worldbody>
    <geom type="sphere" size="${scene.ball.radius}" pos="${bx} ${-bz} ${by}" friction="${scene.friction}"/>
    <geom type="plane" size="50 50 .1" friction="${scene.friction}"/>${sheets}
  </worldbody>
</mujoco>`);
const data = new mujoco.MjData(model);
mujoco.mj_forward(model, data);

const triangles = [];
for (let flex = 0; flex < model.nflex; flex++) {
  const elements = model.flex_elem, at = model.flex_elemdataadr[flex], first = model.flex_vertadr[flex];
  for (let i = 0; i < model.flex_elemnum[flex]; i++) {
    triangles.push([0, 1, 2].map((k) => first + elements[at + 3 * i + k]));
  }
}
new Recorder(`MuJoCo ${mujoco.mj_versionString()}, ipc, ${stepsPerFrame} a frame`, triangles).run(
  () => { for (let i = 0; i < stepsPerFrame; i++) mujoco.mj_step(model, data); },
  () => {
    const from = data.flexvert_xpos, to = new Array(from.length);
    for (let i = 0; i < from.length; i += 3) {
      to[i] = from[i];
      to[i + 1] = from[i + 2];
      to[i + 2] = -from[i + 1];
    }
    return to;
  });
