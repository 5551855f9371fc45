/** The emergency stop: sent at the touch, again until it is answered, and never silent about it. */

import { newId, SILENT_AFTER_MS, steadyNow } from "/field/connection.js";
import { tr } from "/field/texts.js";

const FIRST_TRY_MS = 900;
const NEXT_TRY_MS = 2000;
const BETWEEN_MS = 300;
/** Milliseconds after which the last report is no longer what holds now: one comes each second. */
const OLD_AFTER_MS = SILENT_AFTER_MS + 1000;
const ARMED_MS = 4000;
/** Shown as many names as fit. */
const NAMES = 5;

export class EmergencyStop {
  /** `who` returns the role of this phone, null where it is not signed in, "" where that is not known yet. */
  constructor(connection, { button, state, clear }, who) {
    this._connection = connection;
    this._button = button;
    this._state = state;
    this._clear = clear;
    this._who = who;
    this._trying = null;
    this._report = null;
    this._reportedAt = -Infinity;
    this._failure = "";
    /** The stop of which a supervisor pressed once that it be cleared. */
    this._armed = null;
    // At the touch, and for a second thumb on the glass as well, for which there is no click.
    button.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      button.classList.add("pressed");
      this.press();
    });
    for (const type of ["pointerup", "pointercancel", "pointerleave"]) {
      button.addEventListener(type, () => button.classList.remove("pressed"));
    }
    button.addEventListener("keydown", (event) => {
      if ((event.key === "Enter" || event.key === " ") && !event.repeat) this.press();
    });
    // Assistive programs send a click alone.
    button.addEventListener("click", (event) => event.detail === 0 && event.pointerType === "" && this.press());
    clear.addEventListener("click", () => this._pressedClear());
    setInterval(() => this._trying && this.show(), 200);
  }

  /** Stop every robot. What was begun goes on until it is answered. */
  press() {
    navigator.vibrate?.(80);
    const role = this._who();
    this._failure = "";
    if (role === null) {
      this._failure = tr("NOT STOPPED: {reason}", { reason: tr("this phone is not signed in. Use the robots' own stop buttons.") });
    } else if (role === "viewer") {
      this._failure = tr("NOT STOPPED: {reason}", {
        reason: tr("your role, {role}, may not stop robots. Use the robots' own stop buttons.", { role }),
      });
    } else if (!this._trying) {
      this._trying = { command: newId(), since: steadyNow() };
      this._try(this._trying);
    }
    this.show();
  }

  /** Take over what the gateway says of the stop. */
  update(report) {
    // What was not stopped, or not cleared, is over with the next stop.
    if (report.in_force !== this._report?.in_force || report.stop !== this._report?.stop) this._failure = "";
    if (this._trying && this._trying.command === report.stop && !report.in_force) {
      // It has arrived, and is over. Asked again it would be another one.
      this._trying = null;
      this._failure = clearedSince(report);
    }
    this._report = report;
    this._reportedAt = steadyNow();
    if (this._armed && this._armed.stop !== report.stop) this._disarm();
    this.show();
  }

  /** Say no more of what holds: nobody is signed in. */
  forget() {
    this._report = null;
    this.show();
  }

  show() {
    const lines = [], waited = this._trying ? (steadyNow() - this._trying.since) / 1000 : 0;
    if (this._trying) {
      lines.push(
        waited < FIRST_TRY_MS / 1000
          ? tr("Sending the stop…")
          : tr("NOT CONFIRMED for {s} s: the gateway does not answer. Use the robots' own stop buttons. It is tried again.", { s: waited.toFixed(0) || 1 }),
      );
    }
    if (this._failure) lines.push(this._failure);
    const stop = this._report, age = steadyNow() - this._reportedAt;
    if (stop?.in_force && age > OLD_AFTER_MS) {
      lines.push(tr("A stop by {who} was in force {s} s ago. It may have been cleared since: the gateway does not answer.", { who: stop.by, s: Math.round(age / 1000) }));
    } else if (stop?.in_force) {
      lines.push(
        tr("STOP IN FORCE, by {who}: {acknowledged} of {robots} robots have answered, {standing} stand.", { ...stop, who: stop.by }),
      );
      if (stop.moving.length) lines.push(tr("MOVING: {robots}", { robots: named(stop.moving, stop.moving_more) }));
      if (stop.unheard.length) lines.push(tr("Not heard now, may move: {robots}", { robots: named(stop.unheard, stop.unheard_more) }));
      if (stop.gateways) lines.push(tr("At {reached} of {of} gateways.", stop.gateways));
      if (stop.gateways?.missing.length) lines.push(tr("NOT REACHED: gateways {names}. Watch their robots.", { names: named(stop.gateways.missing) }));
      if (stop.waiting.length) lines.push(tr("Not answered: {robots}", { robots: named(stop.waiting) }));
      if (stop.refused.length) lines.push(tr("Refused: {robots}", { robots: named(stop.refused) }));
      if (!stop.stored) lines.push(tr("It is not in the database yet; it holds all the same."));
    }
    const text = lines.join(" ");
    if (this._state.textContent !== text) this._state.textContent = text;
    this._state.classList.toggle("bad", Boolean(this._trying || this._failure || stop?.in_force));
    this._button.textContent = tr("EMERGENCY STOP");
    this._clear.hidden = !(stop?.in_force && this._who() === "supervisor" && this._connection.isUp);
    this._clear.textContent = tr(this._armed ? "Press again to clear it: robots may drive" : "Clear the emergency stop");
  }

  async _try(stop) {
    for (let within = FIRST_TRY_MS, aside = false; this._trying === stop; within = NEXT_TRY_MS, aside = true) {
      const params = { command: stop.command, reason: "field page" };
      try {
        const report = aside
          ? await this._connection.askAside("emergency_stop", params, within)
          : await this._connection.ask("emergency_stop", params, within);
        this._trying = null;
        this.update(report);
        if (!report.in_force) {
          // It was answered late, and is over: who pressed does not know of either.
          this._failure = clearedSince(report);
          this.show();
        }
      } catch (error) {
        if (this._trying !== stop) return;
        if (!error.silent) {
          this._trying = null;
          this._failure = tr("NOT STOPPED: {reason}", { reason: error.message });
          this.show();
        } else if (this._who() === null) {
          this._trying = null;
          this.press();
        } else {
          this.show();
          await new Promise((resolve) => setTimeout(resolve, BETWEEN_MS));
        }
      }
    }
  }

  _pressedClear() {
    if (!this._armed) {
      this._armed = { stop: this._report.stop, timer: setTimeout(() => this._disarm(), ARMED_MS) };
      this.show();
      return;
    }
    const { stop } = this._armed;
    this._disarm();
    this._connection.ask("clear_emergency_stop", { reason: "cleared at the field page", stop }).then(
      (report) => this.update(report),
      (error) => {
        this._failure = error.silent
          ? tr("No answer: it is not known whether the stop was cleared.")
          : tr("Refused: {reason}", { reason: error.message });
        this.show();
      },
    );
  }

  _disarm() {
    clearTimeout(this._armed?.timer);
    this._armed = null;
    this.show();
  }
}

function clearedSince(report) {
  return tr("The stop was in force, and {who} has cleared it since.", { who: report.cleared_by ?? "?" });
}

function named(robots, more = 0) {
  const beyond = Math.max(0, robots.length - NAMES) + more;
  return robots.slice(0, NAMES).join(", ") + (beyond ? ` +${beyond}` : "");
}
