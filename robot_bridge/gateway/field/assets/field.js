/** The field page: wires the connection, the map, the emergency stop and what is said of robots. */

import { Alarms } from "/field/alarms.js";
import { Banners, element } from "/field/banners.js";
import { PositionBudget } from "/field/budget.js";
import { AnswerError, Connection, fetchSite, newId, otherPages, SILENT_AFTER_MS, steadyNow } from "/field/connection.js";
import { SiteMap } from "/field/map.js";
import { OwnPosition } from "/field/own-position.js";
import { RobotList } from "/field/robot-list.js";
import { RobotPanel } from "/field/robot-panel.js";
import { EmergencyStop } from "/field/stop.js";
import { TargetPanel } from "/field/target.js";
import { firstLanguage, LANGUAGES, setLanguage, tr, translatePage } from "/field/texts.js";
import { ViewChoice } from "/field/view.js";

const TOKEN = "fleet-field-token", LANGUAGE = "fleet-field-language";
/** Milliseconds that the map has to be still before the gateway is asked for what it shows. */
const STILL_MS = 250;
/** Milliseconds after which the site is asked for again where it did not come, or not the one that is served. */
const SITE_AGAIN_MS = 2000;
const by = (id) => document.getElementById(id);

class Field {
  constructor() {
    this.robots = new Map();
    this.tasks = new Map();
    this.account = null;
    /** Whether a token is tried of which the gateway has not said yet that it does not hold. */
    this.isSigningIn = false;
    /** The database and the frame of the gateway: of others, the same names and metres are other robots and places. */
    this.database = null;
    this.frame = null;
    /** Whether the positions are of the link that there is. */
    this.isCurrent = false;
    /** How often something was pressed that holds robots. */
    this.holds = 0;
    this.resumes = 0;
    this.others = [];
    this.selected = null;
    this.site = null;
    this.traffic = [];
    this.budget = new PositionBudget();
    this.views = new ViewChoice();
    /** How the gateway counts the fleet, null where all robots are told. */
    this.fleet = null;
    this.connection = new Connection();
    this.list = new RobotList(this.connection, { search: by("search"), list: by("robots"), more: by("robots-more") });
    this.alarms = new Alarms({ list: by("alarms"), menu: by("menu"), button: by("menu-button") });
    this.map = new SiteMap(by("map"));
    this.target = new TargetPanel(this.map);
    this.stop = new EmergencyStop(
      this.connection,
      { button: by("stop"), state: by("stop-state"), clear: by("clear") },
      () => this.account?.role ?? (this.isSigningIn ? "" : null),
    );
    this.banners = new Banners(by("banners"));
    this.panel = new RobotPanel();
    this.ownPosition = new OwnPosition(this.map, this.banners);
    this._listenToGateway();
    this._listenToPage();
    setInterval(() => this._tick(), 1000);
  }

  async begin() {
    this._chooseLanguage(firstLanguage(stored(LANGUAGE), navigator.languages ?? []));
    const given = new URLSearchParams(location.hash.slice(1)).get("token");
    const misplaced = new URLSearchParams(location.search).has("token");
    // A token is neither to stay in the address nor in the history.
    if (given !== null || misplaced) history.replaceState(null, "", location.pathname);
    if (misplaced) {
      this._showLogin(tr("A token in the address is in logs and histories. Have it replaced, and sign in below."));
      return;
    }
    await this._signIn(given ?? stored(TOKEN) ?? "", { quietly: given === null });
  }

  // --- the account

  async _signIn(token, { remember = false, quietly = false } = {}) {
    clearTimeout(this._retry);
    const attempt = (this._attempt = {});
    this._setConnection("connecting");
    // A stop goes out with it already, however long the site takes.
    this.connection.token = token;
    this.isSigningIn = true;
    let answer;
    try {
      answer = await fetchSite(token);
      if (attempt !== this._attempt) return;
    } catch {
      if (attempt !== this._attempt) return;
      // Not reached: the page tries on, and signs in when there is a network again.
      this._retry = setTimeout(() => this._signIn(token, { remember, quietly }), 2000);
      this._setConnection("none");
      return;
    }
    if (answer.status === 401 || answer.status === 403 || answer.status === 429) {
      const reason = await answer.text();
      this._showLogin(quietly && !token ? "" : reason);
      return;
    }
    keep(TOKEN, token, remember || localStorage.getItem(TOKEN) === token);
    by("login").hidden = true;
    this.token = token;
    // Robots and the stop before the site, which may be long on its way.
    this.connection.start(token);
    await this._readSite(answer).catch(() => {});
    this._siteAgain();
  }

