/** How much of robots a phone asks for, and how often: its contract has a budget, and a busy hour ends. */

/** Bytes a minute that positions may take. */
const BUDGET = 900_000;
/** From all of each robot to places alone, ever more seldom (Hz). */
const STEPS = [{ form: "columns", rate: 1 }, ...[1, 0.5, 0.25, 0.1, 0.05].map((rate) => ({ form: "places", rate }))];
/** So many times as much as its place takes all that is told of a robot, about. */
const COLUMNS_COST = 6;
/** Seconds after which too much is too much, and after which more is tried. */
const TOO_MUCH_AFTER = 5, MORE_AFTER = 60, MORE_AFTER_AT_MOST = 960;
/** The part of the budget that the next step may be expected to take. */
const MARGIN = 0.8;

const cost = ({ form, rate }) => rate * (form === "columns" ? COLUMNS_COST : 1);

export class PositionBudget {
  constructor() {
    this._at = 0;
    this._seconds = [];
    this._moreAfter = MORE_AFTER;
    this._hasTried = false;
  }

  /** The form and the rate of the subscription that is to be. */
  get step() {
    return STEPS[this._at];
  }

  /** Note once a second how many bytes of positions came so far; return whether the step is another now. */
  note(received) {
    this._seconds.push(received);
    if (this._seconds.length > MORE_AFTER_AT_MOST + 1) this._seconds.shift();
    if (this._isTooMuch()) return this._choose(this._at + 1);
    if (this._seconds.length <= this._moreAfter) return false;
    this._hasTried = false;
    const more = STEPS[this._at - 1];
    if (!more || (this._inLast(MORE_AFTER) * cost(more)) / cost(this.step) > MARGIN * BUDGET) return false;
    return this._choose(this._at - 1);
  }

  /** Begin to count anew: another connection, or another way to get positions. */
  restart() {
    this._seconds = [];
  }

  _isTooMuch() {
    // Two updates at least: one that comes every ten seconds is not to be taken for ten of them.
    const seconds = Math.max(TOO_MUCH_AFTER, 2 / this.step.rate);
    return this._at + 1 < STEPS.length && this._seconds.length > seconds && (this._inLast(seconds) / seconds) * 60 > BUDGET;
  }

  _inLast(seconds) {
    return this._seconds.at(-1) - this._seconds.at(-1 - seconds);
  }

  _choose(at) {
    const isMore = at < this._at;
    // What was tried and was too much is tried more seldom.
    if (isMore) this._hasTried = true;
    else this._moreAfter = this._hasTried ? Math.min(2 * this._moreAfter, MORE_AFTER_AT_MOST) : MORE_AFTER;
    this._at = at;
    this._seconds = [this._seconds.at(-1)];
    return true;
  }
}
