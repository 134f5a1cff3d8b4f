// The board of a page as a picture that needs no style sheet.
const kDrawn = [
  ...['fill', 'fill-opacity', 'stroke', 'stroke-width', 'stroke-opacity', 'stroke-dasharray', 'stroke-linecap', 'stroke-linejoin'],
  ...['opacity', 'font-weight'],
];

// `page`: of playwright.
export const pictureOf = (page) =>
  page.evaluate((names) => {
    const shown = document.querySelector('.live-board svg');
    const plain = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
    const copy = (from) => {
      const to = from.cloneNode(false);
      const [style, around] = [from, from.parentElement].map((one) => getComputedStyle(one));
      for (const name of ['class', 'style', 'role', 'aria-label', 'aria-hidden', 'focusable']) to.removeAttribute(name);
      for (const name of names) if (style[name] !== (name === 'opacity' ? '1' : around[name])) to.setAttribute(name, style[name]);
      const move = /translate\(([-\d.]+)px, ([-\d.]+)px\)/.exec(from.style.transform);
      if (move) to.setAttribute('transform', `translate(${move[1]} ${move[2]})`);
      for (const child of from.childNodes) to.append(child instanceof Element ? copy(child) : child.cloneNode());
      return to;
    };
    const used = new Set([...shown.innerHTML.matchAll(/url\(#([^)]+)\)/g)].map(([, id]) => id));
    plain.setAttribute('viewBox', shown.getAttribute('viewBox'));
    plain.setAttribute('font-family', 'Helvetica, Arial, sans-serif');
    plain.append(...[...used].map((id) => copy(document.getElementById(id))), ...[...shown.children].map(copy));
    return `${new XMLSerializer().serializeToString(plain).replaceAll('><', '>\n<')}\n`;
  }, kDrawn);
