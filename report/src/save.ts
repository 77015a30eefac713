// SPDX-License-Identifier: BSD-3-Clause
// The dialog that saves what is seen: a still, a video, a GIF.
import { file_name, hand_over } from "./files";
import type { Picture } from "./picture";
import type { Playback } from "./playback";
import { can_encode, instants_of, is_still, record, type Course, type Kind } from "./record";
import { least_size, most_size, type Look } from "./studio";
import { by_id, element, number, seconds } from "./text";
import type { Scheme } from "./theme";
import type { Timeline } from "./timeline";

const sizes = ["1280 x 720", "1920 x 1080", "3840 x 2160", "1080 x 1080", "960 x 600", "640 x 400"];
const rates = [10, 12.5, 20, 25, 30, 50, 60];
const usual: Record<Kind, { size: string; rate: number }> = {
  png: { size: "1920 x 1080", rate: 30 },
  svg: { size: "1280 x 720", rate: 30 },
  webm: { size: "1280 x 720", rate: 30 },
  gif: { size: "640 x 400", rate: 20 },
};
const kinds: [Kind, string][] = [
  ["png", "Picture"],
  ["svg", "Sketch"],
  ["webm", "Video"],
  ["gif", "GIF"],
];

const field = (label: string, ...controls: HTMLElement[]) =>
  element("label", { class: "field" }, element("span", {}, label), ...controls);
const options = (select: HTMLSelectElement, ...all: [string, string][]) => {
  select.append(...all.map(([value, label]) => element("option", { value }, label)));
  return select;
};
const numeric = (id: string, label: string) =>
  element("input", { type: "number", step: "any", id, "aria-label": label });
const box = (id: string, label: string) =>
  element("label", {}, element("input", { type: "checkbox", id }), ` ${label}`);

export class Save {
  private readonly dialog = element("dialog", { id: "save", "aria-labelledby": "save-title" });
  private readonly size = element("select", { id: "save-size" });
  private readonly width = numeric("save-width", "width in pixels");
  private readonly height = numeric("save-height", "height in pixels");
  private readonly scheme = element("select", { id: "save-colours" });
  private readonly from = numeric("save-from", "from, in seconds");
  private readonly to = numeric("save-to", "to, in seconds");
  private readonly speed = element("select", { id: "save-speed" });
  private readonly rate = element("select", { id: "save-rate" });
  private readonly told = element("p", { id: "save-told", role: "status" });
  private readonly bar = element("progress", {
    max: "1",
    value: "0",
    "aria-label": "frames made",
    hidden: "",
  });
  private readonly go = element("button", { id: "save-go", class: "main", type: "submit" }, "Save");
  private readonly stop = element("button", { id: "save-stop", type: "button" }, "Cancel");
  private running: AbortController | null = null;

  constructor(
    private readonly picture: Picture,
    private readonly time: Timeline,
    private readonly playback: Playback,
    private readonly name: string,
  ) {
    this.fill();
    document.body.append(this.dialog);
    const open = by_id<HTMLButtonElement>("save-open");
    open.hidden = picture.stage === null;
    open.addEventListener("click", () => this.open());
  }

  private get kind(): Kind {
    return (this.dialog.querySelector<HTMLInputElement>("input[name=kind]:checked")?.value ?? "png") as Kind;
  }
  private checked(id: string) {
    return by_id<HTMLInputElement>(id).checked;
  }

  private fill() {
    const { dialog, time } = this;
    options(this.size, ...sizes.map((s): [string, string] => [s, s.replace("x", "\u00d7")]), [
      "other",
      "other\u2026",
    ]);
    options(this.scheme, ["", "as on the screen"], ["light", "light"], ["dark", "dark"]);
    this.speed.append(...[...by_id<HTMLSelectElement>("speed").options].map((o) => o.cloneNode(true)));
    options(this.rate, ...rates.map((r): [string, string] => [String(r), String(r)]));
    const choice = element(
      "fieldset",
      { class: "kinds" },
      element("legend", { class: "unseen" }, "what"),
      ...kinds.map(([kind, label], i) =>
        element(
          "label",
          {},
          element("input", { type: "radio", name: "kind", value: kind, ...(i === 0 && { checked: "" }) }),
          element("span", {}, label),
        ),
      ),
    );
    const form = element(
      "form",
      { method: "dialog" },
      element("h2", { id: "save-title" }, "Save the picture"),
      choice,
      field("size", this.size),
      element("p", { class: "pair", id: "save-own" }, this.width, " \u00d7 ", this.height, " px"),
      field("colours", this.scheme),
      element(
        "p",
        { class: "boxes" },
        box("save-names", "names of bodies"),
        box("save-clock", "time"),
        box("save-clear", "no background"),
      ),
      element(
        "div",
        { id: "save-course" },
        element("p", { class: "pair" }, "from ", this.from, " to ", this.to, " s"),
        field("speed", this.speed),
        field("frames per second", this.rate),
      ),
      element("p", { class: "note" }, "From where you look now, with what is switched on below the picture."),
      this.told,
      this.bar,
      element("p", { class: "buttons" }, this.stop, this.go),
    );
    dialog.append(form);
    const places = time.span / 1000;
    [this.from.value, this.to.value] = [String(time.start), String(time.end)];
    for (const input of [this.from, this.to])
      input.step = String(places > 0 ? 10 ** Math.floor(Math.log10(places)) : 1);
    for (const input of [this.width, this.height])
      [input.min, input.max, input.step] = [String(least_size), String(most_size), "1"];
    form.noValidate = true; // what is wrong is said in our words
    this.follow(form, choice);
  }

