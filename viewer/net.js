// A running program: its endless answer is read frame by frame, commands are posted to it. Nothing else is ever fetched.
// @ts-check

const MOST = 1 << 30; // bytes of a frame

/** Length of the first frame in the bytes, or -1 while it is not whole: chunks up to DONE. @param {Uint8Array} bytes @param {number} length @param {{at: number}} state */
export function frameEnd(bytes, length, state) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, length);
    while (state.at + 8 <= length) {
        const size = view.getUint32(state.at + 4, true), next = state.at + 8 + size + (4 - size % 4) % 4;
        if (next > MOST) throw new Error("A frame of the run is longer than 1 GB.");
        if (next > length) return -1;
        const done = bytes[state.at] === 68 && bytes[state.at + 1] === 79 && bytes[state.at + 2] === 78 && bytes[state.at + 3] === 69;
        state.at = next;
        if (done) return next;
    }
    return -1;
}

/** Takes the token out of the address, where others could read it. */
export function takeToken() {
    const query = new URLSearchParams(location.search), token = query.get("token") ?? "";
    if (token) history.replaceState(null, "", location.pathname + location.hash);
    return token;
}

/** Reads until the program ends. @param {string} token @param {(buffer: ArrayBuffer) => Promise<void>} take */
export async function readRun(token, take) {
    const answer = await fetch("scene", { headers: { "X-Talus-Token": token }, cache: "no-store", referrerPolicy: "no-referrer" });
    if (!answer.ok || !answer.body) throw new Error(answer.status === 403 ? "The program refuses this page: open the address it has printed, with its token." : `The program answers with status ${answer.status}.`);
    const reader = answer.body.getReader();
    let bytes = new Uint8Array(1 << 20), length = 0;
    const state = { at: 0 };
    for (;;) {
        const { done, value } = await reader.read();
        if (done) return;
        if (length + value.length > bytes.length) {
            const longer = new Uint8Array(Math.max(2 * bytes.length, length + value.length));
            longer.set(bytes.subarray(0, length));
            bytes = longer;
        }
        bytes.set(value, length);
        length += value.length;
        for (let end = frameEnd(bytes, length, state); end >= 0; end = frameEnd(bytes, length, state)) {
            await take(bytes.slice(0, end).buffer);
            bytes.copyWithin(0, end, length);
            length -= end;
            state.at = 0;
        }
    }
}

/** @param {string} token @param {object} command @returns {Promise<string>} a sentence when it was refused */
export async function postCommand(token, command) {
    try {
        const answer = await fetch("command", { method: "POST", headers: { "X-Talus-Token": token, "Content-Type": "application/json" }, body: JSON.stringify(command), referrerPolicy: "no-referrer" });
        return answer.ok ? "" : (await answer.text()).slice(0, 300) || `The program answers with status ${answer.status}.`;
    } catch {
        return "The program does not answer: has it ended?";
    }
}
