// SPDX-License-Identifier: BSD-3-Clause
// Pictures of any size, apart from the screen: a stage of their own, with names and the time written into them.
import type { Side } from "./camera";
import { beside, spread } from "./labels";
import type { Run } from "./run";
import { Stage, type Shown } from "./stage";
import { element, seconds, shortened } from "./text";
import { body_colour, set_scheme, theme, type Scheme } from "./theme";

export interface Look {
  width: number; // px
  height: number;
  scheme: Scheme; // null: that of the screen
  is_clear: boolean; // without a background
  names: boolean;
  clock: boolean;
  side?: Side; // as on the screen unless it is said
}

const full_height = 640; // px, of a picture that is drawn as on the screen: lines and names of others grow with them
export const least_size = 16;
export const most_size = 8192;
const label_size = 11; // px, of that height

/** Everything that a picture takes from the screen. */
export interface Screen {
  run: Run;
  other: Run | null;
  stage: Stage | null;
  shown: Shown;
}

export class Studio {
  readonly canvas: HTMLCanvasElement;
  private readonly stage: Stage;
  private readonly scale: number; // px of the picture for one of the screen
  private readonly context: CanvasRenderingContext2D;
  private readonly sizes: [number, number][] = [];
  private readonly names: string[] = [];

  /** Throws where there is no WebGL, or no canvas of that size. */
  constructor(
    private readonly screen: Screen,
    private readonly look: Look,
  ) {
    const { width, height } = look,
      { run } = screen;
    for (const n of [width, height])
      if (!(Number.isInteger(n) && n >= least_size && n <= most_size))
        throw new Error(`sides of a picture have ${least_size} to ${most_size} pixels, not ${n}`);
    this.canvas = element("canvas", { width: String(width), height: String(height) });
    this.scale = Math.min(height / full_height, width / (0.75 * full_height));
    this.context = this.canvas.getContext("2d", { willReadFrequently: true })!;
    const stage = this.as_wished(() => new Stage(element("canvas"), run)),
      { drawingBufferWidth: w, drawingBufferHeight: h } = stage.size_exactly(width, height, this.scale);
    this.stage = stage;
    if (w !== width || h !== height) {
      this.close();
      throw new Error(`this browser draws no picture of ${width} \u00d7 ${height} pixels`);
    }
    stage.shown = { ...screen.shown };
    if (screen.other) stage.compare(screen.other);
    if (look.side) stage.eye.fit(look.side);
    else if (screen.stage) stage.eye.see_as(screen.stage.eye);
  }
  /** In the colours that are wished. */
  private as_wished<T>(act: () => T): T {
    set_scheme(this.look.scheme);
    try {
      return act();
    } finally {
      set_scheme(null);
    }
  }

  draw(t: number): HTMLCanvasElement {
    this.as_wished(() => {
      const { context: c, canvas, look, stage } = this,
        { width, height } = canvas;
      c.clearRect(0, 0, width, height);
      if (!look.is_clear) {
        const sky = c.createLinearGradient(0, 0, 0, height);
        sky.addColorStop(0, theme().sky);
        sky.addColorStop(1, theme().floor);
        c.fillStyle = sky;
        c.fillRect(0, 0, width, height);
      }
      stage.show(t);
      c.drawImage(stage.renderer.domElement, 0, 0);
      if (look.names) this.write_names();
      if (look.clock) this.write_clock(t);
    });
    return this.canvas;
  }

  private write_names() {
    const { context: c, canvas, stage, scale } = this,
      { bodies } = this.screen.run.meta,
      bar = 3 * scale,
      pad = 4 * scale;
    c.font = `600 ${label_size * scale}px system-ui, sans-serif`;
    c.textBaseline = "middle";
    const labels = bodies.flatMap((body, b) => {
      const at = stage.screen(b, canvas.width, canvas.height);
      if (!at || !Number.isFinite(at[0] + at[1])) return [];
      const name = (this.names[b] ??= shortened(c, body.name, 0.3 * canvas.width));
      this.sizes[b] ??= [c.measureText(name).width + 2 * pad + bar, 1.5 * label_size * scale];
      return [{ b, name, ...beside(at, this.sizes[b], canvas.width, canvas.height, scale) }];
    });
    spread(labels, canvas.height);
    for (const { b, name, x, y, width, height } of labels) {
      c.globalAlpha = 0.9;
      c.fillStyle = theme().card;
      c.fillRect(x, y, width, height);
      c.globalAlpha = 1;
      c.fillStyle = bodies[b].color ?? body_colour(b);
      c.fillRect(x, y, bar, height);
      c.fillStyle = theme().ink;
      c.fillText(name, x + bar + pad, y + height / 2);
    }
  }
  private write_clock(t: number) {
    const { context: c, canvas, scale } = this,
      { motion } = this.screen.run;
    c.font = `600 ${14 * scale}px system-ui, sans-serif`;
    c.textBaseline = "alphabetic";
    c.fillStyle = theme().ink;
    c.fillText(`${seconds(t, motion.end - motion.start)} s`, 14 * scale, canvas.height - 14 * scale);
  }

  close() {
    this.stage.renderer.dispose();
    this.stage.renderer.forceContextLoss();
  }
}
