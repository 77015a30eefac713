// SPDX-License-Identifier: BSD-3-Clause
// What all plots have: a head with buttons, and ways to be drawn again.
import { cell, file_name, hand_over, png_of } from "./files";
import { element, shortened } from "./text";

export interface Figure {
  readonly box: HTMLElement;
  /** The instant. */
  show(t: number): void;
  /** Another span of time, other units. */
  zoom(): void;
  resize(): void;
  /** For paper, which nothing tells the width of. */
  set_width(width: number): void;
  recolour(): void;
  destroy(): void;
}

/** Columns of a table, each of one length. */
export interface Columns {
  head: string[];
  columns: ArrayLike<number>[];
}

/** Full digits: what JavaScript writes is read back to the same number. */
export function csv_of({ head, columns }: Columns): string {
  const rows = [head.map(cell).join(",")];
  for (let k = 0; k < columns[0].length; ++k)
    rows.push(columns.map((column) => (Number.isFinite(column[k]) ? String(column[k]) : "")).join(","));
  return `${rows.join("\r\n")}\r\n`;
}

export interface Actions {
  title: string;
  picture(): Promise<HTMLCanvasElement>;
  table(): Columns;
  remove?: () => void;
}

/** Name, unit and buttons above a plot. */
export function heading({ title, picture, table, remove }: Actions, unit: HTMLElement): HTMLElement {
  const button = (text: string, label: string, act: () => void, name = "out") => {
    const made = element("button", { class: name, "aria-label": `${label}: ${title}`, title: label }, text);
    made.addEventListener("click", act);
    return made;
  };
  const save_picture = async () => hand_over(await png_of(await picture()), file_name(title, ".png"));
  const save_table = () =>
    hand_over(new Blob([csv_of(table())], { type: "text/csv;charset=utf-8" }), file_name(title, ".csv"));
  return element(
    "figcaption",
    {},
    element("span", {}, title, unit),
    element(
      "span",
      { class: "acts" },
      button("PNG", "save this plot as a picture", () => void save_picture()),
      button("CSV", "save the values of this plot", save_table),
      remove && button("\u00d7", "remove the plot", remove, "remove"),
    ),
  );
}

export const sheet = { width: 1600, height: 800, scale: 2 }; // px of a plot that is saved; of it for one of the screen

/** A canvas with a name above and a legend below what is drawn between. */
export function framed(
  plot: CanvasImageSource,
  height: number,
  title: string,
  unit: string,
  keys: { label: string; colour: string }[],
  colours: { card: string; ink: string; soft: string },
): HTMLCanvasElement {
  const { width, scale } = sheet,
    font = (weight: number, size: number) => `${weight} ${size * scale}px system-ui, sans-serif`,
    head = 34 * scale,
    line = 20 * scale,
    left = 16 * scale;
  const canvas = element("canvas", { width: String(width) }),
    c = canvas.getContext("2d")!;
  c.font = font(400, 12);
  const rows: { label: string; colour: string; x: number }[][] = [[]];
  let x = left;
  for (const { label, colour } of keys) {
    const key = { label: shortened(c, label, width - 3 * left - 40 * scale), colour };
    const wide = c.measureText(key.label).width + 40 * scale;
    if (x > left && x + wide > width) {
      rows.push([]);
      x = left;
    }
    rows[rows.length - 1].push({ ...key, x });
    x += wide;
  }
  canvas.height = head + height + (keys.length ? rows.length * line + 10 * scale : 0);
  c.fillStyle = colours.card;
  c.fillRect(0, 0, width, canvas.height);
  c.fillStyle = colours.ink;
  c.font = font(600, 14);
  const name = shortened(c, title, 0.85 * width);
  c.fillText(name, left, 23 * scale);
  const after = left + c.measureText(name).width + 8 * scale;
  c.fillStyle = colours.soft;
  c.font = font(400, 12);
  c.fillText(unit, after, 23 * scale);
  c.drawImage(plot, 0, head, width, height);
  rows.forEach((row, r) => {
    const y = head + height + r * line + 14 * scale;
    for (const { label, colour, x: at } of row) {
      c.fillStyle = colour;
      c.fillRect(at, y - 5 * scale, 14 * scale, 3 * scale);
      c.fillStyle = colours.ink;
      c.fillText(label, at + 20 * scale, y);
    }
  });
  return canvas;
}
