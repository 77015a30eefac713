// SPDX-License-Identifier: BSD-3-Clause
// Tabs as assistive technology knows them: one is reached by Tab, the others from there by arrows.
import { by_id } from "./text";

export const tab_names = ["motion", "quality", "compare", "about"];

export class Tabs {
  now = tab_names[0];

  constructor(private readonly opened: (name: string) => void) {
    for (const tab of tab_names) by_id(`tab-${tab}`).addEventListener("click", () => this.open(tab));
    by_id("tabs").addEventListener("keydown", (e) => this.press(e));
  }
  open(name: string, is_focused = false) {
    this.now = name;
    for (const tab of tab_names) {
      const button = by_id(`tab-${tab}`),
        is_open = tab === name;
      button.setAttribute("aria-selected", String(is_open));
      button.tabIndex = is_open ? 0 : -1;
      by_id(tab).hidden = !is_open;
      if (is_open && is_focused) button.focus();
    }
    this.opened(name);
  }
  private press(e: KeyboardEvent) {
    const at = tab_names.findIndex((tab) => by_id(`tab-${tab}`) === document.activeElement),
      n = tab_names.length;
    const to: Record<string, number> = { ArrowLeft: at + n - 1, ArrowRight: at + 1, Home: 0, End: n - 1 };
    if (to[e.key] === undefined) return;
    e.preventDefault();
    e.stopPropagation();
    this.open(tab_names[to[e.key] % n], true);
  }
}
