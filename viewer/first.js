// The first picture: it must show what fails, without a click.
// @ts-check
import {meanMotion, named} from "./glyphs.js";
import {fillTable} from "./poses.js";
import {trendPlunge} from "./math.js";

const TRIED = 60000; // triangles of a model up to which several views are tried

/**
 * Pixels of blocks that move, among what a small picture shows.
 * @param {import("./page.js").Page} app
 * @param {Uint8Array} moving by row
 */
function seen(app, moving) {
    const names = app.gpu.names(app.sight(160, 100), app.lookNow(), 160, 100, [0, 0, 160, 100]);
    let count = 0;
    for (const n of names) {
        const what = named(n);
        if (what.kind === "block" && moving[what.index]) count++;
    }
    return count;
}

/**
 * Chooses the side from which most of the moving blocks is seen; where the rest hides them, the rest becomes ghosts.
 * @param {import("./page.js").Page} app
 * @param {boolean} [given] the address tells what is shown, only the side is chosen
 */
export function firstView(app, given = false) {
    const {camera, model, frame, shown} = app;
    if (!frame || !shown) return;
    const motion = meanMotion(model, frame, app.threshold());
    if (motion.count === 0 || motion.count > 0.7 * frame.poses.n) {
        app.oblique = camera.bearing;
        app.fit();
        return;
    }
    const moving = new Uint8Array(model.rows);
    for (let i = 0; i < frame.poses.n; i++)
        if (motion.ids.has(frame.poses.id[i])) moving[frame.rows[i]] = 1;
    const facing = (trendPlunge(motion.direction).trend + 180) % 360, few = model.triangles <= TRIED;
    let best = facing - 35, most = -1;
    for (const by of few ? [-35, 35, -65, 65, -110, 110, 180] : []) {
        camera.bearing = ((facing + by) % 360 + 360) % 360;
        app.fit();
        const count = seen(app, moving) * (1.15 - Math.abs(by) / 600);
        if (count > most) {
            most = count;
            best = camera.bearing;
        }
    }
    camera.bearing = app.oblique = best;
    app.fit();
    if (given) return;
    const kinds = shown.kind.slice();
    const now = seen(app, moving);
    shown.kind.forEach((k, row) => {
        shown.kind[row] = moving[row] ? k : 0;
    });
    fillTable(model, shown, null);
    app.gpu.table("pose", shown.table);
    const alone = seen(app, moving);
    shown.kind.set(kinds);
    fillTable(model, shown, null);
    app.gpu.table("pose", shown.table);
    if (now < 0.6 * alone) app.view.moved = app.threshold();
}
