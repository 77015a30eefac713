// SPDX-License-Identifier: BSD-3-Clause
// The picture with what lies about it: names, scales, switches. Without WebGL plots stand alone.
import type { Eye, Side } from "./camera";
import { beside, spread } from "./labels";
import type { Run } from "./run";
import { Stage, type Shown } from "./stage";
import type { Screen } from "./studio";
import { by_id, element, number, rough, seconds } from "./text";
import { body_colour, dark_wanted, theme } from "./theme";
import type { Timeline } from "./timeline";

/** What somebody has chosen to see. */
export interface Seen {
  shown: Shown;
  eye: Eye | null;
}

const few = 8; // bodies that carry their names unless asked otherwise, twice the joints whose forces are shown
const most_names = 60;

export class Picture {
  stage: Stage | null = null;
  private readonly shown: Shown;
  private readonly labels: HTMLElement[];
  private other: Run | null = null;
  private sizes: [number, number][] = []; // of the labels, px

  constructor(
    private readonly run: Run,
    private readonly time: Timeline,
    private readonly signal: AbortSignal,
    kept: Seen | null,
  ) {
    const { bodies } = run.meta;
    this.shown = kept?.shown ?? {
      trails: true,
      forces: run.forces.length <= 2 * few,
      joints: true,
      names: bodies.length <= few,
      frames: false,
      other: true,
    };
    this.labels = bodies.slice(0, most_names).map((body) => element("span", {}, body.name));
    by_id("labels").append(...this.labels);
    this.build();
    if (kept?.eye) this.stage?.eye.stay_as(kept.eye);
    this.listen();
    time.on_move((t) => this.stage?.show(t));
  }

  /** For the picture of another run. */
  seen(): Seen {
    return { shown: this.shown, eye: this.stage?.eye ?? null };
  }
  close() {
    this.stage?.renderer.dispose();
    this.stage?.renderer.forceContextLoss();
    this.stage = null;
  }
  /** Also anew, where colours change. */
  build() {
    by_id("space").querySelector("canvas")?.remove();
    this.stage?.renderer.dispose();
    this.stage = null;
    this.labels.forEach((label, b) => {
      label.style.borderColor = this.run.meta.bodies[b].color ?? body_colour(b);
    });
    const canvas = element("canvas", {
      id: "stage",
      tabindex: "0",
      role: "img",
      "aria-label": described(this.run),
    });
    try {
      by_id("space").prepend(canvas);
      this.stage = new Stage(canvas, this.run);
    } catch (error) {
      canvas.remove();
      by_id("motion").classList.add("flat");
      const why = error instanceof Error ? error.message : String(error);
      by_id("space").before(
        element(
          "p",
          { id: "no3d", class: "bad" },
          `There is no picture in space: ${why} Everything else is here.`,
        ),
      );
      return;
    }
    this.stage.shown = this.shown;
    this.stage.after_draw = () => this.place_labels();
    if (this.other) this.stage.compare(this.other);
    this.write_caption();
  }

  private listen() {
    for (const what of Object.keys(this.shown) as (keyof Shown)[]) {
      const box = by_id<HTMLInputElement>(`show-${what}`);
      box.checked = this.shown[what];
      box.addEventListener("change", () => {
        this.shown[what] = box.checked;
        this.write_caption();
        this.time.set(this.time.now);
      });
    }
    const wide = matchMedia("(min-width: 1000px)"),
      fold = () => {
        by_id<HTMLDetailsElement>("show").open = wide.matches;
      };
    wide.addEventListener("change", fold, { signal: this.signal });
    fold();
    for (const side of ["fitted", "front", "side", "top"] as Side[])
      by_id(`view-${side}`).addEventListener("click", () => this.stage?.eye.fit_by_hand(side));
  }

  /** What pictures that are saved take from this one. */
  screen(): Screen {
    const { run, other, stage, shown } = this;
    return { run, other: shown.other ? other : null, stage, shown };
  }
  compare(other: Run | null) {
    this.other = other;
    by_id("other-label").hidden = other === null;
    this.stage?.compare(other);
  }
  resize() {
    const { clientWidth, clientHeight } = by_id("space"),
      below_caption = 20; // px
    this.sizes = [];
    if (clientWidth > 0 && clientHeight > 0)
      this.stage?.resize(
        clientWidth,
        clientHeight,
        by_id("views").offsetTop + by_id("views").offsetHeight,
        by_id("caption").offsetHeight + below_caption,
      );
  }

