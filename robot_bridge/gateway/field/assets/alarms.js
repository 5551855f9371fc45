/** What is wrong in the fleet, as the gateway says it, in a list and as a number on the button of the menu. */

import { element } from "/field/banners.js";
import { tr } from "/field/texts.js";

const LISTED = 50;

export class Alarms {
  /** `list` has the texts; how many there are stands on `button` while `menu` is closed. */
  constructor({ list, menu, button }) {
    this._parts = { list, menu, button };
    this.forget();
  }

  forget() {
    this._of = { geofence: [], nearness: [], links: [], suspensions: [] };
    this._unlisted = { geofence: 0, nearness: 0 };
  }

  /** Take in what the gateway says of alarms; anything else is none. */
  update(method, params) {
    if (method === "geofence") this._of.geofence = params.alarms.filter((one) => one.current);
    else if (method === "nearness") this._of.nearness = params.alarms;
    else if (method === "links") this._of.links = params.links.filter((one) => !one.up);
    else if (method === "suspensions") this._of.suspensions = params.robots;
    // The gateway lists the newest of a geofence, the soonest of nearness, and counts the others.
    if (method in this._unlisted) this._unlisted[method] = params.more;
  }

  /** Show alarms with the lost ones and those that may be elsewhere among `robots`; of a large `fleet` the gateway counts those. */
  show(robots, fleet) {
    const { geofence, nearness, links, suspensions } = this._of, { list, menu, button } = this._parts;
    const lost = [...robots.values()].filter((one) => one.state === "lost");
    const doubted = new Set([...robots.values()].filter((one) => one.doubt).map(({ robot }) => robot));
    const unsure = (...names) => names.filter((name) => doubted.has(name)).map((robot) => `; ${tr("{robot} may be elsewhere", { robot })}`).join("");
    const texts = [
      ...lost.map(({ robot }) => tr("{robot} is lost", { robot })),
      ...[...doubted].map((robot) => tr("{robot} may be elsewhere", { robot })),
      ...geofence.map((one) => tr("{robot} is in {name}", one)),
      ...nearness.map((one) => tr("{seen} is {m} m from {robot}", { ...one, m: one.metres.toFixed(1) }) + unsure(one.seen, one.robot)),
      ...links.map((one) => tr("link {link}: {text}", one)),
      ...suspensions.map((one) => tr("robot {robot} is kept out: {text}", { robot: one.robot, text: one.reason })),
    ];
    // Of a large fleet the first thousand that are lost are named.
    const unnamed = Math.max((fleet?.lost ?? 0) - lost.length, 0) + this._unlisted.geofence + this._unlisted.nearness;
    const alarms = texts.length + unnamed;
    const text = alarms ? `${tr("Menu")} (${alarms} !)` : tr("Menu");
    if (menu.hidden && button.textContent !== text) button.textContent = text;
    const said = alarms ? texts.slice(0, LISTED) : [tr("none")];
    if (alarms > said.length) said.push(tr("{n} more alarms", { n: alarms - said.length }));
    if (list.dataset.said === said.join("\n")) return;
    list.dataset.said = said.join("\n");
    list.replaceChildren(...said.map((one) => element("li", one)));
  }
}
