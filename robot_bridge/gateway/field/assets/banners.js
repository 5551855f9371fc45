/** What the page says above the map, each until it is over or was read. */

import { tr } from "/field/texts.js";

/** Return a new element with a text. */
export function element(name, text = "") {
  const made = document.createElement(name);
  made.textContent = text;
  return made;
}

/** Show in the panel's element `id` what became of what was asked. */
export function showAnswer(id, text, refused) {
  const place = document.getElementById(id);
  place.textContent = text;
  place.classList.toggle("refused", refused);
}

export class Banners {
  constructor(place) {
    this._place = place;
    this._shown = new Map();
  }

  has(id) {
    return this._shown.has(id);
  }

  /** Show a text with an element behind it in place of what `id` said before; without a text nothing any more. */
  show(id, text, more = null, kind = "") {
    let one = this._shown.get(id);
    if (!text) {
      one?.remove();
      this._shown.delete(id);
      return;
    }
    if (!one) {
      one = element("p");
      this._place.append(one);
      this._shown.set(id, one);
    }
    one.className = kind;
    if (one.firstChild?.textContent === text && !more) return;
    one.replaceChildren(text, ...(more ? [more] : []));
  }

  /** Show a text that stays until somebody has read it and closes it. */
  showUntilRead(id, text, isBad = true) {
    const button = element("button", tr("Close"));
    button.type = "button";
    button.onclick = () => this.show(id, "");
    this.show(id, text, button, isBad ? "bad" : "");
  }
}
