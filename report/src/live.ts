// SPDX-License-Identifier: BSD-3-Clause
// A page that follows the program which serves it: a scenario is solved and shown again whenever it is saved, and what is
// wrong with it is said here as it is on the terminal, while the last motion stays.
import { data_of, type Data, type Meta } from "./data";
import { by_id } from "./text";

interface Told {
  number: number;
  file: string;
  said: string; // errors or warnings, as the program prints them
}
interface Shown extends Told {
  run: Meta;
  numbers: string;
}

const patience = 400; // ms, after which it is worth a word that something is being solved

class Bar {
  private readonly bar = by_id("live");
  private soon = 0;

  show(text: string, said: string, grade: "bad" | "doubtful" | "") {
    clearTimeout(this.soon);
    const [lead, listing] = this.bar.children as unknown as [HTMLElement, HTMLElement];
    this.bar.hidden = text === "";
    this.bar.className = grade;
    lead.textContent = text;
    listing.textContent = said;
    listing.hidden = said === "";
    dispatchEvent(new Event("resize")); // what lies below has another height
  }
  show_soon(text: string) {
    clearTimeout(this.soon);
    this.soon = window.setTimeout(() => this.show(text, "", ""), patience);
  }
}

/** `number`: of the run that the page holds. */
export function follow(number: number, show: (data: Data) => void) {
  const source = new EventSource(`events?${number}`),
    bar = new Bar();
  let newest = number,
    has_run = number > 0,
    again = () => {};
  const on = <T extends Told>(kind: string, act: (told: T) => void | Promise<void>) =>
    source.addEventListener(kind, (e) => {
      const told = JSON.parse((e as MessageEvent<string>).data) as T;
      if (told.number <= newest) return; // it was sent again
      newest = told.number;
      void act(told);
    });
  const say = (text: string, said = "", grade: "bad" | "doubtful" | "" = "") => {
    again = () => bar.show(text, said, grade);
    again();
  };
  on<Shown>("run", async ({ number: mine, file, said, run, numbers }) => {
    const data = await data_of(run, numbers);
    if (mine !== newest) return; // a newer one came meanwhile
    try {
      show(data);
    } catch (error) {
      say(
        `${file} was solved, but this page could not be shown: ${String(error)}. Load it again.`,
        said,
        "bad",
      );
      return;
    }
    has_run = true;
    say(said && `${file}: solved, with warnings`, said, "doubtful");
  });
  on("fault", ({ file, said }) => {
    const below = has_run ? " The motion below is of the version before." : "";
    say(`${file} could not be solved.${below}`, said, "bad");
  });
  on("solving", ({ file }) => bar.show_soon(`Solving ${file}\u2026`));
  source.onopen = () => again();
  source.onerror = () =>
    bar.show("livens view has ended or cannot be reached: nothing new is shown.", "", "doubtful");
}
