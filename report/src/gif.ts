// SPDX-License-Identifier: BSD-3-Clause
// GIF: one table of colours for all pictures, of each picture only what has changed.   [GIF89a; median cut: Heckbert 1982]

const bits = 7; // of a channel, that colours are told apart by
const most_colours = 255; // one more is for what has not changed
const unchanged = 255;

type Bytes = Uint8Array<ArrayBuffer>;
const key_of = (r: number, g: number, b: number) =>
  ((r >> (8 - bits)) << (2 * bits)) | ((g >> (8 - bits)) << bits) | (b >> (8 - bits));

interface Box {
  colours: number[]; // keys
  widest: number; // channel
  size: number; // what is won by cutting it
}

/** The colours that some pictures are shown with best. */
export class Palette {
  readonly rgb = new Uint8Array(3 * 256);
  private n = 0;
  private readonly counts = new Uint32Array(1 << (3 * bits));
  private readonly nearest = new Int16Array(1 << (3 * bits)).fill(-1);

  /** Pixels are r, g, b, a. */
  see(pixels: Uint8ClampedArray) {
    for (let i = 0; i < pixels.length; i += 4) ++this.counts[key_of(pixels[i], pixels[i + 1], pixels[i + 2])];
  }
  private channel(key: number, c: number) {
    return (key >> ((2 - c) * bits)) & ((1 << bits) - 1);
  }
  private box(colours: number[]): Box {
    let widest = 0,
      range = -1,
      count = 0;
    for (let c = 0; c < 3; ++c) {
      let low = 255,
        high = 0;
      for (const key of colours) {
        const v = this.channel(key, c);
        low = Math.min(low, v);
        high = Math.max(high, v);
      }
      if (high - low > range) [widest, range] = [c, high - low];
    }
    for (const key of colours) count += this.counts[key];
    return { colours, widest, size: range * count ** 0.25 }; // so that what is small, but bright, keeps its colour
  }
  /** After everything was seen. */
  choose() {
    const all: number[] = [];
    this.counts.forEach((count, key) => {
      if (count) all.push(key);
    });
    const boxes = all.length ? [this.box(all)] : [];
    while (boxes.length < most_colours) {
      const best = boxes.reduce((b, box, i) => (box.size > (boxes[b]?.size ?? 0) ? i : b), -1);
      if (best < 0) break;
      const { colours, widest } = boxes[best];
      let sum = 0,
        count = 0;
      for (const key of colours) {
        const weight = Math.sqrt(this.counts[key]);
        sum += weight * this.channel(key, widest);
        count += weight;
      }
      const middle = sum / count,
        low = colours.filter((key) => this.channel(key, widest) <= middle),
        high = colours.filter((key) => this.channel(key, widest) > middle);
      boxes.splice(best, 1, this.box(low), this.box(high));
    }
    const half = 1 << (7 - bits);
    boxes.forEach(({ colours }, i) => {
      const count = colours.reduce((n, key) => n + this.counts[key], 0);
      for (let c = 0; c < 3; ++c) {
        const sum = colours.reduce(
          (s, key) => s + this.counts[key] * ((this.channel(key, c) << (8 - bits)) + half),
          0,
        );
        this.rgb[3 * i + c] = Math.round(sum / count);
      }
    });
    this.n = boxes.length;
  }
  index(r: number, g: number, b: number): number {
    const key = key_of(r, g, b);
    if (this.nearest[key] >= 0) return this.nearest[key];
    let best = 0,
      least = Infinity;
    for (let i = 0; i < this.n; ++i) {
      const d = (this.rgb[3 * i] - r) ** 2 + (this.rgb[3 * i + 1] - g) ** 2 + (this.rgb[3 * i + 2] - b) ** 2;
      if (d < least) [best, least] = [i, d];
    }
    return (this.nearest[key] = best);
  }
}

/** Bytes that grow. */
class Sink {
  private buffer = new Uint8Array(1 << 16);
  private n = 0;
  byte(value: number) {
    if (this.n === this.buffer.length) {
      const more = new Uint8Array(2 * this.n);
      more.set(this.buffer);
      this.buffer = more;
    }
    this.buffer[this.n++] = value;
  }
  bytes(...values: number[]) {
    for (const value of values) this.byte(value);
  }
  short(value: number) {
    this.bytes(value & 255, value >> 8);
  }
  text(value: string) {
    for (let i = 0; i < value.length; ++i) this.byte(value.charCodeAt(i));
  }
  all(): Bytes {
    return this.buffer.slice(0, this.n);
  }
}

