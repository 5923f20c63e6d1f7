// The least contrast of the elements that arguments[0] selects, as the guidelines for accessible pages count it.
const light = text => { const [r, g, b] = text.match(/[0-9.]+/g).slice(0, 3).map(x => Number(x) / 255)
    .map(x => x <= 0.03928 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
const behind = x => { for (; x; x = x.parentElement) { const c = getComputedStyle(x).backgroundColor;
    if (c !== "rgba(0, 0, 0, 0)") return light(c); } return 1; };
return Math.min(...[...document.querySelectorAll(arguments[0])].filter(x => x.innerText).map(x => {
    const text = light(getComputedStyle(x).color), back = behind(x);
    return (Math.max(text, back) + 0.05) / (Math.min(text, back) + 0.05); }));
