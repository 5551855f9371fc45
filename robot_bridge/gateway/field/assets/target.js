/** The panel in which the target of one robot is made: by a tap on the map, or by coordinates. */

import { showAnswer } from "/field/banners.js";
import { newId } from "/field/connection.js";
import { tr } from "/field/texts.js";

const by = (id) => document.getElementById(id);

export class TargetPanel {
  constructor(map) {
    this._map = map;
    this._place = null;
    /** The target that is being made: its robot, and the id that it keeps however often it is sent. */
    this.draft = null;
    map.addEventListener("place", ({ detail }) => this._choose(detail));
    by("place-crs").addEventListener("change", () => this.label());
    by("place-form").addEventListener("submit", (event) => event.preventDefault());
  }

  get isOpen() {
    return !by("target-panel").hidden;
  }

  begin(robot, byCoordinates) {
    this.draft = { robot, command: null, params: "" };
    this._place = null;
    this._map.markTarget(null);
    this._map.isChoosing = !byCoordinates;
    by("map").classList.toggle("choosing", !byCoordinates);
    by("place-form").hidden = !byCoordinates;
    by("cone").checked = false;
    by("target-panel").hidden = false;
    this.answer("");
    by("target-title").textContent = tr("Target of {robot}", { robot });
    by("target-help").textContent = tr(byCoordinates ? "Enter the coordinates, then send." : "Tap the place on the map.");
    by("send").disabled = !byCoordinates;
    this.label();
    this._map.lookAt(robot, by("target-panel").offsetHeight);
  }

  end() {
    this.draft = null;
    this._map.isChoosing = false;
    by("map").classList.remove("choosing");
    this._map.markTarget(null);
    by("target-panel").hidden = true;
  }

  /** Show what became of the target that was sent. */
  answer(text, refused = false) {
    showAnswer("target-answer", text, refused);
  }

  /** Write what the two coordinates are, in the language of the page. */
  label() {
    const geographic = by("place-crs").value === "EPSG:4326";
    by("place-x-label").textContent = tr(geographic ? "Longitude, degrees" : "x (easting), metres");
    by("place-y-label").textContent = tr(geographic ? "Latitude, degrees" : "y (northing), metres");
  }

  /** Return the command that sends the robot there; throws an Error that says which coordinate is none. */
  order() {
    const { draft } = this;
    const where = by("place-form").hidden ? { x: this._place.lng, y: this._place.lat, crs: "EPSG:4326" } : this._entered();
    const params = { ...where, cone: by("cone").checked }, said = JSON.stringify(params);
    // Sent again after no answer it is the same, and done once; another place is another one.
    if (draft.params !== said) Object.assign(draft, { command: newId(), params: said });
    return { command: draft.command, robot: draft.robot, op: "SetPosEnd", params };
  }

  _choose(place) {
    this._place = place;
    this._map.markTarget(place);
    by("target-help").textContent = tr("To {place}. Tap elsewhere to change it, then send.", {
      place: `${place.lat.toFixed(6)}, ${place.lng.toFixed(6)}`,
    });
    by("send").disabled = false;
  }

  _entered() {
    const numbers = [by("place-x"), by("place-y")].map((input) => {
      const text = input.value.trim().replace(",", ".");
      if (text === "" || !Number.isFinite(Number(text))) throw new Error(tr("{text} is not a number", { text: text || "–" }));
      return Number(text);
    });
    return { x: numbers[0], y: numbers[1], crs: by("place-crs").value };
  }
}
