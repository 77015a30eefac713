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

const many_elements = 450; // more than are told from each other
const seen_loss = 0.01; // of what a series reaches, or of the model

/** A plot that is shown: by its name, or as one quantity over another, by theirs; and its lines that are not. */
export interface Choice {
  id?: string;
  pair?: { title: string; x: string; y: string };
  hidden: string[];
}
export interface Choices {
  all: Choice[];
  are_usual: boolean; // nobody has chosen
}

/** What plots and picture of a long run do not show at once, or not at all. */
function coarseness({ meta, curves }: Run): string {
  const { elements, precision, position_loss } = meta.pose,
    loss = meta.curves.loss ?? (meta.curves.every ? 0 : 1),
    off = position_loss ?? Infinity;
  return [
    elements > many_elements &&
      `${elements} time elements: where there is more than fits, plots show the least and the largest value; zoom in to see all of the motion.`,
    loss > seen_loss &&
      `Energies, forces, joints and sensors are known here every ${number(curves.step, 2)}\u00a0s and off by up to ${number(100 * Math.min(loss, 1), 2)}\u00a0% of what they reach: what oscillates faster is lost or seems slower than it is. livens export --csv has all of it.`,
    precision === "thinned" &&
      off > seen_loss * meta.length &&
      `Bodies are off by up to ${number(off, 2)}\u00a0m here, as every few time elements are drawn as one.`,
  ]
    .filter(Boolean)
    .join(" ");
}

export class PlotList {
  readonly plots: Figure[] = [];
  private readonly host = by_id("plot-list");
  private readonly chooser = by_id<HTMLSelectElement>("add");
  private readonly choices = new Map<Figure, Omit<Choice, "hidden">>();

  constructor(
    private readonly run: Run,
    private readonly time: Timeline,
    kept: Choices | null,
  ) {
    const usual = default_plots(run).map((id) => ({ id, hidden: [] }));
    for (const choice of !kept || kept.are_usual ? usual : kept.all) this.restore(choice);
    const words = coarseness(run);
    if (words) by_id("adding").before(element("p", { class: "note" }, words));
    this.fill();
    this.listen_to_zoom();
    this.offer_angles();
    this.offer_pairs();
  }

  /** What is shown now, for a page of another run. */
  chosen(): Choices {
    const all = this.plots.map((figure) => ({
        ...this.choices.get(figure),
        hidden: figure instanceof Plot ? figure.hidden : [],
      })),
      usual = default_plots(this.run);
    const are_usual =
      all.length === usual.length && all.every(({ id, hidden }, i) => id === usual[i] && !hidden.length);
    return { all, are_usual };
  }
  /** Where the run has it. */
  private restore({ id, pair, hidden }: Choice) {
    if (id) this.add(id, hidden);
    if (!pair) return;
    const find = (label: string) =>
      quantities_of(this.run).find(({ quantity }) => quantity.label === label)?.quantity;
    const [x, y] = [find(pair.x), find(pair.y)];
    if (x && y) this.add_phase({ id: "", title: pair.title, x, y });
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

  private put<T extends Figure>(choice: Omit<Choice, "hidden">, make: (remove: () => void) => T) {
    const figure: T = make(() => {
      this.plots.splice(this.plots.indexOf(figure), 1);
      this.choices.delete(figure);
      figure.destroy();
      this.chooser.focus();
    });
    this.plots.push(figure);
    this.choices.set(figure, choice);
  }
  private add_phase({ id, title, x, y }: PhaseSpec) {
    const { elements } = this.run.meta.pose,
      choice = id ? { id } : { pair: { title, x: x.label, y: y.label } };
    this.put(choice, (remove) => new Phase(this.host, { title, x, y, elements, remove }, this.time));
  }
  private add(id: string, hidden: string[] = []) {
    const spec = this.run.specs.find((s) => s.id === id),
      phase = this.run.phases.find((s) => s.id === id);
    if (spec)
      this.put(
        { id },
        (remove) => new Plot(this.host, { ...spec, hidden, grain: this.run.grain, remove }, this.time),
      );
    if (phase) this.add_phase(phase);
  }
}