  _showLogin(reason) {
    this.account = null;
    this.isSigningIn = false;
    this.stop.forget();
    by("login-reason").textContent = reason;
    by("login").hidden = false;
    this._setConnection("out");
    by("token").focus();
  }

  _signOut(reason = "") {
    clearTimeout(this._retry);
    this._attempt = null;
    keep(TOKEN, "", false);
    this.connection.stop();
    this._select(null);
    this._close("menu");
    this._showLogin(reason);
  }

  async _readSite(answer) {
    if (!answer.ok) {
      this.banners.show("site", tr("The site is not drawn: {reason}", { reason: await answer.text() }));
      return;
    }
    const site = await answer.json(), before = this.site;
    // Asked for before the gateway was another one.
    if (this.frame !== null && !isSame(site.frame, this.frame)) return;
    this.banners.show("site", "");
    if (["id", "version", "gateway"].every((fact) => site[fact] === before?.[fact])) return;
    this.site = site;
    by("site").textContent = document.title = site.name;
    this.map.showSite(site, site.id === before?.id);
    this.views.restart();
    this._renewView();
    if (site.left_out.length) this.banners.show("left-out", tr("Too much to draw: {what} are not all shown.", { what: site.left_out.join(", ") }));
    const mine = document.querySelector('meta[name="gateway"]').content;
    if (site.gateway !== mine) this._offerReload(mine, site.gateway);
  }

  _offerReload(old, fresh) {
    const button = element("button", tr("Load the new page"));
    button.type = "button";
    button.onclick = () => location.reload();
    this.banners.show("upgrade", tr("The gateway has been upgraded from {old} to {new}.", { old, new: fresh }), button);
  }

  // --- what the gateway tells

  _listenToGateway() {
    const gateway = this.connection, on = (type, act) => gateway.addEventListener(type, ({ detail }) => act(detail));
    // What goes on is told again on a new link, and what is over is not.
    on("open", () => this.alarms.forget());
    on("up", (hello) => {
      this._greeted(hello);
      this._choosePositions();
      gateway.ask("get_commands", { limit: 200 }).then(({ commands }) => commands.reverse().forEach((one) => this._task(one)), () => {});
      // The site may be another publication, or the gateway another version, than before the link was lost.
      this._newSite();
    });
    on("hello", (hello) => {
      this._greeted(hello);
      if (this.views.isDue) this._renewView();
    });
    on("down", () => {
      this.isCurrent = false;
      this._tick();
    });
    on("ended", (reason) => this._signOut(reason));
    on("refused", (reason) => this.banners.show("refused", reason));
    on("positions", (positions) => this._positions(positions));
    on("notice", (notice) => this._notice(notice));
  }

  _greeted(hello) {
    const before = this.account?.role;
    this._standOn(hello);
    this.account = { name: hello.operator, role: hello.role };
    this.others = otherPages(hello.gateways);
    this.bounds = hello.site.bounds;
    this.views.count(hello.robots);
    this.banners.show("refused", "");
    this.stop.update(hello.emergency);
    by("account").textContent = tr("{name}, {role}", this.account);
    if (before !== hello.role) this._showRobot();
    this._setConnection("up");
  }

  /** Forget what is of another fleet or another frame than this gateway's: nothing of it may be sent to this one. */
  _standOn({ database, site: { crs, origin, rotation } }) {
    const frame = { crs, origin, rotation }, isKnown = this.database !== null;
    const isAnother = isKnown && (database !== this.database || !isSame(frame, this.frame));
    this.database = database;
    this.frame = frame;
    if (isAnother) {
      this.robots.clear();
      this.tasks.clear();
      this.fleet = null;
      this.list.forget();
      this._select(null);
      this.banners.showUntilRead("ground", tr("Another site, or another fleet, is served now than before. What was being made was not sent. Look at the map."));
    }
    if (this.site && !isSame(this.site.frame, frame)) {
      this.site = null;
      this.views.restart();
      this.map.hideSite();
      this._siteAgain();
    }
  }

