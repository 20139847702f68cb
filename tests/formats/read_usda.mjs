// Reads .usda files with TinyUSDZ: read_usda.mjs NODE_MODULES FILE... Prints one line of JSON for each.
import fs from 'fs';
import path from 'path';

// The package is built for browsers, and asks whether it is in one.
process.type = 'renderer';
globalThis.window = globalThis;
const [modules, ...files] = process.argv.slice(2);
const folder = path.join(modules, 'tinyusdz');
const {default: load} = await import(path.join(folder, 'tinyusdz.js'));
const library = await load({wasmBinary: fs.readFileSync(path.join(folder, 'tinyusdz.wasm'))});

for (const file of files) {
  const reader = new library.TinyUSDZLoaderNative();
  reader.setEnableComposition(true);  // bodies refer to shared meshes
  const ok = reader.loadFromBinary(new Uint8Array(fs.readFileSync(file)), file);
  console.log(JSON.stringify({file, ok, error: reader.error(), meshes: ok ? reader.numMeshes() : 0}));
}
