// Prints what ESLint finds in the scripts of a page, as JSON. They share one scope, so they are read as one.
// node lint_page.mjs FOLDER
import { readFileSync } from "node:fs";
import { ESLint } from "eslint";

const kScripts = ["data", "trace", "body", "scene", "still", "raster", "player"];
const kGlobals = ["document", "window", "THREE", "Blob", "DecompressionStream", "Response", "atob", "getComputedStyle", "requestAnimationFrame", "cancelAnimationFrame", "Element"];

const rules = {
  "no-undef": "error", "no-unused-vars": "error", "no-redeclare": "error", "prefer-const": "error", "no-var": "error", eqeqeq: "error",
  "no-shadow": "error", "no-constant-condition": "error", "no-unreachable": "error", "no-dupe-keys": "error", "no-implicit-globals": "off",
  "no-self-assign": "error", "no-fallthrough": "error", "use-isnan": "error", "no-eval": "error", "max-len": ["error", 140],
};
const linter = new ESLint({
  overrideConfigFile: true,
  overrideConfig: {
    languageOptions: { sourceType: "script", globals: Object.fromEntries(kGlobals.map((name) => [name, "readonly"])) }, rules,
  },
});
const text = kScripts.map((name) => readFileSync(`${process.argv[2]}/${name}.js`, "utf8")).join("");
const [{ messages }] = await linter.lintText(text);
console.log(JSON.stringify(messages.map(({ message }) => `${message}`).concat(messages.map(({ line }) => text.split("\n")[line - 1]))));
