// SPDX-License-Identifier: BSD-3-Clause
// The plots beside the picture: some to begin with, any other to be added, and any quantity against any other.
import type { Figure } from "./figure";
import { default_plots } from "./first_plots";
import { Phase } from "./phase";
import { Plot } from "./plot";
import type { Run } from "./run";
import { quantities_of, type PhaseSpec } from "./specs";
import { by_id, element, number } from "./text";
import type { Timeline } from "./timeline";
import { angles_now, is_angular, set_angles, type Angles } from "./units";

const many_elements = 450; // more than plots of 900 points show

export class PlotList {
  readonly plots: Figure[] = [];
  private readonly host = by_id("plot-list");
  private readonly chooser = by_id<HTMLSelectElement>("add");

  constructor(
    private readonly run: Run,
    private readonly time: Timeline,
  ) {
    for (const id of default_plots(run)) this.add(id);
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
    this.fill();
    this.listen_to_zoom();
    this.offer_angles();
    this.offer_pairs();
  }

  private fill() {
    const groups = new Map<string, HTMLOptGroupElement>();
    const offer = (group: string, id: string, title: string) => {
      if (!groups.has(group)) groups.set(group, element("optgroup", { label: group }));
      groups.get(group)!.append(element("option", { value: id }, title));
    };
    for (const { group, id, title } of this.run.specs) offer(group, id, title);
    for (const { id, title } of this.run.phases) offer("One against another", id, title);
    this.chooser.append(element("option", { value: "" }, "choose\u2026"), ...groups.values());
    this.chooser.addEventListener("change", () => {
      this.add(this.chooser.value);
      this.chooser.value = "";
    });
  }

  private listen_to_zoom() {
    const { time } = this,
      hint = by_id("zoom-hint"),
      all = by_id<HTMLButtonElement>("zoom-all");
    const show = () => {
      const is_whole = time.is_whole;
      hint.hidden = !is_whole || !(time.span > 0);
      all.hidden = is_whole;
      all.textContent = `Show all: ${number(time.start)} to ${number(time.end)}\u00a0s`;
    };
    all.addEventListener("click", () => time.zoom(null));
    time.on_zoom(show);
    show();
  }
  private offer_angles() {
    const select = by_id<HTMLSelectElement>("angles");
    const has_angles = this.run.specs.some(({ unit }) => is_angular(unit));
    by_id("angles-label").hidden = !has_angles;
    select.value = angles_now();
    select.addEventListener("change", () => set_angles(select.value as Angles));
  }

  /** Two lists, filled when they are asked for: large mechanisms have hundreds of quantities. */
  private offer_pairs() {
    const pair = by_id<HTMLDetailsElement>("pair"),
      [over, of] = [by_id<HTMLSelectElement>("pair-y"), by_id<HTMLSelectElement>("pair-x")];
    let all: ReturnType<typeof quantities_of> = [];
    pair.addEventListener("toggle", () => {
      if (all.length) return;
      all = quantities_of(this.run);
      for (const select of [over, of]) {
        const groups = new Map<string, HTMLOptGroupElement>();
        all.forEach(({ group, quantity }, i) => {
          if (!groups.has(group)) groups.set(group, element("optgroup", { label: group }));
          groups.get(group)!.append(element("option", { value: String(i) }, quantity.label));
        });
        select.append(...groups.values());
      }
      over.value = String(Math.min(1, all.length - 1));
    });
    by_id("pair-add").addEventListener("click", () => {
      const [y, x] = [over, of].map((select) => all[Number(select.value)]?.quantity);
      if (x && y) this.add_phase({ id: "", title: `${y.label} over ${x.label}`, x, y });
    });
  }

  private put<T extends Figure>(make: (remove: () => void) => T) {
    const figure: T = make(() => {
      this.plots.splice(this.plots.indexOf(figure), 1);
      figure.destroy();
      this.chooser.focus();
    });
    this.plots.push(figure);
  }
  private add_phase({ title, x, y }: PhaseSpec) {
    const { elements } = this.run.meta.pose;
    this.put((remove) => new Phase(this.host, { title, x, y, elements, remove }, this.time));
  }
  private add(id: string) {
    const spec = this.run.specs.find((s) => s.id === id),
      phase = this.run.phases.find((s) => s.id === id);
    if (spec) this.put((remove) => new Plot(this.host, { ...spec, remove }, this.time));
    if (phase) this.add_phase(phase);
  }
}
