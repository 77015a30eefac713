// SPDX-License-Identifier: BSD-3-Clause
// Files that the page hands to whoever looks at it. Nothing is sent anywhere: the browser saves what the page made.
import { element } from "./text";

const most_letters = 60; // at most 240 bytes

/** What a name may be of on every system. */
export function file_name(...parts: string[]): string {
  const [last, ...first] = parts.reverse();
  const stem = [
    ...first
      .reverse()
      .map((part) =>
        part
          .replace(/[^\p{L}\p{N}.-]+/gu, "_")
          .replace(/\.{2,}/g, ".")
          .replace(/^[_.]+|[_.]+$/g, ""),
      )
      .filter((part) => part !== "")
      .join("_"),
  ]
    .slice(0, most_letters)
    .join("");
  return (stem || "livens") + last;
}

export function hand_over(data: Blob, name: string) {
  const address = URL.createObjectURL(data),
    link = element("a", { href: address, download: name });
  document.body.append(link); // Firefox clicks only what is in the page
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

export const png_of = (canvas: HTMLCanvasElement) =>
  new Promise<Blob>((done, fail) =>
    canvas.toBlob(
      (blob) => (blob ? done(blob) : fail(new Error("the picture is too large for this browser"))),
      "image/png",
    ),
  );

/** A cell of CSV: quoted where it must be, and no formula to a program of tables. */
export function cell(text: string): string {
  const plain = /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
  return /[",\r\n]/.test(plain) ? `"${plain.replaceAll('"', '""')}"` : plain;
}
