// SPDX-License-Identifier: BSD-3-Clause
// A still gives way to its live report when it is pressed: no page loads what nobody looks at.
for (const host of document.querySelectorAll(".report")) {
  host.querySelector("button").addEventListener("click", () => {
    const frame = document.createElement("iframe");
    frame.src = host.dataset.page;
    frame.title = "live report";
    host.replaceChildren(frame);
    frame.focus();
  });
}
