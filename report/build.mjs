// SPDX-License-Identifier: BSD-3-Clause
// Makes the page that livens ships, src/livens/io/report/page.html: scripts, style and their hashes in one file. The program
// compresses the script when it writes a page; the loader unpacks it.
//   node build.mjs [FILE]
import { build } from "esbuild";
import { createHash } from "node:crypto";
import { readFile, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const target = process.argv[2] ?? join(here, "../src/livens/io/report/page.html");
const read = (file) => readFile(join(here, file), "utf8");

const bundle = async (options) => {
  const made = await build({
    bundle: true,
    minify: true,
    write: false,
    absWorkingDir: here,
    charset: "utf8",
    legalComments: "none",
    metafile: true,
    ...options,
  });
  return {
    text: made.outputFiles[0].text,
    inputs: Object.values(made.metafile.outputs).flatMap((o) => Object.entries(o.inputs)),
  };
};
const notice = async (name) => {
  const { version, license } = JSON.parse(await read(`node_modules/${name}/package.json`));
  return `${name} ${version} (${license})\n${(await read(`node_modules/${name}/LICENSE`)).trim()}`;
};

// three by its modules; shaders of what is not used (physical materials, shadows, textures) are left out.
const unused =
  /ShaderChunk\/(lights_physical|lights_toon|shadow|transmission|iridescence|envmap|clearcoat|lightprobes|morph|skin|displacementmap|normalmap|bumpmap)\w*\.glsl|ShaderLib\/(meshphysical|meshtoon|meshmatcap|points|sprite|vsm|distance|background|backgroundCube|cube|equirect|shadow|meshnormal)\w*\.glsl/;
const slim = {
  name: "slim",
  setup(plugin) {
    plugin.onResolve({ filter: /^three$/ }, () => ({
      path: join(here, "node_modules/three/src/Three.js"),
      sideEffects: false,
    }));
    plugin.onLoad({ filter: /three\/src\/renderers\/shaders\/Shader(Chunk|Lib)\// }, async ({ path }) => {
      if (!unused.test(path)) return undefined;
      const names = [...(await readFile(path, "utf8")).matchAll(/export (?:default|const (\w+))/g)];
      return {
        contents: names
          .map(([, name]) => (name ? `export const ${name} = "";` : `export default "";`))
          .join("\n"),
      };
    });
  },
};
const js = await bundle({ entryPoints: ["src/main.ts"], format: "esm", target: "es2022", plugins: [slim] });
const loader = (await bundle({ entryPoints: ["src/loader.ts"], format: "esm", target: "es2022" })).text;
const notices = (await Promise.all(["three", "uplot"].map(notice))).join("\n\n").replaceAll("*/", "* /");
const script = `/*!\n${notices}\n*/\n${js.text}`;
const style = (
  await bundle({
    stdin: {
      contents: (await read("node_modules/uplot/dist/uPlot.min.css")) + (await read("src/page.css")),
      loader: "css",
    },
  })
).text;
const hash = (text) => `sha256-${createHash("sha256").update(text).digest("base64")}`;

// Nothing may end an element early, begin a comment in a script, or stand where the program puts titles and data.
for (const text of [loader, script, style])
  if (/<\/(script|style)|<!--/i.test(text)) throw new Error("the bundle contains </script, </style or <!--");
let page = await read("src/page.html");
for (const [key, value] of Object.entries({
  "@LOADER_HASH@": hash(loader),
  "@SCRIPT_HASH@": hash(script),
  "@STYLE_HASH@": hash(style),
  "@STYLE@": style,
  "@LOADER@": loader,
  "@SCRIPT@": script,
})) {
  if (page.split(key).length !== 2) throw new Error(`${key} must stand in the page once`);
  page = page.replace(key, () => value);
}
for (const place of ["<!--title-->", "<!--data-->", '<script type="text/plain" id="code">'])
  if (page.split(place).length !== 2) throw new Error(`${place} must stand in the page once`);
await writeFile(target, page);

const size = (part) =>
  js.inputs.filter(([file]) => file.includes(part)).reduce((sum, [, input]) => sum + input.bytesInOutput, 0);
console.log(
  `${Buffer.byteLength(page)} bytes: three ${size("node_modules/three")}, uPlot ${size("node_modules/uplot")}, own script ${size("src/")}, style ${style.length}, notices ${notices.length}`,
);
