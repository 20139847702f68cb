// Validates .glb files: validate_glb.js NODE_MODULES FILE... Prints one line of JSON for each.
const fs = require('fs');
const path = require('path');

const [modules, ...files] = process.argv.slice(2);
const validator = require(path.join(modules, 'gltf-validator'));

(async () => {
  for (const file of files) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {maxIssues: 1000});
    const {numErrors, numWarnings, messages} = report.issues;
    const grave = messages.filter(message => message.severity < 2).slice(0, 10);
    console.log(JSON.stringify({file, errors: numErrors, warnings: numWarnings, messages: grave}));
  }
})();
