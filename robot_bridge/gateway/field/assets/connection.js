/** The link to the gateway: JSON-RPC over one WebSocket, connected again for as long as the page is open. */

export const ASK_EVERY_MS = 1000;
/** Milliseconds without any answer after which the gateway counts as silent. */
export const SILENT_AFTER_MS = 3000;
const ANSWER_WITHIN_MS = 10000;
const FIRST_WAIT_MS = 500;
const LONGEST_WAIT_MS = 8000;
/** Milliseconds in which nothing of the page ran, after which it was asleep: what waited meanwhile is of long ago. */
const ASLEEP_AFTER_MS = 5000;
const HEADERS_WITHIN_MS = 10000;
/** Milliseconds for an answer about what holds robots, before it is asked for on another link, and between two. */
const FIRST_ANSWER_MS = 1500, BETWEEN_MS = 300;
/** Close codes that say that the token, or the session, does not hold any more. */
const ENDED = new Set([4003, 4004]);
/** The rate of a subscription cannot be 0: so seldom, and of next to nobody, where positions are asked for. */
const QUIET = { rate: 0.01, form: "places", view: { bounds: [0, 0, 1, 1], most: 1 } };

/** An error that the gateway answered with, or the absence of an answer (`silent`). */
export class AnswerError extends Error {
  constructor(message, { silent = false, sent = true } = {}) {
    super(message);
    this.silent = silent;
    this.sent = sent;
  }
}

/** Return an id that nobody else has; crypto.randomUUID is there for pages with https only. */
export function newId() {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
}

let clocks = { date: Date.now(), steady: performance.now() }, slept = 0;

/** Milliseconds that only grow, those included for which the phone slept: performance.now() stands still then. */
export function steadyNow() {
  const date = Date.now(), steady = performance.now(), more = date - clocks.date - (steady - clocks.steady);
  clocks = { date, steady };
  // A clock that is set ahead makes what is known older than it is, never newer.
  if (more > ASLEEP_AFTER_MS) slept += more;
  return steady + slept;
}

/** Ask for the site, which a phone may load for a minute; rejects where the gateway does not begin to answer. */
export async function fetchSite(token) {
  const aborter = new AbortController(), timer = setTimeout(() => aborter.abort(), HEADERS_WITHIN_MS);
  const headers = token ? { Authorization: `Bearer ${token}` } : {};
  try {
    return await fetch("/field/site.json", { headers, signal: aborter.signal });
  } finally {
    clearTimeout(timer);
  }
}

function address() {
  return `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/desk`;
}

/**
 * Return the addresses of this page at the other gateways of a fleet, of which hello named the URLs of desks, this
 * one's first. A page with https leads to none without.
 */
export function otherPages(urls) {
  const schemes = location.protocol === "https:" ? ["wss:"] : ["ws:", "wss:"], pages = [];
  for (const text of (urls ?? []).slice(1)) {
    const url = new URL(text);
    if (!schemes.includes(url.protocol) || url.host === location.host) continue;
    const path = url.pathname.replace(/\/desk$/, "/field");
    pages.push(`${url.protocol === "wss:" ? "https" : "http"}://${url.host}${path}`);
  }
  return pages;
}

function openSocket(token) {
  const socket = new WebSocket(address(), token ? ["robot-bridge", `token.${token}`] : []);
  socket.binaryType = "arraybuffer";
  return socket;
}

/**
 * Events: `open` (a link is there, and nothing came on it yet), `up` (detail: the answer to hello), `down`, `ended` (detail: why the session is over), `notice`
 * (detail: {method, params}), `positions` (detail: {robots: rows by name, everything, removed,
 * untracked: those that the page is told of no more, view: null where nothing is new of it}).
 */
export class Connection extends EventTarget {
  constructor() {
    super();
    this.token = "";
    this.isUp = false;
    this.byPolling = false;
    this.received = 0;
    this.positionsReceived = 0;
    this.heardAt = null;
    /** Milliseconds of the gateway's clock for deadlines less those of the page's own; null where it has none. */
    this._ahead = null;
    this._socket = null;
    this._waiting = new Map();
    this._nextId = 1;
    this._wait = FIRST_WAIT_MS;
    this._timer = null;
    this._wanted = false;
    this._ranAt = steadyNow();
    setInterval(() => this._watch(), ASK_EVERY_MS);
    window.addEventListener("online", () => this._retryNow());
    document.addEventListener("visibilitychange", () => document.hidden || this._wake() || this._retryNow());
    // Kept by the browser while another page was shown: its link is over, whatever it looks like.
    window.addEventListener("pageshow", ({ persisted }) => persisted && this._renew());
  }

