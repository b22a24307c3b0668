// Starts the page: reads its frames, or those of a running program, and shows the first picture.
// @ts-check
import {toPixel} from "./camera.js";
import {makeControls} from "./controls.js";
import {byId, say} from "./dom.js";
import {firstView} from "./first.js";
import {column} from "./frames.js";
import {makeHistory} from "./history.js";
import {makeImage} from "./image.js";
import {listen} from "./input.js";
import {makeRun} from "./live.js";
import {takeToken} from "./net.js";
import {Page} from "./page.js";
import {showFrame, tightBox} from "./poses.js";
import {pyramid, touchedFaces} from "./pyramid.js";
import {CAP_FACE} from "./section.js";
import {makeStereonet} from "./stereonet.js";
import {makeTable} from "./table.js";
import {principal, principalAxes} from "./zones.js";

/** @param {Page} app */
function listenAll(app) {
    const history = makeHistory(app);
    if (app.live) app.run = makeRun(app);
    app.parts = [makeTable(app), history, makeStereonet(app), makeControls(app), ...(app.run ? [app.run] : [])];
    listen(app, history);
    new ResizeObserver(() => app.resize()).observe(app.canvas);
    app.canvas.addEventListener("webglcontextlost", (e) => {
        e.preventDefault();
        say("The graphics driver has let go of the picture: load the page again.", true);
    });
    window.addEventListener("hashchange", () => {
        if (location.hash !== app.address) app.fromAddress();
    });
    const more = byId("more");
    more.onclick = () => more.setAttribute("aria-expanded", String(byId("controls").classList.toggle("open")));
    app.resize();
}

/** Looks at all frames that have not been looked at, for the scales of all frames. @param {Page} app */
async function readRest(app) {
    for (const [i, frame] of app.model.frames.entries()) {
        if (frame.whole) continue;
        await new Promise((done) => setTimeout(done));
        await app.model.frame(i);
        if (i % 20 === 0) app.change("look");
    }
    app.change("colour");
}

/** @param {Page} app */
async function begin(app) {
    const packed = /** @type {HTMLElement[]} */ ([...document.querySelectorAll('script[type="text/talus"]')]);
    const opened = () => {
        app.home = (app.shown && tightBox(app.model, app.shown, () => true)) ?? app.home;
    };
    app.view.dark = matchMedia("(prefers-color-scheme: dark)").matches;
    app.reading = packed.length > 0;
    app.live = packed.length === 0 && location.protocol.startsWith("http");
    listenAll(app);
    if (app.blind) say(`${app.blind} The model is not drawn; finding, chart and stereonet are.`, true);
    if (app.run) {
        app.token = takeToken();
        return app.run.follow(async () => {
            app.refresh();
            opened();
            firstView(app);
            app.change("pose");
        });
    }
    if (!packed.length) throw new Error("This page holds no frames.");
    for (const [i, script] of packed.entries()) {
        const text = script.textContent ?? "", d = script.dataset;
        const numbers = [d.bytes, d.time, d.cycle, d.largest].map(Number);
        if (d.model === "0" && i > 0 && i < packed.length - 1 && numbers.every(Number.isFinite))
            app.model.addLater(text, numbers[0], numbers[1], numbers[2], numbers[3]);
        else await app.model.addPacked(text, numbers[0]);
    }
    await app.goTo(0);
    if (app.frame) app.shown = showFrame(app.model, app.frame, app.view);
    opened();
    const given = location.hash.length > 1, found = await app.fromAddress();
    app.refresh();
    if (!found) {
        firstView(app, given);
        app.change("pose");
    }
    readRest(app).catch((error) => say(error.message, true)).finally(() => {
        app.reading = false;
    });
}

document.addEventListener("DOMContentLoaded", async () => {
    /** @type {any} */ const page = globalThis;
    try {
        const app = new Page();
        // For scripts and tests: talus.app is the state, talus.ready is kept when the first picture can be drawn.
        page.talus = {
            app,
            toPixel,
            makeImage: (/** @type {number} */ f) => makeImage(app, f),
            CAP_FACE,
            pyramid,
            touchedFaces,
            principal,
            principalAxes,
            column: (/** @type {string} */ name) => app.frame && column(app.frame.data, app.frame.head, name),
            ready: begin(app)
        };
        await page.talus.ready;
    } catch (error) {
        say(String(/** @type {Error} */ (error).message), true);
    }
});
