/** The list of robots in the menu, and the search for one of a large fleet at the gateway. */

import { element } from "/field/banners.js";
import { steadyNow } from "/field/connection.js";
import { tr } from "/field/texts.js";

const LISTED = 50;
/** Milliseconds that keys have to be still before the gateway is asked. */
const STILL_MS = 250;
/** Milliseconds after which a list that stays open is asked for again. */
const LISTED_FOR_MS = 5000;
/** Milliseconds for which a list stays as it is after a finger left it: the click comes later. */
const FINGER_MS = 300;

/** Return the state of a robot as it is, or as it was where the gateway is not heard; of one that is fresh and not believed where. */
export function stateOf({ state, doubt }, isCurrent) {
  if (doubt) return state === "fresh" ? tr("may be elsewhere") : `${known(state, isCurrent)}, ${tr("may be elsewhere")}`;
  return known(state, isCurrent);
}

function known(state, isCurrent) {
  return isCurrent ? tr(state) : tr("was {state}", { state: tr(state) });
}

/** Event: `robot` (detail: the name of the one that was chosen). */
export class RobotList extends EventTarget {
  /** `search` is where a part of a name is typed, `list` has the robots, `more` says how many there are besides. */
  constructor(connection, { search, list, more }) {
    super();
    this._connection = connection;
    this._parts = { search, list, more };
    this._isHeld = false;
    this.forget();
    search.addEventListener("input", () => this._typed());
    // No other robot may come under a finger that is down on the list.
    list.addEventListener("pointerdown", () => {
      clearTimeout(this._lifting);
      this._isHeld = true;
    });
    // A long press is a pointercancel, and a click all the same.
    for (const type of ["pointerup", "touchend", "touchcancel"]) {
      window.addEventListener(type, () => {
        clearTimeout(this._lifting);
        this._lifting = setTimeout(() => (this._isHeld = false), FINGER_MS);
      });
    }
  }

  /** Know no robot any more: those of another fleet are others. */
  forget() {
    this._known = { robots: new Map(), fleet: null, isCurrent: false };
    this._found = { robots: new Map(), count: 0, at: -Infinity };
  }

  /** Return a robot that was found at the gateway, with when that was. */
  found(name) {
    return this._found.robots.get(name);
  }

  /** Ask the gateway again when the list is shown next. */
  renew() {
    this._found.at = -Infinity;
  }

  /** Show robots by name; of a large `fleet` those that the gateway finds, as the page knows them. */
  show(robots, fleet, isCurrent) {
    this._known = { robots, fleet, isCurrent };
    this._show();
  }

  _show() {
    const { robots, fleet, isCurrent } = this._known, { search, list, more } = this._parts;
    const wanted = search.value.trim().toLowerCase();
    if (this._isHeld) return;
    if (fleet && steadyNow() - this._found.at > LISTED_FOR_MS) this._find();
    const known = fleet ? this._found.robots : robots;
    const names = [...known.keys()].filter((name) => name.toLowerCase().includes(wanted)).sort();
    const shown = names.slice(0, LISTED);
    while (list.children.length > shown.length) list.lastChild.remove();
    shown.forEach((name, k) => {
      const button = list.children[k]?.firstChild ?? this._addButton(), one = robots.get(name) ?? known.get(name);
      button.dataset.robot = name;
      const text = `${name}: ${stateOf(one, isCurrent)}`;
      if (button.textContent !== text) button.textContent = text;
    });
    const unlisted = (fleet ? this._found.count : names.length) - shown.length;
    more.textContent = unlisted > 0 ? tr("{n} more: search for them", { n: unlisted }) : names.length ? "" : tr("no robots");
  }

  _addButton() {
    const button = element("button"), item = element("li");
    button.type = "button";
    button.onclick = () => this.dispatchEvent(new CustomEvent("robot", { detail: button.dataset.robot }));
    item.append(button);
    this._parts.list.append(item);
    return button;
  }

  _typed() {
    this._show();
    clearTimeout(this._typing);
    if (this._known.fleet) this._typing = setTimeout(() => this._find(), STILL_MS);
  }

  /** Search at the gateway, which knows robots that the page is not told of. */
  async _find() {
    clearTimeout(this._typing);
    this._found.at = steadyNow();
    const asked = (this._asked = { text: this._parts.search.value.trim(), limit: LISTED });
    const answer = await this._connection.ask("find_robots", asked).catch(() => null);
    // Another text was typed meanwhile, or there was no answer: it is asked for again.
    if (answer === null || asked !== this._asked) return;
    const at = steadyNow(), robots = new Map(answer.robots.map((one) => [one.robot, { ...one, at }]));
    this._found = { robots, count: answer.count, at };
    this._show();
  }
}
