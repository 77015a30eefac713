// SPDX-License-Identifier: BSD-3-Clause
// The plots beside the picture: some to begin with, any other to be added.
import { Plot } from "./plot";
import type { Run } from "./run";
import { by_id, element } from "./text";
import type { Timeline } from "./timeline";

const many_elements = 450; // more than plots of 900 points show

export class PlotList {
  readonly plots: Plot[] = [];
  private readonly chooser = by_id<HTMLSelectElement>("add");

  constructor(
    private readonly run: Run,
    private readonly time: Timeline,
  ) {
    for (const id of run.default_plots()) this.add(id);
    const n = run.meta.pose.elements,
      coarse = "energies, forces, joints and sensors are known here every few elements";
    if (n > many_elements)
      by_id("adding").before(
        element(
          "p",
          { class: "note" },
          `${n} time elements: zoom in to see all of the motion${run.meta.curves.every ? "" : `; ${coarse}`}.`,
        ),
      );
    this.chooser.append(element("option", { value: "" }, "choose\u2026"));
    const groups = new Map<string, HTMLOptGroupElement>();
    for (const spec of run.specs) {
      if (!groups.has(spec.group)) groups.set(spec.group, element("optgroup", { label: spec.group }));
      groups.get(spec.group)!.append(element("option", { value: spec.id }, spec.title));
    }
    this.chooser.append(...groups.values());
    this.chooser.addEventListener("change", () => {
      this.add(this.chooser.value);
      this.chooser.value = "";
    });
  }
  private add(id: string) {
    const spec = this.run.specs.find((s) => s.id === id);
    if (!spec) return;
    const remove = () => {
      this.plots.splice(this.plots.indexOf(plot), 1);
      plot.destroy();
      this.chooser.focus();
    };
    const plot: Plot = new Plot(by_id("plot-list"), { ...spec, remove }, this.time);
    this.plots.push(plot);
  }
}
