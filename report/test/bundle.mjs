// SPDX-License-Identifier: BSD-3-Clause
// The page that is checked in is what its sources make, to the byte, and they pass the compiler's checks. As a control, a
// source with one more rule must make another page.
import { execFileSync } from "node:child_process";
import { cpSync, existsSync, mkdtempSync, readFileSync, rmSync, symlinkSync, appendFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const report = join(dirname(fileURLToPath(import.meta.url)), ".."),
  modules = join(report, "node_modules");
if (!existsSync(join(modules, "esbuild"))) {
  console.log("SKIPPED: the packages of report/ are not installed (npm ci in report)");
  process.exit(0);
}
const folder = mkdtempSync(join(tmpdir(), "livens-bundle-"));
try {
  const made = (name, change = () => {}) => {
    const copy = join(folder, name);
    for (const part of ["src", "build.mjs", "package.json"])
      cpSync(join(report, part), join(copy, part), { recursive: true });
    symlinkSync(modules, join(copy, "node_modules"));
    change(copy);
    execFileSync(process.execPath, [join(copy, "build.mjs"), join(copy, "page.html")], {
      stdio: ["ignore", "ignore", "inherit"],
    });
    return readFileSync(join(copy, "page.html"));
  };
  const shipped = readFileSync(join(report, "../src/livens/io/report/page.html"));
  const faults = [];
  if (!made("same").equals(shipped))
    faults.push("src/livens/io/report/page.html is not what report/ makes: run `node report/build.mjs`");
  if (
    made("control", (copy) => appendFileSync(join(copy, "src/page.css"), "b { color: red }\n")).equals(
      shipped,
    )
  )
    faults.push("the control was not noticed");
  if (shipped.length >= 690_000) faults.push(`the page has ${shipped.length} bytes, 690000 are allowed`);
  execFileSync(process.execPath, [join(modules, "typescript/bin/tsc"), "--noEmit", "-p", report], {
    stdio: "inherit",
  });
  if (/"resolved"/.test(readFileSync(join(report, "package-lock.json"), "utf8")))
    faults.push("package-lock.json names hosts");
  for (const fault of faults) console.log(fault);
  process.exitCode = faults.length ? 1 : 0;
} finally {
  rmSync(folder, { recursive: true, force: true });
}