  private place_labels() {
    by_id("labels").hidden = !this.shown.names;
    if (!this.stage || !this.shown.names) return;
    const { clientWidth: width, clientHeight: height } = by_id("space");
    const placed = this.labels.flatMap((label, b) => {
      const at = this.stage!.screen(b);
      label.hidden = at === null || !Number.isFinite(at[0] + at[1]);
      if (!at || label.hidden) return [];
      this.sizes[b] ??= [label.offsetWidth, label.offsetHeight];
      return [{ label, ...beside(at, this.sizes[b], width, height) }];
    });
    spread(placed, height);
    for (const { label, x, y } of placed)
      label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
  }

  /** The scales of the picture. */
  private write_caption() {
    const { run, stage } = this,
      said: HTMLElement[] = [];
    if (!stage) return;
    const add = (swatch: string | null, text: string) => {
      const mark = element("i", {});
      if (swatch) mark.style.background = swatch;
      said.push(element("span", {}, swatch && mark, text));
    };
    if (run.meta.bodies.length > few) add(null, `${run.meta.bodies.length} bodies`);
    if (stage.leaving.length)
      add(null, `${stage.leaving.slice(0, 3).join(", ")} goes far: Fit once more shows the whole way`);
    add(null, `grid ${number(stage.cell)}\u00a0m`);
    if (this.shown.trails && stage.path_window > 0)
      add(null, `paths of the last ${number(stage.path_window, 2)}\u00a0s`);
    const kinds = new Set(run.forces.filter((f) => f.largest > 0).map((f) => f.kind));
    if (this.shown.forces && run.largest_force > 0) {
      if (kinds.has("reaction")) add(theme().force, "force of a joint on its second body");
      if (kinds.has("load")) add(theme().load, "force of a load");
      add(null, `longest arrow ${number(run.largest_force, 3)}\u00a0N, lengths as \u221aforce`);
    }
    if (this.shown.forces && run.largest_torque > 0) {
      if (!kinds.has("load") || run.largest_force === 0) add(theme().load, "torque of a load");
      add(null, `largest torque ${number(run.largest_torque, 3)}\u00a0N\u00a0m`);
    }
    const thinned = run.meta.bodies.filter((body) => body.thinned);
    if (thinned.length)
      add(null, `surfaces thinned, off by ${rough(Math.max(...thinned.map((b) => b.thinned![2])))}\u00a0m`);
    if (this.shown.frames) ["d\u2081", "d\u2082", "d\u2083"].forEach((d, i) => add(theme().axes[i], d));
    by_id("caption").replaceChildren(...said);
  }

  /** Start, middle and end, for paper. */
  print_stills(host: HTMLElement) {
    host.replaceChildren();
    if (dark_wanted.matches) this.build(); // in the colours of paper
    this.draw_stills(host);
  }
  private draw_stills(host: HTMLElement) {
    const { stage } = this,
      { now, start, end, span } = this.time;
    if (!stage) return;
    const source = stage.renderer.domElement;
    stage.resize(720, 560, 0, 0);
    for (const t of span > 0 ? [start, (start + end) / 2, end] : [start]) {
      stage.show(t);
      const canvas = element("canvas", { width: String(source.width), height: String(source.height) });
      canvas.getContext("2d")!.drawImage(source, 0, 0);
      host.append(element("figure", {}, canvas, element("figcaption", {}, `${seconds(t, span)}\u00a0s`)));
    }
    stage.show(now);
    this.resize();
  }
}

function described({ meta }: Run): string {
  const names = meta.bodies
      .slice(0, 6)
      .map((b) => b.name)
      .join(", "),
    more = meta.bodies.length > 6 ? ", \u2026" : "";
  return (
    `the mechanism in space: ${meta.bodies.length} bodies (${names}${more}) and ${meta.joints.length} joints; ` +
    "arrow keys turn it, plus and minus come nearer, 0 shows all"
  );
}