  private follow(form: HTMLFormElement, choice: HTMLElement) {
    form.addEventListener("submit", (e) => {
      e.preventDefault();
      void this.save();
    });
    form.addEventListener("change", (e) => {
      if (e.target instanceof HTMLInputElement && e.target.name === "kind") this.as_usual();
      this.show();
    });
    form.addEventListener("input", () => this.show());
    this.stop.addEventListener("click", () => this.cancel());
    this.dialog.addEventListener("cancel", (e) => {
      e.preventDefault();
      this.cancel();
    });
    if (!(this.time.span > 0))
      for (const radio of choice.querySelectorAll("input")) radio.disabled = !is_still(radio.value as Kind);
  }
  private cancel() {
    if (this.running) this.running.abort();
    else this.dialog.close();
  }

  private open() {
    this.playback.stop();
    this.as_usual();
    this.speed.value = by_id<HTMLSelectElement>("speed").value;
    by_id<HTMLInputElement>("save-names").checked = this.checked("show-names");
    this.bar.hidden = true;
    this.show();
    this.dialog.showModal();
  }
  private as_usual() {
    const { size, rate } = usual[this.kind];
    this.size.value = size;
    this.rate.value = String(rate);
    [this.width.value, this.height.value] = size.split(" x ");
  }

  private look(): Look {
    const [width, height] =
      this.size.value === "other"
        ? [Number(this.width.value), Number(this.height.value)]
        : this.size.value.split(" x ").map(Number);
    return {
      width,
      height,
      scheme: (this.scheme.value || null) as Scheme,
      is_clear: is_still(this.kind) && this.checked("save-clear"),
      names: this.checked("save-names"),
      clock: this.checked("save-clock"),
    };
  }
  private course(): Course {
    const { start, end } = this.time;
    const inside = (input: HTMLInputElement) =>
      input.value === "" ? NaN : Math.min(Math.max(Number(input.value), start), end);
    return {
      from: is_still(this.kind) ? this.time.now : inside(this.from),
      to: inside(this.to),
      speed: Number(this.speed.value),
      rate: Number(this.rate.value),
    };
  }

  /** What fits the kind, and how many frames it makes. */
  private show() {
    const { kind } = this,
      is_one = is_still(kind),
      course = this.course();
    by_id("save-own").hidden = this.size.value !== "other";
    by_id("save-course").hidden = is_one;
    by_id("save-clock").parentElement!.hidden = kind === "svg";
    by_id("save-clear").parentElement!.hidden = !is_one;
    this.go.textContent = `Save ${kind === "webm" ? "WebM" : kind.toUpperCase()}`;
    this.told.className = "";
    try {
      if (this.kind === "webm" && !can_encode())
        throw new Error("This browser cannot encode video: choose GIF");
      const n = is_one ? 1 : instants_of(course).length;
      this.told.textContent = is_one
        ? `at ${seconds(course.from, this.time.span)} s`
        : `${n} frames, ${number(n / course.rate, 3)} s long`;
      this.go.disabled = false;
    } catch (error) {
      this.say(error);
      this.go.disabled = true;
    }
  }
  private say(error: unknown) {
    this.told.className = "bad";
    this.told.textContent = error instanceof Error ? error.message : String(error);
  }

  private async save() {
    const { kind, bar, go, time } = this,
      course = this.course(),
      running = (this.running = new AbortController());
    go.disabled = true;
    bar.hidden = is_still(kind);
    bar.value = 0;
    try {
      const when = is_still(kind) ? [`${seconds(course.from, time.span)}s`] : [];
      const told = (share: number) => {
        bar.value = share;
        this.told.textContent = `${Math.round(100 * share)} %`;
      };
      const data = await record(kind, this.picture.screen(), this.look(), course, told, running.signal);
      hand_over(data, file_name(this.name, ...when, `.${kind}`));
      this.dialog.close();
    } catch (error) {
      if (running.signal.aborted) this.show();
      else this.say(error);
    } finally {
      this.running = null;
      bar.hidden = true;
      go.disabled = false;
    }
  }
}
