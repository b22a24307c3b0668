// A run: its frames are followed, its state is told, and commands are sent to it.
// @ts-check
import {button, byId, element, labelled, say} from "./dom.js";
import {figure, planeNormal, scale, add, dot, sub} from "./math.js";
import {makeLog} from "./log.js";
import {Feed, postCommand, readRun} from "./net.js";

/** @typedef {import("./page.js").Page} Page */

const KEPT = 400;    // frames of a run
const ASLEEP = 1000; // ms between two frames while nobody sees the page
const LONGEST = 511; // bytes of a command
// status of a full queue, ms until a further part of a command is tried again, and how often
const BUSY = 503, AGAIN = 200, PATIENCE = 50;
const WORDS = /** @type {Record<string, string>} */ (
    {running: "Running", paused: "Paused", waiting: "Waiting for Go", ended: "Ended", lost: "Broken off"});

/**
 * Commands for blocks, each of at most 511 bytes; where blocks are joined, each begins with the last of the one before.
 * @param {string} op
 * @param {number[]} ids
 * @returns {string[]}
 */
export function blockCommands(op, ids) {
    const out = [];
    /** @type {number[]} */ let part = [];
    for (const id of ids) {
        if (JSON.stringify({op, blocks: [...part, id]}).length > LONGEST) {
            out.push(JSON.stringify({op, blocks: part}));
            part = op === "join" ? part.slice(-1) : [];
        }
        part.push(id);
    }
    return [...out, JSON.stringify({op, blocks: part})];
}

