// A running program: its endless answer is read frame by frame, commands are posted to it. Nothing else is ever
// fetched. Frames come as fast as they may; who looks takes what has come, which is all that is new and what is so now:
// nothing piles up.
// @ts-check

const MOST_BYTES = 1 << 30; // of a frame
const KEPT_TOKEN = "talus token";

/**
 * The end of the first frame in the bytes, or -1 while it is not whole: chunks up to DONE; in `now` where those of the
 * moment begin, with FRAM.
 * @param {Uint8Array} bytes
 * @param {number} length
 * @param {{begin: number, at: number, now: number}} state
 */
function frameEnd(bytes, length, state) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, length);
    while (state.at + 8 <= length) {
        const size = view.getUint32(state.at + 4, true), next = state.at + 8 + size + (4 - size % 4) % 4;
        if (next - state.begin > MOST_BYTES) throw new Error("A frame of the run is longer than 1 GB.");
        if (next > length) return -1;
        const name = String.fromCharCode(...bytes.subarray(state.at, state.at + 4));
        if (name === "FRAM" && state.now < 0) state.now = state.at;
        state.at = next;
        if (name === "DONE") return next;
    }
    return -1;
}

/** Takes the token out of the address, where others could read it. */
export function takeToken() {
    const given = new URLSearchParams(location.search).get("token") ?? "";
    try { // kept for this tab, so that the page can be loaded again
        if (given) sessionStorage.setItem(KEPT_TOKEN, given);
        if (given) history.replaceState(null, "", location.pathname + location.hash);
        return given || sessionStorage.getItem(KEPT_TOKEN) || "";
    } catch {
        return given;
    }
}

/** Chunks one after the other. @param {Uint8Array[]} parts */
function joined(parts) {
    const out = new Uint8Array(parts.reduce((n, p) => n + p.length, 0));
    let at = 0;
    for (const p of parts) {
        out.set(p, at);
        at += p.length;
    }
    return out.buffer;
}

/** What has come of a run, and was not taken yet. */
export class Feed {
    constructor() {
        /** @type {Uint8Array[]} */ this.news = [];
        /** @type {Uint8Array | null} */ this.now = null;
        this.number = -1;  // of the last frame
        this.anew = false; // news has begun anew: it tells all again
        this.over = false;
        this.fault = "";
        this.wake = () => {};
    }

    /** @param {Uint8Array} news @param {Uint8Array} now ends with DONE and the frame's number */
    put(news, now) {
        const number = new DataView(now.buffer, now.byteOffset + now.length - 4).getUint32(0, true);
        if (number <= this.number) {
            this.news = [];
            this.anew = true;
        }
        this.number = number;
        if (news.length) this.news.push(news);
        this.now = now;
        this.wake();
    }

    /** @param {string} fault */
    end(fault) {
        this.over = true;
        this.fault = fault;
        this.wake();
    }

    /**
     * Waits for something new; null when there will be nothing more.
     * @returns {Promise<{news: ArrayBuffer, now: ArrayBuffer, anew: boolean} | null>}
     */
    async take() {
        while (!this.now) {
            if (this.over) return null;
            await new Promise((done) => {
                this.wake = () => done(0);
            });
        }
        const out = {news: joined(this.news), now: joined([this.now]), anew: this.anew};
        this.news = [];
        this.anew = false;
        this.now = null;
        return out;
    }
}

/** The sentence of a refusal. @param {Response} answer */
async function saidBy(answer) {
    return (await answer.text()).slice(0, 300) || `The program answers with status ${answer.status}.`;
}

/** Reads until the program ends. @param {string} token @param {Feed} feed */
export async function readRun(token, feed) {
    const answer =
        await fetch("scene", {headers: {"X-Talus-Token": token}, cache: "no-store", referrerPolicy: "no-referrer"});
    if (!answer.ok || !answer.body)
        throw new Error(
            answer.status === 403 ? "The program refuses this page: open the address it has printed, with its token."
                                  : await saidBy(answer));
    const reader = answer.body.getReader();
    let bytes = new Uint8Array(1 << 20), length = 0;
    const state = {begin: 0, at: 0, now: -1};
    for (;;) {
        const {done, value} = await reader.read().catch(() => ({done: true, value: new Uint8Array(0)}));
        if (done) return;
        if (length + value.length > bytes.length) {
            const longer = new Uint8Array(Math.max(2 * bytes.length, length + value.length));
            longer.set(bytes.subarray(0, length));
            bytes = longer;
        }
        bytes.set(value, length);
        length += value.length;
        for (let end = frameEnd(bytes, length, state); end >= 0; end = frameEnd(bytes, length, state)) {
            const now = state.now < 0 ? state.begin : state.now;
            feed.put(bytes.slice(state.begin, now), bytes.subarray(now, end));
            state.begin = end;
            state.now = -1;
        }
        if (feed.now?.buffer === bytes.buffer) feed.now = feed.now.slice();
        bytes.copyWithin(0, state.begin, length);
        length -= state.begin;
        state.at -= state.begin;
        state.now -= state.now < 0 ? 0 : state.begin;
        state.begin = 0;
    }
}

/**
 * @param {string} token
 * @param {string} body
 * @returns {Promise<{status: number, refused: string}>} a sentence when it was refused
 */
export async function postCommand(token, body) {
    try {
        const answer = await fetch("command", {
            method: "POST",
            headers: {"X-Talus-Token": token, "Content-Type": "application/json"},
            body,
            referrerPolicy: "no-referrer"
        });
        return {status: answer.status, refused: answer.ok ? "" : await saidBy(answer)};
    } catch {
        return {status: 0, refused: "The program does not answer: has it ended?"};
    }
}
