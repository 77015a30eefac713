// SPDX-License-Identifier: BSD-3-Clause
// The tab on the run and the page themselves: how exact, made how, by what, under which terms.
import type { Run } from "./run";
import { by_id, element, rough } from "./text";
import { exactness } from "./verdict";

const keys: [string, string][] = [
  ["Space", "play, stop"],
  ["\u2190 \u2192", "back and on by a 500th, with Shift by a 50th"],
  ["Page Up, Page Down", "to the end of an element of time"],
  ["Home, End", "to start and end"],
  ["+ \u2212 0", "zoom plots in and out, show all; in the picture nearer, farther, everything"],
  ["1 2 3 4", "tabs"],
  ["in the picture: arrows", "turn it, with Shift move it"],
  ["drag, wheel, two fingers", "turn, nearer; with Shift or the right button move"],
  ["drag in a plot", "zoom into that time; double click shows all"],
  ["click in a plot, on its curve", "go to that time"],
  ["click on a name below a plot", "hide its line, show it again"],
];

export function build_about(host: HTMLElement, run: Run, program: string, notices: string) {
  const { meta } = run,
    card = (title: string, ...children: (Node | string)[]) =>
      element("section", { class: "card" }, element("h2", {}, title), ...children);
  const { every, loss = 0 } = meta.curves;
  const curves =
    every && loss === 0
      ? ""
      : ` These series need more instants than a page has room for: ${every ? "elements have fewer nodes or parts than they need" : "between every few elements they are straight lines"}, off by up to ${rough(loss)} of what they reach where it was looked at.`;
  const quality = meta.quality.every ? "" : " Series of quality show the largest of neighbouring elements.";
  host.append(
    card(
      "How exact this page is",
      element("p", { id: "exactness" }, exactness(run)),
      element(
        "p",
        {},
        `Velocities are the derivatives of these polynomials. Energies, reactions, coordinates of joints, forces of loads and sensors were taken by livens at the nodes of polynomials in each element, rounded to a ten-millionth of what they reach, and are evaluated between them.${curves}${quality} Reactions follow from the equations of motion, inside elements in the state of the polynomials, put onto the joints.`,
      ),
      ...meta.bodies.flatMap(({ name, thinned }) =>
        thinned
          ? [
              element(
                "p",
                { class: "thinned" },
                `The surface of ${name} is drawn with ${thinned[1]} of its ${thinned[0]} triangles: corners are at most ${rough(thinned[2])}\u00a0m from where they are, and what is smaller may be gone. Motion and masses are those of the whole.`,
              ),
            ]
          : [],
      ),
    ),
    card(
      "The run",
      element(
        "p",
        {},
        `${meta.method}; solved by livens ${meta.version}, page written by livens ${program}. Constraints hold at ${meta.constraints_hold_at || "\u2013"}.`,
      ),
      element(
        "details",
        {},
        element("summary", {}, "all options, after defaults"),
        element("pre", { tabindex: "0" }, JSON.stringify(meta.options, null, 2)),
      ),
      element(
        "details",
        {},
        element("summary", {}, "all figures"),
        element("pre", { tabindex: "0" }, JSON.stringify(meta.figures, null, 2)),
      ),
    ),
    card("Scenario", element("pre", { tabindex: "0", id: "scenario" }, meta.scenario)),
    card(
      "Keys",
      element(
        "table",
        { class: "checks" },
        element(
          "tbody",
          {},
          ...keys.map(([key, what]) =>
            element("tr", {}, element("th", { scope: "row" }, key), element("td", {}, what)),
          ),
        ),
      ),
    ),
    card(
      "Notices",
      element(
        "p",
        {},
        "This page is one file: it loads nothing and sends nothing. It contains livens\u2019 own script (BSD 3-Clause) and the libraries below.",
      ),
      element("pre", { tabindex: "0" }, notices),
    ),
  );
  by_id("exactness").classList.toggle("off", meta.pose.precision !== "double");
}
