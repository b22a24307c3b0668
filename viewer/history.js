// Time: the slider over the frames, playing, and a chart of a number over the frames.
// @ts-check
import {button, byId, element} from "./dom.js";
import {inks, penOf} from "./overlay.js";
import {figure, norm, triple} from "./math.js";

/** @typedef {import("./page.js").Page} App */

const LINE = [
    "", "", "time step, s", "unbalanced force ratio", "largest velocity, m/s", "kinetic energy, J", "damped energy, J",
    "frictional energy, J"
];

/** @param {App} app */
export function makeHistory(app) {
    const chart = element("canvas", {role: "img"}), text = element("div", {className: "unseen"});
    const range = element("input", {
        type: "range",
        min: 0,
        step: 1,
        ariaLabel: "Frame",
        oninput: () => {
            stop();
            app.goTo(range.value === range.max ? Infinity : Number(range.value));
        }
    });
    range.setAttribute("aria-label", "Frame");
    const out = element("output");
    const what = element("select", {
        onchange: () => {
            app.chart = what.value;
            update();
        }
    });
    what.setAttribute("aria-label", "Chart of");
    const speed = element(
        "select", {
            onchange: () => {
                app.speed = Number(speed.value);
            }
        },
        ...[0.25, 0.5, 1, 2, 4].map((s) => element("option", {value: s, textContent: `${s} ×`})));
    speed.value = "1";
    speed.setAttribute("aria-label", "Speed of playing");
    const play = button("▶", () => toggle(), "Play");
    play.className = "play";
    byId("time").append(play, element("div", {className: "chart"}, chart, range), what, speed, out, text);
    let playing = 0, options = "";
    // displacements, by the frames' numbers
    /** @type {{id: number, values: Map<number, number>}} */ let picked = {id: -1, values: new Map()};
    let reading = false;

    function stop() {
        clearTimeout(playing);
        playing = 0;
        play.textContent = "▶";
        play.setAttribute("aria-label", "Play");
    }

    async function next() {
        const at = app.view.frame, end = app.model.frames.length - 1;
        if (at >= end) return stop();
        const begun = performance.now();
        await app.goTo(at + 1);
        await app.drawn();
        if (playing) playing = setTimeout(next, Math.max(0, 200 / app.speed - (performance.now() - begun)));
    }

    async function toggle() {
        if (playing) return stop();
        if (app.model.frames.length < 2) return;
        play.textContent = "❚❚";
        play.setAttribute("aria-label", "Pause");
        playing = setTimeout(next, 0);
        if (app.view.frame >= app.model.frames.length - 1) await app.goTo(0);
    }

    /** Displacements of the picked block in the frames of which they are not known. */
    async function followPicked() {
        const id = app.view.picked, {frames} = app.model;
        if (picked.id !== id || picked.values.size > 2 * frames.length + 100) picked = {id, values: new Map()};
        const {values} = picked, left = frames.filter((f) => !values.has(f.since));
        if (reading || !left.length) return;
        reading = true;
        try {
            for (const stored of left) {
                const at = app.model.frames.indexOf(stored);
                if (at < 0 || app.view.picked !== id) continue;
                const f = await app.model.frame(at), k = f.poses.id.indexOf(id);
                values.set(f.since, k < 0 ? NaN : norm(triple(f.poses.displacement, k)));
            }
        } finally {
            reading = false;
        }
        if (app.view.picked >= 0) update();
    }

    function series() {
        const frames = app.model.frames;
        if (app.chart === "picked" && app.view.picked >= 0) {
            followPicked();
            return {
                title: `displacement of block ${app.view.picked}, m`,
                values: picked.id === app.view.picked ? frames.map((f) => picked.values.get(f.since) ?? NaN) : []
            };
        }
        const [kind, number] = app.chart.split(":");
        if (kind === "line")
            return {
                title: LINE[Number(number)],
                values: frames.map((f) => f.summary.line?.numbers[Number(number)] ?? NaN)
            };
        if (kind === "history")
            return {
                title: app.model.head?.histories[Number(number)] ?? "",
                values: frames.map((f) => f.summary.line?.histories[Number(number)] ?? NaN)
            };
        return {title: "largest displacement, m", values: frames.map((f) => f.summary.most)};
    }

    function update() {
        const frames = app.model.frames, head = app.model.head, at = app.view.frame;
        range.max = String(Math.max(0, frames.length - 1));
        range.value = String(at);
        const now = frames[at]?.summary;
        out.textContent = now ? `${figure(now.time)} s · cycle ${now.cycle}` : "";
        range.setAttribute("aria-valuetext", now ? `frame ${at + 1} of ${frames.length}, ${out.textContent}` : "");
        const line = frames.some((f) => f.summary.line);
        /** @type {[string, string][]} */ const list = [
            ["largest", "largest displacement"], ["picked", "picked block"],
            .../** @type {[string, string][]} */ (line ? LINE.map((n, i) => [`line:${i}`, n]).filter((v) => v[1]) : []),
            .../** @type {[string, string][]} */ ((head?.histories ?? []).map((n, i) => [`history:${i}`, n]))
        ];
        if (JSON.stringify(list) !== options)
            what.replaceChildren(...list.map(([value, words]) => element("option", {value, textContent: words})));
        options = JSON.stringify(list);
        what.value = app.chart;
        drawChart();
    }

    function drawChart() {
        const {title, values} = series();
        const frames = app.model.frames, width = chart.clientWidth, height = chart.clientHeight;
        if (width < 10 || height < 10) return;
        const pen = penOf(chart, width, height), c = inks(), finite = values.filter(Number.isFinite);
        const high = Math.max(...finite, 0), low = Math.min(...finite, 0), pad = 8, top = 16;
        const times = frames.map((f) => f.summary.time), t0 = times[0] ?? 0;
        const t1 = times[times.length - 1] ?? 1, even = !(t1 > t0);
        const x = (/** @type {number} */ i) =>
            pad + (width - 2 * pad) * (frames.length < 2 ? 0 : i / (frames.length - 1));
        const y = (/** @type {number} */ v) =>
            height - 2 - (height - top - 2) * (high > low ? (v - low) / (high - low) : 0);
        const colour = app.chart === "picked" ? c.accent : c.warm;
        pen.fillStyle = c.soft;
        pen.font = "11px system-ui, 'DejaVu Sans', sans-serif";
        pen.textBaseline = "top";
        const most = finite.length
            ? `${title}: ${figure(finite[finite.length - 1])} at the end, ${figure(high)} at most`
            : `${title}: none`;
        pen.fillText(most, pad, 0);
        pen.beginPath();
        let begun = false;
        values.forEach((v, i) => {
            if (Number.isFinite(v)) {
                begun ? pen.lineTo(x(i), y(v)) : pen.moveTo(x(i), y(v));
                begun = true;
            }
        });
        pen.strokeStyle = colour;
        pen.lineWidth = 1.6;
        pen.stroke();
        if (begun) {
            pen.lineTo(x(values.length - 1), y(low));
            pen.lineTo(x(0), y(low));
            pen.globalAlpha = 0.12;
            pen.fillStyle = colour;
            pen.fill();
            pen.globalAlpha = 1;
        }
        pen.fillStyle = colour;
        pen.fillRect(x(app.view.frame) - 1, top - 2, 2, height - top + 2);
        chart.setAttribute("aria-label", `Chart, ${most}${even ? "" : `, from ${figure(t0)} s to ${figure(t1)} s`}`);
        const step = Math.max(1, Math.ceil(values.length / 60));
        const row = (/** @type {number} */ v, /** @type {number} */ i) =>
            element("tr", {}, element("th", {}, `${figure(times[i])} s`), element("td", {}, figure(v)));
        text.replaceChildren(element(
            "table", {}, element("caption", {}, title), ...values.flatMap((v, i) => (i % step ? [] : [row(v, i)]))));
    }

    return {
        update,
        stop,
        toggle,
        step: (/** @type {number} */ by) => {
            stop();
            app.goTo(app.view.frame + by);
        }
    };
}
