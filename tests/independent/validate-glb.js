// Checks an animation with the validator of the Khronos group: node validate-glb.js FILE.glb
const { readFileSync } = require("fs");
const { validateBytes } = require("gltf-validator");

validateBytes(new Uint8Array(readFileSync(process.argv[2]))).then(({ issues }) => {
  const { numErrors, numWarnings, numInfos } = issues;
  console.log(`${numErrors} errors, ${numWarnings} warnings, ${numInfos} remarks`);
  if (numErrors + numWarnings > 0) {
    console.log(issues.messages.slice(0, 10));
    process.exit(1);
  }
});