const clear = 256,
  last = 257,
  most_codes = 4096;

/** Codes of growing length in blocks of 255 bytes. */
function compress(indices: Uint8Array, out: Sink) {
  const next = new Int16Array(most_codes * 256).fill(-1), // code and colour -> code
    block = new Uint8Array(255);
  let used = 0,
    free = last + 1,
    width = 9,
    bits_held = 0,
    held = 0;
  const flush = () => {
    if (used === 0) return;
    out.byte(used);
    for (let i = 0; i < used; ++i) out.byte(block[i]);
    used = 0;
  };
  const put = (code: number) => {
    held |= code << bits_held;
    bits_held += width;
    for (; bits_held >= 8; bits_held -= 8, held >>>= 8) {
      block[used++] = held & 255;
      if (used === 255) flush();
    }
  };
  out.byte(8);
  put(clear);
  let code = indices[0];
  for (let i = 1; i < indices.length; ++i) {
    const at = (code << 8) | indices[i];
    if (next[at] >= 0) {
      code = next[at];
      continue;
    }
    put(code);
    if (free < most_codes) {
      if (free === 1 << width) ++width;
      next[at] = free++;
    } else {
      put(clear);
      next.fill(-1);
      free = last + 1;
      width = 9;
    }
    code = indices[i];
  }
  put(code);
  // The decoder has made one more code by now, too.
  if (free === 1 << width && free < most_codes) ++width;
  put(last);
  if (bits_held > 0) block[used++] = held & 255;
  flush();
  out.byte(0);
}

export class Gif {
  private readonly out = new Sink();
  private before: Uint8Array | null = null;
  private n = 0;

  constructor(
    private readonly width: number,
    private readonly height: number,
    private readonly rate: number, // pictures a second
    private readonly palette: Palette,
  ) {
    const { out } = this;
    out.text("GIF89a");
    out.short(width);
    out.short(height);
    out.bytes(0xf7, 0, 0, ...palette.rgb);
    out.bytes(0x21, 0xff, 11);
    out.text("NETSCAPE2.0");
    out.bytes(3, 1, 0, 0, 0); // again and again
    out.bytes(0x21, 0xfe, 6);
    out.text("livens");
    out.byte(0);
  }

  /** One more picture: r, g, b, a. */
  add(pixels: Uint8ClampedArray) {
    const { width, height, before, out, palette } = this,
      now = new Uint8Array(width * height);
    for (let i = 0, k = 0; i < now.length; ++i, k += 4)
      now[i] = palette.index(pixels[k], pixels[k + 1], pixels[k + 2]);
    let [left, top, right, bottom] = before ? [width, height, -1, -1] : [0, 0, width - 1, height - 1];
    for (let y = 0, i = 0; before && y < height; ++y)
      for (let x = 0; x < width; ++x, ++i)
        if (now[i] !== before[i]) {
          left = Math.min(left, x);
          right = Math.max(right, x);
          top = Math.min(top, y);
          bottom = y;
        }
    if (right < 0) [left, top, right, bottom] = [0, 0, 0, 0];
    const w = right - left + 1,
      h = bottom - top + 1,
      part = new Uint8Array(w * h);
    for (let y = 0, k = 0; y < h; ++y)
      for (let x = 0, i = (top + y) * width + left; x < w; ++x, ++i, ++k)
        part[k] = before && now[i] === before[i] ? unchanged : now[i];
    const at = (k: number) => Math.round((100 * k) / this.rate); // hundredths of a second
    out.bytes(0x21, 0xf9, 4, before ? 5 : 4);
    out.short(at(this.n + 1) - at(this.n));
    out.bytes(unchanged, 0, 0x2c);
    for (const value of [left, top, w, h]) out.short(value);
    out.byte(0);
    compress(part, out);
    this.before = now;
    ++this.n;
  }
  end(): Blob {
    this.out.byte(0x3b);
    return new Blob([this.out.all()], { type: "image/gif" });
  }
}
