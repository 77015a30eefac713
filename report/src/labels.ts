// SPDX-License-Identifier: BSD-3-Clause
// Names beside bodies, pushed apart where they would cover each other: on the screen and in what is saved alike.

export interface Label {
  x: number; // of its left upper corner, px: wanted, then where it goes
  y: number;
  width: number;
  height: number;
}

const rounds = 24;
const gap = 2; // px

/** Moves labels up and down until none covers another, those that stand higher upwards; in the picture as long as there is room. */
export function spread(labels: Label[], height: number): void {
  for (let round = 0; round < rounds; ++round) {
    let is_moved = false;
    for (let i = 0; i < labels.length; ++i)
      for (let k = i + 1; k < labels.length; ++k) {
        const a = labels[i],
          b = labels[k],
          across = Math.min(a.x + a.width, b.x + b.width) - Math.max(a.x, b.x),
          down = Math.min(a.y + a.height, b.y + b.height) - Math.max(a.y, b.y) + gap;
        if (across <= 0 || down <= 0.01) continue;
        const [upper, lower] = a.y + a.height / 2 <= b.y + b.height / 2 ? [a, b] : [b, a];
        upper.y -= down / 2;
        lower.y += down / 2;
        is_moved = true;
      }
    for (const label of labels) {
      if (label.y < 0 && label.y > -2 * label.height) label.y = 0;
      if (label.y + label.height > height && label.y < height) label.y = height - label.height;
    }
    if (!is_moved) return;
  }
}

/** Where a name of that size stands beside the place of its body: in the picture as long as that is in it. */
export function beside(
  at: [number, number],
  size: [number, number],
  width: number,
  height: number,
  scale = 1,
): Label {
  const [w, h] = size,
    is_in = at[0] > 0 && at[0] < width && at[1] > 0 && at[1] < height,
    x = at[0] + 11 * scale,
    y = at[1] - h - 7 * scale;
  return { x: is_in ? Math.min(x, width - w - 2) : x, y: is_in ? Math.max(y, 2) : y, width: w, height: h };
}