  start(token) {
    this.stop();
    this.token = token;
    this._wanted = true;
    this._wait = FIRST_WAIT_MS;
    this._open();
  }

  stop() {
    this._wanted = false;
    clearTimeout(this._timer);
    this._drop();
  }

  /** Seconds since the gateway was heard last, null before it was. */
  silence() {
    return this.heardAt === null ? null : (steadyNow() - this.heardAt) / 1000;
  }

  /**
   * Ask for something; rejects with AnswerError when it is refused, not sent or not answered. What the page waits for no
   * longer the gateway does not begin any more, unless it holds robots.
   */
  ask(method, params, within = ANSWER_WITHIN_MS) {
    const socket = this._socket;
    if (!socket || socket.readyState !== WebSocket.OPEN) {
      return Promise.reject(new AnswerError("not connected", { silent: true, sent: false }));
    }
    const id = this._nextId++;
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => {
        this._waiting.delete(id);
        reject(new AnswerError("no answer", { silent: true }));
      }, within);
      this._waiting.set(id, { resolve, reject, timer });
      const deadline = this._ahead === null ? undefined : (steadyNow() + this._ahead + within) / 1000;
      socket.send(JSON.stringify({ jsonrpc: "2.0", id, method, params, deadline }));
    });
  }

  /** Ask on a socket of its own, past whatever is the matter with the other one. */
  askAside(method, params, within) {
    return new Promise((resolve, reject) => {
      const socket = openSocket(this.token);
      const end = (then, value) => {
        clearTimeout(timer);
        socket.onclose = socket.onmessage = null;
        socket.close();
        then(value);
      };
      const timer = setTimeout(() => end(reject, new AnswerError("no answer", { silent: true })), within);
      socket.onopen = () => socket.send(JSON.stringify({ jsonrpc: "2.0", id: 1, method, params }));
      socket.onclose = () => end(reject, new AnswerError("not connected", { silent: true, sent: false }));
      socket.onmessage = ({ data }) => {
        const answer = typeof data === "string" ? JSON.parse(data) : {};
        if (answer.id !== 1) return;
        if (answer.error) end(reject, new AnswerError(answer.error.message));
        else end(resolve, answer.result);
      };
    });
  }

  /** Ask for what holds robots: past a link that does not answer, the same again, for as long as `goesOn` says so. */
  async insist(method, params, goesOn) {
    const until = steadyNow() + ANSWER_WITHIN_MS;
    let sent = false;
    for (let aside = false; ; aside = true) {
      try {
        return await (aside ? this.askAside(method, params, FIRST_ANSWER_MS) : this.ask(method, params, FIRST_ANSWER_MS));
      } catch (error) {
        if (!error.silent) throw error;
        sent ||= error.sent;
        if (!this._wanted || steadyNow() > until || !goesOn()) throw new AnswerError("no answer", { silent: true, sent });
        await new Promise((resolve) => setTimeout(resolve, BETWEEN_MS));
      }
    }
  }

  /** Choose how positions come: told when they change, or asked for every 600 ms; of all robots, or by a view. */
  choosePositions(byPolling, rate, form, view) {
    this.byPolling = byPolling;
    this._wantedView = view ? { view } : {};
    if (!this.isUp) return;
    if (!byPolling) {
      this._endPolling();
      this.ask("subscribe", { rate, form, ...this._wantedView }).catch(() => {});
    } else if (!this._polling) {
      this.ask("subscribe", QUIET).catch(() => {});
      this._polling = setInterval(() => this._poll(), 600);
    }
  }

  _poll() {
    const asked = this._wantedView;
    // What comes of an earlier view, or after positions are told again, is not what is wanted.
    const isWanted = () => this.byPolling && asked === this._wantedView;
    this.ask("get_positions", asked).then((answer) => isWanted() && this._tell("positions", rowsOf(answer)), () => {});
  }

  _endPolling() {
    clearInterval(this._polling);
    this._polling = null;
  }

  _open() {
    const socket = openSocket(this.token);
    this._socket = socket;
    this._ahead = null;
    socket.onopen = async () => {
      this._tell("open", null);
      try {
        const hello = await this._greet(SILENT_AFTER_MS);
        this.isUp = true;
        this._wait = FIRST_WAIT_MS;
        this._tell("up", hello);
      } catch (error) {
        if (!error.silent) this._tell("refused", error.message);
        this._drop();
      }
    };
    socket.onmessage = ({ data }) => this._read(data);
    socket.onclose = ({ code, reason }) => this._closed(socket, code, reason);
  }

  async _greet(within) {
    const hello = await this.ask("hello", { operator: "field page", protocol: 1 }, within);
    // Its time when it answered, so that none of what is asked for has longer than it should.
    if (Number.isFinite(hello.now)) this._ahead = 1000 * hello.now - steadyNow();
    return hello;
  }

  _read(data) {
    // What lay here while the page slept looks as if it came now.
    if (this._wake()) return;
    this.heardAt = steadyNow();
    this.received += data.byteLength ?? data.length;
    if (typeof data !== "string") {
      this.positionsReceived += data.byteLength;
      if (!this.byPolling) this._tell("positions", tableOf(data));
      return;
    }
    const message = JSON.parse(data);
    if (message.id === undefined || message.id === null) {
      if (message.method) this._tell("notice", message);
      return;
    }
    const one = this._waiting.get(message.id);
    if (!one) return;
    this._waiting.delete(message.id);
    clearTimeout(one.timer);
    if (message.error) one.reject(new AnswerError(message.error.message));
    else one.resolve(message.result);
  }

  _closed(socket, code, reason) {
    if (socket !== this._socket) return;
    this._drop();
    if (ENDED.has(code)) {
      this._wanted = false;
      this._tell("ended", reason);
    }
    if (!this._wanted) return;
    // Not all phones at once when the gateway is back.
    this._timer = setTimeout(() => this._open(), this._wait * (0.5 + Math.random() / 2));
    this._wait = Math.min(2 * this._wait, LONGEST_WAIT_MS);
  }

  _drop() {
    const socket = this._socket, wasUp = this.isUp;
    this._socket = null;
    this.isUp = false;
    this._endPolling();
    for (const { reject, timer } of this._waiting.values()) {
      clearTimeout(timer);
      reject(new AnswerError("no answer", { silent: true }));
    }
    this._waiting.clear();
    if (socket) {
      socket.onopen = socket.onmessage = socket.onclose = null;
      socket.close();
    }
    if (wasUp) this._tell("down", null);
  }

  /** Note that the page runs; return whether it slept before that. Then its link is made again. */
  _wake() {
    const now = steadyNow(), wasAsleep = now - this._ranAt > ASLEEP_AFTER_MS;
    this._ranAt = now;
    if (wasAsleep) this._renew();
    return wasAsleep;
  }

  _renew() {
    if (!this._wanted) return;
    this._drop();
    this._wait = FIRST_WAIT_MS;
    this._retryNow();
  }

  _watch() {
    if (this._wake() || !this.isUp) return;
    if (this.silence() * 1000 > SILENT_AFTER_MS + ASK_EVERY_MS) {
      this._renew();
      return;
    }
    this._greet().then(
      (hello) => this._tell("hello", hello),
      () => {},
    );
  }

  _retryNow() {
    if (!this._wanted || this._socket) return;
    clearTimeout(this._timer);
    this._open();
  }

  _tell(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}

