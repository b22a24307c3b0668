// What was done in a run, as lines that can be selected and copied.
// @ts-check
import {button, element, say} from "./dom.js";

const LINES = 10000; // lines that are kept

/** The log: lines of Lua that were done, and why others were not, as comments. */
export function makeLog() {
    const list = element("pre", {
        className: "log",
        tabIndex: 0,
        role: "log",
        ariaLabel: "Lines that repeat what was done, and what was refused"
    });
    const copy = button(
        "Copy",
        () => navigator.clipboard.writeText(list.textContent).then(() => say("The log is in the clipboard."), select),
        "Copy the log");
    const node =
        element("div", {hidden: true}, element("h2", {}, "Log"), list, element("div", {className: "buttons"}, copy));
    let lines = 0;

    /** Where a browser lets nothing into the clipboard. */
    function select() {
        getSelection()?.selectAllChildren(list);
        say("The log is selected: copy it with Ctrl+C.");
    }

    return {
        node,
        clear() {
            list.replaceChildren();
            lines = 0;
        },
        add(/** @type {string} */ text) {
            const below = list.scrollTop + list.clientHeight > list.scrollHeight - 20;
            node.hidden = false;
            list.append(text.replaceAll("\n", " ") + "\n");
            if (++lines > LINES) list.firstChild.remove();
            if (below) list.scrollTop = list.scrollHeight;
        }
    };
}