  _positions({ robots, everything, removed, untracked, view }) {
    if (everything) this.robots.clear();
    if (everything || view) this.fleet = view;
    for (const name of [...removed, ...untracked]) this.robots.delete(name);
    const at = steadyNow();
    for (const [name, one] of robots) this.robots.set(name, { ...one, at });
    this.isCurrent = this.connection.isUp;
    // One of that name that comes later is another one.
    const isGone = removed.includes(this.selected) || (everything && !view && !this.robots.has(this.selected));
    if (this.selected !== null && isGone) {
      this.banners.showUntilRead("gone", tr("{robot} was removed.", { robot: this.selected }));
      this._select(null);
    }
    this._draw();
  }

  _notice({ method, params }) {
    if (method === "emergency") this.stop.update(params);
    else if (method === "command") this._task(params);
    else if (method === "site") this._newSite();
    this.alarms.update(method, params);
    this.alarms.show(this.robots, this.fleet);
  }

  async _newSite() {
    await fetchSite(this.token).then((answer) => this._readSite(answer)).catch(() => {});
    this._siteAgain();
  }

  /** Ask for the site until it is there: without it neither it nor robots are drawn. */
  _siteAgain() {
    clearTimeout(this._siteTimer);
    if (this.site === null && this.account) this._siteTimer = setTimeout(() => this._newSite(), SITE_AGAIN_MS);
  }

  _task(report) {
    this.tasks.set(report.robot, report);
    // Of one that was not answered the gateway says so after all.
    if (this.target.draft && report.command === this.target.draft.command) this._wasSent(this.target.draft);
    if (report.robot === this.selected) this._showRobot();
  }

  // --- what is shown

  _tick() {
    const silent = this.connection.silence(), isSilent = this.connection.isUp ? silent > SILENT_AFTER_MS / 1000 : true;
    if (this.account) this._setConnection(isSilent ? "silent" : "up");
    const seconds = Math.round(silent ?? 0);
    this.banners.show(
      "network",
      !navigator.onLine
        ? tr("This phone has no network.")
        : this.account && isSilent
          ? tr("The gateway does not answer. Robots are shown where they were {s} s ago.", { s: seconds })
          : "",
      null,
      "bad",
    );
    this._offerOthers(this.account !== null && isSilent && navigator.onLine);
    this._measure();
    if (this.selected) this._showRobot();
    this._draw();
    this.stop.show();
  }

  /** Name the other gateways of the fleet: the page itself may connect to its own alone. */
  _offerOthers(isSilent) {
    const wanted = isSilent && this.others.length > 0;
    // Replaced under the thumb, a link would not be followed.
    if (wanted === this.banners.has("others")) return;
    const links = element("span");
    for (const address of wanted ? this.others : []) {
      const link = element("a", new URL(address).host);
      link.href = address;
      links.append(" ", link);
    }
    this.banners.show("others", wanted ? tr("Open this page at another gateway of the fleet:") : "", links);
  }

  /** Keep to the budget of a phone's contract: fewer positions where there are many robots. */
  _measure() {
    this.traffic.push(this.connection.received);
    if (this.traffic.length > 61) this.traffic.shift();
    const minute = this.traffic.at(-1) - this.traffic[0];
    by("traffic").textContent = tr("{kb} kB in the last minute", { kb: Math.round(minute / 1000) });
    // What else comes, such as a burst of reports, does not get less by asking for fewer positions.
    if (this.connection.isUp && !this.connection.byPolling && this.budget.note(this.connection.positionsReceived)) {
      this._subscribe();
    }
  }

  _choosePositions() {
    this.budget.restart();
    this._chooseView();
    this._subscribe();
  }

  _subscribe() {
    const { rate, form } = this.budget.step;
    this.connection.choosePositions(by("updates").value === "poll", rate, form, this.views.view);
  }

  /** Return whether the view to ask for is another one now. A site that cannot be drawn is seen as a whole. */
  _chooseView() {
    return this.views.renew(this.map.seen ?? this.bounds, this.selected);
  }

  /** Ask for what the map shows of a large fleet, unless that is what was asked for. */
  _renewView() {
    clearTimeout(this._moving);
    if (this.connection.isUp && this._chooseView()) this._subscribe();
  }

