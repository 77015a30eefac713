// SPDX-License-Identifier: BSD-3-Clause
// Unpacks the script of the page, which the program has compressed, and runs it: the policy admits both by their hashes.
import { unpacked } from "./unpacked";

try {
  const script = document.createElement("script");
  script.type = "module";
  script.textContent = new TextDecoder().decode(
    await unpacked(document.getElementById("code")!.textContent!),
  );
  document.body.append(script);
} catch (error) {
  const said = document.createElement("strong");
  said.className = "bad";
  said.textContent = `This page could not be shown: ${String(error)}. It needs a browser of 2023 or later.`;
  document.getElementById("verdict")!.append(said);
}