/** @param {Page} app */
export function makeRun(app) {
    const {view} = app;
    const log = makeLog();
    const heading = element("p", {className: "state"});
    const facts = element("p", {className: "facts"});
    const spoken = element("p", {className: "unseen", role: "status", ariaLive: "polite"});
    let state = "running", said = "";

    const takes = () => state !== "ended" && state !== "lost" && app.model.head?.commands === true;

    /** Sends commands one after the other, until one is refused. @param {string[]} bodies */
    async function send(bodies) {
        for (const [i, body] of bodies.entries()) {
            if (new TextEncoder().encode(body).length > LONGEST)
                return say(`A command of more than ${LONGEST} bytes is not taken: shorten the name.`, true);
            let answer = await postCommand(app.token, body);
            for (let n = 0; i > 0 && answer.status === BUSY && n < PATIENCE; n++) {
                await new Promise((done) => setTimeout(done, AGAIN));
                answer = await postCommand(app.token, body);
            }
            if (answer.refused) return say(answer.refused, true);
        }
    }
    const command = (/** @type {object} */ c) => send([JSON.stringify(c)]);

    /** Commands for the picked blocks. @param {string} op @param {string} words @param {string} title */
    const forBlocks = (op, words, title) => button(words, () => {
        const ids = app.picks();
        if (op === "join" && ids.length < 2) return say("Pick at least two blocks that touch, with Ctrl held.", true);
        send(blockCommands(op, ids));
        if (op === "hide" || op === "delete") app.pick(-1);
    }, title);

    /** @param {string} words @param {number} low @param {number} high @param {string} value */
    const number = (words, low, high, value) =>
        element("input", {type: "number", min: low, max: high, step: "any", value, ariaLabel: words});
    /** The value of a field, or NaN. @param {HTMLInputElement} input @param {string} words */
    function valueOf(input, words) {
        const value = input.value === "" ? NaN : Number(input.value);
        const low = Number(input.min || -Infinity), high = Number(input.max || Infinity);
        if (value >= low && value <= high) return value;
        say(`${words} must be a number${input.max ? ` from ${low} to ${high}` : ""}.`, true);
        input.focus();
        return NaN;
    }

    const steps = number("Steps", 1, 1e9, "100");
    const toggle = () => command({op: state === "running" ? "pause" : "go"});
    function step() {
        const n = valueOf(steps, "The number of steps");
        if (n >= 1) command({op: "step", n: Math.round(n)});
    }

    // The section as a joint: what is typed is kept as it is while the section lies there.
    const names = element("datalist", {id: "joints"});
    const joint = element("input", {type: "text", maxLength: 100, ariaLabel: "Joint of the cut", placeholder: "joint"});
    joint.setAttribute("list", "joints");
    const dip = number("Dip, degrees", 0, 90, "");
    const direction = number("Dip direction, degrees", 0, 360, "");
    const origin = ["x", "y", "z"].map((c) => {
        const e = number(`${c} of a point of the cut, m`, -Infinity, Infinity, "");
        e.removeAttribute("min");
        e.removeAttribute("max");
        return e;
    });
    const typed = {key: ""};
    const middle = () => scale(add(app.home.min, app.home.max), 0.5), base = () => app.model.head?.origin ?? [0, 0, 0];
    const sectionKey = () => [view.dip, view.direction, view.position, ...middle()].join();
    function takeSection() {
        const [d, t, ...at] = [dip, direction, ...origin].map((e) => Number(e.value));
        if (!(d >= 0 && d <= 90 && t >= 0 && t <= 360) || !at.every(Number.isFinite)) return;
        view.dip = d;
        view.direction = t;
        view.position = dot(planeNormal(d, t), sub(sub(at, base()), middle()));
        view.cut = true;
        typed.key = sectionKey();
        app.change("pose");
    }
    for (const e of [dip, direction, ...origin]) e.onchange = takeSection;
    function showSection() {
        if (typed.key === sectionKey() || [dip, direction, ...origin].includes(document.activeElement)) return;
        typed.key = sectionKey();
        const point = add(middle(), scale(planeNormal(view.dip, view.direction), view.position));
        const digits = Math.max(0, Math.ceil(-Math.log10(app.reach() * 1e-5)));
        dip.value = String(view.dip);
        direction.value = String(view.direction);
        origin.forEach((e, i) => {
            e.value = String(Number((point[i] + base()[i]).toFixed(Math.min(20, digits))));
        });
    }
    function cut() {
        if (!view.cut) {
            view.cut = true;
            app.change("pose");
            return say("This is where the cut would be: press the button again to make it.");
        }
        if (view.explode > 0 || view.motion !== 1)
            return say("A cut is made where the blocks are: set explode to 0 and motion to × 1 first.", true);
        const at = origin.map((e) => valueOf(e, "A coordinate of the point"));
        const d = valueOf(dip, "The dip"), t = valueOf(direction, "The dip direction");
        if (joint.value === "") {
            joint.focus();
            return say("Give the joint of the cut a name, or choose one.", true);
        }
        if ([...at, d, t].every(Number.isFinite))
            command({op: "cut", joint: joint.value, dip: d, dip_direction: t, origin: at});
    }

    const rubbed = element("select", {ariaLabel: "Joint of the friction"});
    const friction = number("Friction, degrees", 0, 89.9, "30");
    function setFriction() {
        const value = valueOf(friction, "The friction");
        if (Number.isFinite(value)) command({op: "friction", joint: rubbed.value, value});
    }

    const pause = button("Pause", () => command({op: "pause"}), "Pause the run (p)");
    const go = button("Go", () => command({op: "go"}), "Let the run go on (p)");
    const tools = element(
        "div", {hidden: true},
        element(
            "div", {className: "buttons"}, pause, go, steps,
            button("Step", step, "Make so many steps, then pause (n)")),
        element(
            "div", {className: "buttons"},
            button("Save", () => command({op: "snapshot"}), "Save the model as it is now"),
            button("VTK", () => command({op: "write_vtk"}), "Write a frame for ParaView"),
            button("Show all", () => command({op: "show"}), "Show all blocks that are hidden in the run"),
            button(
                "Safety",
                () => {
                    say("Trials on copies are made: the run waits.");
                    command({op: "factor_of_safety"});
                },
                "Find the factor of safety, and pick what fails")),
        element("h2", {}, "Cut"), labelled("joint", joint, names),
        element("div", {className: "row"}, "dip", dip, "direction", direction),
        element("div", {className: "row"}, "point", ...origin),
        element(
            "div", {className: "buttons"},
            button(
                "Cut all visible blocks here", cut,
                "Cut all blocks that are not hidden in the run by this plane: their parts have the joint between " +
                    "them. It cannot be undone")),
        element("h2", {}, "Friction"),
        element(
            "div", {className: "row"}, rubbed, friction, "°",
            button("Set", setFriction, "Set the friction of the joint")));
    joint.setAttribute("aria-label", "Joint of the cut");
    let joints = "";

    function update() {
        const frames = app.model.frames;
        const {summary} = frames[frames.length - 1] ?? {summary: null};
        const numbers = summary?.line?.numbers;
        if (!summary) return;
        const text = [
            `cycle ${summary.cycle}`, `time ${figure(summary.time)} s`,
            ...(numbers && numbers[2] > 0 ? [`dt\u00a0${figure(numbers[2])}\u00a0s`] : []),
            ...(numbers && Number.isFinite(numbers[3]) ? [`ratio ${figure(numbers[3])}`] : [])
        ].join(", ");
        heading.textContent = WORDS[state];
        heading.className = `state ${state}`;
        facts.textContent = text;
        if (said !== state) {
            said = state;
            spoken.textContent = `${WORDS[state]}: ${text}`;
        }
        tools.hidden = !takes();
        pause.setAttribute("aria-pressed", String(state === "paused"));
        go.setAttribute("aria-pressed", String(state === "running"));
        const list = app.model.head?.joints.slice(1) ?? [], key = JSON.stringify(list);
        if (key !== joints) {
            const before = rubbed.value;
            names.replaceChildren(...list.map((value) => element("option", {value})));
            rubbed.replaceChildren(...[...list, "*"].map(
                (value) => element("option", {value, textContent: value === "*" ? "all" : value})));
            if (before) rubbed.value = before;
            joints = key;
        }
        showSection();
    }

    /**
     * What a frame tells of the run.
     * @param {import("./scene.js").Live[]} lives
     * @param {boolean} anew all is told again
     */
    function take(lives, anew) {
        if (anew) log.clear();
        let words = "", bad = false;
        for (const live of lives) {
            state = live.state;
            if (live.line) log.add(live.line);
            if (live.refused) log.add(`-- refused: ${live.refused}`);
            if (live.line || live.refused) {
                words = live.refused || live.line;
                bad = live.refused !== "";
            }
        }
        if (words && !anew && app.model.frames.length > 1) {
            const [first, ...more] = /^model:factor_of.*; blocks (.*)/.exec(words)?.[1].split(", ").map(Number) ?? [];
            if (first) app.pick(first);
            for (const id of more) app.pickMore(id);
            say(words, bad);
        }
        return lives.length > 0;
    }

    /**
     * Follows the run until it ends: takes the newest frame when the picture of the one before is there.
     * @param {() => Promise<void>} opened after the first frame
     */
    async function follow(opened) {
        const feed = new Feed();
        readRun(app.token, feed).then(() => feed.end(""), (error) => feed.end(error.message));
        for (let got = await feed.take(); got; got = await feed.take()) {
            const {model} = app;
            const seen = model.frames[view.frame];
            const {following} = app;
            const told = take(model.addLive(got.news, got.now).live, got.anew);
            model.thin(KEPT, seen);
            const swept = model.sweep();
            view.frame = Math.max(0, model.frames.indexOf(seen));
            app.loud ||= told;
            if (following || swept) await app.goTo(following ? model.frames.length - 1 : view.frame, told);
            else app.tellSoon();
            app.following = following;
            if (model.frames.length === 1) await opened();
            const painted = following && !document.hidden ? [app.painted()] : [];
            await Promise.race([
                ...painted, new Promise((done) => setTimeout(done, painted.length || document.hidden ? ASLEEP : AGAIN))
            ]);
        }
        const closed = state === "ended";
        state = closed ? "ended" : "lost";
        app.tell();
        if (feed.fault) throw new Error(feed.fault);
        if (closed) return say("The run has ended.");
        const cycle = app.model.frames[app.model.frames.length - 1]?.summary.cycle ?? 0;
        say(`The run has broken off: the program is gone. What is seen is its state at cycle ${cycle}.`, true);
    }

    const node =
        element("section", {ariaLabel: "Run"}, element("h2", {}, "Run"), heading, facts, spoken, tools, log.node);
    return {
        node,
        follow,
        update,
        takes,
        key(/** @type {string} */ key) {
            if (!takes() || (key !== "p" && key !== "n")) return false;
            if (key === "p") toggle();
            else step();
            return true;
        },
        blockButtons: () =>
            [forBlocks("hide", "Hide in run", "Hide in the run: what follows, as cuts, leaves them out"),
             forBlocks("fix", "Fix", "Hold them where they are"), forBlocks("free", "Free", "Let them move"),
             forBlocks("join", "Join", "Join them to one body: their contacts hold"),
             forBlocks("unjoin", "Unjoin", "Part the bodies that they were joined to"),
             forBlocks("delete", "Delete", "Delete them. It cannot be undone")]
    };
}
