// SPDX-License-Identifier: BSD-3-Clause
// Colours of picture and plots, light and dark. Those of bodies are told apart with any colour vision. [Okabe and Ito 2008]

const on_light = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#b8a900"];
const on_dark = ["#3d9bdc", "#f0b030", "#22b98d", "#de92bd", "#7cc8f5", "#f07b3f", "#f0e442"];

const light = {
  edge: "#1a1f26",
  grid: "#dde1e6",
  joint: "#8d97a3",
  foot: "#6a747f",
  still: "#c9ced4",
  force: "#c2185b",
  load: "#6a3fb5",
  spring: "#4a535e",
  ghost: "#808892",
  sensor: "#111111",
  axes: ["#c62828", "#2e7d32", "#1565c0"],
  ink: "#20262d",
  soft: "#5a6570",
  line: "#e3e6ea",
  now: "#20262d",
  bad: "#b3261e",
  card: "#fff",
  sky: "#fdfdfe", // as in page.css
  floor: "#e9edf1",
  shade: "#3a4654",
  shadow: 0.28, // how dark it is
};
const dark: typeof light = {
  edge: "#05070a",
  grid: "#2a313a",
  joint: "#9aa5b1",
  foot: "#6d7884",
  still: "#4a535d",
  force: "#ff5c9a",
  load: "#b79bff",
  spring: "#b4bec9",
  ghost: "#8a939d",
  sensor: "#ffffff",
  axes: ["#ff6b6b", "#57d163", "#5aa9ff"],
  ink: "#e6edf3",
  soft: "#9da7b3",
  line: "#2a313a",
  now: "#e6edf3",
  bad: "#ff8a80",
  card: "#151b23",
  sky: "#161d26",
  floor: "#0b0f14",
  shade: "#000000",
  shadow: 0.55,
};

export const dark_wanted = matchMedia("(prefers-color-scheme: dark)");
export type Scheme = "light" | "dark" | null; // null: as the screen is
let printing = false,
  scheme: Scheme = null;
/** Paper is white. */
export function set_printing(is_printing: boolean) {
  printing = is_printing;
}
/** Of what is drawn until it is set again. */
export function set_scheme(wanted: Scheme) {
  scheme = wanted;
}
const is_dark = () => (scheme ? scheme === "dark" : dark_wanted.matches && !printing);
export const theme = () => (is_dark() ? dark : light);
export const colour = (i: number) => (is_dark() ? on_dark : on_light)[i % on_light.length];
export const body_colour = colour;