  _moved() {
    clearTimeout(this._moving);
    this._moving = setTimeout(() => this._renewView(), STILL_MS);
  }

  _setConnection(state) {
    const seconds = Math.round(this.connection.silence() ?? 0);
    const text = {
      up: () => tr("connected"),
      connecting: () => tr("connecting"),
      none: () => tr("no answer for {s} s", { s: seconds }),
      silent: () => tr("no answer for {s} s", { s: seconds }),
      out: () => tr("not signed in"),
    }[state]();
    by("connection").textContent = text;
    by("connection").className = state === "up" ? "up" : "down";
  }

  _draw() {
    this.map.showRobots(this.robots.values(), this.fleet?.density, this.selected, !this.isCurrent);
    if (!by("menu").hidden) this.list.show(this.robots, this.fleet, this.isCurrent);
    this.alarms.show(this.robots, this.fleet);
  }

  /** Say how many robots of a large fleet are in view. */
  _count(shown) {
    const language = document.documentElement.lang, values = { n: shown.toLocaleString(language), all: this.fleet?.robots.toLocaleString(language) };
    by("count").hidden = this.fleet === null;
    by("count").textContent = !this.fleet
      ? ""
      : this.fleet.density && shown
        ? tr("Robots here: {n} of {all}. Zoom in to see each.", values)
        : tr("Robots here: {n} of {all}.", values);
  }

  // --- one robot

  _select(name, { close = false } = {}) {
    this.selected = name;
    this.panel.answer("");
    this._endTarget();
    if (close) this._close("menu");
    by("robot").hidden = name === null;
    const found = this.list.found(name);
    if (found && !this.robots.has(name)) this.robots.set(name, found);
    this._draw();
    if (name !== null) {
      this._showRobot();
      this.map.lookAt(name, by("robot").offsetHeight);
      if (close) by("robot-close").focus();
    }
    this._renewView();
  }

  _showRobot() {
    const name = this.selected;
    if (name === null || this.target.isOpen) return;
    const role = this.account?.role ?? "viewer";
    this.panel.show(name, { robot: this.robots.get(name), task: this.tasks.get(name), role, isCurrent: this.isCurrent });
  }

  /**
   * Ask for something of a robot, and say what became of it: in `panel`, unless another robot is chosen by then, or
   * something else was pressed or another target of it is made: then where it is read all the same.
   */
  async _do(what, ask, panel = this.panel) {
    const robot = this.selected, draft = this.target.draft, press = (this._press = {});
    const say = (text, refused = false) => {
      if (draft?.wasSent) return;
      if (this.selected === robot && this.target.draft === draft && this._press === press) panel.answer(text, refused);
      else this.banners.showUntilRead(`answer ${robot} ${what}`, `${robot}, ${what}: ${text}`, refused);
    };
    panel.answer("…");
    try {
      const result = await ask();
      // It may have been reported before it was answered.
      if (draft && draft === this.target.draft) this._wasSent(draft);
      else say(tr("sent"));
      return result;
    } catch (error) {
      say(failure(error), true);
      return null;
    }
  }

  /** Ask for what sets a robot in motion: of no gateway that has not said yet which fleet is its own. */
  _move(method, params) {
    if (this.connection.isUp) return this.connection.ask(method, params);
    return Promise.reject(new AnswerError("not connected", { silent: true, sent: false }));
  }

  /** Abort or pause the chosen robot, past a link that does not answer. */
  _hold(what, method, params, goesOn) {
    this.holds++;
    const all = { ...params, robot: this.selected, reason: "field page" };
    return this._do(what, () => this.connection.insist(method, all, goesOn));
  }

  _pause() {
    const resumed = this.resumes;
    // Resumed meanwhile, it is not paused later.
    return this._hold(tr("Pause"), "pause_robot", {}, () => this.resumes === resumed);
  }

  _resume() {
    const robot = this.selected, holds = this.holds;
    this.resumes++;
    return this._do(tr("Resume"), async () => {
      const { queues } = await this._move("get_queue", { robot });
      // Its answer may be of after a pause that was pressed meanwhile, which is what holds.
      if (holds !== this.holds) throw new AnswerError(tr("something that holds robots was pressed since"));
      if (queues[0]) await this._move("resume_queue", { robot, revision: queues[0].revision });
    });
  }