/** Read positions that came as rows. */
function rowsOf(params) {
  const robots = new Map(params.robots.map((one) => [one.robot, one]));
  return { robots, ...newsOf(params) };
}

function newsOf({ everything, removed, untracked, view }) {
  return { everything: everything === true, removed: removed ?? [], untracked: untracked ?? [], view: view ?? null };
}

const WORDS = new Set(["state", "link", "status", "command", "theta_from", "paths", "abilities", "doubt"]);

/** Read positions that came as a table of numbers behind a JSON head (docs/desk-protocol.md). */
export function tableOf(buffer) {
  const begin = 4 + new DataView(buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, begin - 4))).params;
  const at = Math.ceil(begin / 8) * 8, numbers = new DataView(buffer, at), count = head.robots.length * head.columns.length;
  // The form "places" has 32 bits for each number, and every other 64.
  const isShort = buffer.byteLength - at === 4 * count;
  const numberAt = (k) => (isShort ? numbers.getFloat32(4 * k, true) : numbers.getFloat64(8 * k, true));
  const robots = new Map();
  head.robots.forEach((robot, row) => {
    const found = { robot };
    head.columns.forEach((name, column) => {
      const value = numberAt(column * head.robots.length + row);
      if (Number.isNaN(value)) return;
      found[name] = WORDS.has(name) ? head.words[value] : name === "stopped" ? value === 1 : value;
    });
    robots.set(robot, found);
  });
  return { robots, ...newsOf(head) };
}
