// Elements of the page. Text of the model goes into text nodes only.
// @ts-check

/** @param {string} id @returns {HTMLElement} */
export function byId(id) { return /** @type {HTMLElement} */ (document.getElementById(id)); }

/** @param {string} tag @param {Record<string, any>} properties @param {(Node | string)[]} children @returns {any} */
export function element(tag, properties = {}, ...children) {
    const e = document.createElement(tag);
    for (const [name, value] of Object.entries(properties)) {
        if (name.startsWith("aria") || name === "role" || name === "for")
            e.setAttribute(name.replace("aria", "aria-").toLowerCase(), String(value));
        else /** @type {any} */ (e)[name] = value;
    }
    e.append(...children);
    return e;
}

/**
 * A control with its words before it.
 * @param {string} words
 * @param {HTMLElement} input
 * @param {(Node | string)[]} after
 */
export function labelled(words, input, ...after) {
    input.setAttribute("aria-label", words);
    return element("div", {className: "row"}, element("span", {}, words), input, ...after);
}

/** @param {string} words @param {() => boolean} get @param {(on: boolean) => void} set */
export function checkBox(words, get, set) {
    const input = element("input", {type: "checkbox", onchange: () => set(input.checked)});
    return {node: element("label", {}, input, words), update() { input.checked = get(); }};
}

/**
 * @param {string} words
 * @param {number} low
 * @param {number} high
 * @param {number} step
 * @param {() => number} get
 * @param {(v: number) => void} set
 * @param {() => string} text
 */
export function slider(words, low, high, step, get, set, text) {
    const out = element("output");
    const input = element("input", {type: "range", min: low, max: high, step, oninput: () => set(Number(input.value))});
    const node = labelled(words, input, out);
    return {
        node,
        input,
        update() {
            if (document.activeElement !== input || Math.abs(Number(input.value) - get()) > step)
                input.value = String(get());
            out.textContent = text();
            input.setAttribute("aria-valuetext", text());
        }
    };
}

/**
 * @param {string} words
 * @param {() => [string, string][]} options
 * @param {() => string} get
 * @param {(v: string) => void} set
 */
export function choice(words, options, get, set) {
    const input = element("select", {onchange: () => set(input.value)});
    let known = "";
    return {
        node: labelled(words, input),
        update() {
            const list = options(), key = JSON.stringify(list);
            if (key !== known)
                input.replaceChildren(...list.map(([value, text]) => element("option", {value, textContent: text})));
            known = key;
            input.value = get();
        }
    };
}

/** @param {string} words @param {() => void} act @param {string} [title] */
export function button(words, act, title) {
    const e = element("button", {type: "button", textContent: words, onclick: act});
    if (title) {
        e.title = title;
        e.setAttribute("aria-label", title);
    }
    return e;
}

/** A sentence in the line for the state. @param {string} text @param {boolean} [bad] */
export function say(text, bad = false) {
    const line = byId("status");
    line.textContent = text;
    line.classList.toggle("bad", bad);
}