  // --- a target

  _beginTarget(byCoordinates) {
    by("robot").hidden = true;
    this.target.begin(this.selected, byCoordinates);
  }

  _endTarget() {
    this.target.end();
    by("robot").hidden = this.selected === null;
  }

  async _send() {
    const { draft } = this.target;
    let order;
    try {
      order = this.target.order();
    } catch (error) {
      this.target.answer(error.message, true);
      return;
    }
    by("send").disabled = true;
    const sent = await this._do(tr("Send"), () => this._move("send", order), this.target);
    if (sent) this._task(sent);
    if (draft === this.target.draft) by("send").disabled = false;
  }

  _wasSent(draft) {
    draft.wasSent = true;
    this._endTarget();
    this.panel.answer(tr("sent"));
    this._showRobot();
  }

  // --- the page itself

  _listenToPage() {
    const on = (id, type, act) => by(id).addEventListener(type, act);
    on("menu-button", "click", () => (by("menu").hidden ? this._openMenu() : this._close("menu")));
    on("robot-close", "click", () => this._select(null));
    on("abort", "click", () => this._hold(tr("Abort"), "abort", { command: newId() }, () => true));
    on("pause", "click", () => this._pause());
    on("resume", "click", () => this._resume());
    on("target", "click", () => this._beginTarget(false));
    on("coordinates", "click", () => this._beginTarget(true));
    on("send", "click", () => this._send());
    on("cancel", "click", () => (this._endTarget(), this._showRobot()));
    on("whole", "click", () => this.map.showWhole());
    on("here", "click", () => this.ownPosition.find());
    on("sign-out", "click", () => this._signOut());
    on("language", "change", () => this._chooseLanguage(by("language").value));
    on("updates", "change", () => this._choosePositions());
    on("login-form", "submit", (event) => {
      event.preventDefault();
      this._signIn(by("token").value.trim(), { remember: by("remember").checked });
      by("token").value = "";
    });
    this.list.addEventListener("robot", ({ detail }) => this._select(detail, { close: true }));
    this.map.addEventListener("robot", ({ detail }) => this._select(detail));
    this.map.addEventListener("moved", () => this._moved());
    this.map.addEventListener("drawn", ({ detail }) => this._count(detail));
    this.map.addEventListener("tiles-failed", () => this.banners.show("tiles", tr("The background map does not answer; everything else works.")));
    this.map.addEventListener("tiles-came", () => this.banners.show("tiles", ""));
    new ResizeObserver(() => this.map.resized()).observe(by("map"));
    window.addEventListener("hashchange", () => location.hash.includes("token=") && this.begin());
    for (const [code, name] of Object.entries(LANGUAGES)) {
      const option = element("option", name);
      option.value = code;
      option.lang = code;
      by("language").append(option);
    }
  }

  _openMenu() {
    this.list.renew();
    by("menu").hidden = false;
    by("menu-button").textContent = tr("Map");
    by("menu-button").setAttribute("aria-expanded", "true");
    this.list.show(this.robots, this.fleet, this.isCurrent);
  }

  _close(id) {
    by(id).hidden = true;
    by("menu-button").setAttribute("aria-expanded", "false");
    this.alarms.show(this.robots, this.fleet);
  }

  _chooseLanguage(language) {
    setLanguage(language);
    keep(LANGUAGE, language, true);
    by("language").value = language;
    translatePage();
    this.target.label();
    by("alarms").dataset.said = "";
    this.alarms.show(this.robots, this.fleet);
    this._showRobot();
    this.stop.show();
  }
}

function isSame(one, other) {
  return JSON.stringify(one) === JSON.stringify(other);
}

function failure(error) {
  if (!error.silent) return tr("Refused: {reason}", { reason: error.message });
  return error.sent
    ? tr("No answer: it is not known whether this was done. Look at the last task.")
    : tr("Not sent: the gateway does not answer.");
}

/** Return what is kept in this tab, or on this phone. */
function stored(key) {
  return sessionStorage.getItem(key) ?? localStorage.getItem(key);
}

function keep(key, value, onPhone) {
  sessionStorage.removeItem(key);
  localStorage.removeItem(key);
  if (value) (onPhone ? localStorage : sessionStorage).setItem(key, value);
}

new Field().begin();
