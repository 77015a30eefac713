// SPDX-License-Identifier: BSD-3-Clause
// WebM, as far as one track of pictures needs it: elements of EBML, all of known length, with cues before the clusters.
//   [Matroska, RFC 9559; EBML, RFC 8794]

export interface Chunk {
  data: Uint8Array<ArrayBuffer>;
  timestamp: number; // µs
  is_key: boolean;
}
type Bytes = Uint8Array<ArrayBuffer>;
export type Colours = NonNullable<VideoDecoderConfig["colorSpace"]>;

// Numbers of what a browser names [ITU-T H.273]; 2 is "unspecified".
const numbers: Record<string, number> = { bt709: 1, bt470bg: 5, smpte170m: 6, "iec61966-2-1": 13, rgb: 0 };

const longest_cluster = 30_000; // ms: timestamps in a cluster have 16 bits

function joined(parts: Bytes[]): Bytes {
  const all = new Uint8Array(parts.reduce((n, part) => n + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}
/** Big-endian, in `n` bytes. */
function big(value: number, n: number): Bytes {
  const bytes = new Uint8Array(n);
  for (let i = n - 1, rest = value; i >= 0; --i, rest = Math.floor(rest / 256)) bytes[i] = rest % 256;
  return bytes;
}
const id_of = (id: number) => big(id, id > 0xffffff ? 4 : id > 0xffff ? 3 : id > 0xff ? 2 : 1);
/** The length of an element, in eight bytes. */
function length_of(n: number): Bytes {
  const bytes = big(n, 8);
  bytes[0] = 1;
  return bytes;
}
const element = (id: number, ...content: Bytes[]): Bytes => {
  const n = content.reduce((sum, part) => sum + part.length, 0);
  return joined([id_of(id), length_of(n), ...content]);
};
const unsigned = (id: number, value: number) => element(id, big(value, 8));
const text = (id: number, value: string) => element(id, new TextEncoder().encode(value));
const real = (id: number, value: number) => {
  const bytes = new Uint8Array(8);
  new DataView(bytes.buffer).setFloat64(0, value);
  return element(id, bytes);
};

const head = () =>
  element(
    0x1a45dfa3,
    unsigned(0x4286, 1),
    unsigned(0x42f7, 1),
    unsigned(0x42f2, 4),
    unsigned(0x42f3, 8),
    text(0x4282, "webm"),
    unsigned(0x4287, 4),
    unsigned(0x4285, 2),
  );

/** Pictures from one that stands alone on, as far as a cluster may reach. */
function clusters_of(chunks: Chunk[]): { time: number; bytes: Bytes }[] {
  const groups: Chunk[][] = [];
  for (const chunk of chunks) {
    const group = groups.at(-1),
      is_far = group !== undefined && (chunk.timestamp - group[0].timestamp) / 1000 > longest_cluster;
    if (group === undefined || chunk.is_key || is_far) groups.push([chunk]);
    else group.push(chunk);
  }
  return groups.map((group) => {
    const time = Math.round(group[0].timestamp / 1000);
    const blocks = group.map(({ data, timestamp, is_key }) =>
      element(
        0xa3,
        Uint8Array.of(0x81),
        big(Math.round(timestamp / 1000) - time, 2),
        Uint8Array.of(is_key ? 0x80 : 0),
        data,
      ),
    );
    return { time, bytes: element(0x1f43b675, unsigned(0xe7, time), ...blocks) };
  });
}

/** How numbers become colours; players guess it, each in its way, where it is not told. */
function colours_of({ matrix, transfer, primaries, fullRange }: Colours): Bytes {
  const number = (name: string | null | undefined) => numbers[name ?? ""] ?? 2;
  return element(
    0x55b0,
    unsigned(0x55b1, number(matrix)),
    unsigned(0x55b9, fullRange ? 2 : 1),
    unsigned(0x55ba, number(transfer)),
    unsigned(0x55bb, number(primaries)),
  );
}

/** `seconds`: how long all of it lasts; `rate`: pictures a second. */
export function webm_of(
  chunks: Chunk[],
  codec: "V_VP9" | "V_VP8",
  width: number,
  height: number,
  rate: number,
  seconds: number,
  colours: Colours,
): Blob {
  const info = element(
    0x1549a966,
    unsigned(0x2ad7b1, 1_000_000), // ns of a unit of time
    real(0x4489, 1000 * seconds),
    text(0x4d80, "livens"),
    text(0x5741, "livens"),
  );
  const track = element(
    0xae,
    unsigned(0xd7, 1),
    unsigned(0x73c5, 1),
    unsigned(0x9c, 0),
    unsigned(0x83, 1),
    text(0x86, codec),
    unsigned(0x23e383, Math.round(1e9 / rate)),
    element(0xe0, unsigned(0xb0, width), unsigned(0xba, height), colours_of(colours)),
  );
  const tracks = element(0x1654ae6b, track),
    clusters = clusters_of(chunks);
  const cues = (first: number) => {
    let at = first;
    const points = clusters.map(({ time, bytes }) => {
      const point = element(0xbb, unsigned(0xb3, time), element(0xb7, unsigned(0xf7, 1), unsigned(0xf1, at)));
      at += bytes.length;
      return point;
    });
    return element(0x1c53bb6b, ...points);
  };
  const before = info.length + tracks.length,
    index = cues(before + cues(0).length);
  const size = before + index.length + clusters.reduce((n, { bytes }) => n + bytes.length, 0);
  return new Blob(
    [head(), id_of(0x18538067), length_of(size), info, tracks, index, ...clusters.map(({ bytes }) => bytes)],
    { type: "video/webm" },
  );
}
